//! The `config` file: transactions, refusals that say where, and writers of all kinds.

use crate::mount;
use harness::Mount;
use std::io::Write;

const GOOD: &str = "trikfs = {\n  zero = { src = '/dev/zero', input_tuple_size = 4 },\n}\n";
const OTHER: &str =
    "-- another one\ntrikfs = { one = { src = '/dev/zero', input_tuple_size = 1 } }\n";

/// Applies a configuration that must be refused; the tree must go on as before.
fn refused(m: &Mount, config: &str) -> String {
    let before = m.read("config").unwrap();
    let line = m.apply(config).expect_err(config);
    assert_eq!(m.read("config").unwrap(), before, "{config}");
    assert_eq!(m.read("zero/bin_data").unwrap(), [0; 4]);
    assert_eq!(m.result(), line);
    line.strip_prefix("config refused: ")
        .unwrap_or_else(|| panic!("{line}"))
        .to_owned()
}

#[test]
fn the_exact_bytes_in_force_are_read_back() {
    let Some(m) = mount(GOOD) else { return };
    assert_eq!(m.read("config").unwrap(), GOOD.as_bytes());
    m.board().file("new", OTHER);
    m.sh("cp $DIR/new config");
    assert_eq!(m.read("config").unwrap(), OTHER.as_bytes());
    assert_eq!(m.sh("cat config | dd bs=1 2>/dev/null"), OTHER);
    assert_eq!(m.result(), "config ok: 1 node");
    assert_eq!(m.sh("ls"), "config\nlog\none\nstatus\nstop\n");
}

#[test]
fn echo_and_append_apply_when_they_close() {
    let Some(m) = mount(GOOD) else { return };
    m.sh("echo \"trikfs = { a = { src = '/dev/zero', input_tuple_size = 1 } }\" > config; cat a/bin_data > /dev/null");
    m.sh("echo \"trikfs.b = { src = '/dev/zero', input_tuple_size = 2 }\" >> config; cat b/bin_data a/bin_data > /dev/null");
    assert_eq!(
        m.text("config"),
        "trikfs = { a = { src = '/dev/zero', input_tuple_size = 1 } }\ntrikfs.b = { src = '/dev/zero', input_tuple_size = 2 }\n"
    );
}

#[test]
fn a_refused_configuration_is_an_error_of_close_and_changes_nothing() {
    let Some(m) = mount(GOOD) else { return };
    m.python(
        "file = open(M + '/config', 'w')
file.write('trikfs = {\\n  zero = 1,\\n}\\n')
expect('EINVAL', file.close)
fd = os.open(M + '/config', os.O_WRONLY | os.O_TRUNC)
os.write(fd, b'trikfs = ')
expect('EINVAL', os.fsync, fd)
os.close(fd)
",
    );
    assert_eq!(m.read("config").unwrap(), GOOD.as_bytes());
    // cp tells; echo of dash and bash cannot, but status does.
    m.board().file("bad", "trikfs = { zero = { src = 5 } }");
    assert_ne!(m.try_sh("cp $DIR/bad config").code(), 0);
    m.try_sh("echo 'nonsense nonsense' > config");
    assert!(
        m.result().starts_with("config refused: config:1: "),
        "{}",
        m.result()
    );
    assert_eq!(m.read("zero/bin_data").unwrap(), [0; 4]);
    assert_eq!(m.read("config").unwrap(), GOOD.as_bytes());
}

#[test]
fn status_names_file_line_and_reason() {
    let Some(m) = mount(GOOD) else { return };
    let library = m.board().library("empty.so", "int nothing;");
    let library = library.display();
    let cases = [
        ("trikfs = {\n  a = = 1\n}".to_owned(), "config:2: ", "="),
        ("trikfs = {}\nerror('boom')".to_owned(), "config:2: ", "boom"),
        ("local x = nil\ntrikfs = {}\nx.y = 1".to_owned(), "config:3: ", "x"),
        ("\ntrikfs = { a = { src = '/dev/zero', inputtuple_size = 1 } }".to_owned(), "config:2: ", "input_tuple_size"),
        ("trikfs = {\n\n  a = { src = '/dev/zero', input_tuple_size = 0 } }".to_owned(), "config:3: ", "input_tuple_size"),
        ("x = 1".to_owned(), "config:", "trikfs"),
        ("trikfs = 5".to_owned(), "config:", "trikfs"),
        ("trikfs = { status = { src = '/dev/zero', input_tuple_size = 1 } }".to_owned(), "config:1: ", "status"),
        ("trikfs = {\n  ['a/b'] = { src = '/dev/zero', input_tuple_size = 1 } }".to_owned(), "config:", "a/b"),
        ("trikfs = { ['a\\0b'] = { src = '/dev/zero', input_tuple_size = 1 } }".to_owned(), "config:", ""),
        ("trikfs = { a = { src = 'trikfs:b' } }".to_owned(), "config:1: ", "b"),
        (
            "trikfs = {\n  a = { src = '/dev/zero', input_tuple_size = 1, output_tuple_size = 1, converter = 'libabsent.so' } }".to_owned(),
            "config:2: ",
            "libabsent.so",
        ),
        (
            format!("trikfs = {{\n  a = {{ src = '/dev/zero', input_tuple_size = 1, output_tuple_size = 1, converter = '{library}' }} }}"),
            "config:2: ",
            "converter",
        ),
    ];
    for (config, place, named) in cases {
        let line = refused(&m, &config);
        assert!(
            line.starts_with(place) && line.contains(named),
            "{config}\n{line}"
        );
    }
}

