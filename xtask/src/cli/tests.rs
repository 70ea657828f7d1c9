//! Which lines are taken, and what `--help` says.

use super::*;

fn parse(line: &str) -> Result<Cli, clap::Error> {
    Cli::try_parse_from(std::iter::once("xtask").chain(line.split_whitespace()))
}

#[test]
fn clap_finds_no_fault_in_the_definition() {
    command().debug_assert();
}

#[test]
fn help_lists_every_command_once_with_its_line() {
    let help = command().render_help().to_string();
    for subcommand in Cli::command().get_subcommands() {
        let name = subcommand.get_name();
        let about = subcommand.get_about().expect("every command says what it does").to_string();
        let line = format!("  {name:<10}{about}\n");
        assert_eq!(help.matches(&line).count(), 1, "{name} in:\n{help}");
        assert!(line.len() <= 96, "{name}'s line wraps on a usual terminal");
    }
    assert!(help.contains("Usage: cargo xtask"), "{help}");
}

#[test]
fn render_takes_all_its_flags() {
    let line = "render m.obj -o o.png --rotate -20,30.5,0 --two-sided --dump w --triangles t --depth d";
    let Task::Render(arguments) = parse(line).expect("a valid line").command else {
        panic!("render is render");
    };
    assert_eq!(arguments.rotate, Some(Rotation { degrees: [-20.0, 30.5, 0.0] }));
    assert!(arguments.two_sided && arguments.mvp.is_none());
    assert!(parse("render m.obj -o o.png --rotate 1,2,3 --mvp f").is_err());
    assert!(parse("render m.obj").is_err());
}

#[test]
fn headless_wants_frames_and_a_folder() {
    assert!(parse("run").is_ok());
    assert!(parse("run --headless --frames 3 --output d").is_ok());
    assert!(parse("run --headless").is_err());
    assert!(parse("run --frames 3").is_err());
    assert!(parse("run --headless --frames 0 --output d").is_err());
}

#[test]
fn a_wave_wants_the_design_and_a_number_of_units_one_that_there_is() {
    let Task::Replay(arguments) = parse("replay w -o o.png --rtl --wave f --from 7").expect("valid").command else {
        panic!("replay is replay");
    };
    assert_eq!((arguments.units, arguments.from, arguments.clocks), (8, 7, 20_000));
    assert!(parse("replay w -o o.png").is_ok());
    assert!(parse("replay w -o o.png --rtl --units 4 --pins --wave f --clocks 9").is_ok());
    for wrong in ["--wave f", "--units 8", "--pins", "--rtl --from 1", "--rtl --clocks 5", "--rtl --wave f --clocks 0"]
    {
        assert!(parse(&format!("replay w -o o.png {wrong}")).is_err(), "{wrong}");
    }
    let message = parse("replay w -o o.png --rtl --units 3").expect_err("no such build").to_string();
    assert!(message.contains("1, 2, 4 or 8 pixel units"), "{message}");
}

#[test]
fn the_other_commands_parse() {
    for line in [
        "demo",
        "demo --board vexpress-a9",
        "demo --board raspi2b",
        "run --board raspi2b --pad s",
        "run --board raspi2b --usb-host 054c:0268",
        "run --board de1-soc --rtl",
        "pad s --session f",
        "image",
        "image --rbf f --uboot u --output d",
        "demo --dump w",
        "test",
        "test --only usb",
        "replay w -o o.png --depth d",
        "decode w",
        "run --model a.stl --board raspi2b",
        "run --model a.mesh --headless --frames 3 --output d --style wireframe",
        "mesh a.stl -o a.mesh --flat --scale-to-fit",
        "mesh a.stl -o a.mesh --smooth --two-sided --clockwise",
        "render a.glb -o a.png --style hidden-lines",
        "bench --json",
        "generate --check",
        "generate --golden",
    ] {
        assert!(parse(line).is_ok(), "{line}");
    }
    assert!(parse("demo --board c64").is_err());
    assert!(parse("mesh a.stl -o a.mesh --smooth --flat").is_err());
}
