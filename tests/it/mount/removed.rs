//! A mount point, a configuration, a cache and pipes that are taken away while programs work on the tree.

use crate::mount_on;
use harness::wait::eventually;
use harness::{Board, Mount, processes};
use nix::sys::signal::Signal;
use std::fs::{self, File};
use std::io::{Read, Write};
use std::os::unix::fs::FileExt;
use std::path::Path;
use std::process::Command;
use std::sync::Arc;
use std::sync::atomic::{AtomicU32, Ordering};
use std::sync::mpsc::{RecvTimeoutError, Sender, channel};
use std::thread::JoinHandle;
use std::time::Duration;

const ROBOT: &str = "trikfs = {
  motor = { src = '$DIR/motor', input_tuple_size = 2, format = 'i8 speed, u8 mode', rest = { 0, 7 } },
  lua = { src = fake{ data = 'abcd', period_ms = 0, loop = true }, input_tuple_size = 4, output_tuple_size = 4, poll_ms = 5,
    converter = function(a_s, a, b_s, b) for i = 0, 3 do ba.set(b, i, ba.get(a, i)) end end },
  stream = { src = '$DIR/in', input_tuple_size = 1 },
}";

fn robot() -> Option<Mount> {
    let board = Board::new();
    board.file("motor", "..");
    board.fifo("in");
    let m = mount_on(board, ROBOT)?;
    m.sh("echo 100 1 > motor/value");
    eventually("a sample", || m.errno("lua/value") == 0);
    Some(m)
}

/// Between two things that one of a crowd does: others have the machine too.
const PACE: Duration = Duration::from_millis(2);

/// Sixteen that open, read or write and close, whatever comes of it, until they are told to end. Each has been served once.
struct Crowd {
    /// Dropping them ends it.
    over: Vec<Sender<()>>,
    all: Vec<JoinHandle<()>>,
}

impl Crowd {
    fn new(root: &Path) -> Self {
        let served = Arc::<AtomicU32>::default();
        let one = |number: u32| {
            let (root, served) = (root.to_owned(), served.clone());
            let (over, is_over) = channel();
            let work = move || {
                let mut is_served = false;
                while is_over.recv_timeout(PACE) == Err(RecvTimeoutError::Timeout) {
                    let done = if number.is_multiple_of(2) {
                        File::open(root.join("lua/value"))
                            .and_then(|mut file| file.read(&mut [0; 64]))
                    } else {
                        let file = File::options().write(true).open(root.join("motor/value"));
                        file.and_then(|mut file| file.write(format!("{number} 1").as_bytes()))
                    };
                    if done.is_ok() && !is_served {
                        is_served = true;
                        served.fetch_add(1, Ordering::Relaxed);
                    }
                }
            };
            (over, std::thread::spawn(work))
        };
        let (over, all): (Vec<_>, Vec<_>) = (0..16).map(one).unzip();
        eventually("each is served", || {
            served.load(Ordering::Relaxed) as usize == all.len()
        });
        Self { over, all }
    }

    /// None of them hangs.
    fn end(self) {
        drop(self.over);
        for one in self.all {
            one.join().expect("no panic");
        }
    }
}

#[test]
fn a_tree_that_is_detached_under_load_rests_and_ends() {
    for words in [&["umount", "-l"][..], &["fusermount3", "-u", "-z"]] {
        if words[0] == "umount" && !nix::unistd::geteuid().is_root() {
            continue;
        }
        let Some(mut m) = robot() else { return };
        let held = File::options()
            .write(true)
            .open(m.path("motor/value"))
            .unwrap();
        let mut waiting = Command::new("cat")
            .arg(m.path("stream/device"))
            .stderr(std::process::Stdio::null())
            .spawn()
            .unwrap();
        eventually("a reader that waits", || processes::is_asleep(waiting.id()));
        let (daemon, crowd) = (m.daemon(), Crowd::new(m.root()));
        let driven = || matches!(m.board().content("motor")[..], [speed, 1] if speed < 16);
        eventually("a crowd that drives", driven);
        let mut detach = Command::new(words[0]);
        harness::run(detach.args(&words[1..]).arg(m.root()), b"").good();
        assert_eq!(m.wait().code(), Some(0), "{}", m.complaints());
        assert_eq!(m.board().content("motor"), [0, 7]);
        assert!(!m.is_mounted() && !processes::is_alive(daemon));
        assert!(held.write_at(b"50 1", 0).is_err());
        eventually("the end of the reader", || {
            waiting.try_wait().unwrap().is_some()
        });
        crowd.end();
        // Nobody has driven it since.
        assert_eq!(m.board().content("motor"), [0, 7]);
        // The mount point may go as well.
        fs::remove_dir(m.root()).unwrap();
    }
}

#[test]
fn a_pipe_that_is_removed_and_made_again_comes_back_to_all_readers() {
    let Some(m) = robot() else { return };
    m.python(
        "
import collections
got, over = collections.defaultdict(set), []
def reader(number):
    while not over:
        try:
            fd = open_ro(M + '/stream/device')
        except OSError as error:
            got[number].add(error.errno)
            os.sched_yield()
            continue
        try:
            while not over:
                got[number].add(os.read(fd, 1))
        except OSError as error:
            got[number].add(error.errno)
        finally:
            os.close(fd)
threads = [threading.Thread(target=reader, args=(number,)) for number in range(8)]
for thread in threads: thread.start()
pipe = feed('in')
def all_have(what):
    return all(what in got[number] for number in range(8))
def reaches(byte):
    def look():
        os.write(pipe, byte)
        return all_have(byte)
    return look
eventually(reaches(b'a'), 'the first pipe')
for byte in (b'b', b'c', b'd'):
    os.unlink(D + '/in')
    os.close(pipe)
    eventually(lambda: all_have(errno.ENODEV), 'ENODEV')
    os.mkfifo(D + '/in')
    pipe = feed('in')
    eventually(reaches(byte), 'another pipe')
    for heard in got.values(): heard.discard(errno.ENODEV)
over.append(True)
def ended():
    os.write(pipe, b'z')
    return not any(thread.is_alive() for thread in threads)
eventually(ended, 'the end of the readers')
",
    );
    // A pipe that goes is no reason to let a motor rest.
    assert_eq!(m.board().content("motor"), [100, 1]);
}

#[test]
fn a_tree_needs_neither_its_configuration_file_nor_its_cache_to_come_back() {
    let Some(m) = robot() else { return };
    let crowd = Crowd::new(m.root());
    fs::remove_file(m.board().path("robot.lua")).unwrap();
    fs::remove_dir_all(m.board().path("cache")).unwrap();
    let daemon = m.daemon();
    processes::signal(daemon, Signal::SIGKILL);
    eventually("another daemon", || {
        processes::children(m.guardian())
            .iter()
            .any(|&pid| pid != daemon)
    });
    eventually("the tree", || m.read("motor/units").is_ok());
    crowd.end();
    assert_eq!(m.text("config"), m.board().fill_in(ROBOT));
    // What is compiled needs a cache, which is made again.
    let code =
        "[[int converter(int in_s, char *in, int out_s, char *out) { out[0] = 5; return 0; }]]";
    let more = format!(
        "{ROBOT} trikfs.five = {{ src = '/dev/zero', input_tuple_size = 1, output_tuple_size = 1, converter = {{ code = {code} }} }}"
    );
    m.apply(&more).unwrap();
    assert_eq!(m.read("five/bin_data").unwrap(), [5]);
}
