//! What every transport must do, with the kernel as the judge.

use super::rig::{CACHED, PATIENCE, Rig, Serve, eventually};
use nix::errno::Errno;
use nix::poll::{PollFd, PollFlags, PollTimeout, poll};
use nix::sys::epoll::{Epoll, EpollCreateFlags, EpollEvent, EpollFlags, EpollTimeout};
use std::fs::{self, File, OpenOptions};
use std::io::{self, Read, Write};
use std::os::fd::{AsFd, IntoRawFd};
use std::os::unix::fs::{FileExt, MetadataExt, OpenOptionsExt, PermissionsExt};
use std::path::Path;
use std::sync::atomic::Ordering;
use std::sync::mpsc;

/// One `#[test]` for each body, over one transport.
macro_rules! instantiate {
    ($serve:expr) => {
        $crate::transport::native::tests::bodies::instantiate! { $serve =>
            names_attributes_and_sizes_are_shown
            what_the_filesystem_does_not_have_is_refused
            reads_respect_size_and_position
            a_waiting_read_gets_what_is_written_later
            a_waiting_read_does_not_hold_up_a_write_of_the_same_descriptor
            without_waiting_there_is_eagain
            poll_wakes_when_data_comes
            an_edge_triggered_epoll_sees_every_event
            release_follows_the_last_close
            close_reports_what_flush_says
            large_writes_come_in_pieces_of_the_agreed_size
            truncating_opens_say_so
            stored_bytes_are_read_without_asking
            a_panic_costs_one_request
            writers_of_one_file_do_not_wait_for_each_other
            a_busy_mount_outlives_its_name
        }
    };
    ($serve:expr => $($name:ident)*) => {
        $(
            #[test]
            fn $name() {
                $crate::transport::native::tests::bodies::$name(stringify!($name), $serve);
            }
        )*
    };
}
pub(crate) use instantiate;

fn errno<T>(result: io::Result<T>) -> Option<i32> {
    result.err().and_then(|error| error.raw_os_error())
}

fn read_write(path: &Path) -> File {
    OpenOptions::new()
        .read(true)
        .write(true)
        .open(path)
        .unwrap()
}

/// Reads on another thread; the result comes over the channel.
fn read_elsewhere(mut file: File, size: usize) -> mpsc::Receiver<io::Result<Vec<u8>>> {
    let (give, get) = mpsc::channel();
    std::thread::spawn(move || {
        let mut bytes = vec![0; size];
        let result = file.read(&mut bytes).map(|count| bytes[..count].to_vec());
        let _ = give.send(result);
    });
    get
}

pub(crate) fn names_attributes_and_sizes_are_shown(test: &str, serve: Serve) {
    let Some(rig) = Rig::over(test, serve) else {
        return;
    };
    let mut names: Vec<_> = fs::read_dir(rig.path(""))
        .unwrap()
        .map(|e| e.unwrap().file_name())
        .collect();
    names.sort();
    assert_eq!(
        names,
        [
            "cached", "config", "gate", "null", "panic", "slow", "stream"
        ]
    );
    let data = fs::metadata(rig.path("null")).unwrap();
    assert_eq!(
        (data.ino(), data.size(), data.mode(), data.nlink()),
        (2, 4, 0o100_644, 1)
    );
    assert_eq!((data.mtime(), data.mtime_nsec()), (5, 6));
    assert_eq!(fs::metadata(rig.path("")).unwrap().mode(), 0o040_755);
    assert_eq!(errno(fs::metadata(rig.path("nothing"))), Some(libc::ENOENT));
    let stat = nix::sys::statvfs::statvfs(&rig.path("")).unwrap();
    assert_eq!((stat.files(), stat.name_max()), (8, 255));
}

