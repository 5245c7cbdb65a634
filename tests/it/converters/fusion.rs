//! Several nodes in one: who sets the pace, how old the others are, samples of one moment, numbers changed on the way.

use crate::mount_on;
use harness::{Board, eventually};

#[test]
fn only_the_trigger_makes_tuples_from_the_newest_of_the_others() {
    let board = Board::new();
    for name in ["fast", "slow", "still"] {
        board.fifo(name);
    }
    board.file("state", "s");
    let Some(m) = mount_on(
        board,
        "trikfs = {
           still = { src = '$DIR/still', input_tuple_size = 1, on_event = true },
           both = { src = { fast = '$DIR/fast', slow = '$DIR/slow', state = '$DIR/state', still = 'newest:still' },
                    input_tuple_size = { fast = 1, slow = 1, state = 1 }, trigger = 'fast' },
         }",
    ) else {
        return;
    };
    m.python(
        "fd = open_ro(M + '/both/device', os.O_NONBLOCK)
fast, slow, still = feed('fast'), feed('slow'), feed('still')
# Not every source has delivered yet: nothing is made.
os.write(fast, b'1')
os.write(slow, b'a')
expect('EAGAIN', os.read, fd, 4)
os.write(still, b'x')
eventually(lambda: open(M + '/still/bin_data', 'rb').read() == b'x')
os.write(fast, b'2')
assert ready(fd, ms=60000)
assert os.read(fd, 4) == b'2asx'
# The others alone make none, and the newest of them is what counts.
os.write(slow, b'bc')
os.write(still, b'yz')
eventually(lambda: open(M + '/still/bin_data', 'rb').read() == b'z')
expect('EAGAIN', os.read, fd, 4)
os.write(fast, b'3')
assert ready(fd, ms=60000)
assert os.read(fd, 4) == b'3csz'
",
    );
}

#[test]
fn ages_and_the_interval_are_those_of_the_clock() {
    let board = Board::new();
    board.fifo("in");
    board.fifo("old");
    let Some(m) = mount_on(
        board,
        "trikfs = {
           old = { src = '$DIR/old', format = 'u8 number', on_event = true },
           new = { src = '$DIR/in', format = 'u8 number' },
           timed = { src = { 'trikfs:new', 'newest:old' }, ages = true, interval = true },
         }",
    ) else {
        return;
    };
    assert_eq!(
        m.text("timed/format"),
        "u8 new, u8 old, u32 age1_us, u32 age2_us, u32 interval_us\n"
    );
    m.python(
        "fd, pipe, old = open_ro(M + '/timed/device'), feed('in'), feed('old')
os.write(old, b'\\x07')
eventually(lambda: open(M + '/old/value').read() == '7\\n')
sampled = time.monotonic_ns()
before = None
for number in range(5):
    # Long enough for an age and an interval that are not nothing.
    since = time.monotonic_ns()
    eventually(lambda: time.monotonic_ns() > since + 20_000_000, 'the clock')
    wrote = time.monotonic_ns()
    os.write(pipe, bytes([number]))
    first, second, age1, age2, interval = struct.unpack('<BBIII', read_exactly(fd, 14))
    got = time.monotonic_ns()
    assert (first, second) == (number, 7)
    assert age1 <= (got - wrote) // 1000
    # The old one was sampled before `sampled` was taken.
    assert age2 >= (wrote - sampled) // 1000, (age2, wrote - sampled)
    if before is None:
        assert interval == 0
    else:
        assert (wrote - before[1]) // 1000 <= interval <= (got - before[0]) // 1000, interval
    before = (wrote, got)
",
    );
}

