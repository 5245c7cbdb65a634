//! Things taken together: the newest samples of many nodes in one read, and many converters in one node.
//!
//! A chain is measured by many tuples in one read, because a single conversion is far below what a read(2) costs: from the
//! time for a tuple the same read without a converter is taken off, for the chain and for each of its parts.

use super::measure::{Plan, median, row, table, time, verdict};
use super::peers::Mount;
use std::fs::File;
use std::io::Read;
use std::os::unix::fs::FileExt;
use std::time::Instant;

/// Nodes in a snapshot.
const NODES: usize = 20;
/// The converters of a chain.
const PARTS: usize = 4;
/// Bytes of one read, and of one tuple in it.
const READ_BYTES: usize = 128 << 10;
const TUPLE_BYTES: usize = 8;
/// Reads that one time is taken of.
const READS: usize = 20;

pub fn run(plan: &Plan) -> Result<(), String> {
    snapshot(plan)?;
    for language in [LUA, LUA_ALIKE, LIBRARY] {
        chain(plan, &language)?;
    }
    Ok(())
}

/// A read of the newest samples of all nodes, against a read of one of them. Their tuples are too large for the page
/// cache, so that both are round trips.
fn snapshot(plan: &Plan) -> Result<(), String> {
    let mut text = "local all = {}\ntrikfs = {\n".to_owned();
    for number in 0..NODES {
        text.push_str(&format!(
            "n{number} = {{ src = fake{{ data = ('x'):rep(12), loop = true }}, input_tuple_size = 12, format = 'i32 x, i32 y, i32 z', poll_ms = 10 }},\n"
        ));
    }
    text.push_str(&format!(
        "}}\nfor number = 0, {NODES} - 1 do all['n' .. number] = 'newest:n' .. number end\ntrikfs.all = {{ src = all }}\n"
    ));
    let mount = Mount::start("snapshot", &text)?;
    let one = super::newest::open_when_sampled(&mount, "n0/bin_data")?;
    let all = mount.open("all/bin_data")?;
    let pread = |file: &File, size: usize| {
        let mut tuple = vec![0; size];
        time(plan.samples, || {
            let got = file.read_at(&mut tuple, 0).expect("read");
            assert_eq!(got, size, "a whole tuple");
        })
    };
    let rows = vec![
        row("bin_data of one node", 0, None, || pread(&one, 12)),
        row("snapshot of 20 nodes", 0, Some(2.0), || {
            pread(&all, 12 * NODES)
        }),
    ];
    table(
        "pread(2) of the newest samples of 20 nodes, ratio to a read of one",
        plan.rounds,
        rows,
    );
    Ok(())
}

/// Converters that do what the usual ones do to two numbers, one after the other.
struct Language {
    name: &'static str,
    goal: Option<f64>,
    before: &'static str,
    parts: [&'static str; PARTS],
    params: &'static str,
}

const LUA: Language = Language {
    name: "Lua",
    goal: Some(1.3),
    before: "local smooth = 0
",
    parts: [
        "function(a_s, a, b_s, b) for at = 0, a_s - 4, 4 do ba.i32(b, at, ba.i32(a, at) + 7) end end",
        "function(a_s, a, b_s, b) for at = 0, a_s - 4, 4 do ba.i32(b, at, ba.i32(a, at) * 3) end end",
        "function(a_s, a, b_s, b)
          for at = 0, a_s - 4, 4 do
            local v = ba.i32(a, at)
            if v < -1000 then v = -1000 elseif v > 1000 then v = 1000 end
            ba.i32(b, at, v)
          end
        end",
        "function(a_s, a, b_s, b)
          for at = 0, a_s - 4, 4 do
            smooth = smooth + (ba.i32(a, at) - smooth) / 4
            ba.i32(b, at, smooth)
          end
        end",
    ],
    params: "{}",
};

/// The same out of one function that makes them all: in one Lua state its compiled code has to tell them apart, which a
/// node with one of them alone need not.
const LUA_ALIKE: Language = Language {
    name: "Lua, all made by one function",
    goal: None,
    before: "local function each(f)
  return function(a_s, a, b_s, b) for at = 0, a_s - 4, 4 do ba.i32(b, at, f(ba.i32(a, at))) end end
end
local function clamp(v) if v < -1000 then return -1000 elseif v > 1000 then return 1000 end return v end
local function smooth() local s = 0 return function(v) s = s + (v - s) / 4 return s end end
",
    parts: [
        "each(function(v) return v + 7 end)",
        "each(function(v) return v * 3 end)",
        "each(clamp)",
        "each(smooth())",
    ],
    params: "{}",
};

const LIBRARY: Language = Language {
    name: "library",
    goal: Some(1.3),
    before: "",
    parts: [
        "'libtrikfs_filters.so#median3'",
        "'libtrikfs_filters.so#scale'",
        "'libtrikfs_filters.so#dead_band'",
        "'libtrikfs_filters.so#low_pass'",
    ],
    params: "{ x1 = 10, y1 = 25, width = 5, alpha = 0.25 }",
};

/// Nanoseconds for each tuple of many in one read.
fn tuple_ns(file: &mut File, bytes: &mut [u8]) -> f64 {
    let mut read = || file.read_exact(bytes).expect("read");
    (0..READS / 4).for_each(|_| read());
    let start = Instant::now();
    (0..READS).for_each(|_| read());
    start.elapsed().as_secs_f64() * 1e9 / (READS * READ_BYTES / TUPLE_BYTES) as f64
}

fn chain(plan: &Plan, language: &Language) -> Result<(), String> {
    let mut text = format!("{}trikfs = {{\n", language.before);
    let mut node = |name: &str, converter: &str| {
        text.push_str(&format!(
            "{name} = {{ src = '/dev/zero', input_tuple_size = {TUPLE_BYTES}, output_tuple_size = {TUPLE_BYTES}, params = {}, {converter} }},\n",
            language.params
        ));
    };
    node("plain", "");
    node(
        "chain",
        &format!("converter = {{ {} }}", language.parts.join(", ")),
    );
    for (number, part) in language.parts.iter().enumerate() {
        node(&format!("part{number}"), &format!("converter = {part}"));
    }
    let mount = Mount::start("chain", &(text + "}\n"))?;
    let mut files = Vec::new();
    for name in ["plain", "chain", "part0", "part1", "part2", "part3"] {
        files.push(mount.open(&format!("{name}/device"))?);
    }
    let mut bytes = vec![0; READ_BYTES];
    let (mut chains, mut sums, mut ratios) = (Vec::new(), Vec::new(), Vec::new());
    for _ in 0..plan.rounds {
        let times: Vec<f64> = files
            .iter_mut()
            .map(|file| tuple_ns(file, &mut bytes))
            .collect();
        let chain = times[1] - times[0];
        let sum: f64 = times[2..].iter().map(|time| time - times[0]).sum();
        chains.push(chain);
        sums.push(sum);
        ratios.push(chain / sum);
    }
    let ratio = median(ratios);
    println!(
        "\n{PARTS} converters in one node, {}, for each tuple of {TUPLE_BYTES} bytes of a read(2) of 128 KiB",
        language.name
    );
    println!(
        "the four in nodes of their own, sum {:>6.1} ns",
        median(sums)
    );
    let goal = language.goal.map_or(String::new(), |goal| {
        format!("goal <= {goal:.2} {}", verdict(ratio <= goal))
    });
    println!(
        "the chain                           {:>6.1} ns {ratio:>6.2}x  {goal}",
        median(chains)
    );
    Ok(())
}
