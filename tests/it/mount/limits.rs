//! Large tuples, many nodes, many open files at once, and memory that does not grow.

use crate::{mount, mount_on, mount_with};
use harness::Board;

#[test]
fn the_largest_tuple_passes_whole_and_a_larger_one_is_refused() {
    const LARGEST: usize = 4 << 20;
    let board = Board::new();
    let picture: Vec<u8> = (0..LARGEST).map(|i| (i / 3) as u8).collect();
    board.file("in", &picture);
    let config = format!("trikfs = {{ n = {{ src = '$DIR/in', input_tuple_size = {LARGEST} }} }}");
    let Some(m) = mount_on(board, &config) else {
        return;
    };
    assert!(m.read("n/bin_data").unwrap() == picture);
    assert!(m.read("n/device").unwrap() == picture);
    let digits: usize = picture.iter().map(|byte| byte.to_string().len()).sum();
    assert_eq!(m.text("n/value").len(), digits + LARGEST);
    let larger = config.replace(&LARGEST.to_string(), &(LARGEST + 1).to_string());
    let line = m.apply(&larger).unwrap_err();
    assert!(line.contains("4194304"), "{line}");
}

#[test]
fn a_converter_in_lua_sees_large_tuples_whole() {
    let board = Board::new();
    board.file("in", [5; 65536]);
    let config = "trikfs = { n = { src = '$DIR/in', input_tuple_size = 65536, output_tuple_size = 65536, budget_us = 1000000,
      converter = function(a_s, a, b_s, b) for i = 0, b_s - 1 do ba.set(b, i, ba.get(a, i) + 1) end end } }";
    let Some(m) = mount_on(board, config) else {
        return;
    };
    assert_eq!(m.read("n/bin_data").unwrap(), [6; 65536]);
    assert_eq!(m.read("n/device").unwrap(), [6; 65536]);
}

#[test]
fn more_nodes_than_allowed_are_refused() {
    let Some(m) = mount("trikfs = {}") else {
        return;
    };
    let config = |count| {
        format!(
            "trikfs = {{}} for i = 1, {count} do trikfs['n' .. i] = {{ src = '/dev/zero', input_tuple_size = 1 }} end"
        )
    };
    m.apply(&config(4096)).unwrap();
    let line = m.apply(&config(4097)).unwrap_err();
    assert!(line.contains("4096"), "{line}");
    assert_eq!(m.result(), line);
}

#[test]
fn opening_and_closing_does_not_make_the_daemon_grow() {
    let Some(m) = mount(
        "trikfs = { n = { src = '/dev/zero', input_tuple_size = 4, output_tuple_size = 4,
          converter = function(a_s, a, b_s, b) ba.set(b, 0, 1) end } }",
    ) else {
        return;
    };
    let rounds = "for _ in range(1000):
    fd = open_ro(M + '/n/device')
    assert os.read(fd, 4) == b'\\1\\0\\0\\0'
    os.close(fd)
";
    m.python(rounds);
    let before = harness::processes::resident_bytes(m.daemon()).unwrap();
    m.python(rounds);
    m.python(rounds);
    let after = harness::processes::resident_bytes(m.daemon()).unwrap();
    assert!(after < before + (4 << 20), "{before} bytes became {after}");
}

#[test]
fn reloading_does_not_make_the_daemon_grow() {
    let Some(m) = mount("trikfs = {}") else {
        return;
    };
    let reload = |count: u32| {
        for number in 0..count {
            let config = format!(
                "trikfs = {{ n = {{ src = '/dev/zero', input_tuple_size = 4, output_tuple_size = 4, converter = function(a_s, a, b_s, b) ba.set(b, 0, {number}) end }} }}"
            );
            m.apply(&config).unwrap();
            let expected = u8::try_from(number % 256).unwrap();
            assert_eq!(m.read("n/bin_data").unwrap(), [expected, 0, 0, 0]);
        }
    };
    reload(100);
    let before = harness::processes::resident_bytes(m.daemon()).unwrap();
    reload(300);
    let after = harness::processes::resident_bytes(m.daemon()).unwrap();
    assert!(after < before + (6 << 20), "{before} bytes became {after}");
}

