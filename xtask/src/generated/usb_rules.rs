//! The page of the rules that the strict model of the USB core watches.

use usb_model::violation::Rule;

/// The modules of `host-tests/tests/usb_driver/rules` that hold the tests, and their sources.
const TESTS: [(&str, &str); 6] = [
    ("start", include_str!("../../../host-tests/tests/usb_driver/rules/start.rs")),
    ("memory", include_str!("../../../host-tests/tests/usb_driver/rules/memory.rs")),
    ("channels", include_str!("../../../host-tests/tests/usb_driver/rules/channels.rs")),
    ("transfers", include_str!("../../../host-tests/tests/usb_driver/rules/transfers.rs")),
    ("splits", include_str!("../../../host-tests/tests/usb_driver/rules/splits.rs")),
    ("hubs", include_str!("../../../host-tests/tests/usb_driver/rules/hubs.rs")),
];

pub(super) fn text() -> String {
    let mut page = String::from(
        "# Rules of the USB host controller\n\n\
         Generated from `usb-model` by `cargo xtask generate`: change it there.\n\n\
         QEMU's model of the DWC2 core lets a driver do much that the core itself does not forgive. `usb-model`'s does not:\n\
         it writes down whenever the driver breaks one of these rules of the core, of the bus, of memory behind caches, or\n\
         of a high-speed hub's transaction translator, and the test that did not ask for it fails. The driver passes\n\
         with every device of the tests.\n\n\
         Among these are 100,000 that are wrong, each in a way of its own: descriptors, answers, a habit such as falling\n\
         silent, or all three. A fifth of them do not get past their device descriptor, a fifth not past their configuration\n\
         descriptor, one in sixteen not past what its class is asked for; a quarter are named and let be, and three in ten\n\
         are served, and go wrong then or never: `whole::rogues` counts. Each is done with within `usb_input::SETTLED_WITHIN_US`\n\
         of its turn, and the next good device in its place works.\n\n\
         Each rule has a test that shows that a break is seen: a thin layer between the driver and the model changes, drops or\n\
         adds register accesses, skips cache maintenance or shortens waits, or a careless stack is on top, and the test turns\n\
         red if the rule goes unnoticed. `cargo test -p host-tests --test usb_driver TEST` runs one.\n\n\
         | rule | what it asks for | source | test |\n| --- | --- | --- | --- |\n",
    );
    for rule in Rule::ALL {
        page += &format!("| {rule} | {} | {} | `{}` |\n", rule.text(), rule.source(), path(*rule));
    }
    page
}

/// Returns the name of a rule's test, as `cargo test` takes it.
///
/// # Panics
/// When there is none.
fn path(rule: Rule) -> String {
    let name = rule.test();
    let head = format!("#[test]\nfn {name}() {{");
    let module = TESTS.iter().find(|(_, source)| source.contains(&head));
    let (module, _) = module.unwrap_or_else(|| panic!("{rule} has no test `{name}`: write one"));
    format!("rules::{module}::{name}")
}

#[cfg(test)]
mod tests {
    use super::*;

    /// So that what a reader pastes runs that test and no other.
    #[test]
    fn no_tests_name_is_in_another_ones() {
        let paths: Vec<String> = Rule::ALL.iter().map(|rule| path(*rule)).collect();
        for (index, one) in paths.iter().enumerate() {
            let others = paths.iter().enumerate().filter(|(at, _)| *at != index);
            assert_eq!(others.filter(|(_, other)| other.contains(one.as_str())).count(), 0, "{one}");
        }
    }
}
