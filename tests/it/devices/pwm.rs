//! Servos and other pulses: plain files instead of a PWM chip.

use crate::mount_with;
use harness::{Board, Mount};
use std::fs;

fn servo() -> Option<Mount> {
    let board = Board::new();
    let channel = board.path("sys/class/pwm/pwmchip3/pwm1");
    fs::create_dir_all(&channel).unwrap();
    for name in ["period", "duty_cycle", "enable"] {
        fs::write(channel.join(name), "0\n").unwrap();
    }
    let root = board.dir().to_str().unwrap().to_owned();
    mount_with(
        board,
        "trikfs = { s = { src = pwm{ chip = '/sys/class/pwm/pwmchip3', channel = 1, period_ns = 20000000 }, format = 'u32 pulse', units = 'ns', rest = 0 } }",
        &["--device-root", &root],
    )
}

const HELPERS: &str = "
def of(name): return text(D + '/sys/class/pwm/pwmchip3/pwm1/' + name)
def put(number):
    fd = os.open(M + '/s/value', os.O_WRONLY)
    try: os.write(fd, b'%d\\n' % number)
    finally: os.close(fd)
";

#[test]
fn a_pulse_switches_the_channel_on_and_0_switches_it_off() {
    let Some(m) = servo() else { return };
    m.python(&format!(
        "{HELPERS}
put(1500000)
assert (of('period'), of('enable'), of('duty_cycle')) == ('20000000\\n', '1\\n', '1500000\\n')
assert text(M + '/s/value') == '1500000\\n'
put(700000)
assert text(M + '/s/value') == '700000\\n' and of('enable') == '1\\n'
expect('ERANGE', put, 20000001)
assert text(M + '/s/value') == '700000\\n'
put(0)
assert (of('enable'), of('duty_cycle'), text(M + '/s/value')) == ('0\\n', '0\\n', '0\\n')
put(900000)
with open(M + '/stop', 'w') as stop: stop.write('1')
assert (of('enable'), of('duty_cycle')) == ('0\\n', '0\\n')
"
    ));
}

#[test]
fn garbage_in_the_files_is_an_error_and_a_missing_chip_is_named() {
    let Some(m) = servo() else { return };
    m.python(&format!(
        "{HELPERS}
put(1500000)
C = D + '/sys/class/pwm/pwmchip3'
with open(C + '/pwm1/duty_cycle', 'w') as file: file.write('garbage')
expect('EIO', text, M + '/s/value')
assert \"'garbage' is no number\" in text(M + '/s/fault')
os.rename(C, C + '-away')
expect('ENODEV', text, M + '/s/value')
expect('ENODEV', put, 5)
assert 'pwmchip3' in text(M + '/s/fault')
os.rename(C + '-away', C)
put(0)
assert text(M + '/s/value') == '0\\n' and text(M + '/s/fault') == ''
"
    ));
}