/// Programs of nobody that open a file until it is refused, and keep what they have until they hear from their parent. A
/// process may have few files open, so there are several.
pub(super) const GREEDY: &str = "
resource.setrlimit(resource.RLIMIT_NOFILE, (4096, resource.getrlimit(resource.RLIMIT_NOFILE)[1]))
def greedy(path):
    number, count = 0, 0
    heard, go = os.pipe()
    while number == 0:
        told, tell = os.pipe()
        if os.fork() == 0:
            os.close(go), os.setgroups([]), os.setgid(65534), os.setuid(65534)
            files = []
            while number == 0 and len(files) < 4000:
                try:
                    files.append(os.open(path, os.O_RDONLY))
                except OSError as error:
                    number = error.errno
            os.write(tell, b'%d %d' % (number, len(files)))
            os.read(heard, 1)
            os._exit(0)
        number, more = map(int, os.read(told, 100).split())
        count += more
    return number, count, lambda: os.close(go)
";

#[test]
fn a_user_who_only_reads_takes_a_part_of_the_memory_and_gives_it_back() {
    let config = "local big = string.rep('x', 300000)
      trikfs = { n = { src = '/dev/zero', input_tuple_size = 1, output_tuple_size = 1,
        converter = function(a_s, a, b_s, b) ba.set(b, 0, #big == 300000 and 1 or 0) end } }";
    let Some(m) = mount_with(Board::new(), config, &["--allow-other"]) else {
        return;
    };
    let daemon = m.daemon();
    m.python(&format!(
        "{GREEDY}
def resident():
    return int(open('/proc/{daemon}/statm').read().split()[1]) * resource.getpagesize()
assert os.read(open_ro(M + '/n/device'), 1) == b'\\1'
before = resident()
number, count, end = greedy('n/device')
assert number == errno.ENOMEM, number
assert count >= 10, count
# A quarter of at most 512 MiB, and what the allocator adds.
assert resident() - before < 192 << 20, (before, resident())
assert os.read(open_ro(M + '/n/device'), 1) == b'\\1'
end()
eventually(lambda: resident() < before * 1.1 + (4 << 20), 'the memory of closed files')
"
    ));
    let log = m.log();
    assert!(
        log.contains("open: too much memory: the open files of user 65534 may hold "),
        "{log}"
    );
}

#[test]
fn a_user_who_only_reads_takes_a_part_of_the_files() {
    let config = "trikfs = { n = { src = '/dev/zero', input_tuple_size = 1 } }";
    let Some(m) = mount_with(Board::new(), config, &["--allow-other"]) else {
        return;
    };
    m.python(&format!(
        "{GREEDY}
number, count, end = greedy('status')
assert (number, count) == (errno.EMFILE, 16384), (number, count)
assert text(M + '/n/value') == '0\\n'
end()
"
    ));
    let log = m.log();
    assert!(
        log.contains("open: too many open files: user 65534 may have 16384 files open: close some"),
        "{log}"
    );
}

#[test]
fn texts_of_large_tuples_that_a_user_keeps_open_are_charged() {
    const LARGE: usize = 1 << 20;
    let board = Board::new();
    board.file("in", vec![255; LARGE]);
    let config = format!("trikfs = {{ n = {{ src = '$DIR/in', input_tuple_size = {LARGE} }} }}");
    let Some(m) = mount_with(board, &config, &["--allow-other"]) else {
        return;
    };
    let daemon = m.daemon();
    for file in ["value", "bin_data", "device"] {
        m.python(&format!(
            "
def resident():
    return int(open('/proc/{daemon}/statm').read().split()[1]) * resource.getpagesize()
before = resident()
heard, go = os.pipe()
told, tell = os.pipe()
if os.fork() == 0:
    os.close(go), os.setgroups([]), os.setgid(65534), os.setuid(65534)
    files = []
    try:
        while len(files) < 240:
            files.append(os.open('n/{file}', os.O_RDONLY))
            os.read(files[-1], 1)
    except OSError as error:
        assert error.errno == errno.ENOMEM, error
    os.write(tell, b'%d' % len(files))
    os.read(heard, 1)
    os._exit(0)
count = int(os.read(told, 100))
# A quarter of at most 512 MiB, and what the allocator adds.
assert count >= 1 and resident() - before < 192 << 20, (count, before, resident())
assert len(os.read(open_ro(M + '/n/bin_data'), 9)) == 9
os.close(go)
"
        ));
    }
}
