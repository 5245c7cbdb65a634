//! Converters that loop, grow, recurse or talk nonsense: an error for their own file, nothing for others.

use crate::{mount, mount_on};
use harness::Board;

/// Name, code of a converter, and a word of its fault.
const HOSTILE: &[(&str, &str, &str)] = &[
    ("loop", "while true do end", "budget"),
    (
        "compiled_loop",
        "local x = 0 for i = 1, 1e12 do x = x + i % 7 end",
        "budget",
    ),
    (
        "caught_loop",
        "while true do pcall(function() while true do end end) end",
        "budget",
    ),
    (
        "coroutines",
        "while true do coroutine.wrap(function() while true do end end)() end",
        "budget",
    ),
    (
        "pattern",
        "('a'):rep(30000):find(('a*'):rep(30) .. 'b')",
        "",
    ),
    ("repetition", "local s = ('x'):rep(2 ^ 31)", ""),
    (
        "growth",
        "local t = {} for i = 1, 1e9 do t[i] = { i } end",
        "memory",
    ),
    ("text", "local s = 'x' while true do s = s .. s end", ""),
    (
        "recursion",
        "local function f(n) return 1 + f(n + 1) end f(1)",
        "",
    ),
    (
        "metatables",
        "local t = setmetatable({}, {}) getmetatable(t).__index = t return t.x.y",
        "",
    ),
    (
        "talk",
        "while true do trikfs_log(('x'):rep(1000)) end",
        "budget",
    ),
    (
        "sort",
        "local t = {} for i = 1, 1000 do t[i] = i end table.sort(t, function() while true do end end)",
        "budget",
    ),
    (
        "gsub",
        "('x'):rep(1000):gsub('x', function() while true do end end)",
        "budget",
    ),
    (
        "concatenation",
        "local t = {} for i = 1, 10000 do t[i] = 'abcdefgh' end while true do table.concat(t) end",
        "",
    ),
    ("thrown_table", "error({})", ""),
    ("thrown_nil", "error()", ""),
    (
        "tostring",
        "error(setmetatable({}, { __tostring = function() while true do end end }))",
        "",
    ),
];

#[test]
fn a_hostile_converter_costs_its_own_file_an_error_and_no_other_file_its_latency() {
    let board = Board::new();
    board.file("raw", "x");
    let mut config = "trikfs = { good = { src = '$DIR/raw', input_tuple_size = 1, output_tuple_size = 1, converter = id_create(1) } }\n".to_owned();
    for (name, code, _) in HOSTILE {
        config.push_str(&format!("trikfs['{name}'] = {{ src = '$DIR/raw', input_tuple_size = 1, output_tuple_size = 1, converter = function(a_s, a, b_s, b) {code} end }}\n"));
    }
    let Some(m) = mount_on(board, &config) else {
        return;
    };
    let open = m.open("good/device");
    std::thread::scope(|scope| {
        let hostile = scope.spawn(|| {
            for (name, _, word) in HOSTILE {
                assert_eq!(m.errno(&format!("{name}/device")), libc::EIO, "{name}");
                let fault = m.text(&format!("{name}/fault"));
                assert!(
                    fault.starts_with("converter: ") && fault.contains(word),
                    "{name}: {fault}"
                );
                assert_eq!(m.errno(&format!("{name}/value")), libc::EIO, "{name}");
            }
        });
        let mut worst = std::time::Duration::ZERO;
        while !hostile.is_finished() {
            let start = std::time::Instant::now();
            let mut got = [0; 1];
            std::os::unix::fs::FileExt::read_exact_at(&open, &mut got, 0).unwrap();
            worst = worst.max(start.elapsed());
            assert_eq!(&got, b"x");
        }
        if let Err(panic) = hostile.join() {
            std::panic::resume_unwind(panic);
        }
        assert!(
            worst < std::time::Duration::from_secs(10),
            "a good converter took {worst:?}"
        );
    });
}

