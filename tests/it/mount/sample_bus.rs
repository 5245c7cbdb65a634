//! Samples in shared memory: what subscribers see of samples, failures, reloads and deaths, and who may look.

use crate::{mount_with, program};
use harness::{Board, Mount, eventually, processes};
use nix::sys::signal::Signal;
use sample_bus::place::{self, SHARED_MEMORY};
use sample_bus::{Reader, Step};
use std::io::ErrorKind;
use std::os::unix::fs::PermissionsExt;
use std::path::{Path, PathBuf};
use std::process::Command;

const TREE: &str = "trikfs = {
  sensors = {
    ramp = { src = fake{ data = 'abcd', period_ms = 5, loop = true }, input_tuple_size = 1, on_event = true },
    zero = { src = '/dev/zero', input_tuple_size = 4, poll_ms = 5 },
    quiet = { src = '/dev/zero', input_tuple_size = 4 },
  },
}";

/// Where the rings of a mount are.
fn directory(m: &Mount) -> PathBuf {
    place::directory(Path::new(SHARED_MEMORY), &m.root().canonicalize().unwrap()).unwrap()
}

/// An installed program may have been built without a sample bus, like that of the controller.
fn has_a_bus(board: &Board) -> bool {
    if std::env::var_os(crate::UNDER_TEST).is_none() {
        return true;
    }
    let words = crate::trikfs(board, &["mount", "--help"], b"").stdout;
    let has = words.contains("--no-sample-bus");
    if !has {
        harness::wait::note_skip("the program under test has no sample bus");
    }
    has
}

fn mount_on(board: Board, config: &str, options: &[&str]) -> Option<Mount> {
    if !has_a_bus(&board) {
        return None;
    }
    mount_with(board, config, options)
}

fn mount(config: &str) -> Option<Mount> {
    mount_on(Board::new(), config, &[])
}

fn open(m: &Mount, node: &str) -> Reader {
    Reader::open(m.root(), node).unwrap_or_else(|error| panic!("{node}: {error}"))
}

fn errno(reader: &Reader) -> i32 {
    let newest = reader.newest(&mut Vec::new());
    newest
        .err()
        .map_or(0, |error| error.raw_os_error().unwrap())
}

#[test]
fn a_subscriber_gets_what_the_files_show_in_order() {
    let Some(mut m) = mount(TREE) else { return };
    let mut reader = open(&m, "sensors/ramp");
    let mut seen = Vec::new();
    let mut tuple = Vec::new();
    let mut last = None;
    eventually("six samples", || {
        // All that are there: a test that takes one now and then falls behind for ever.
        while seen.len() < 6 {
            match reader.next_event(&mut tuple) {
                Step::Event(event) => {
                    assert!(last.is_none_or(|(sequence, time_ns)| {
                        event.sequence == sequence + 1 && event.time_ns > time_ns
                    }));
                    last = Some((event.sequence, event.time_ns));
                    seen.extend(&tuple);
                }
                // The machine was busy elsewhere.
                Step::Missed(_) => {
                    last = None;
                    seen.clear();
                }
                Step::Nothing => break,
            }
        }
        seen.len() == 6
    });
    let text = String::from_utf8(seen).unwrap();
    assert!("abcdabcdabcd".contains(&text), "{text}");
    eventually("a sample", || errno(&open(&m, "sensors/zero")) == 0);
    // Nodes that nobody samples have none, and nobody but the owner may look.
    let missing = Reader::open(m.root(), "sensors/quiet").unwrap_err();
    assert_eq!(missing.kind(), ErrorKind::NotFound);
    let mode = std::fs::metadata(directory(&m))
        .unwrap()
        .permissions()
        .mode();
    assert_eq!(mode & 0o777, 0o700);
    let place = directory(&m);
    m.stop();
    assert!(!place.exists());
    assert_eq!(errno(&reader), libc::ESTALE);
}

