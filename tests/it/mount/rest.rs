//! Rest of every kind of actuator when the daemon, the guardian, or one after the other is killed.

use crate::mount_with;
use harness::{Board, Mount, eventually, processes};

/// `motor` is on a bus, the next three are files; `hanging` and `gone` cannot be reached.
const ROBOT: &str = "
local function byte(path, register)
  return i2c{ path = path, address = 0x48, register = register, transfer = 'byte' }
end
trikfs = {
  motor = { src = byte('/bus', 0x14), input_tuple_size = 1, output_tuple_size = 1, format = 'i8 power', rest = { 0 },
    converter = function(a_s, a, b_s, b) ba.set(b, 0, ba.get(a, 0)) end,
    write_converter = function(a_s, a, b_s, b) ba.set(b, 0, (ba.get(a, 0) + 1) % 256) end },
  wheel = { src = '/wheel', input_tuple_size = 1, output_tuple_size = 1, rest = { 3 },
    converter = function(a_s, a, b_s, b) ba.set(b, 0, ba.get(a, 0) - 10) end,
    write_converter = function(a_s, a, b_s, b) ba.set(b, 0, ba.get(a, 0) + 10) end },
  file = { src = '/file', input_tuple_size = 1, rest = { 7 } },
  text = { src = attribute{ '/text' }, input_tuple_size = 8, output_tuple_size = 1, rest = { 9 },
    converter = function(a_s, a, b_s, b) ba.set(b, 0, 0) end,
    write_converter = function(a_s, a, b_s, b) ba.set(b, 0, ba.get(a, 0) + 48) end },
  servo = { src = pwm{ chip = '/sys/class/pwm/pwmchip2', channel = 1, period_ns = 20000000 }, input_tuple_size = 4,
    format = 'u32 duty', rest = { 0 } },
  lamp = { src = gpio{ number = 56, direction = 'out' }, input_tuple_size = 1, rest = { 1 } },
  a_hanging = { src = byte('/silent', 0x15), input_tuple_size = 1, rest = { 0 }, timeout_ms = 6000 },
  a_gone = { src = byte('/nothing', 0x15), input_tuple_size = 1, rest = { 0 } },
  absent = { src = absent{ reason = 'not on this board' }, input_tuple_size = 1, rest = { 0 } },
}";

/// A bus that notes what is written, and one that takes requests and never answers.
const WORDS: &str = "
import socket
written = []
def bus(name, serve):
    listener = socket.socket(socket.AF_UNIX, socket.SOCK_SEQPACKET)
    listener.bind(D + '/' + name)
    listener.listen(16)
    def accept():
        while True:
            peer, _ = listener.accept()
            threading.Thread(target=serve, args=(peer,), daemon=True).start()
    threading.Thread(target=accept, daemon=True).start()
def answers(peer):
    while request := peer.recv(9000):
        version, flags, address, writes, reads = struct.unpack('<BBHHH', request[:8])
        if not reads: written.append((address, request[8:]))
        peer.send(struct.pack('<i', 0) + bytes(reads))
def never(peer):
    while peer.recv(9000): pass
bus('bus', answers)
bus('silent', never)
def byte(name): return open(D + '/' + name, 'rb').read()
def sys():
    names = ('pwm/pwmchip2/pwm1/enable', 'pwm/pwmchip2/pwm1/duty_cycle', 'gpio/gpio56/value')
    return tuple(text(D + '/sys/class/' + name).strip() for name in names)
def put(name, text):
    with open(M + '/' + name + '/value', 'w') as file: file.write(text)
def drive():
    put('motor', '50'); put('wheel', '40'); put('file', '60'); put('text', '5'); put('servo', '1500000'); put('lamp', '0')
    assert written[-1] == (0x48, b'\\x14\\x33'), written
    assert [byte(name) for name in ('wheel', 'file', 'text')] == [b'\\x32', b'\\x3c', b'5.'], [byte(name) for name in ('wheel', 'file', 'text')]
    assert sys() == ('1', '1500000', '0'), sys()
    del written[:]
def rests():
    return (0x48, b'\\x14\\x01') in written and [byte(name) for name in ('wheel', 'file', 'text')] == [b'\\x0d', b'\\x07', b'9.'] \\
        and sys()[0] == '0' and sys()[1].startswith('0') and sys()[2] == '1'
";

fn robot() -> Option<Mount> {
    let board = Board::new();
    for name in ["wheel", "file"] {
        board.file(name, ".");
    }
    board.file("text", "..");
    let sys = board.path("sys/class");
    let channel = sys.join("pwm/pwmchip2/pwm1");
    let line = sys.join("gpio/gpio56");
    for (folder, files) in [
        (channel, &["period", "duty_cycle", "enable"][..]),
        (line, &["direction", "value", "active_low"]),
    ] {
        std::fs::create_dir_all(&folder).unwrap();
        for file in files {
            std::fs::write(folder.join(file), "0\n").unwrap();
        }
    }
    let root = board.dir().to_str().unwrap().to_owned();
    mount_with(board, ROBOT, &["--device-root", &root])
}

#[test]
fn killed_daemons_and_a_killed_guardian_leave_every_kind_of_actuator_at_rest() {
    let Some(mut m) = robot() else { return };
    let (guardian, daemon) = (m.guardian(), m.daemon());
    m.python(&format!(
        "{WORDS}
def daemon():
    with open('/proc/{guardian}/task/{guardian}/children') as file:
        words = file.read().split()
    return int(words[0]) if words else 0
def comes_back(before):
    eventually(lambda: daemon() not in (0, before), 'another daemon')
    eventually(lambda: os.path.exists(M + '/motor/value'), 'the tree')
assert daemon() == {daemon}
for victim in range(2):
    drive()
    begin, before = time.monotonic(), daemon()
    os.kill(before, signal.SIGKILL)
    eventually(rests, 'rest')
    took = time.monotonic() - begin
    assert took < 5, 'others waited for the bus that hangs: %f' % took
    comes_back(before)
drive()
os.kill({guardian}, signal.SIGKILL)
eventually(rests, 'rest')
"
    ));
    m.wait();
    eventually("the end of the mount", || !m.is_mounted());
    eventually("the end of the daemon", || {
        processes::children(guardian).is_empty()
    });
    let said = m.complaints();
    for part in ["rest of $DIR/silent", "rest of $DIR/nothing"] {
        let part = m.board().fill_in(part);
        assert!(said.contains(&part), "no {part:?} in {said}");
    }
}

#[test]
fn stop_reaches_all_that_can_be_reached_at_once_and_tells_of_the_others() {
    let Some(m) = robot() else { return };
    m.python(&format!(
        "{WORDS}
drive()
def stop():
    fd = os.open(M + '/stop', os.O_WRONLY)
    os.write(fd, b'1')
begin = time.monotonic()
done = []
thread = threading.Thread(target=lambda: done.append(error_of(stop)))
thread.start()
eventually(rests, 'rest')
took = time.monotonic() - begin
assert took < 5, took
thread.join()
assert done[0] in ('ENODEV', 'ETIMEDOUT'), done
assert text(M + '/absent/fault') == ''
assert 'nothing' in text(M + '/a_gone/fault') and 'silent' in text(M + '/a_hanging/fault')
"
    ));
}
