//! Terminals as devices: bytes pass unchanged in both directions.

use crate::mount;

#[test]
fn a_terminal_passes_all_bytes_unchanged_to_every_reader() {
    let Some(m) = mount("trikfs = {}") else {
        return;
    };
    m.python(
        "master, slave = os.openpty()
name = os.ttyname(slave)
with open(M + '/config', 'w') as file: file.write(\"trikfs = { n = { src = '%s', input_tuple_size = 2 } }\" % name)
one, two = open_ro(M + '/n/device'), open_ro(M + '/n/device', os.O_NONBLOCK)
odd = b'\\x03\\x04\\x1a\\x11\\x13\\r\\n\\x00\\xff\\x7f'
os.write(master, odd)
assert read_exactly(one, len(odd)) == odd
assert ready(two, ms=60000)
assert read_exactly(two, len(odd), 3) == odd
# No echo: the robot would take it for an answer.
assert ready(master) == []
sink = os.open(M + '/n/device', os.O_WRONLY)
os.write(sink, odd)
assert read_exactly(master, len(odd)) == odd
os.close(master)
",
    );
}

#[test]
fn an_unplugged_terminal_is_enodev_and_its_return_is_noticed() {
    let Some(m) = mount("trikfs = {}") else {
        return;
    };
    m.python(
        "master, slave = os.openpty()
link = D + '/tty'
os.symlink(os.ttyname(slave), link)
with open(M + '/config', 'w') as file: file.write(\"trikfs = { n = { src = '%s', input_tuple_size = 1 } }\" % link)
fd = open_ro(M + '/n/device')
os.write(master, b'a')
assert os.read(fd, 1) == b'a'
os.close(slave)
os.close(master)
os.unlink(link)
# The kernel hangs up: EIO of the terminal, then nothing to open any more.
eventually(lambda: error_of(os.read, fd, 1) == 'ENODEV', 'the loss')
assert open(M + '/n/fault').read().startswith('device: ')
master, slave = os.openpty()
os.symlink(os.ttyname(slave), link)
got = []
def again():
    os.write(master, b'b')
    got.append(error_of(lambda: got.append(os.read(fd, 1))))
    return b'b' in got
eventually(again, 'the return')
",
    );
}