#[test]
fn a_failure_is_an_event_and_no_value() {
    let config = "trikfs = {
      loose = { src = faulty{ src = '/dev/zero', fail = 'EIO', from = 3, count = 2 }, input_tuple_size = 4, poll_ms = 5 },
      broken = { src = faulty{ src = '/dev/zero', fail = 'EIO', from = 3, count = 0 }, input_tuple_size = 4, poll_ms = 5 },
    }";
    let Some(m) = mount(config) else { return };
    let mut reader = open(&m, "loose");
    let (mut errors, mut samples, mut tuple) = (Vec::new(), 0, Vec::new());
    eventually("samples before and after", || {
        match reader.next_event(&mut tuple) {
            Step::Event(event) if event.errno == 0 => samples += 1,
            Step::Event(event) => errors.push(event.errno),
            _ => {}
        }
        samples > 3
    });
    // Twice the same failure is one event, as for readers of the files; who comes late may have missed it.
    let only_that = errors.iter().all(|errno| *errno == libc::EIO);
    assert!(errors.len() <= 1 && only_that, "{errors:?}");
    let broken = open(&m, "broken");
    eventually("no value", || errno(&broken) == libc::EIO);
    assert_eq!(m.errno("broken/bin_data"), libc::EIO);
}

#[test]
fn a_reload_ends_what_has_changed_and_leaves_the_rest() {
    let Some(m) = mount(TREE) else { return };
    let (ramp, zero) = (open(&m, "sensors/ramp"), open(&m, "sensors/zero"));
    eventually("samples", || errno(&ramp) == 0 && errno(&zero) == 0);
    let before = zero.newest_sequence();
    m.apply(&TREE.replace("'abcd'", "'wxyz'")).unwrap();
    assert_eq!(errno(&ramp), libc::ESTALE);
    assert!(!ramp.is_current() && zero.is_current());
    eventually("more of the same ring", || zero.newest_sequence() > before);
    let again = open(&m, "sensors/ramp");
    let mut tuple = Vec::new();
    eventually("a sample of the new node", || {
        again.newest(&mut tuple).is_ok()
    });
    assert!(b"wxyz".contains(&tuple[0]), "{tuple:?}");
    m.apply("trikfs = {}").unwrap();
    assert!(!again.is_current() && !zero.is_current());
    assert_eq!(std::fs::read_dir(directory(&m)).unwrap().count(), 0);
    m.apply(TREE).unwrap();
    eventually("a sample", || errno(&open(&m, "sensors/ramp")) == 0);
}

#[test]
fn second_names_lead_to_the_ring_of_their_node() {
    let with = |rest: &str| format!("{TREE} trikfs.sensors.{rest}");
    let Some(mut m) = mount(&with("front = { alias = 'sensors/ramp' }")) else {
        return;
    };
    let mut tuple = Vec::new();
    let front = open(&m, "sensors/front");
    eventually("a sample", || front.newest(&mut tuple).is_ok());
    assert!(b"abcd".contains(&tuple[0]), "{tuple:?}");
    // The ring goes on through a reload that leaves the name alone, and a subscriber notices where a name leads.
    m.apply(&with("front = { alias = 'sensors/ramp' } -- again"))
        .unwrap();
    assert!(front.is_current());
    m.apply(&with("front = { alias = 'sensors/zero' }"))
        .unwrap();
    assert!(!front.is_current());
    eventually("a sample of the other node", || {
        open(&m, "sensors/front").newest(&mut tuple).is_ok() && tuple == [0; 4]
    });
    // A node may take the place of a second name, and the other way round.
    let node = "{ src = fake{ data = 'wxyz', period_ms = 5, loop = true }, input_tuple_size = 1, on_event = true }";
    m.apply(&with(&format!("front = {node}"))).unwrap();
    eventually("a sample of the new node", || {
        open(&m, "sensors/front").newest(&mut tuple).is_ok() && b"wxyz".contains(&tuple[0])
    });
    m.apply(&with("front = { alias = 'sensors/quiet' }"))
        .unwrap();
    let missing = Reader::open(m.root(), "sensors/front").unwrap_err();
    assert_eq!(missing.kind(), ErrorKind::NotFound);
    m.apply(TREE).unwrap();
    let link = directory(&m).join("sensors+front");
    assert!(link.symlink_metadata().is_err());
    m.apply(&with("front = { alias = 'sensors/ramp' }"))
        .unwrap();
    assert!(link.symlink_metadata().is_ok());
    assert!(!m.log().contains("sample bus"), "{}", m.log());
    m.stop();
    assert!(link.symlink_metadata().is_err());
}