#[test]
fn after_a_fault_the_same_file_converts_again() {
    let board = Board::new();
    board.fifo("in");
    let Some(m) = mount_on(
        board,
        "trikfs = { n = { src = '$DIR/in', input_tuple_size = 1, output_tuple_size = 1, converter = function(a_s, a, b_s, b)
          local what = ba.get(a, 0)
          if what == 1 then while true do end end
          if what == 2 then local t = {} for i = 1, 1e9 do t[i] = {} end end
          if what == 3 then error('three', 0) end
          if what == 4 then ba.get(a, 9) end
          ba.set(b, 0, what)
        end } }",
    ) else {
        return;
    };
    m.python(
        "fd, pipe = open_ro(M + '/n/device'), feed('in')
for round in range(3):
    for what in (1, 2, 3, 4):
        os.write(pipe, bytes([what, 77]))
        expect('EIO', os.read, fd, 1)
        assert os.read(fd, 1) == b'M'
        os.write(pipe, bytes([what, 78, 79]))
        expect('EIO', os.read, fd, 100)
        assert read_exactly(fd, 2) == b'NO'
assert text(M + '/n/fault') == ''
assert stat_of(M + '/n/stats', 'faults') == 24
",
    );
}

#[test]
fn no_bits_of_a_float_harm_the_daemon_and_the_stage_that_fails_is_named() {
    let board = Board::new();
    board.fifo("in");
    let Some(m) = mount_on(
        board,
        "trikfs = { n = { src = '$DIR/in', input_tuple_size = 8, output_tuple_size = 4, format = 'f32 x', converter = {
          { converter = function(a_s, a, b_s, b)
              local x = ba.f64(a, 0)
              if type(x) ~= 'number' then error('bits became a ' .. type(x), 0) end
              local ok, what = pcall(function() return x.y, #x, x() end)
              if ok then error('a number was indexed', 0) end
              ba.f32(b, 0, x)
            end, output_tuple_size = 4 },
          filter.low_pass_f32{} } } }",
    ) else {
        return;
    };
    m.python(
        "fd, pipe = open_ro(M + '/n/device'), feed('in')
for high in range(0xfff0, 0x10000):
    for low in (1, 0x4141, 0xffffffffffff):
        os.write(pipe, (high << 48 | low).to_bytes(8, 'little'))
        expect('EIO', os.read, fd, 4)
        assert text(M + '/n/fault') == 'converter: stage 2 of 2: low_pass: value 0: not a finite number\\n', text(M + '/n/fault')
os.write(pipe, bytes([0, 0, 0, 0, 0, 0, 0xf8, 0x3f]))
assert os.read(fd, 4) == bytes([0, 0, 0xc0, 0x3f])
",
    );
}

#[test]
fn a_budget_of_ones_own_is_kept() {
    let Some(m) = mount(
        "local function busy() while true do end end
         trikfs = {
           short = { src = '/dev/zero', input_tuple_size = 1, output_tuple_size = 1, budget_us = 1000, converter = busy },
           long = { src = '/dev/zero', input_tuple_size = 1, output_tuple_size = 1, budget_us = 300000, converter = busy },
         }",
    ) else {
        return;
    };
    for (name, least_us) in [("short", 1_000), ("long", 300_000)] {
        let start = std::time::Instant::now();
        assert_eq!(m.errno(&format!("{name}/device")), libc::EIO);
        let took = start.elapsed();
        assert!(
            took >= std::time::Duration::from_micros(least_us),
            "{name}: {took:?}"
        );
        assert!(
            took < std::time::Duration::from_micros(least_us) * 2
                + std::time::Duration::from_secs(60),
            "{name}: {took:?}"
        );
        assert!(
            m.text(&format!("{name}/fault"))
                .contains(&format!("{least_us} us")),
            "{}",
            m.text(&format!("{name}/fault"))
        );
    }
}

#[test]
fn a_program_that_holds_more_than_an_open_file_may_is_refused() {
    let Some(m) = mount("trikfs = { n = { src = '/dev/zero', input_tuple_size = 1 } }") else {
        return;
    };
    let refused = m.apply(
        "local t = {}
         for i = 1, 300000 do t[i] = i end
         trikfs = { n = { src = '/dev/zero', input_tuple_size = 1, output_tuple_size = 1, memory_kb = 128, converter = function() return t[1] and nil end } }",
    );
    assert!(refused.is_err());
    let status = m.text("status");
    assert!(
        status.contains("memory_kb = 128 leaves no room"),
        "{status}"
    );
    assert_eq!(m.errno("n/value"), 0);
}