#[test]
fn c_that_does_not_compile_is_told_with_the_lines_of_the_configuration() {
    let Some(m) = mount(GOOD) else { return };
    let line = refused(
        &m,
        "trikfs = {
  n = { src = '/dev/zero', input_tuple_size = 1, output_tuple_size = 1, converter = { code = [[
    int converter(int in_s, char *in, int out_s, char *out)
    {
      return undeclared_thing;
    }
  ]] } },
}",
    );
    assert!(line.starts_with("config:5: "), "{line}");
    assert!(line.contains("undeclared_thing"), "{line}");
}

#[test]
fn greed_and_loops_are_refused_while_the_tree_stays_alive() {
    let Some(m) = mount(GOOD) else { return };
    std::thread::scope(|scope| {
        let looping = scope.spawn(|| m.apply("while true do end\ntrikfs = {}"));
        let mut rounds = 0;
        while !looping.is_finished() {
            let start = std::time::Instant::now();
            assert_eq!(m.read("zero/bin_data").unwrap(), [0; 4]);
            assert!(
                start.elapsed() < std::time::Duration::from_secs(60),
                "the loop held up a reader"
            );
            rounds += 1;
        }
        assert!(rounds > 10);
        let line = looping.join().unwrap().unwrap_err();
        assert!(
            line.starts_with("config refused: config:1: ") && line.contains("time"),
            "{line}"
        );
    });
    let line = refused(&m, "local s = string.rep('x', 2 ^ 30)\ntrikfs = {}");
    assert!(line.starts_with("config:1: "), "{line}");
    let line = refused(
        &m,
        "local t = {}\nfor i = 1, 1e9 do t[i] = {} end\ntrikfs = {}",
    );
    assert!(line.contains("memory"), "{line}");
    refused(&m, "local function f() return f() + 1 end\nf()");
    refused(&m, "\x1bLJ\x02");
    refused(&m, "trikfs = {} -- \0");
}

#[test]
fn truncating_alone_changes_nothing() {
    let Some(m) = mount(GOOD) else { return };
    m.sh(": > config; truncate -s 0 config; truncate -s 3 config");
    assert_eq!(m.read("config").unwrap(), GOOD.as_bytes());
    assert_eq!(m.result(), "config ok: 1 node");
}

#[test]
fn a_change_in_place_keeps_the_rest() {
    let Some(m) = mount(GOOD) else { return };
    m.python(
        "with open(M + '/config', 'r+b', 0) as file:
    at = file.read().index(b'4')
    file.seek(at)
    file.write(b'7')
assert len(open(M + '/zero/bin_data', 'rb').read()) == 7
",
    );
    assert_eq!(m.text("config"), GOOD.replace('4', "7"));
}

#[test]
fn too_many_bytes_are_refused_without_being_kept() {
    let Some(m) = mount(GOOD) else { return };
    m.python(
        "before = open(M + '/config', 'rb').read()
fd = os.open(M + '/config', os.O_WRONLY | os.O_TRUNC)
def write():
    for _ in range(160): os.write(fd, b'-' * 65536)
expect('EFBIG', write)
expect('EINVAL', os.close, fd)
assert open(M + '/config', 'rb').read() == before
line = open(M + '/status').readline()
assert line == 'config refused: config: more than 1048576 bytes were written\\n', line
",
    );
}