#[test]
fn a_killed_daemon_leaves_nothing_and_the_next_one_publishes_again() {
    let Some(mut m) = mount(TREE) else { return };
    let reader = open(&m, "sensors/zero");
    eventually("a sample", || errno(&reader) == 0);
    processes::signal(m.daemon(), Signal::SIGKILL);
    eventually("the end of the ring", || !reader.is_current());
    eventually("an old value", || errno(&reader) == libc::ETIMEDOUT);
    eventually("another ring", || {
        Reader::open(m.root(), "sensors/zero").is_ok_and(|reader| errno(&reader) == 0)
    });
    let left = directory(&m);
    m.kill_everything();
    assert!(left.exists());
    // The next mount cleans up, at whichever mount point.
    let Some(other) = mount(TREE) else { return };
    assert!(!left.exists() && directory(&other).exists());
}

#[test]
fn two_trees_do_not_meet() {
    let (Some(one), Some(other)) = (mount(TREE), mount(&TREE.replace("abcd", "wxyz"))) else {
        return;
    };
    let mut tuple = Vec::new();
    for (m, letters) in [(&one, b"abcd"), (&other, b"wxyz")] {
        let reader = open(m, "sensors/ramp");
        eventually("a sample", || reader.newest(&mut tuple).is_ok());
        assert!(letters.contains(&tuple[0]));
    }
}

#[test]
fn a_tree_without_a_bus_is_like_any_other() {
    let Some(m) = mount_on(Board::new(), TREE, &["--no-sample-bus"]) else {
        return;
    };
    eventually("a sample", || m.errno("sensors/zero/bin_data") == 0);
    assert!(!directory(&m).exists());
    assert!(!m.text("status").contains("bus"));
}

#[test]
fn pictures_travel_and_a_subscriber_that_stalls_disturbs_nobody() {
    let config = "trikfs = { camera = {
      src = fake{ data = ('x'):rep(100 * 1024) .. ('y'):rep(100 * 1024), period_ms = 2, loop = true },
      input_tuple_size = 100 * 1024, on_event = true,
    } }";
    let Some(m) = mount(config) else { return };
    let mut reader = open(&m, "camera");
    let mut tuple = Vec::new();
    let whole =
        |tuple: &[u8]| tuple.len() == 100 << 10 && tuple.iter().all(|byte| *byte == tuple[0]);
    eventually("a picture", || {
        matches!(reader.next_event(&mut tuple), Step::Event(_))
    });
    assert!(whole(&tuple));
    let ring = std::fs::metadata(directory(&m).join("camera"))
        .unwrap()
        .len();
    let samples = m.stat("camera", "samples");
    eventually("more pictures than the ring keeps", || {
        m.stat("camera", "samples") > samples + 40.0
    });
    assert_eq!(
        std::fs::metadata(directory(&m).join("camera"))
            .unwrap()
            .len(),
        ring
    );
    eventually("what was missed", || {
        matches!(reader.next_event(&mut tuple), Step::Missed(10..))
    });
    eventually("a picture", || {
        matches!(reader.next_event(&mut tuple), Step::Event(_)) && whole(&tuple)
    });
    // The file has the same, however small the pieces.
    assert!(whole(&m.read("camera/bin_data").unwrap()));
    assert_eq!(
        m.sh("head -c 1048576 camera/device | wc -c").trim(),
        "1048576"
    );
}

