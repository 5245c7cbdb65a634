//! Sampled sensors: a folder instead of sysfs and a named pipe in that of the node.

use crate::mount_with;
use harness::{Board, Mount};
use std::fs;

/// A board with an accelerometer, mounted with the board's folder as device root.
fn accelerometer(fields: &str) -> Option<Mount> {
    let board = Board::new();
    let folder = board.path("sys/bus/iio/devices/iio:device0");
    fs::create_dir_all(folder.join("scan_elements")).unwrap();
    fs::create_dir_all(folder.join("buffer")).unwrap();
    fs::create_dir_all(board.path("dev")).unwrap();
    board.fifo("dev/iio:device0");
    let channels = ["accel_x", "accel_y", "accel_z", "timestamp"];
    for (index, channel) in channels.iter().enumerate() {
        let kind = if index == 3 {
            "le:s64/64>>0"
        } else {
            "be:s14/16>>2"
        };
        for (what, text) in [("en", "0"), ("index", &index.to_string()), ("type", kind)] {
            let path = folder.join(format!("scan_elements/in_{channel}_{what}"));
            fs::write(path, format!("{text}\n")).unwrap();
        }
    }
    let files = [
        ("name", "mma8451"),
        ("sampling_frequency", "50"),
        ("buffer/enable", "0"),
        ("buffer/length", "2"),
    ];
    for (name, text) in files {
        fs::write(folder.join(name), format!("{text}\n")).unwrap();
    }
    let root = board.dir().to_str().unwrap().to_owned();
    let config = format!(
        "trikfs = {{ a = {{ src = iio{{ name = 'mma8451', channels = {{ 'accel_x', 'accel_y', 'accel_z', 'timestamp' }}, sampling_frequency = 100 }}, format = 'i32 x, i32 y, i32 z, i64 t', {fields} }}, x = {{ src = 'trikfs:a', format = 'i32 x', converter = function(_, i, _, o) ba.i32(o, 0, ba.i32(i, 0)) end }} }}"
    );
    mount_with(board, &config, &["--device-root", &root])
}

const HELPERS: &str = "
S = D + '/sys/bus/iio/devices/iio:device0'
def sample(x, y, z, t): return struct.pack('>hhh', x << 2, y << 2, z << 2) + b'\\xee\\xee' + struct.pack('<q', t)
def switched(on): return lambda: text(S + '/buffer/enable') == on + '\\n'
";

#[test]
fn samples_reach_all_readers_and_the_device_is_off_when_nobody_reads() {
    let Some(m) = accelerometer("") else { return };
    m.python(&format!(
        "{HELPERS}
assert switched('0')()
one = open_ro(M + '/a/device')
assert switched('1')() and text(S + '/sampling_frequency') == '100\\n'
two, linked, pipe = open_ro(M + '/a/device'), open_ro(M + '/x/device'), feed('dev/iio:device0')
assert ready(one, ms=30) == []
os.write(pipe, sample(4096, -1, -8192, 1 << 40))
os.write(pipe, sample(1, 2, 3, 5))
for fd in (one, two):
    assert ready(fd, ms=60000)
    assert read_exactly(fd, 40) == struct.pack('<iiiq', 4096, -1, -8192, 1 << 40) + struct.pack('<iiiq', 1, 2, 3, 5)
assert read_exactly(linked, 8) == struct.pack('<ii', 4096, 1)
os.write(pipe, sample(1, 2, 3, 5)[:5])
eventually(lambda: stat_of(M + '/a/stats', 'damaged') == 1, 'the count')
os.write(pipe, sample(7, 8, 9, 10))
assert read_exactly(one, 20) == struct.pack('<iiiq', 7, 8, 9, 10)
os.close(one)
os.close(linked)
assert switched('1')()
os.close(two)
eventually(switched('0'), 'switched off')
"
    ));
}

#[test]
fn a_device_that_vanishes_is_missing_until_it_is_back() {
    let Some(m) = accelerometer("on_event = true, timeout_ms = 10000") else {
        return;
    };
    m.python(&format!(
        "{HELPERS}
eventually(switched('1'), 'switched on')
pipe = feed('dev/iio:device0')
os.write(pipe, sample(1, 2, 3, 4))
eventually(lambda: text(M + '/a/value') == '1 2 3 4\\n', 'a value')
os.rename(S, D + '/elsewhere')
os.remove(D + '/dev/iio:device0')
eventually(lambda: error_of(text, M + '/a/value') == 'ENODEV', 'missing')
eventually(lambda: 'there is no mma8451; there are: none' in text(M + '/a/fault'), 'the reason')
os.mkfifo(D + '/dev/iio:device0')
pipe = feed('dev/iio:device0')
os.rename(D + '/elsewhere', S)
def is_back():
    os.write(pipe, sample(-5, 6, 7, 8))
    return error_of(text, M + '/a/value') is None and text(M + '/a/value') == '-5 6 7 8\\n'
eventually(is_back, 'back')
assert text(M + '/a/fault') == ''
"
    ));
}
