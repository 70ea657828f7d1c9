use super::*;
use crate::cli::Board;
use crate::log_decoder::LogDecoder;
use crate::paths;
use crate::test_elf::{TestElf, TestFile};

const MINUTE: Duration = Duration::from_secs(60);

/// Stand-ins for QEMU: `/bin/sh` takes QEMU's arguments and does not understand them.
#[test]
fn a_qemu_that_does_not_start_is_explained() {
    let elf = TestFile::new("any.elf", b"");
    let error = Qemu::start(&QemuOptions::new("/bin/sh", Board::VexpressA9, elf.path()))
        .err()
        .expect("sh is no QEMU")
        .to_string();
    assert!(error.contains("QEMU ended before its control was connected") && error.contains("QEMU said:"), "{error}");
    let error = Qemu::start(&QemuOptions::new("no-such-qemu", Board::VexpressA9, elf.path()))
        .err()
        .expect("missing")
        .to_string();
    assert!(error.contains("cannot start no-such-qemu"), "{error}");
    let error =
        Qemu::start(&QemuOptions::new("/bin/sh", Board::VexpressA9, "no.elf")).err().expect("no firmware").to_string();
    assert!(error.contains("there is no firmware in no.elf"), "{error}");
}

/// ARM code that prints `hi` and a line end on UART 0, then for every byte from UART 1 sends
/// the byte + 1 back and the byte itself to UART 2; on a zero byte it ends QEMU by semihosting.
const ECHO: &[u32] = &[
    0xe3a0_0201, // mov  r0, #0x10000000
    0xe280_0a09, // add  r0, r0, #0x9000      UART 0
    0xe280_1a01, // add  r1, r0, #0x1000      UART 1
    0xe281_2a01, // add  r2, r1, #0x1000      UART 2
    0xe3a0_3068, // mov  r3, #'h'
    0xe580_3000, // str  r3, [r0]
    0xe3a0_3069, // mov  r3, #'i'
    0xe580_3000, // str  r3, [r0]
    0xe3a0_300a, // mov  r3, #'\n'
    0xe580_3000, // str  r3, [r0]
    0xe591_3018, // wait: ldr r3, [r1, #0x18] flags
    0xe313_0010, // tst  r3, #0x10            receive FIFO empty
    0x1aff_fffc, // bne  wait
    0xe591_3000, // ldr  r3, [r1]
    0xe213_30ff, // ands r3, r3, #0xff
    0x0a00_0003, // beq  end
    0xe582_3000, // str  r3, [r2]
    0xe283_3001, // add  r3, r3, #1
    0xe581_3000, // str  r3, [r1]
    0xeaff_fff5, // b    wait
    0xe3a0_0018, // end: mov r0, #0x18        SYS_EXIT
    0xe59f_1000, // ldr  r1, [pc]             ADP_Stopped_ApplicationExit
    0xef12_3456, // svc  #0x123456
    0x0002_0026,
];

fn echo(options: impl FnOnce(&mut QemuOptions)) -> (Qemu, TestFile) {
    let mut elf = TestElf::new(ECHO);
    elf.defmt_symbol("_defmt_version_ = 4", 0);
    elf.defmt_symbol("_defmt_encoding_ = rzcobs", 0);
    let file = TestFile::new("echo.elf", &elf.bytes());
    let mut qemu_options = QemuOptions::new("qemu-system-arm", Board::VexpressA9, file.path());
    options(&mut qemu_options);
    (Qemu::start(&qemu_options).expect("QEMU starts"), file)
}

#[test]
#[ignore = "needs qemu-system-arm"]
fn console_link_log_screen_and_keys_work() {
    let folder = paths::TemporaryFolder::new().expect("folders can be made");
    let console_file = folder.path().join("console.txt");
    let (mut qemu, file) = echo(|options| {
        options.icount_shift = Some(5);
        options.console_file = Some(console_file.clone());
    });
    assert!(qemu.console().lines().is_empty(), "it is paused");
    let log = qemu.take_log().expect("not taken yet");
    let decoder = LogDecoder::start(file.path(), log, |_| {}).expect("a table");
    qemu.resume().expect("it runs");
    assert_eq!(qemu.wait_for_line("the greeting", MINUTE, |line| line == "hi").expect("it prints"), "hi");

    let sent: Vec<u8> = (1..=200).cycle().take(5_000).collect();
    let mut link = qemu.link().expect("a handle");
    let sender = thread::spawn({
        let sent = sent.clone();
        move || link.write_all(&sent)
    });
    let mut received = vec![0; sent.len()];
    qemu.receive("the echo", MINUTE, &mut received).expect("an echo");
    sender.join().expect("no panic").expect("all sent");
    assert!(received.iter().zip(&sent).all(|(back, byte)| *back == byte + 1));

    let screen = qemu.screen().expect("a screen");
    assert!(screen.width() >= 320 && screen.height() >= 240);
    qemu.qmp().keys(&[("spc", true)]).expect("a known key");
    qemu.qmp().keys(&[("spc", false)]).expect("a known key");
    assert!(qemu.qmp().keys(&[("no-such-key", true)]).is_err());

    let error = qemu
        .wait_for_line("a miracle", Duration::from_millis(50), |line| line == "miracle")
        .expect_err("none")
        .to_string();
    assert!(error.contains("waited 0.05 s in vain for a miracle") && error.contains("last lines:\n    hi"), "{error}");
    let error = qemu.receive("more", Duration::from_millis(50), &mut [0; 3]).expect_err("none").to_string();
    assert!(error.contains("more: 0 of 3 bytes"), "{error}");

    qemu.send("the end", MINUTE, &[0]).expect("taken");
    assert!(qemu.wait_for_exit(MINUTE).expect("it ends").success());
    let error = qemu.wait_for_line("another", MINUTE, |line| line == "x").expect_err("it has ended").to_string();
    assert!(error.contains("QEMU has ended (exit status: 0)"), "{error}");
    // 5,000 bytes of the log's text with 1 to 200 and no frame end: no frame, and no complaint.
    assert_eq!(decoder.finish().frames, 0);
    assert_eq!(std::fs::read_to_string(&console_file).expect("written"), "hi\n");
}

#[test]
#[ignore = "needs qemu-system-arm"]
fn quitting_and_dropping_end_qemu() {
    let (mut qemu, _file) = echo(|_| {});
    qemu.resume().expect("it runs");
    qemu.wait_for_line("the greeting", MINUTE, |line| line == "hi").expect("it prints");
    qemu.quit().expect("it ends");

    let (qemu, _file) = echo(|_| {});
    let console = qemu.console().clone();
    let folder = qemu.folder.path().to_path_buf();
    drop(qemu);
    assert!(console.wait_for_end(MINUTE) && !folder.exists());
}