#[test]
fn other_users_see_what_the_mode_of_a_node_lets_them_see() {
    if !nix::unistd::geteuid().is_root() {
        return harness::skip("only root can be two users");
    }
    let config = TREE.replace("poll_ms = 5", "poll_ms = 5, mode = 0600");
    let Some(m) = mount_on(Board::new(), &config, &["--allow-other"]) else {
        return;
    };
    // The board's folder belongs to its user alone.
    std::fs::set_permissions(m.board().dir(), PermissionsExt::from_mode(0o755)).unwrap();
    let script = concat!(
        env!("CARGO_MANIFEST_DIR"),
        "/../sample-bus/examples/follow.py"
    );
    let follow = |node: &str| {
        let mut nobody = Command::new("setpriv");
        nobody.args(["--reuid=65534", "--regid=65534", "--clear-groups"]);
        // Its own file may be out of reach for nobody.
        nobody
            .args(["/usr/bin/python3", "-S", "-c"])
            .arg(std::fs::read_to_string(script).unwrap());
        harness::run(nobody.arg(m.root()).args([node, "5"]).current_dir("/"), b"")
    };
    eventually("samples", || errno(&open(&m, "sensors/zero")) == 0);
    let output = follow("sensors/ramp");
    assert_eq!(output.code(), 0, "{}", output.stderr);
    assert_eq!(output.stdout.lines().count(), 5, "{}", output.stdout);
    let refused = follow("sensors/zero");
    assert!(
        refused.stderr.contains("Permission denied") && refused.stderr.lines().count() == 1,
        "{}",
        refused.stderr
    );
    // Neither can they write, shorten, remove or replace what they see.
    let place = directory(&m);
    for attempt in [
        ": > ramp",
        "rm -f ramp && test ! -e ramp",
        "mv ramp other",
        "touch new",
    ] {
        let mut nobody = Command::new("setpriv");
        nobody.args([
            "--reuid=65534",
            "--regid=65534",
            "--clear-groups",
            "sh",
            "-c",
        ]);
        let attempt = format!(
            "cd {} && {}",
            place.display(),
            attempt.replace("ramp", "sensors+ramp")
        );
        assert_ne!(
            harness::run(nobody.arg(&attempt).current_dir("/"), b"").code(),
            0,
            "{attempt}"
        );
    }
}

/// Runs a script with a shared memory of its own, which `mounting` puts in place, and reads so many lines of the log.
/// None: not possible here.
fn with_shared_memory(board: &Board, mounting: &str, lines: u32) -> Option<String> {
    if !has_a_bus(board) {
        return None;
    }
    if !nix::unistd::geteuid().is_root() || harness::mount::obstacle().is_some() {
        harness::skip("only root can have another /dev/shm");
        return None;
    }
    let file = board.file("robot.lua", board.fill_in(TREE));
    let script = format!(
        "{mounting}
        {program} mount --background --cache {dir}/cache --config {file} {dir}/mnt >{dir}/said 2>&1 || {{ cat {dir}/said; exit 1; }}
        cat {dir}/mnt/status; head -n {lines} {dir}/mnt/log
        until head -c 1 {dir}/mnt/sensors/zero/bin_data >{dir}/byte 2>{dir}/byte; do sleep 0.01; done
        echo samples come
        {program} umount {dir}/mnt",
        program = program(),
        dir = board.dir().display(),
        file = file.display(),
    );
    let mut command = Command::new("unshare");
    command.args(["-m", "sh", "-ec", &script]);
    Some(harness::run(&mut command, b"").good())
}

#[test]
fn shared_memory_that_is_full_is_told_and_files_go_on() {
    let board = Board::new();
    let full = "mount -t tmpfs -o size=4k,nr_inodes=64 none /dev/shm; head -c 4096 /dev/zero > /dev/shm/full";
    let Some(text) = with_shared_memory(&board, full, 3) else {
        return;
    };
    assert!(
        text.contains("No space left") || text.contains("ENOSPC"),
        "{text}"
    );
    assert!(text.contains("sample bus: not published"), "{text}");
    assert!(text.ends_with("samples come\n"), "{text}");
}

#[test]
fn shared_memory_that_is_missing_is_told_and_files_go_on() {
    let board = Board::new();
    let missing = "mount -t tmpfs none /dev; mknod /dev/fuse c 10 229; mknod /dev/null c 1 3; mknod /dev/zero c 1 5";
    let Some(text) = with_shared_memory(&board, missing, 2) else {
        return;
    };
    assert!(text.contains("sample bus: off: /dev/shm/trikfs+"), "{text}");
    assert!(text.ends_with("samples come\n"), "{text}");
}

