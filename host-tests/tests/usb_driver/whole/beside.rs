//! A device that fails while it starts, and a good one that starts at the same time beside it; and one that fails once.

use dwc2_host::{Config, SpeedLimit};
use usb_input::Kind;
use usb_model::faulty::{Fault as Mischief, Faulty};
use usb_model::hub::Hub;
use usb_model::keyboard::{Form, keyboard};
use usb_model::rogue::{Habit, Rogue};
use usb_model::shared::Shared;
use usb_model::wire::Speed;

use super::{Whole, port};

/// The rogue has three attempts of five seconds, of which the good device may have to wait for one at a time.
const LIMIT_US: u64 = 25_000_000;

/// Where no split says which port is meant, both would answer at address 0.
#[test]
fn the_good_one_is_found() {
    for (limit, speed) in [(SpeedLimit::Full, Speed::Full), (SpeedLimit::High, Speed::High)] {
        for habit in [Habit::Garbles, Habit::Stalls, Habit::Naks] {
            let mut whole = Whole::new(Config::new().with_speed_limit(limit));
            let hub = Shared::new(Hub::new(Speed::High));
            hub.lock().plug(1, Box::new(Rogue::new(keyboard(Form::Boot, speed), habit, 0, 1, 7)));
            hub.lock().plug(2, Box::new(keyboard(Form::Boot, speed)));
            whole.rig.plug(hub.clone());
            let found = whole.run_until(LIMIT_US, |whole| whole.is_attached(port(2), Kind::BootKeyboard));
            assert!(found, "{limit:?}, beside one that {habit:?}: {:?}", whole.events);
        }
    }
}

/// Three strikes of a transfer leave its translator in a muddle: it is cleared, and the transfer tried again.
#[test]
fn one_that_does_not_answer_three_times_is_served_all_the_same() {
    for speed in [Speed::Low, Speed::Full] {
        for good in 0..50 {
            let mut whole = Whole::new(Config::new());
            let mut device = Faulty::new(keyboard(Form::Boot, speed));
            device.break_for(good, 3, Mischief::Vanish);
            let mut hub = Hub::new(Speed::High);
            hub.plug(1, Box::new(device));
            whole.rig.plug(hub);
            let found = whole.run_until(1_000_000, |whole| whole.is_attached(port(1), Kind::BootKeyboard));
            assert!(found, "{speed:?} after {good} transactions: {:?}", whole.events);
            whole.run(100_000);
            assert_eq!(whole.events.len(), 2, "{speed:?} after {good} transactions: {:?}", whole.events);
        }
    }
}
