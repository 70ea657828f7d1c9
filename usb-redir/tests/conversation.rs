//! Conversations with a stand-in for QEMU, which spells packets out by itself.

use std::io::{Read, Write};
use std::os::unix::net::UnixStream;
use std::path::PathBuf;
use std::time::Duration;
use std::{env, process};

use usb_model::keyboard::{Form, keyboard};
use usb_model::shared::Shared;
use usb_model::wire::Speed;
use usb_redir::Socket;

/// Kinds of packets, from the protocol's description.
const HELLO: u32 = 0;
const CONNECT: u32 = 1;
const DISCONNECT: u32 = 2;
const RESET: u32 = 3;
const INTERFACES: u32 = 4;
const ENDPOINTS: u32 = 5;
const SET_CONFIGURATION: u32 = 6;
const CONFIGURATION: u32 = 8;
const LISTEN: u32 = 15;
const LISTENING: u32 = 17;
const LET_GO: u32 = 24;
const CONTROL: u32 = 100;
const INTERRUPT: u32 = 103;

/// What QEMU 7.2 says it can do.
const CAPABILITIES: u32 = 0xFF;

/// A file for a socket that no other test has.
fn path(name: &str) -> PathBuf {
    env::temp_dir().join(format!("halfspace-usbredir-{}-{name}", process::id()))
}

/// QEMU's end of a conversation, both hellos said.
struct Guest(UnixStream);

impl Guest {
    fn call(path: &PathBuf) -> Self {
        let mut stream = UnixStream::connect(path).expect("the socket listens");
        stream.set_read_timeout(Some(Duration::from_secs(20))).expect("a limit");
        let hello = [&[b'q'; 64][..], &CAPABILITIES.to_le_bytes()].concat();
        stream.write_all(&[&HELLO.to_le_bytes()[..], &68_u32.to_le_bytes(), &[0; 4], &hello].concat()).expect("room");
        let mut bytes = [0; 12 + 68];
        stream.read_exact(&mut bytes).expect("its hello, with a short id");
        assert_eq!((bytes[0], bytes[4]), (0, 68));
        Self(stream)
    }

    fn say(&mut self, kind: u32, id: u64, content: &[u8]) {
        let length = content.len() as u32;
        let head = [&kind.to_le_bytes()[..], &length.to_le_bytes(), &id.to_le_bytes()].concat();
        self.0.write_all(&[&head, content].concat()).expect("it is read");
    }

    fn hear(&mut self) -> (u32, u64, Vec<u8>) {
        let mut head = [0; 16];
        self.0.read_exact(&mut head).expect("a packet");
        let word = |at: usize| u32::from_le_bytes([head[at], head[at + 1], head[at + 2], head[at + 3]]);
        let mut content = vec![0; word(4) as usize];
        self.0.read_exact(&mut content).expect("all of it");
        (word(0), u64::from(word(8)), content)
    }

    /// Hears what a device that is plugged in says of itself; returns CONNECT's content.
    fn hear_a_device(&mut self) -> Vec<u8> {
        assert_eq!(self.hear().0, INTERFACES);
        assert_eq!(self.hear().0, ENDPOINTS);
        let (kind, _, content) = self.hear();
        assert_eq!(kind, CONNECT);
        content
    }

    /// Makes a control transfer: setup packet, data out; returns status, length and data in.
    fn control(&mut self, id: u64, setup: [u8; 8], data: &[u8]) -> (u8, u16, Vec<u8>) {
        let [request_type, request, v0, v1, i0, i1, l0, l1] = setup;
        let head = [request_type & 0x80, request, request_type, 0, v0, v1, i0, i1, l0, l1];
        self.say(CONTROL, id, &[&head, data].concat());
        let (kind, answered, content) = self.hear();
        assert_eq!((kind, answered), (CONTROL, id));
        assert_eq!(content[..3], head[..3]);
        (content[3], u16::from_le_bytes([content[8], content[9]]), content[10..].to_vec())
    }

    /// Configures a keyboard and listens to it.
    fn configure(&mut self) {
        self.say(RESET, 0, &[]);
        self.say(SET_CONFIGURATION, 5, &[1]);
        assert_eq!(self.hear().0, INTERFACES);
        assert_eq!(self.hear().0, ENDPOINTS);
        assert_eq!(self.hear(), (CONFIGURATION, 5, vec![0, 1]));
        self.say(LISTEN, 6, &[0x81]);
        assert_eq!(self.hear(), (LISTENING, 6, vec![0, 0x81]));
    }
}

