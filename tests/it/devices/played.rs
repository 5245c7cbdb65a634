//! Channels of a player: tuples, failures, writes, and players that come late, talk rubbish or leave.

use crate::mount_on;
use harness::Board;

/// A player in the test's own process: who connects, and what it says to them.
const PLAYER: &str = "import socket
server = socket.socket(socket.AF_UNIX, socket.SOCK_SEQPACKET)
server.bind(D + '/player')
server.listen(8)
peers, wrote = {}, []
def hear(peer):
    while data := peer.recv(4096):
        wrote.append(data)
def admit():
    while True:
        peer, _ = server.accept()
        hello = peer.recv(600).decode()
        peers[hello] = peer
        if hello.startswith('write'):
            threading.Thread(target=hear, args=(peer,), daemon=True).start()
threading.Thread(target=admit, daemon=True).start()
def sample(name, *bytes_):
    peers['read ' + name].send(struct.pack('<i', 0) + bytes(bytes_))
def fail(name, errno, reason):
    peers['read ' + name].send(struct.pack('<i', errno) + reason)
";

const TREE: &str = "trikfs = {
  a = { src = played{ path = '$DIR/player', channel = 'x y' }, format = 'u8 n', on_event = true, mode = 0444 },
  m = { src = played{ path = '$DIR/player', channel = 'm' }, format = 'i8 power', on_event = true, rest = 0 },
}";

#[test]
fn a_player_gives_values_failures_and_hears_what_is_written() {
    let Some(m) = mount_on(Board::new(), TREE) else {
        return;
    };
    m.python(&format!(
        "{PLAYER}
eventually(lambda: 'read x y' in peers and 'read m' in peers, 'both readers')
sample('x y', 7)
eventually(lambda: answer(M + '/a/value') == '7\\n', 'a value')
fail('x y', errno.ETIMEDOUT, b'no echo')
eventually(lambda: answer(M + '/a/value') == 'ETIMEDOUT', 'a failure')
assert text(M + '/a/fault') == 'device: no echo\\n', text(M + '/a/fault')
# The channel stays open, and another value ends the failure.
sample('x y', 8)
eventually(lambda: answer(M + '/a/value') == '8\\n', 'a value')
assert text(M + '/a/fault') == ''
open(M + '/m/value', 'w').write('-30')
# Each connection is heard by a thread of its own, so the rest must not come before this was heard.
eventually(lambda: bytes([226]) in wrote, 'what was written')
open(M + '/stop', 'w').write('1')
eventually(lambda: wrote[-1] == bytes([0]), 'a rest')
"
    ));
}

#[test]
fn what_comes_right_after_a_failure_is_there_while_others_have_the_channel_open() {
    let Some(m) = mount_on(Board::new(), TREE) else {
        return;
    };
    m.python(&format!(
        "{PLAYER}
def value():
    return answer(M + '/a/value')
eventually(lambda: 'read x y' in peers, 'the sampler')
sample('x y', 7)
eventually(lambda: value() == '7\\n', 'a value')
other = os.open(M + '/a/bin_data', os.O_RDONLY | os.O_NONBLOCK)
eventually(lambda: error_of(lambda: os.read(other, 1)) is None, 'another reader')
for number in range(8, 12):
    fail('x y', errno.ETIMEDOUT, b'no echo')
    eventually(lambda: value() == 'ETIMEDOUT', 'a failure')
    sample('x y', number)
    eventually(lambda: value() == '%d\\n' % number, 'the value after it')
"
    ));
}

#[test]
fn rubbish_of_a_player_is_a_failure_and_a_late_one_is_found() {
    let Some(m) = mount_on(Board::new(), TREE) else {
        return;
    };
    m.python(&format!(
        "assert answer(M + '/a/value') in ('ENODEV', 'ENODATA')
{PLAYER}
eventually(lambda: 'read x y' in peers, 'a reader')
for rubbish in (b'', struct.pack('<i', 0), struct.pack('<i', 0) + b'12', struct.pack('<i', -5), b'ab', bytes(5000)):
    peer = peers['read x y']
    if rubbish:
        peer.send(rubbish)
    else:
        peer.shutdown(socket.SHUT_RDWR)
    eventually(lambda: peers['read x y'] is not peer, 'a new connection after %r' % rubbish)
sample('x y', 9)
eventually(lambda: answer(M + '/a/value') == '9\\n', 'a value')
"
    ));
}