#[test]
fn what_is_written_to_an_actuator_is_in_a_ring_of_its_own() {
    let Some(m) = mount(
        "trikfs = {
  m = { src = '/dev/null', format = 'i8 power', rest = 0 },
  plain = { src = '/dev/null', format = 'i8 power' },
}",
    ) else {
        return;
    };
    m.python(
        "for power in ('30', '-30'):
    open(M + '/m/value', 'w').write(power)
open(M + '/stop', 'w').write('1')
",
    );
    let mut ring = Reader::open_written(m.root(), "m").expect("a ring");
    let mut tuple = Vec::new();
    let mut powers = Vec::new();
    while let Step::Event(event) = ring.next_event(&mut tuple) {
        assert_eq!(event.errno, 0);
        powers.push(i8::from_le_bytes([tuple[0]]));
    }
    // A rest when the tree was made may be before them.
    assert!(powers.ends_with(&[30, -30, 0]), "{powers:?}");
    // What needs no rest is none, and the node itself is not sampled.
    for missing in [
        Reader::open_written(m.root(), "plain"),
        Reader::open(m.root(), "m"),
    ] {
        assert_eq!(
            missing.err().map(|error| error.kind()),
            Some(ErrorKind::NotFound)
        );
    }
}

#[test]
fn what_a_source_gives_is_in_a_ring_of_its_own_if_that_is_asked_for() {
    let config = "trikfs = {
  s = { src = fake{ data = '\\1\\2\\3\\4', period_ms = 20, loop = true }, input_tuple_size = 1, format = 'u8 x', on_event = true, raw = true,
    converter = function(a_s, a, b_s, b)
      if ba.u8(a, 0) == 3 then error('three') end
      ba.u8(b, 0, ba.u8(a, 0) * 2)
    end },
  plain = { src = fake{ data = 'a' }, input_tuple_size = 1, poll_ms = 10 },
}";
    let Some(m) = mount(config) else { return };
    let mut raw = Reader::open_raw(m.root(), "s").expect("a ring");
    let mut samples = open(&m, "s");
    let mut tuple = Vec::new();
    let mut after = Vec::new();
    eventually("four samples", || {
        while let Step::Event(event) = samples.next_event(&mut tuple) {
            after.push((event.time_ns, event.errno, tuple.clone()));
        }
        after.len() >= 4
    });
    // Later than the samples, which come after their bytes.
    let mut pairs = Vec::new();
    while let Step::Event(event) = raw.next_event(&mut tuple) {
        pairs.push((event.time_ns, event.errno, tuple.clone()));
    }
    // What the converter refuses is no failure of the source.
    assert!(
        pairs
            .iter()
            .all(|(_, errno, raw)| *errno == 0 && raw.len() == 1),
        "{pairs:?}"
    );
    for (at, errno, sample) in after {
        let before = pairs.iter().rfind(|(raw_at, ..)| *raw_at <= at);
        let (_, _, raw) = before.expect("bytes before the sample");
        match errno {
            0 => assert_eq!(sample[0], raw[0] * 2),
            _ => assert_eq!(raw[0], 3),
        }
    }
    let missing = Reader::open_raw(m.root(), "plain").err();
    assert_eq!(missing.map(|error| error.kind()), Some(ErrorKind::NotFound));
}

#[test]
fn a_folder_that_was_removed_is_back_with_the_next_configuration() {
    let more = "near = { alias = 'sensors/zero' },
      motor = { src = '$DIR/motor', input_tuple_size = 1, rest = { 0 } },
      sensors = {";
    let config = TREE.replace("sensors = {", more);
    let board = Board::new();
    board.file("motor", ".");
    let Some(m) = mount_on(board, &config, &[]) else {
        return;
    };
    let old = open(&m, "sensors/ramp");
    std::fs::remove_dir_all(directory(&m)).unwrap();
    // Files never notice.
    assert_eq!(m.read("sensors/zero/bin_data").unwrap(), [0; 4]);
    m.apply(&config.replace("'abcd'", "'wxyz'")).unwrap();
    // Of a node that has changed, and of those that are the same.
    for node in ["sensors/ramp", "sensors/zero", "near"] {
        eventually(node, || {
            Reader::open(m.root(), node).is_ok_and(|reader| errno(&reader) == 0)
        });
    }
    let mut writes = Reader::open_written(m.root(), "motor").unwrap();
    m.sh("printf x > motor/device");
    let mut tuple = Vec::new();
    assert!(matches!(writes.next_event(&mut tuple), Step::Event(_)));
    assert_eq!(tuple, b"x");
    assert!(!old.is_current());
    let place = directory(&m);
    drop(m);
    assert!(!place.exists());
}