#[test]
fn a_keyboard_is_found_configured_and_heard() {
    let path = path("keyboard");
    let socket = Socket::bind(&path).expect("a free path");
    let mut guest = Guest::call(&path);
    let device = Shared::new(keyboard(Form::StubbornBoot, Speed::Full));
    // Full speed, ids and version from its descriptor.
    let ids = device.lock().descriptors.device[8..14].to_vec();
    socket.plug_in(Box::new(device.clone()));
    assert_eq!(guest.hear_a_device(), [&[1, 0, 0, 0], &ids[..]].concat());

    guest.configure();
    let (status, length, data) = guest.control(7, [0x80, 6, 0, 1, 0, 0, 18, 0], &[]);
    assert_eq!((status, length, data[..2].to_vec()), (0, 18, vec![18, 1]));
    let set_idle = [0x21, 0x0A, 0, 0, 0, 0, 0, 0];
    assert_eq!(guest.control(8, set_idle, &[]), (4, 0, vec![]), "a stubborn keyboard stalls SET_IDLE");
    assert_eq!(guest.control(9, [0x80, 6, 0, 1, 0, 0, 4, 0], &[]).1, 4, "and goes on");
    assert!(socket.complaints().is_empty());
    // The server keeps the rules of a host: waits, toggles, stages.
    assert_eq!(device.lock().violations(), [""; 0]);
}

/// A keyboard that has as many reports as it is asked for, each with its number.
struct Counting(u8);

impl usb_model::leaf::Function for Counting {
    fn request_in(&mut self, _: u64, _: [u8; 8]) -> Option<Vec<u8>> {
        None
    }

    fn request_out(&mut self, _: u64, _: [u8; 8], _: &[u8]) -> bool {
        true
    }

    fn input(&mut self, _: u64, _: u8) -> Option<Vec<u8>> {
        self.0 = self.0.wrapping_add(1);
        Some(vec![self.0; 8])
    }
}

#[test]
fn reports_come_in_order_and_none_is_lost() {
    let path = path("reports");
    let socket = Socket::bind(&path).expect("a free path");
    let mut guest = Guest::call(&path);
    let mut descriptors = keyboard(Form::Boot, Speed::Full).descriptors;
    // Every millisecond.
    *descriptors.configuration.last_mut().expect("an interval") = 1;
    socket.plug_in(Box::new(usb_model::leaf::Leaf::new(Speed::Full, descriptors, Counting(0))));
    guest.hear_a_device();
    guest.configure();
    for number in 1..=100 {
        let (kind, _, content) = guest.hear();
        assert_eq!((kind, content), (INTERRUPT, [vec![0x81, 0, 8, 0], vec![number; 8]].concat()));
    }
}

#[test]
fn devices_are_pulled_out_and_swapped_and_survive_qemu() {
    let path = path("swap");
    let socket = Socket::bind(&path).expect("a free path");
    let full = || Box::new(keyboard(Form::Boot, Speed::Full));
    let low = || Box::new(keyboard(Form::Boot, Speed::Low));
    // It waits for QEMU.
    socket.plug_in(full());
    let mut guest = Guest::call(&path);
    assert_eq!(guest.hear_a_device()[0], 1);
    socket.pull_out();
    assert_eq!(guest.hear().0, DISCONNECT);
    socket.plug_in(low());
    // Not before QEMU has let the first one go.
    guest.0.set_read_timeout(Some(Duration::from_millis(100))).expect("a limit");
    assert!(guest.0.read_exact(&mut [0]).is_err(), "the second one came too early");
    guest.0.set_read_timeout(Some(Duration::from_secs(20))).expect("a limit");
    guest.say(LET_GO, 0, &[]);
    assert_eq!(guest.hear_a_device()[0], 0);
    // In its place, at once.
    socket.plug_in(full());
    assert_eq!(guest.hear().0, DISCONNECT);
    guest.say(LET_GO, 0, &[]);
    assert_eq!(guest.hear_a_device()[0], 1);
    // Another QEMU finds it.
    drop(guest);
    assert_eq!(Guest::call(&path).hear_a_device()[0], 1);
    assert!(socket.complaints().is_empty());
}

#[test]
fn nonsense_is_told_and_the_next_call_is_served() {
    let path = path("nonsense");
    let socket = Socket::bind(&path).expect("a free path");
    socket.plug_in(Box::new(keyboard(Form::Boot, Speed::Full)));
    let mut guest = Guest::call(&path);
    guest.hear_a_device();
    guest.say(CONTROL, 1, &[0x80]);
    assert_eq!(guest.0.read(&mut [0]).expect("the end"), 0);
    // Who is served next is so after the complaint was made.
    Guest::call(&path).hear_a_device();
    assert_eq!(socket.complaints(), ["QEMU's packet of kind 100 has 1 bytes, at least 10 expected"]);
}

#[test]
fn a_socket_that_nobody_listens_at_is_replaced_and_one_in_use_is_not() {
    let path = path("file");
    drop(std::os::unix::net::UnixListener::bind(&path).expect("a free path"));
    assert!(path.exists(), "the file stays");
    let socket = Socket::bind(&path).expect("nobody listens there");
    assert!(Socket::bind(&path).is_err(), "somebody does");
    drop(socket);
    assert!(!path.exists(), "the file goes with the socket");
    std::fs::write(&path, "no socket").expect("room");
    assert!(Socket::bind(&path).is_err());
    std::fs::remove_file(&path).expect("it is ours");
}