/// Two nodes that count in step are never seen out of step when they are read together.
#[test]
fn a_snapshot_never_mixes_samples_of_different_moments() {
    let board = Board::new();
    board.fifo("in");
    let Some(m) = mount_on(
        board,
        "trikfs = {
           a = { src = '$DIR/in', format = 'u32 number', on_event = true },
           snapshot = { src = { first = 'newest:a', again = 'newest:a' } },
           late = { src = { 'newest:never' } },
           never = { src = '$DIR/absent', format = 'u8 x', poll_ms = 1000 },
         }",
    ) else {
        return;
    };
    assert_eq!(m.text("snapshot/format"), "u32 again, u32 first\n");
    m.python(
        "pipe = feed('in')
os.write(pipe, struct.pack('<I', 1))
eventually(lambda: open(M + '/a/value').read() == '1\\n')
stop = False
def publish():
    number = 1
    while not stop:
        number += 1
        os.write(pipe, struct.pack('<I', number))
writer = threading.Thread(target=publish)
writer.start()
fd = open_ro(M + '/snapshot/bin_data')
seen = set()
for _ in range(3000):
    first, second = struct.unpack('<II', os.pread(fd, 8, 0))
    assert first == second, (first, second)
    seen.add(first)
stop = True
writer.join()
assert len(seen) > 10, len(seen)
",
    );
    // A node that fails makes the whole fail, with its name.
    assert_eq!(m.errno("late/value"), libc::ENODEV);
    assert!(
        m.text("late/fault").contains("never"),
        "{}",
        m.text("late/fault")
    );
}

#[test]
fn a_changed_param_reaches_converters_that_are_open() {
    let board = Board::new();
    board.file("in", [10]);
    let Some(m) = mount_on(
        board,
        "trikfs = {
           lua = { src = '$DIR/in', input_tuple_size = 1, format = 'f64 scaled', params = { gain = { 2, min = -5, max = 5 }, free = 1 },
             converter = function(a_s, a, b_s, b) ba.f64(b, 0, ba.u8(a, 0) * params.gain * params.free) end },
           filtered = { src = '$DIR/in', format = 'u8 x', params = { width = 1 },
             attributes = { half = { src = '$DIR/in', input_tuple_size = 1, format = 'f64 x', params = { gain = 0.5 },
               converter = function(a_s, a, b_s, b) ba.f64(b, 0, ba.u8(a, 0) * params.gain) end } } },
         }",
    ) else {
        return;
    };
    assert_eq!(m.sh("ls $MNT/lua/params").trim(), "free\ngain");
    assert_eq!(m.text("lua/params/gain"), "2\n");
    m.python(
        "fd = open_ro(M + '/lua/value')
read = lambda: os.pread(fd, 64, 0)
assert read() == b'20\\n', read()
def put(text, name='lua/params/gain'):
    with open(M + '/' + name, 'w') as f:
        f.write(text)
put('3\\n')
assert read() == b'30\\n', read()
expect('ERANGE', put, '5.5')
expect('EINVAL', put, 'much')
expect('ERANGE', put, 'nan')
expect('ERANGE', put, '1e999')
assert read() == b'30\\n', read()
put('-0.5', 'lua/params/free')
assert read() == b'-15\\n', read()
half = open_ro(M + '/filtered/half')
assert os.pread(half, 64, 0) == b'5\\n'
put('4', 'filtered/params/half.gain')
assert os.pread(half, 64, 0) == b'40\\n'
",
    );
    // What a caller did wrong is in the log, with what would be right, and no fault.
    let log = m.log();
    for line in [
        "lua: caller: params/gain is a number from -5 to 5, not 5.5\n",
        "lua: caller: params/gain is a number from -5 to 5, not 'much'\n",
        "lua: caller: params/gain is a number from -5 to 5, not nan\n",
    ] {
        assert!(log.contains(line), "{line}{log}");
    }
    assert_eq!(m.text("lua/fault"), "");
    assert_eq!(m.stat("lua", "faults"), 0.0);
    // A reload that changes nothing keeps what was set; one that changes the node begins with the description.
    let config = m.text("config");
    m.apply(&format!("{config}\n-- again")).unwrap();
    assert_eq!(m.text("lua/params/gain"), "3\n");
    m.apply(&config.replace("gain = { 2,", "gain = { 4,"))
        .unwrap();
    assert_eq!(m.text("lua/params/gain"), "4\n");
    assert_eq!(m.text("lua/value"), "40\n");
}