pub(crate) fn what_the_filesystem_does_not_have_is_refused(test: &str, serve: Serve) {
    let Some(rig) = Rig::over(test, serve) else {
        return;
    };
    let (null, new) = (rig.path("null"), rig.path("new"));
    assert_eq!(errno(fs::create_dir(&new)), Some(libc::EPERM));
    assert_eq!(errno(File::create(&new)), Some(libc::EPERM));
    assert_eq!(errno(fs::remove_file(&null)), Some(libc::EPERM));
    assert_eq!(errno(fs::rename(&null, &new)), Some(libc::EPERM));
    assert_eq!(errno(fs::hard_link(&null, &new)), Some(libc::EPERM));
    assert_eq!(
        errno(std::os::unix::fs::symlink(&null, &new)),
        Some(libc::EPERM)
    );
    let chmod = fs::set_permissions(&null, fs::Permissions::from_mode(0o600));
    assert_eq!(errno(chmod), Some(libc::EPERM));
    let file = read_write(&null);
    // A terminal is asked for by many programs; what else ioctl and fallocate answer is not an error to them.
    assert!(!io::IsTerminal::is_terminal(&file));
    let allocate = nix::fcntl::fallocate(&file, nix::fcntl::FallocateFlags::empty(), 0, 10);
    assert_eq!(allocate, Err(Errno::EOPNOTSUPP));
    file.sync_all().unwrap();
}

pub(crate) fn reads_respect_size_and_position(test: &str, serve: Serve) {
    let Some(rig) = Rig::over(test, serve) else {
        return;
    };
    assert_eq!(fs::read(rig.path("null")).unwrap(), b"null");
    let file = File::open(rig.path("null")).unwrap();
    let mut two = [0; 2];
    file.read_exact_at(&mut two, 1).unwrap();
    assert_eq!(&two, b"ul");
    let mut many = vec![0; 1 << 20];
    assert_eq!(file.read_at(&mut many, 0).unwrap(), 4);
    assert_eq!(file.read_at(&mut many, 4).unwrap(), 0);
}

pub(crate) fn a_waiting_read_gets_what_is_written_later(test: &str, serve: Serve) {
    let Some(rig) = Rig::over(test, serve) else {
        return;
    };
    let readers: Vec<_> = (0..20)
        .map(|_| read_elsewhere(File::open(rig.path("stream")).unwrap(), 4))
        .collect();
    eventually("twenty readers wait", || rig.fs.parked() == 20);
    let mut writer = OpenOptions::new()
        .write(true)
        .open(rig.path("stream"))
        .unwrap();
    for number in 0..20_u32 {
        writer.write_all(&number.to_ne_bytes()).unwrap();
    }
    let mut got: Vec<_> = readers
        .iter()
        .map(|reader| reader.recv_timeout(PATIENCE).unwrap().unwrap())
        .map(|bytes| u32::from_ne_bytes(bytes.try_into().unwrap()))
        .collect();
    got.sort_unstable();
    assert_eq!(got, (0..20).collect::<Vec<_>>());
}

pub(crate) fn a_waiting_read_does_not_hold_up_a_write_of_the_same_descriptor(
    test: &str,
    serve: Serve,
) {
    let Some(rig) = Rig::over(test, serve) else {
        return;
    };
    let mut file = read_write(&rig.path("stream"));
    let reader = read_elsewhere(file.try_clone().unwrap(), 64);
    eventually("the reader waits", || rig.fs.parked() == 1);
    file.write_all(b"hello").unwrap();
    assert_eq!(reader.recv_timeout(PATIENCE).unwrap().unwrap(), b"hello");
    let position = nix::unistd::lseek(&file, 0, nix::unistd::Whence::SeekSet);
    assert_eq!(position, Err(Errno::ESPIPE));
}

pub(crate) fn without_waiting_there_is_eagain(test: &str, serve: Serve) {
    let Some(rig) = Rig::over(test, serve) else {
        return;
    };
    let options = OpenOptions::new()
        .read(true)
        .custom_flags(libc::O_NONBLOCK)
        .clone();
    let mut file = options.open(rig.path("stream")).unwrap();
    let mut bytes = [0; 8];
    assert_eq!(errno(file.read(&mut bytes)), Some(libc::EAGAIN));
    rig.fs.feed(b"abc");
    assert_eq!(file.read(&mut bytes).unwrap(), 3);
    // The flag of the moment counts, not that of the open.
    nix::fcntl::fcntl(
        &file,
        nix::fcntl::FcntlArg::F_SETFL(nix::fcntl::OFlag::empty()),
    )
    .unwrap();
    let reader = read_elsewhere(file, 8);
    eventually("the reader waits", || rig.fs.parked() == 1);
    rig.fs.feed(b"d");
    assert_eq!(reader.recv_timeout(PATIENCE).unwrap().unwrap(), b"d");
}

