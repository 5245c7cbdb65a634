//! Several stages in a row, several sources side by side, nodes that read nodes.

use crate::mount_on;
use harness::Board;

#[test]
fn stages_of_three_languages_make_one_chain() {
    let board = Board::new();
    board.file("in", "ab");
    board.library("plus.so", "int converter(int in_s, char *in, int out_s, char *out) { for (int i = 0; i < out_s; i++) out[i] = in[i] + 1; return 0; }");
    let Some(m) = mount_on(
        board,
        "trikfs = { n = { src = '$DIR/in', input_tuple_size = 2, output_tuple_size = 4, converter = {
          function(a_s, a, b_s, b) ba.set(b, 0, ba.get(a, 1)); ba.set(b, 1, ba.get(a, 0)) end,
          { converter = 'plus.so', output_tuple_size = 2 },
          { code = [[ int converter(int in_s, char *in, int out_s, char *out)
            { for (int i = 0; i < out_s; i++) out[i] = in[i % in_s] + 1; return in_s != 2 || out_s != 4; } ]] },
        } } }",
    ) else {
        return;
    };
    assert_eq!(m.read("n/device").unwrap(), b"dcdc");
}

#[test]
fn a_stage_that_consumes_consumes_for_the_whole_chain() {
    let board = Board::new();
    board.fifo("in");
    let Some(m) = mount_on(
        board,
        "local function every(n)
           local count = 0
           return function(a_s, a, b_s, b)
             count = count + 1
             if count % n ~= 0 then return false end
             ba.set(b, 0, ba.get(a, 0))
           end
         end
         trikfs = { n = { src = '$DIR/in', input_tuple_size = 1, output_tuple_size = 1, converter = { every(2), every(3) } } }",
    ) else {
        return;
    };
    m.python(
        "fd, pipe = open_ro(M + '/n/device'), feed('in')
os.write(pipe, bytes(range(1, 25)))
assert read_exactly(fd, 4) == bytes([6, 12, 18, 24])
",
    );
}

#[test]
fn a_node_reads_another_node_after_its_converter() {
    let board = Board::new();
    board.fifo("in");
    board.file("state", "a");
    let Some(m) = mount_on(
        board,
        "local function more(a_s, a, b_s, b) ba.set(b, 0, ba.get(a, 0) + 1) end
         trikfs = {
           third = { src = 'trikfs:deep/second', output_tuple_size = 1, converter = more },
           deep = { second = { src = 'trikfs:first', output_tuple_size = 1, converter = more } },
           first = { src = '$DIR/in', input_tuple_size = 1, output_tuple_size = 1, converter = more },
           still = { src = 'trikfs:state', output_tuple_size = 1, converter = more },
           state = { src = '$DIR/state', input_tuple_size = 1, output_tuple_size = 1, converter = more },
         }",
    ) else {
        return;
    };
    m.python(
        "fd, other, first, pipe = open_ro(M + '/third/device', os.O_NONBLOCK), open_ro(M + '/deep/second/device'), open_ro(M + '/first/device'), feed('in')
expect('EAGAIN', os.read, fd, 1)
for number in range(100):
    os.write(pipe, bytes([number]))
    assert ready(fd, ms=60000)
    assert os.read(fd, 1) == bytes([number + 3])
    assert os.read(other, 1) == bytes([number + 2])
    assert os.read(first, 1) == bytes([number + 1])
    assert ready(fd) == []
",
    );
    assert_eq!(m.read("still/device").unwrap(), b"c");
    assert_eq!(m.read("still/bin_data").unwrap(), b"c");
    m.board().file("state", "x");
    assert_eq!(m.read("still/bin_data").unwrap(), b"z");
    // A link is only as new as what it links to.
    let held = m.open("still/bin_data");
    let config = m
        .text("config")
        .replace("$DIR/state", "x")
        .replace("ba.get(a, 0) + 1", "ba.get(a, 0) + 2");
    m.apply(&config).unwrap();
    assert_eq!(
        std::os::unix::fs::FileExt::read_at(&held, &mut [0; 1], 0)
            .unwrap_err()
            .raw_os_error(),
        Some(libc::ESTALE)
    );
    assert_eq!(m.read("still/bin_data").unwrap(), b"|");
}

#[test]
fn circles_and_missing_links_are_refused() {
    let Some(m) = mount_on(Board::new(), "trikfs = {}") else {
        return;
    };
    for config in [
        "trikfs = { a = { src = 'trikfs:a' } }",
        "trikfs = { a = { src = 'trikfs:b' }, b = { src = 'trikfs:a' } }",
        "trikfs = { a = { src = { 'trikfs:b', '/dev/zero' }, input_tuple_size = { 1, 1 } }, b = { src = 'trikfs:a', input_tuple_size = 1 } }",
        "trikfs = { a = { src = 'trikfs:absent' } }",
        "trikfs = { a = { src = 'trikfs:' } }",
    ] {
        m.apply(config).expect_err(config);
    }
}

#[test]
fn several_states_are_sampled_together() {
    let board = Board::new();
    board.file("one", "1");
    board.file("two", "22");
    let Some(m) = mount_on(
        board,
        "trikfs = {
          list = { src = { '$DIR/one', '$DIR/two' }, input_tuple_size = { 1, 2 } },
          named = { src = { b = '$DIR/one', a = '$DIR/two' }, input_tuple_size = { b = 1, a = 2 } },
          fused = { src = { '$DIR/one', 'trikfs:list' }, input_tuple_size = { 1, 3 }, output_tuple_size = 1,
            converter = function(a_s, a, b_s, b) ba.set(b, 0, ba.get(a, 0) + ba.get(a, 3) - 48) end },
        }",
    ) else {
        return;
    };
    assert_eq!(m.read("list/bin_data").unwrap(), b"122");
    assert_eq!(m.read("named/bin_data").unwrap(), b"221");
    assert_eq!(m.read("fused/bin_data").unwrap(), b"3");
    m.board().file("two", "55");
    assert_eq!(
        (
            m.read("list/bin_data").unwrap(),
            m.read("fused/bin_data").unwrap()
        ),
        (b"155".to_vec(), b"6".to_vec())
    );
    std::fs::remove_file(m.board().path("one")).unwrap();
    assert_eq!(m.errno("list/value"), libc::ENODEV);
    assert!(
        m.text("list/fault").contains("/one"),
        "{}",
        m.text("list/fault")
    );
}

#[test]
fn several_streams_give_a_tuple_whenever_one_of_them_delivers() {
    let board = Board::new();
    board.fifo("left");
    board.fifo("right");
    board.file("state", "s");
    let Some(m) = mount_on(
        board,
        "trikfs = { n = { src = { '$DIR/left', '$DIR/right', '$DIR/state' }, input_tuple_size = { 2, 1, 1 } } }",
    ) else {
        return;
    };
    m.python(
        "fd = open_ro(M + '/n/device', os.O_NONBLOCK)
left, right = feed('left'), feed('right')
os.write(left, b'LL')
assert ready(fd, ms=30) == []
expect('EAGAIN', os.read, fd, 4)
os.write(right, b'R')
assert ready(fd, ms=60000)
assert os.read(fd, 100) == b'LLRs'
with open(D + '/state', 'w') as file: file.write('t')
os.write(right, b'r')
assert ready(fd, ms=60000)
assert os.read(fd, 100) == b'LLrt'
os.write(left, b'l')
assert ready(fd, ms=30) == []
os.write(left, b'l')
assert ready(fd, ms=60000)
assert os.read(fd, 100) == b'llrt'
",
    );
}
