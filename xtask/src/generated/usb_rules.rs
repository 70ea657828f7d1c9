//! The page of the rules that the strict model of the USB core watches.

use usb_model::violation::Rule;

pub(super) fn text() -> String {
    let mut page = String::from(
        "# Rules of the USB host controller\n\n\
         Generated from `usb-model` by `cargo xtask generate`: change it there.\n\n\
         QEMU's model of the DWC2 core lets a driver do much that the core itself does not forgive. `usb-model`'s does not:\n\
         it writes down whenever the driver breaks one of these rules of the core, of the bus, of memory behind caches, or\n\
         of a high-speed hub's transaction translator, and the test that did not ask for it fails. The driver passes\n\
         with every device of the tests, the 100,000 that go wrong included.\n\n\
         Each rule has a test that shows that a break is seen: a thin layer between the driver and the model changes, drops or\n\
         adds register accesses, skips cache maintenance or shortens waits, and the test turns red if the rule goes unnoticed.\n\
         They are in `host-tests/tests/usb_driver/rules/`; `cargo test -p host-tests --test usb_driver NAME` runs one.\n\n\
         | rule | what it asks for | source | test |\n| --- | --- | --- | --- |\n",
    );
    for rule in Rule::ALL {
        page += &format!("| {rule} | {} | {} | `{}` |\n", rule.text(), rule.source(), rule.test());
    }
    page
}