pub(crate) fn poll_wakes_when_data_comes(test: &str, serve: Serve) {
    let Some(rig) = Rig::over(test, serve) else {
        return;
    };
    let file = read_write(&rig.path("stream"));
    let ask = |timeout: PollTimeout| {
        let mut fds = [PollFd::new(file.as_fd(), PollFlags::POLLIN)];
        poll(&mut fds, timeout).unwrap();
        fds[0].revents().unwrap()
    };
    assert_eq!(ask(PollTimeout::ZERO), PollFlags::empty());
    let (woken, wakes) = mpsc::channel();
    std::thread::scope(|scope| {
        scope.spawn(|| {
            woken
                .send(ask(PollTimeout::try_from(PATIENCE).unwrap()))
                .unwrap()
        });
        rig.fs.feed(b"x");
        assert_eq!(wakes.recv_timeout(PATIENCE).unwrap(), PollFlags::POLLIN);
    });
    assert_eq!(ask(PollTimeout::ZERO), PollFlags::POLLIN);
}

pub(crate) fn an_edge_triggered_epoll_sees_every_event(test: &str, serve: Serve) {
    let Some(rig) = Rig::over(test, serve) else {
        return;
    };
    let options = OpenOptions::new()
        .read(true)
        .custom_flags(libc::O_NONBLOCK)
        .clone();
    let mut file = options.open(rig.path("stream")).unwrap();
    let epoll = Epoll::new(EpollCreateFlags::EPOLL_CLOEXEC).unwrap();
    let edge = EpollEvent::new(EpollFlags::EPOLLIN | EpollFlags::EPOLLET, 1);
    epoll.add(&file, edge).unwrap();
    for _ in 0..5 {
        rig.fs.feed(b"x");
        let mut events = [EpollEvent::empty()];
        let timeout = EpollTimeout::try_from(PATIENCE).unwrap();
        assert_eq!(epoll.wait(&mut events, timeout).unwrap(), 1);
        assert_eq!(file.read(&mut [0; 8]).unwrap(), 1);
    }
}

pub(crate) fn release_follows_the_last_close(test: &str, serve: Serve) {
    let Some(rig) = Rig::over(test, serve) else {
        return;
    };
    let file = File::open(rig.path("null")).unwrap();
    let clone = file.try_clone().unwrap();
    drop(file);
    assert!(rig.fs.state().released.is_empty());
    drop(clone);
    eventually("the file is released", || rig.fs.state().released == [20]);
}

pub(crate) fn close_reports_what_flush_says(test: &str, serve: Serve) {
    let Some(rig) = Rig::over(test, serve) else {
        return;
    };
    let write = |bytes: &[u8]| {
        let mut file = OpenOptions::new()
            .write(true)
            .open(rig.path("config"))
            .unwrap();
        file.write_all(bytes).unwrap();
        file
    };
    assert_eq!(nix::unistd::close(write(b"good").into_raw_fd()), Ok(()));
    assert_eq!(
        nix::unistd::close(write(b"bad").into_raw_fd()),
        Err(Errno::EINVAL)
    );
    assert_eq!(errno(write(b"bad").sync_all()), Some(libc::EINVAL));
    assert_eq!(nix::unistd::close(write(b"good").into_raw_fd()), Ok(()));
}

pub(crate) fn large_writes_come_in_pieces_of_the_agreed_size(test: &str, serve: Serve) {
    let Some(rig) = Rig::over(test, serve) else {
        return;
    };
    let mut file = OpenOptions::new()
        .write(true)
        .open(rig.path("config"))
        .unwrap();
    file.write_all(&vec![7; 300_000]).unwrap();
    let lengths = rig.fs.state().lengths.clone();
    assert_eq!(lengths.iter().sum::<usize>(), 300_000);
    // A buffer that does not start on a page fills one page more than it has bytes for.
    assert!(
        (131_072 - 4096..=131_072).contains(&lengths[0]),
        "{lengths:?}"
    );
}

