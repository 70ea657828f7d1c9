//! A Unix socket where devices are plugged in and out.

use std::io::{self, ErrorKind};
use std::os::unix::fs::FileTypeExt;
use std::os::unix::net::UnixListener;
use std::path::{Path, PathBuf};
use std::sync::mpsc::{self, Receiver, Sender, TryRecvError};
use std::sync::{Arc, Mutex, PoisonError};
use std::thread::{self, JoinHandle};
use std::time::Duration;

use usb_model::wire::Device;

use crate::connection::Connection;
use crate::session::{Order, Session};

/// How often somebody who calls is looked for.
const LISTEN: Duration = Duration::from_millis(2);

/// A socket that QEMU's `usb-redir` calls. What is plugged in stays so when QEMU ends, and the next
/// QEMU finds it.
///
/// The socket's file goes with the value.
pub struct Socket {
    path: PathBuf,
    orders: Option<Sender<Order>>,
    thread: Option<JoinHandle<()>>,
    complaints: Arc<Mutex<Vec<String>>>,
}

impl Socket {
    /// Listens at `path`, with nothing plugged in. A socket that nobody listens at any more is replaced.
    ///
    /// # Errors
    /// When there is no such folder, or something else is there.
    pub fn bind(path: &Path) -> io::Result<Self> {
        let listener = match UnixListener::bind(path) {
            Err(error) if error.kind() == ErrorKind::AddrInUse && is_dead_socket(path) => {
                std::fs::remove_file(path)?;
                UnixListener::bind(path)?
            }
            bound => bound?,
        };
        listener.set_nonblocking(true)?;
        let (sender, receiver) = mpsc::channel();
        let complaints = Arc::<Mutex<Vec<String>>>::default();
        let told = Arc::clone(&complaints);
        let thread =
            thread::Builder::new().name("usbredir".into()).spawn(move || listen(&listener, &receiver, &told))?;
        Ok(Self { path: path.into(), orders: Some(sender), thread: Some(thread), complaints })
    }

    /// Plugs a device in, in place of the one that is; at once, or as soon as QEMU calls.
    pub fn plug_in(&self, device: Box<dyn Device + Send>) {
        self.order(Order::PlugIn(device));
    }

    /// Pulls the device out, once no request of QEMU's is under way.
    pub fn pull_out(&self) {
        self.order(Order::PullOut);
    }

    /// Takes what went wrong so far: with a device, or with who called.
    pub fn complaints(&self) -> Vec<String> {
        std::mem::take(&mut *self.complaints.lock().unwrap_or_else(PoisonError::into_inner))
    }

    fn order(&self, order: Order) {
        if let Some(orders) = &self.orders {
            // The thread listens as long as this value lives.
            let _ = orders.send(order);
        }
    }
}

impl Drop for Socket {
    fn drop(&mut self) {
        self.orders = None;
        if let Some(thread) = self.thread.take() {
            let _ = thread.join();
        }
        // Nothing is lost when it stays: the next one replaces it.
        let _ = std::fs::remove_file(&self.path);
    }
}

/// Returns whether the file is a socket that nobody listens at.
fn is_dead_socket(path: &Path) -> bool {
    let is_socket = path.symlink_metadata().is_ok_and(|data| data.file_type().is_socket());
    let refused =
        std::os::unix::net::UnixStream::connect(path).is_err_and(|error| error.kind() == ErrorKind::ConnectionRefused);
    is_socket && refused
}

/// Talks to one QEMU after the other until the socket's owner ends.
fn listen(listener: &UnixListener, orders: &Receiver<Order>, complaints: &Mutex<Vec<String>>) {
    let mut waiting = None;
    loop {
        match orders.try_recv() {
            Ok(Order::PlugIn(device)) => waiting = Some(device),
            Ok(Order::PullOut) => waiting = None,
            Err(TryRecvError::Disconnected) => return,
            Err(TryRecvError::Empty) => {}
        }
        let Ok((stream, _)) = listener.accept() else {
            thread::sleep(LISTEN);
            continue;
        };
        let talked = Connection::open(stream).and_then(|connection| {
            let mut session = Session::new(connection, orders, waiting.take());
            let ended = session.run();
            waiting = session.into_device();
            ended
        });
        match talked {
            Ok(()) => return,
            Err(error)
                if matches!(
                    error.kind(),
                    ErrorKind::UnexpectedEof | ErrorKind::BrokenPipe | ErrorKind::ConnectionReset
                ) => {}
            Err(error) => complaints.lock().unwrap_or_else(PoisonError::into_inner).push(error.to_string()),
        }
    }
}