/// A library converter is opened anew with the new numbers, and one that refuses them leaves all as it was.
#[test]
fn a_library_takes_a_changed_param_or_refuses_it() {
    let board = Board::new();
    board.fifo("in");
    let Some(m) = mount_on(
        board,
        "trikfs = { calm = { src = '$DIR/in', input_tuple_size = 4, format = 'i32 x', params = { alpha = 1 },
           converter = 'libtrikfs_filters.so#low_pass' } }",
    ) else {
        return;
    };
    m.python(
        "fd, pipe = open_ro(M + '/calm/device'), feed('in')
def through(number):
    os.write(pipe, struct.pack('<i', number))
    return struct.unpack('<i', read_exactly(fd, 4))[0]
def put(text):
    with open(M + '/calm/params/alpha', 'w') as f:
        f.write(text)
assert [through(x) for x in (0, 100, 200)] == [0, 100, 200]
put('0.5')
# It began afresh: the first tuple passes as it is.
assert [through(x) for x in (0, 100, 100)] == [0, 50, 75]
expect('EINVAL', put, '7')
assert open(M + '/calm/params/alpha').read() == '0.5\\n'
assert through(75) == 75
",
    );
    let log = m.log();
    assert!(log.contains("params/alpha stays as it is"), "{log}");
}

/// A motor whose speed is what is written to it, seen by a file that the test plays the encoder with.
const REGULATED: &str = "
trikfs = {
  encoder = { src = '$DIR/encoder', format = 'i32 speed' },
  motor = { src = '$DIR/motor', format = 'i32 power', rest = 0,
    attributes = {
      speed = {
        src = regulator{ feedback = 'trikfs:encoder', actuator = 'trikfs:motor' },
        poll_ms = 5, format = 'i32 speed', units = 'deg/s', params = { gain = 2 },
        converter = function(a_s, a, b_s, b) ba.i32(b, 0, ba.i32(a, 0)) end,
        write_converter = function(a_s, a, b_s, b)
          assert(a_s == 12 and b_s == 4)
          local ordered, measured, interval_us = ba.i32(a, 0), ba.i32(a, 4), ba.u32(a, 8)
          if ordered == 666 then error('no such speed', 0) end
          if ordered > 666 then error('ERANGE: too fast', 0) end
          ba.i32(b, 0, params.gain * (ordered - measured) + (interval_us < 1000000 and 0 or 1000))
        end,
      },
    },
  },
}";

fn regulated() -> Option<harness::Mount> {
    let board = Board::new();
    board.file("encoder", 10i32.to_le_bytes());
    board.file("motor", 0i32.to_le_bytes());
    mount_on(board, REGULATED)
}

const POWER: &str = "
def power():
    with open(D + '/motor', 'rb') as f:
        return struct.unpack('<i', f.read(4))[0]
def put(name, text):
    with open(M + '/' + name, 'w') as f:
        f.write(text)
def encoder(speed):
    with open(D + '/encoder', 'r+b') as f:
        f.write(struct.pack('<i', speed))
def stamp():
    return os.getxattr(M + '/motor/speed', 'user.trik.time_ns')
def some_steps():
    # Of the regulator: begun and ended, whatever they did.
    for _ in range(4):
        before = stamp()
        eventually(lambda: stamp() != before, 'a step')
";

