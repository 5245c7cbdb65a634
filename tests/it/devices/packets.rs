//! Packets of a serial line, through a pipe and a terminal.

use crate::mount_on;
use harness::Board;

const CONFIG: &str = "trikfs = { lidar = { src = packets{ path = '$DIR/line', baud = 230400, start = '\\xAA', length = { at = 1, bytes = 2, add = 2 }, order = 'big', checksum = 'sum16' }, input_tuple_size = 32 } }";
const HELPERS: &str = "
def packet(content):
    body = b'\\xaa' + struct.pack('>H', len(content) + 3) + content
    return body + struct.pack('>H', sum(body) & 0xffff)
def tuple_of(content): return packet(content).ljust(32, b'\\0')
";

#[test]
fn good_packets_between_garbage_reach_all_readers() {
    let board = Board::new();
    board.fifo("line");
    let Some(m) = mount_on(board, CONFIG) else {
        return;
    };
    m.python(&format!(
        "{HELPERS}
one, pipe = open_ro(M + '/lidar/device'), feed('line')
two = open_ro(M + '/lidar/device')
damaged = bytearray(packet(b'wrong'))
damaged[-1] ^= 1
for byte in b'noise' + packet(b'first') + bytes(damaged) + packet(b'') + b'\\xaa\\xff\\xff' + packet(b'last'):
    os.write(pipe, bytes([byte]))
for fd in (one, two):
    assert ready(fd, ms=60000)
    assert read_exactly(fd, 96, 7) == tuple_of(b'first') + tuple_of(b'') + tuple_of(b'last')
assert ready(one, ms=30) == []
eventually(lambda: stat_of(M + '/lidar/stats', 'damaged') == 2, 'the count')
# A pipe that is made anew is another one.
os.remove(D + '/line')
os.mkfifo(D + '/line')
pipe = feed('line')
def is_back():
    os.write(pipe, packet(b'again'))
    try: return os.read(one, 32) == tuple_of(b'again')
    except OSError as error:
        assert error.errno == errno.ENODEV
        return False
eventually(is_back, 'the new pipe')
"
    ));
}

#[test]
fn a_terminal_passes_every_byte_and_gets_its_speed() {
    let board = Board::new();
    let Some(m) = mount_on(board, CONFIG) else {
        return;
    };
    m.python(&format!(
        "{HELPERS}
import termios
expect('ENODEV', open_ro, M + '/lidar/device')
master, slave = os.openpty()
os.symlink(os.ttyname(slave), D + '/line')
fd = open_ro(M + '/lidar/device')
assert termios.tcgetattr(slave)[5] == termios.B230400
content = bytes(range(0, 24))
os.write(master, packet(content))
assert read_exactly(fd, 32) == tuple_of(content)
"
    ));
}
