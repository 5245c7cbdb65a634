//! GPIO lines: plain files instead of sysfs.

use crate::mount_with;
use harness::Board;
use std::fs;

#[test]
fn lines_are_read_written_and_missed() {
    let board = Board::new();
    for (number, direction, value) in [(56, "in", "1"), (62, "in", "0")] {
        let line = board.path(&format!("sys/class/gpio/gpio{number}"));
        fs::create_dir_all(&line).unwrap();
        fs::write(line.join("direction"), format!("{direction}\n")).unwrap();
        fs::write(line.join("value"), format!("{value}\n")).unwrap();
    }
    board.file("sys/class/gpio/export", "");
    let root = board.dir().to_str().unwrap().to_owned();
    let config = "local function line(n, d) return { src = gpio{ number = n, direction = d }, format = 'u8 level' } end
        trikfs = { level = line(56, 'in'), supply = line(62, 'high'), absent = line(7, 'out') }";
    let Some(m) = mount_with(board, config, &["--device-root", &root]) else {
        return;
    };
    m.python(
        "G = D + '/sys/class/gpio'
def put(name, number):
    fd = os.open(M + '/' + name + '/value', os.O_WRONLY)
    try: os.write(fd, b'%d\\n' % number)
    finally: os.close(fd)
assert text(M + '/level/value') == '1\\n'
with open(G + '/gpio56/value', 'w') as file: file.write('0\\n')
assert text(M + '/level/value') == '0\\n'
expect('EACCES', put, 'level', 1)
put('supply', 1)
assert text(G + '/gpio62/direction') == 'high\\n' and text(G + '/gpio62/value') == '1\\n'
expect('ERANGE', put, 'supply', 2)
put('supply', 0)
assert text(G + '/gpio62/value') == '0\\n'
# Nobody makes the line here, but it was asked for.
expect('ENODEV', text, M + '/absent/value')
assert text(G + '/export') == '7\\n' and 'gpio7' in text(M + '/absent/fault')
with open(G + '/gpio56/value', 'w') as file: file.write('2\\n')
expect('EIO', text, M + '/level/value')
",
    );
}