#[test]
fn what_is_ordered_is_held_until_somebody_else_drives() {
    let Some(m) = regulated() else {
        return;
    };
    m.python(&format!(
        "{POWER}
# Measured without an order: nothing is driven.
eventually(lambda: text(M + '/motor/speed') == '10\\n')
assert power() == 0
put('motor/speed', '50')
eventually(lambda: power() == 80)
encoder(45)
eventually(lambda: power() == 10)
assert text(M + '/motor/speed') == '45\\n'
put('motor/params/speed.gain', '3')
eventually(lambda: power() == 15)
put('motor/speed', '46')
eventually(lambda: power() == 3)
# A program that writes to the motor has it from there on.
put('motor/value', '-7')
encoder(20)
eventually(lambda: text(M + '/motor/speed') == '20\\n')
some_steps()
assert power() == -7, power()
put('motor/speed', '21')
eventually(lambda: power() == 3)
"
    ));
}

/// A program that gives an order hears at once that it cannot be.
#[test]
fn an_order_that_the_law_refuses_changes_nothing() {
    let Some(m) = regulated() else {
        return;
    };
    m.python(&format!(
        "{POWER}
expect('ERANGE', put, 'motor/speed', '700')
assert power() == 0
put('motor/value', '33')
expect('ERANGE', put, 'motor/speed', '700')
assert power() == 33, 'it was not touched'
# The first step is made before the write returns.
put('motor/speed', '50')
assert power() == 80
expect('ERANGE', put, 'motor/speed', '700')
encoder(45)
eventually(lambda: power() == 10, 'the order before is held')
# Without feedback nothing can be held; the reason stays until somebody drives again.
os.truncate(D + '/encoder', 0)
eventually(lambda: power() == 0)
expect('EIO', put, 'motor/speed', '50')
assert 'bytes of a tuple' in text(M + '/motor/fault'), text(M + '/motor/fault')
put('motor/value', '5')
assert text(M + '/motor/fault') == ''
expect('EIO', put, 'motor/speed', '50')
assert power() == 5, 'what another drives is left alone'
"
    ));
}

/// A node that is sampled by the clock has its first value when its sources have.
#[test]
fn a_sampled_node_has_its_first_value_when_the_others_have_theirs() {
    let board = Board::new();
    board.fifo("in");
    let Some(m) = mount_on(
        board,
        "trikfs = {
           early = { src = '$DIR/in', format = 'u8 x', on_event = true },
           one = { src = 'newest:early', format = 'u8 x', poll_ms = 5, timeout_ms = 60000 },
           both = { src = { 'newest:early', 'newest:one' }, poll_ms = 5, timeout_ms = 60000 },
           asked = { src = 'newest:early', format = 'u8 x' },
         }",
    ) else {
        return;
    };
    m.python(
        "import select
for name in ('one', 'both', 'asked'):
    expect('ENODATA', text, M + '/' + name + '/value')
    assert text(M + '/' + name + '/fault') == '', name
for name in ('one', 'both'):
    fd = open_ro(M + '/' + name + '/value', os.O_NONBLOCK)
    expect('EAGAIN', os.pread, fd, 10, 0)
pipe = feed('in')
fd = open_ro(M + '/both/value')
waiting = select.poll()
waiting.register(fd, select.POLLIN)
assert waiting.poll(0) == []
os.write(pipe, b'\\x07')
assert waiting.poll(60000) != []
assert os.pread(fd, 10, 0) == b'7 7\\n'
assert text(M + '/one/value') == '7\\n'
assert text(M + '/asked/value') == '7\\n'
",
    );
}

