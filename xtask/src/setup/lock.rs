//! Lets one process at a time change the machine.

use std::fs::{self, File, TryLockError};

use anyhow::Context;

use crate::paths;
use crate::progress::Progress;

/// Held while something is installed; the lock goes with the value, or with the process.
pub(super) struct SetupLock {
    _file: File,
}

impl SetupLock {
    /// Waits until no other process holds the lock, and takes it.
    pub(super) fn take(progress: &Progress) -> anyhow::Result<Self> {
        let folder = paths::target_folder().join("setup");
        let path = folder.join("lock");
        let remedy = || format!("cannot lock {}: check the folder's permissions", path.display());
        fs::create_dir_all(&folder).with_context(remedy)?;
        let file = File::create(&path).with_context(remedy)?;
        match file.try_lock() {
            Ok(()) => {}
            Err(TryLockError::WouldBlock) => {
                let step = progress.step("waiting for another set-up to end");
                file.lock().with_context(remedy)?;
                step.done();
            }
            Err(TryLockError::Error(error)) => return Err(error).with_context(remedy),
        }
        Ok(Self { _file: file })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::sync::atomic::{AtomicBool, Ordering};
    use std::thread;

    #[test]
    fn one_holder_at_a_time() {
        let held = AtomicBool::new(false);
        thread::scope(|scope| {
            for _ in 0..4 {
                scope.spawn(|| {
                    let lock = SetupLock::take(&Progress::quiet()).expect("the target folder can be written");
                    assert!(!held.swap(true, Ordering::SeqCst), "two holders");
                    thread::yield_now();
                    held.store(false, Ordering::SeqCst);
                    drop(lock);
                });
            }
        });
    }
}
