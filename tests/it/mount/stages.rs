//! `stages`: the bytes of a sample on their way through the converters of its node.

use crate::mount_on;
use harness::Board;

const CHAIN: &str = "trikfs = { n = { src = '$DIR/in', input_tuple_size = 1, format = 'u16 x', PACE
    converter = {
        { converter = function(a_s, a, b_s, b)
            if ba.u8(a, 0) == 9 then return false end
            ba.u16(b, 0, ba.u8(a, 0) * 2)
        end, output_tuple_size = 2 },
        function(a_s, a, b_s, b)
            if ba.u16(a, 0) == 14 then error('no seven', 0) end
            ba.u16(b, 0, ba.u16(a, 0) + params.more)
        end,
    }, params = { more = { 256, min = 0 } } } }";

#[test]
fn stages_are_those_of_the_newest_sample_as_far_as_it_came() {
    let board = Board::new();
    board.fifo("in");
    let config = CHAIN.replace("PACE", "on_event = true,");
    let Some(m) = mount_on(board, &config) else {
        return;
    };
    m.python(
        "import stat
stages = open_ro(M + '/n/stages')
def now(): return os.pread(stages, 99, 0).decode()
assert now() == ''
pipe = feed('in')
os.write(pipe, b'\\x03')
eventually(lambda: now() == '03\\n0600\\n0601\\n', 'a sample')
assert os.pread(stages, 99, 3) == b'0600\\n0601\\n'
# What stands in the way is told up to where it came: a fault, and a tuple of which nothing is made.
os.write(pipe, b'\\x07')
eventually(lambda: now() == '07\\n0e00\\n', 'a fault in the second')
os.write(pipe, b'\\x09')
eventually(lambda: now() == '09\\n', 'nothing of the first')
with open(M + '/n/params/more', 'w') as file: file.write('512')
os.write(pipe, b'\\x03')
eventually(lambda: now() == '03\\n0600\\n0602\\n', 'a param that was turned')
expect('EACCES', os.open, M + '/n/stages', os.O_RDWR)
assert stat.S_IMODE(os.stat(M + '/n/stages').st_mode) == 0o444
assert os.getxattr(M + '/n/params/more', 'user.trik.range') == b'0 -'
assert 'user.trik.range' in os.listxattr(M + '/n/params/more')
with open(M + '/config', 'w') as file: file.write('trikfs = {}')
expect('ESTALE', os.pread, stages, 99, 0)
",
    );
}

#[test]
fn a_read_of_stages_samples_what_nothing_else_does() {
    let board = Board::new();
    let Some(m) = mount_on(
        board,
        "trikfs = { n = { src = '/dev/zero', input_tuple_size = 2000, format = 'u8 x', mode = '0400',
            converter = function(a_s, a, b_s, b) ba.u8(b, 0, 5) end },
          plain = { src = '/dev/zero', input_tuple_size = 1, params = { free = 1 } } }",
    ) else {
        return;
    };
    m.python(
        "import stat
assert text(M + '/n/stages') == '00' * 1024 + '...\\n05\\n'
assert not os.path.exists(M + '/plain/stages')
expect('ENODATA', os.getxattr, M + '/plain/params/free', 'user.trik.range')
assert stat.S_IMODE(os.stat(M + '/n/stages').st_mode) == 0o400
",
    );
}
