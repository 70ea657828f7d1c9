//! From power to the first report, and from a report to the state, with everything in between that the board has.

use dwc2_host::{Config, SpeedLimit};
use usb_input::{Event, Kind, Place};
use usb_model::dualshock3::{Temper, dualshock3};
use usb_model::hub::Hub;
use usb_model::keyboard::{Form, Keyboard, keyboard};
use usb_model::shared::Shared;
use usb_model::wire::Speed;

use super::{Whole, port};

/// A keyboard and a DualShock 3 behind a hub that are there at power-on.
pub fn board(limit: SpeedLimit, ports: [usize; 2]) -> (Whole, Shared<Keyboard>) {
    let whole = Whole::new(Config::new().with_speed_limit(limit));
    let (mut hub, keys) = (Hub::new(Speed::High), Shared::new(keyboard(Form::Boot, Speed::Low)));
    hub.plug(ports[0], Box::new(keys.clone()));
    hub.plug(ports[1], Box::new(Shared::new(dualshock3(Temper::Sony))));
    whole.rig.plug(hub);
    (whole, keys)
}

/// The core's start is in there as well, which comes before power on the port.
#[test]
fn keyboard_and_pad_report_within_a_second_and_a_half_of_power() {
    for limit in [SpeedLimit::High, SpeedLimit::Full] {
        for ports in [[1, 2], [2, 1]] {
            let (mut whole, keys) = board(limit, ports);
            let attached =
                whole.run_until(1_500_000, |whole| whole.is_attached(port(ports[0] as u8), Kind::BootKeyboard));
            assert!(attached, "{limit:?}: {:?}", whole.events);
            keys.lock().function.press(0x2C);
            let both = |whole: &Whole| {
                let from =
                    |keys: bool| whole.reports.iter().any(|it| matches!(it, Event::KeyboardReport { .. }) == keys);
                from(true) && from(false)
            };
            assert!(whole.run_until(1_500_000 - whole.now(), both), "{limit:?}: {:?}", whole.events);
            println!("{limit:?}, ports {ports:?}: keyboard and pad have reported {} us after power-on", whole.now());
            // What the specification asks for is in there: twice 100 ms of debounce, 100 ms of power, 50 ms of reset.
            assert!(whole.now() > 350_000);
        }
    }
}

/// A report that is ready waits for the endpoint's next turn, and less than a millisecond more.
#[test]
fn a_report_is_in_the_state_a_millisecond_after_its_interval() {
    const INTERVAL_US: u64 = 10_000;
    for (limit, behind_hub) in [(SpeedLimit::High, true), (SpeedLimit::Full, true), (SpeedLimit::High, false)] {
        let (mut whole, keys) = if behind_hub {
            board(limit, [1, 2])
        } else {
            let whole = Whole::new(Config::new());
            let keys = Shared::new(keyboard(Form::Boot, Speed::Low));
            whole.rig.plug(keys.clone());
            (whole, keys)
        };
        let place = if behind_hub { port(1) } else { Place::ROOT };
        assert!(whole.run_until(1_500_000, |whole| whole.is_attached(place, Kind::BootKeyboard)));
        whole.run(100_000);
        let mut worst = 0;
        for round in 0..100 {
            for down in [true, false] {
                whole.run(20_000 + round * 1_000);
                // Anywhere between two polls of the stack.
                let pressed = whole.now() + round * 10;
                whole.rig.pass_until(pressed);
                if down {
                    keys.lock().function.press(0x2C)
                } else {
                    keys.lock().function.release(0x2C)
                };
                assert!(whole.run_until(30_000, |whole| whole.controls.state().frozen == down));
                worst = worst.max(whole.now() - pressed);
            }
        }
        println!("{limit:?}, behind a hub {behind_hub}: {worst} us at worst, of which {INTERVAL_US} are the interval");
        assert!(worst < INTERVAL_US + 1_000, "{limit:?} {behind_hub}: {worst} us");
    }
}