#[test]
fn a_forked_child_that_closes_does_not_apply_half_a_configuration() {
    let Some(m) = mount(GOOD) else { return };
    m.python(
        "good = b\"trikfs = { n = { src = '/dev/zero', input_tuple_size = 3 } }\"
fd = os.open(M + '/config', os.O_WRONLY | os.O_TRUNC)
os.write(fd, good[:20])
assert ended(forked(lambda: None)) == 0
assert open(M + '/status').readline() == 'config ok: 1 node\\n'
assert not os.path.exists(M + '/n')
os.write(fd, good[20:])
os.close(fd)
assert len(open(M + '/n/bin_data', 'rb').read()) == 3
assert open(M + '/config', 'rb').read() == good
",
    );
}

#[test]
fn a_writer_that_is_killed_half_way_changes_nothing_and_status_says_so() {
    let Some(m) = mount(GOOD) else { return };
    m.python(
        "for number in (signal.SIGKILL, signal.SIGTERM):
    read_end, write_end = os.pipe()
    def write():
        signal.signal(signal.SIGTERM, signal.SIG_DFL)
        fd = os.open(M + '/config', os.O_WRONLY | os.O_TRUNC)
        os.write(fd, b'trikfs = {}')
        os.write(write_end, b'.')
        signal.pause()
    child = forked(write)
    os.read(read_end, 1)
    os.kill(child, number)
    assert ended(child) == -number
    eventually(lambda: 'killed' in open(M + '/status').readline(), 'a word about it')
    assert os.path.exists(M + '/zero/device')
",
    );
    assert_eq!(m.read("config").unwrap(), GOOD.as_bytes());
    m.apply(OTHER).unwrap();
    assert_eq!(m.result(), "config ok: 1 node");
}

#[test]
fn of_two_writers_the_last_to_close_wins() {
    let Some(m) = mount(GOOD) else { return };
    m.python(
        "def config(n): return b\"trikfs = { n%d = { src = '/dev/zero', input_tuple_size = 1 } }\" % n
one = os.open(M + '/config', os.O_WRONLY | os.O_TRUNC)
two = os.open(M + '/config', os.O_WRONLY | os.O_TRUNC)
os.write(one, config(1))
os.write(two, config(2))
os.close(two)
assert open(M + '/config', 'rb').read() == config(2)
os.close(one)
assert open(M + '/config', 'rb').read() == config(1)
assert os.path.exists(M + '/n1') and not os.path.exists(M + '/n2')
",
    );
}

#[test]
fn fsync_applies_and_the_file_can_be_written_again() {
    let Some(m) = mount(GOOD) else { return };
    let mut file = std::fs::File::options()
        .write(true)
        .truncate(true)
        .open(m.path("config"))
        .unwrap();
    file.write_all(OTHER.as_bytes()).unwrap();
    assert_eq!(m.read("config").unwrap(), GOOD.as_bytes());
    file.sync_all().unwrap();
    assert_eq!(m.read("config").unwrap(), OTHER.as_bytes());
    file.write_all(b"trikfs.two = { src = '/dev/zero', input_tuple_size = 1 }\n")
        .unwrap();
    drop(file);
    assert_eq!(m.result(), "config ok: 2 nodes");
}

#[test]
fn many_writers_at_once_leave_one_whole_configuration() {
    let Some(m) = mount(GOOD) else { return };
    m.python(
        "def write(n):
    for turn in range(10):
        with open(M + '/config', 'w') as file:
            file.write(\"trikfs = { n%d = { src = '/dev/zero', input_tuple_size = %d } }\" % (n, turn + 1))
writers = [threading.Thread(target=write, args=(n,)) for n in range(4)]
for writer in writers: writer.start()
for writer in writers: writer.join()
config = open(M + '/config').read()
node = config.split()[3]
assert len(open(M + '/' + node + '/bin_data', 'rb').read()) == int(config.split()[11])
assert len(os.listdir(M)) == 5
",
    );
}

#[test]
fn the_edit_command_applies_what_the_editor_leaves() {
    let Some(m) = mount(GOOD) else { return };
    let editor = m
        .board()
        .file("editor", "#!/bin/sh\nsed -i s/zero/null/ \"$1\"\n");
    m.sh("chmod +x $DIR/editor");
    let mut command = std::process::Command::new(crate::program());
    command
        .arg("edit")
        .arg(m.root())
        .env("EDITOR", &editor)
        .env_remove("VISUAL")
        .env("TMPDIR", m.board().dir());
    let output = harness::run(&mut command, b"");
    assert_eq!(output.code(), 0, "{}{}", output.stdout, output.stderr);
    assert_eq!(m.text("config"), GOOD.replacen("zero", "null", 1));
}