pub(crate) fn truncating_opens_say_so(test: &str, serve: Serve) {
    let Some(rig) = Rig::over(test, serve) else {
        return;
    };
    let mut options = OpenOptions::new();
    options
        .write(true)
        .truncate(true)
        .open(rig.path("config"))
        .unwrap();
    assert_eq!(rig.fs.state().open_flags & libc::O_TRUNC, libc::O_TRUNC);
    assert_eq!(rig.fs.state().truncated, 0);
    nix::unistd::truncate(&rig.path("config"), 0).unwrap();
    assert_eq!(rig.fs.state().truncated, 1);
}

pub(crate) fn stored_bytes_are_read_without_asking(test: &str, serve: Serve) {
    let Some(rig) = Rig::over(test, serve) else {
        return;
    };
    let file = File::open(rig.path("cached")).unwrap();
    let kernel = rig.fs.kernel();
    assert!(kernel.can_store());
    let mut bytes = [0; 16];
    for number in 1..100_u32 {
        assert!(kernel.store(CACHED, &number.to_ne_bytes()));
        let count = file.read_at(&mut bytes, 0).unwrap();
        assert_eq!(bytes[..count], number.to_ne_bytes());
    }
    // A later open keeps what is there.
    assert_eq!(fs::read(rig.path("cached")).unwrap(), 99_u32.to_ne_bytes());
    assert_eq!(rig.fs.reads.load(Ordering::SeqCst), 0);
    kernel.invalidate(CACHED);
    assert_eq!(fs::read(rig.path("cached")).unwrap(), b"null");
    assert!(rig.fs.reads.load(Ordering::SeqCst) > 0);
    kernel.invalidate_entry(1, "cached");
    kernel.invalidate_entry(1, "never looked up");
    assert_eq!(fs::metadata(rig.path("cached")).unwrap().ino(), CACHED);
}

pub(crate) fn a_panic_costs_one_request(test: &str, serve: Serve) {
    let Some(rig) = Rig::over(test, serve) else {
        return;
    };
    assert_eq!(errno(fs::read(rig.path("panic"))), Some(libc::EIO));
    assert_eq!(errno(fs::read(rig.path("panic"))), Some(libc::EIO));
    assert_eq!(fs::read(rig.path("null")).unwrap(), b"null");
}

pub(crate) fn writers_of_one_file_do_not_wait_for_each_other(test: &str, serve: Serve) {
    let Some(rig) = Rig::over(test, serve) else {
        return;
    };
    let slow = read_write(&rig.path("gate"));
    let (done, told) = mpsc::channel();
    std::thread::spawn(move || done.send(slow.write_at(b"wait", 0)).unwrap());
    eventually("the writer is inside", || rig.fs.state().at_gate == 1);
    let file = read_write(&rig.path("gate"));
    let (give, get) = mpsc::channel();
    std::thread::spawn(move || give.send(file.write_at(b"go", 0)).unwrap());
    let second = get.recv_timeout(PATIENCE);
    rig.fs.open_gate();
    assert_eq!(second.unwrap().unwrap(), 2);
    assert_eq!(told.recv_timeout(PATIENCE).unwrap().unwrap(), 4);
}

pub(crate) fn a_busy_mount_outlives_its_name(test: &str, serve: Serve) {
    let Some(mut rig) = Rig::over(test, serve) else {
        return;
    };
    let file = File::open(rig.path("null")).unwrap();
    assert_eq!(rig.unmount(), crate::mount::Unmounted::Detached);
    let mut bytes = [0; 4];
    file.read_exact_at(&mut bytes, 0).unwrap();
    drop(file);
    rig.served().unwrap();
    assert_eq!(rig.fs.stopped.load(Ordering::SeqCst), 1);
}
