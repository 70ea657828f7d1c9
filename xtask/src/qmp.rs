//! QEMU's remote control, the QEMU Machine Protocol: one JSON object a line, both ways, over a
//! socket. A greeting comes first, then each command has one answer; events may come between.

use std::io::{ErrorKind, Read, Write};
use std::os::unix::net::UnixStream;
use std::path::Path;
use std::time::{Duration, Instant};

use anyhow::{Context, bail};
use serde_json::{Value, json};

/// Longest time for one answer; a screen dump takes 10 ms.
const ANSWER_LIMIT: Duration = Duration::from_secs(20);
/// A longer line is no answer of QEMU's.
const LINE_BYTES_MAX: usize = 4 << 20;

/// A connection that is ready for commands.
pub struct Qmp {
    stream: UnixStream,
    received: Vec<u8>,
}

impl Qmp {
    /// Greets the QEMU at the other end of `stream`.
    ///
    /// # Errors
    ///
    /// When nothing that speaks QMP is there.
    pub fn connect(stream: UnixStream) -> anyhow::Result<Self> {
        stream.set_write_timeout(Some(ANSWER_LIMIT))?;
        let mut qmp = Self { stream, received: Vec::new() };
        let greeting = qmp.receive("QEMU's greeting")?;
        if greeting.get("QMP").is_none() {
            bail!("the control socket does not speak QMP: it said {greeting}");
        }
        qmp.execute("qmp_capabilities", json!({}))?;
        Ok(qmp)
    }

    /// Runs a command and returns its answer.
    ///
    /// # Errors
    ///
    /// When QEMU refuses it, with its reason, or gives no answer.
    pub fn execute(&mut self, command: &str, arguments: Value) -> anyhow::Result<Value> {
        let line = format!("{}\n", json!({ "execute": command, "arguments": arguments }));
        self.stream.write_all(line.as_bytes()).with_context(|| format!("cannot send `{command}` to QEMU"))?;
        loop {
            let mut answer = self.receive(&format!("QEMU's answer to `{command}`"))?;
            if let Some(reason) = answer.pointer("/error/desc") {
                bail!("QEMU refused `{command}`: {}", reason.as_str().unwrap_or("it gave no reason"));
            }
            if let Some(value) = answer.get_mut("return") {
                return Ok(value.take());
            }
            // All else is an event (RESUME, STOP …): nobody asked for it.
        }
    }

    /// Starts or continues the machine.
    ///
    /// # Errors
    ///
    /// As [`execute`](Self::execute).
    pub fn cont(&mut self) -> anyhow::Result<()> {
        self.execute("cont", json!({})).map(drop)
    }

    /// Pauses the machine.
    ///
    /// # Errors
    ///
    /// As [`execute`](Self::execute).
    pub fn stop(&mut self) -> anyhow::Result<()> {
        self.execute("stop", json!({})).map(drop)
    }

    /// Ends QEMU.
    ///
    /// # Errors
    ///
    /// As [`execute`](Self::execute).
    pub fn quit(&mut self) -> anyhow::Result<()> {
        self.execute("quit", json!({})).map(drop)
    }

    /// Writes the machine's screen to `path` as a PPM picture (every QEMU can; PNG came with 7.1).
    ///
    /// # Errors
    ///
    /// As [`execute`](Self::execute), and when the path is no UTF-8.
    pub fn screendump(&mut self, path: &Path) -> anyhow::Result<()> {
        let name = path.to_str().with_context(|| format!("{} is no UTF-8 path, which QMP needs", path.display()))?;
        self.execute("screendump", json!({ "filename": name })).map(drop)
    }

    /// Presses (`true`) or releases keys, all at once; each by its QEMU name: `a`, `left`, `spc`, `ret`.
    ///
    /// # Errors
    ///
    /// As [`execute`](Self::execute): a name that QEMU does not know is refused.
    pub fn keys(&mut self, keys: &[(&str, bool)]) -> anyhow::Result<()> {
        let event = |(name, down): &(&str, bool)| json!({ "type": "key", "data": { "down": down, "key": { "type": "qcode", "data": name } } });
        let events: Vec<Value> = keys.iter().map(event).collect();
        self.execute("input-send-event", json!({ "events": events })).map(drop)
    }

