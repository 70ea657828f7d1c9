//! Whether this process may install packages without asking for a password.

use std::process::{Command, Stdio};

/// How a command is run as the system's administrator.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Privilege {
    /// This process is the administrator.
    Root,
    /// `sudo` works without a password.
    Sudo,
}

impl Privilege {
    /// Finds out; `None` when a person would have to type a password.
    pub(super) fn detect() -> Option<Self> {
        let id = Command::new("id").arg("-u").output().ok()?;
        if id.stdout.trim_ascii() == b"0" {
            return Some(Self::Root);
        }
        let sudo = Command::new("sudo")
            .args(["-n", "true"])
            .stdin(Stdio::null())
            .stdout(Stdio::null())
            .stderr(Stdio::null())
            .status();
        sudo.is_ok_and(|status| status.success()).then_some(Self::Sudo)
    }

    /// Returns `program` to be run as the administrator, never asking and in English.
    pub(super) fn command(self, program: &str) -> Command {
        // sudo clears the environment, so it is set behind it.
        const SETTINGS: [&str; 2] = ["DEBIAN_FRONTEND=noninteractive", "LC_ALL=C"];
        let mut command = match self {
            Self::Root => Command::new("env"),
            Self::Sudo => {
                let mut sudo = Command::new("sudo");
                sudo.args(["-n", "env"]);
                sudo
            }
        };
        command.args(SETTINGS).arg(program);
        command
    }
}