#[test]
fn a_regulator_ends_in_rest_by_every_way() {
    let Some(m) = regulated() else {
        return;
    };
    m.python(&format!(
        "{POWER}
def begin(speed='50'):
    encoder(10)
    eventually(lambda: error_of(text, M + '/motor/speed') is None)
    put('motor/speed', speed)
    eventually(lambda: power() == 120 or power() == 80)
def ends(why):
    eventually(lambda: power() == 0, why)
    # It stays there, with an encoder that can be read, too.
    encoder(10)
    some_steps()
    assert power() == 0, (why, power())
begin()
put('stop', '1')
ends('stop')
# The encoder dies: a motor that cannot be measured must not run.
begin()
os.truncate(D + '/encoder', 0)
ends('feedback')
assert 'comes to rest' in os.read(open_ro(M + '/log'), 65536).decode()
begin()
expect('EIO', put, 'motor/speed', '666')
ends('law')
assert text(M + '/motor/fault').strip().endswith('no such speed'), text(M + '/motor/fault')
# A program that dies with the file open has lost the motor.
def drive():
    fd = os.open(M + '/motor/speed', os.O_WRONLY)
    os.write(fd, b'50')
    eventually(lambda: power() == 80)
    os.kill(os.getpid(), signal.SIGKILL)
encoder(10)
ended(forked(drive))
ends('program')
"
    ));
    m.python(&format!(
        "{POWER}
encoder(10)
put('motor/speed', '50')
eventually(lambda: power() == 80)"
    ));
    let config = m.text("config");
    m.apply(&config.replace("poll_ms = 5", "poll_ms = 6"))
        .unwrap();
    m.python(&format!(
        "{POWER}
assert power() == 0, power()
put('motor/speed', '50')
eventually(lambda: power() == 80)"
    ));
    harness::processes::signal(m.daemon(), nix::sys::signal::Signal::SIGKILL);
    eventually("rest", || m.board().content("motor") == 0i32.to_le_bytes());
}

#[test]
fn a_regulator_that_cannot_work_is_refused() {
    let Some(m) = mount_on(Board::new(), "trikfs = {}") else {
        return;
    };
    let law =
        "poll_ms = 5, format = 'i32 v', converter = id_create(4), write_converter = id_create(4)";
    let cases = [
        (format!("src = regulator{{ actuator = 'trikfs:motor' }}, {law}"), "regulator: feedback is missing"),
        (format!("src = regulator{{ feedback = 'trikfs:e' }}, {law}"), "regulator: actuator is missing"),
        (format!("src = regulator{{ feedback = '/dev/zero', actuator = 'trikfs:motor' }}, {law}"), "feedback is another node"),
        (format!("src = regulator{{ feedback = 'trikfs:e', actuator = 'trikfs:mot' }}, {law}"), "there is no node 'mot'"),
        (format!("src = regulator{{ feedback = 'trikfs:e', actuator = 'trikfs:sensor' }}, {law}"), "'sensor' cannot be driven: it cannot be written"),
        (format!("src = regulator{{ feedback = 'trikfs:e', actuator = 'trikfs:e' }}, {law}"), "'e' cannot be driven: it has no rest"),
        (format!("src = regulator{{ feedback = 'trikfs:x', actuator = 'trikfs:motor' }}, {law}"), "in a circle: x -> x"),
        (format!("src = regulator{{ feedback = 'trikfs:e', actuator = 'trikfs:motor', gain = 1 }}, {law}"), "regulator: unknown key 'gain'"),
        (format!("src = regulator{{ feedback = 'trikfs:e', actuator = 'trikfs:motor' }}, {}", law.replace("poll_ms = 5,", "")), "give poll_ms"),
        ("src = regulator{ feedback = 'trikfs:e', actuator = 'trikfs:motor' }, poll_ms = 5, format = 'i32 v', converter = id_create(4)".to_owned(), "a regulator needs a write_converter"),
        (format!("src = regulator{{ feedback = 'trikfs:e', actuator = 'trikfs:motor' }}, {law}, rest = 0"), "a regulator has no rest of its own"),
    ];
    for (node, reason) in cases {
        let config = format!(
            "trikfs = {{ x = {{ {node} }}, e = {{ src = '/dev/null', format = 'i32 v' }}, sensor = {{ src = fake{{ data = 'abcd' }}, format = 'i32 v' }},\n\
             motor = {{ src = '/dev/null', format = 'i32 v', rest = 0 }} }}"
        );
        let refused = m.apply(&config).unwrap_err();
        assert!(refused.contains(reason), "{node}: {refused}");
    }
}