    /// Receives one line.
    fn receive(&mut self, what: &str) -> anyhow::Result<Value> {
        let deadline = Instant::now() + ANSWER_LIMIT;
        loop {
            if let Some(end) = self.received.iter().position(|byte| *byte == b'\n') {
                let line: Vec<u8> = self.received.drain(..=end).collect();
                return serde_json::from_slice(&line)
                    .with_context(|| format!("{what} is no JSON: {}", String::from_utf8_lossy(&line)));
            }
            if self.received.len() > LINE_BYTES_MAX {
                bail!("{what} is longer than {LINE_BYTES_MAX} bytes");
            }
            let left = deadline.saturating_duration_since(Instant::now());
            if left.is_zero() {
                bail!("timed out after {} s waiting for {what}", ANSWER_LIMIT.as_secs());
            }
            self.stream.set_read_timeout(Some(left))?;
            let mut bytes = [0; 4_096];
            match self.stream.read(&mut bytes) {
                Ok(0) => bail!("QEMU closed its control socket instead of {what}"),
                Ok(count) => self.received.extend_from_slice(&bytes[..count]),
                Err(error)
                    if matches!(error.kind(), ErrorKind::WouldBlock | ErrorKind::TimedOut | ErrorKind::Interrupted) => {
                }
                Err(error) => return Err(error).with_context(|| format!("cannot read {what}")),
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::io::{BufRead, BufReader};
    use std::thread::{self, JoinHandle};

    const GREETING: &str = r#"{"QMP": {"version": {"qemu": {"major": 7}}, "capabilities": []}}"#;
    const DONE: &str = r#"{"return": {}}"#;

    /// Plays QEMU: greets, then gives one answer a command; returns the commands.
    fn fake_qemu(greeting: &'static str, answers: &'static [&'static str]) -> (UnixStream, JoinHandle<Vec<String>>) {
        let (here, mut there) = UnixStream::pair().expect("sockets");
        let server = thread::spawn(move || {
            writeln!(there, "{greeting}").expect("the client reads");
            let mut commands = BufReader::new(there.try_clone().expect("a socket")).lines();
            let mut received = Vec::new();
            for answer in answers {
                let Some(Ok(command)) = commands.next() else { break };
                received.push(command);
                writeln!(there, "{answer}").expect("the client reads");
            }
            received
        });
        (here, server)
    }

    #[test]
    fn commands_are_sent_as_qemu_wants_them() {
        let (socket, server) = fake_qemu(GREETING, &[DONE; 5]);
        let mut qmp = Qmp::connect(socket).expect("a greeting");
        qmp.cont().expect("done");
        qmp.keys(&[("spc", true), ("left", false)]).expect("done");
        qmp.screendump(Path::new("/t/x.ppm")).expect("done");
        qmp.quit().expect("done");
        let commands: Vec<Value> =
            server.join().expect("no panic").iter().map(|line| line.parse().expect("JSON")).collect();
        let key = |down: bool, name: &str| json!({"type": "key", "data": {"down": down, "key": {"type": "qcode", "data": name}}});
        assert_eq!(
            commands,
            [
                json!({"execute": "qmp_capabilities", "arguments": {}}),
                json!({"execute": "cont", "arguments": {}}),
                json!({"execute": "input-send-event", "arguments": {"events": [key(true, "spc"), key(false, "left")]}}),
                json!({"execute": "screendump", "arguments": {"filename": "/t/x.ppm"}}),
                json!({"execute": "quit", "arguments": {}}),
            ]
        );
    }

    #[test]
    fn events_before_an_answer_are_passed_over() {
        let (socket, _server) =
            fake_qemu(GREETING, &[DONE, "{\"event\": \"RESUME\"}\n{\"return\": {\"running\": true}}"]);
        let mut qmp = Qmp::connect(socket).expect("a greeting");
        assert_eq!(qmp.execute("query-status", json!({})).expect("an answer"), json!({"running": true}));
    }

    #[test]
    fn a_refusal_carries_qemu_s_reason() {
        let refusal = r#"{"error": {"class": "GenericError", "desc": "Could not open 'x'"}}"#;
        let (socket, _server) = fake_qemu(GREETING, Box::leak(Box::new([DONE, refusal])));
        let mut qmp = Qmp::connect(socket).expect("a greeting");
        let error = qmp.screendump(Path::new("x")).expect_err("refused").to_string();
        assert_eq!(error, "QEMU refused `screendump`: Could not open 'x'");
    }

    #[test]
    fn other_programs_and_silence_are_named() {
        let error = |greeting| Qmp::connect(fake_qemu(greeting, &[]).0).err().expect("no QMP").to_string();
        assert_eq!(error("{}"), "the control socket does not speak QMP: it said {}");
        assert!(error("SSH-2.0").starts_with("QEMU's greeting is no JSON: SSH-2.0"));
        let (socket, server) = fake_qemu(GREETING, &[DONE]);
        let mut qmp = Qmp::connect(socket).expect("a greeting");
        server.join().expect("no panic");
        let error = qmp.execute("cont", json!({})).expect_err("closed").to_string();
        assert!(error.contains("`cont`"), "{error}");
    }
}
