//! Extended attributes: the exact time of the newest sample, and what brings an actuator to rest.

use crate::mount_on;
use harness::Board;

#[test]
fn the_time_of_the_newest_sample_is_exact_and_moves_on() {
    let board = Board::new();
    board.fifo("in");
    let Some(m) = mount_on(
        board,
        "trikfs = { n = { src = '$DIR/in', input_tuple_size = 1, on_event = true } }",
    ) else {
        return;
    };
    m.python(
        "name = 'user.trik.time_ns'
for file in ('/n/value', '/n/bin_data', '/n/device'):
    expect('ENODATA', os.getxattr, M + file, name)
    assert os.listxattr(M + file) == []
pipe = feed('in')
last = 0
for number in range(20):
    before = time.clock_gettime_ns(time.CLOCK_MONOTONIC)
    os.write(pipe, bytes([number]))
    eventually(lambda: answer(M + '/n/value') == '%d\\n' % number, 'the sample')
    stamp = int(os.getxattr(M + '/n/value', name))
    assert before <= stamp <= time.clock_gettime_ns(time.CLOCK_MONOTONIC)
    assert stamp > last
    last = stamp
assert os.listxattr(M + '/n/value') == [name]
offset = int(text(M + '/n/stats').split()[-1])
assert abs(offset - (time.time_ns() - time.clock_gettime_ns(time.CLOCK_MONOTONIC))) < 50_000_000
",
    );
}

#[test]
fn other_attributes_do_not_exist_and_none_can_be_set() {
    let board = Board::new();
    let Some(m) = mount_on(
        board,
        "trikfs = { n = { src = '/dev/zero', input_tuple_size = 1 } }",
    ) else {
        return;
    };
    m.python(
        "expect('ENODATA', os.getxattr, M + '/n/value', 'user.other')
expect('ENODATA', os.getxattr, M + '/config', 'user.trik.time_ns')
assert error_of(os.setxattr, M + '/n/value', 'user.other', b'1') in ('EPERM', 'EOPNOTSUPP', 'ENOTSUP', 'EACCES')
assert error_of(os.removexattr, M + '/n/value', 'user.trik.time_ns') in ('EPERM', 'EOPNOTSUPP', 'ENOTSUP', 'EACCES')
os.pread(open_ro(M + '/n/value'), 9, 0)
assert len(os.getxattr(M + '/n/value', 'user.trik.time_ns')) >= 9
",
    );
}

#[test]
fn an_actuator_tells_what_brings_it_to_rest() {
    let board = Board::new();
    let Some(m) = mount_on(
        board,
        "trikfs = { m = { src = '/dev/null', format = 'i8 left, f32 right', rest = { 0, -1.5 } } }",
    ) else {
        return;
    };
    m.python(
        "assert os.getxattr(M + '/m/value', 'user.trik.rest') == b'0 -1.5'
assert os.listxattr(M + '/m/value') == ['user.trik.rest']
",
    );
}
