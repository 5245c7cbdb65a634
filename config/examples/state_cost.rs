//! What a private Lua state costs: time to prepare, bind and close, resident memory at rest and after conversions, and
//! conversions per second. Run with `cargo run --release -p config --example state_cost`.
//!
//! Method: resident memory is the difference of /proc/self/statm over many states that are alive together, divided by
//! their number; every case runs in a process of its own. Times
//! are means over the same states.

use config::load::Loader;
use config::program::{Blank, Program, Vm};
use converter::Direction;
use std::time::{Duration, Instant};

const STATES: usize = 500;
const TUPLES: usize = 1 << 20;

const SOURCE: &str = "
trikfs = {
  random = { src = '/dev/urandom', input_tuple_size = 8, output_tuple_size = 8,
    converter = function(a_s, a, b_s, b)
      for i = 0, b_s - 1 do ba.set(b, i, ba.get(a, i) % 10 + (i + 1) + 33) end
    end },
  copy = { src = '/dev/urandom', input_tuple_size = 8, output_tuple_size = 8, converter = id_create(8) },
  typed = { src = '/dev/urandom', input_tuple_size = 8, output_tuple_size = 8, converter = function(a_s, a, b_s, b)
      ba.i32(b, 0, ba.i32(a, 0) * 2)
      ba.f32(b, 4, ba.i16_be(a, 4) * 0.5)
    end },
}";

fn resident_kib() -> f64 {
    let text = std::fs::read_to_string("/proc/self/statm").unwrap_or_default();
    let pages: f64 = text
        .split(' ')
        .nth(1)
        .and_then(|word| word.parse().ok())
        .unwrap_or(0.0);
    pages * 4.0
}

fn each(time: Duration) -> f64 {
    time.as_secs_f64() * 1e6 / STATES as f64
}

/// Makes the states, uses each `conversions` times on `node`, and reports.
fn states(
    program: &Program,
    node: Option<&str>,
    conversions: usize,
) -> Result<(), Box<dyn std::error::Error>> {
    let mut vms: Vec<Vm> = Vec::with_capacity(STATES);
    let (memory, start) = (resident_kib(), Instant::now());
    let mut blanks = Vec::with_capacity(STATES);
    for _ in 0..STATES {
        blanks.push(Blank::new()?);
    }
    let blank = start.elapsed();
    let start = Instant::now();
    for blank in blanks {
        vms.push(program.prepare(blank, node.unwrap_or("copy"))?);
    }
    let prepared = start.elapsed();
    let mut bound = Duration::ZERO;
    if let Some(node) = node {
        for vm in &mut vms {
            let start = Instant::now();
            let stage = vm.bind(node, Direction::Read, 0, 8, 8)?;
            bound += start.elapsed();
            let mut output = [0; 8];
            for i in 0..conversions {
                vm.convert(stage, &[i as u8; 8], &mut output)?;
            }
        }
    }
    let resident = (resident_kib() - memory) / STATES as f64;
    let lua = vms.iter().map(Vm::memory).sum::<usize>() as f64 / 1024.0 / STATES as f64;
    let start = Instant::now();
    drop(vms);
    println!(
        "{:8} {conversions:5} conversions: blank {:5.1} us, prepare {:5.1} us, bind {:5.1} us, close {:5.1} us, lua {lua:5.1} KiB, resident {resident:5.1} KiB",
        node.unwrap_or("-"),
        each(blank),
        each(prepared),
        each(bound),
        each(start.elapsed()),
    );
    Ok(())
}

fn speed(program: &Program, node: &str) -> Result<(), Box<dyn std::error::Error>> {
    let mut vm = program.open(node)?;
    let stage = vm.bind(node, Direction::Read, 0, 8, 8)?;
    let (input, mut output) = (vec![7; TUPLES * 8], vec![0; TUPLES * 8]);
    let start = Instant::now();
    let (_, produced, fault) = vm.convert_many(stage, &input, &mut output);
    let rate = produced as f64 / start.elapsed().as_secs_f64() / 1e6;
    println!(
        "{node:8} {rate:.1} million 8-byte tuples/s {}",
        fault.map_or_else(String::new, |fault| fault.to_string())
    );
    Ok(())
}

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let mut arguments = std::env::args().skip(1);
    let Some(node) = arguments.next() else {
        return every_case();
    };
    let conversions = arguments
        .next()
        .and_then(|word| word.parse().ok())
        .unwrap_or(0);
    let loaded = Loader::default()
        .load("cost.lua", None, SOURCE.as_bytes())
        .map_err(|problem| problem.to_string())?;
    let program = loaded.program;
    // The first states pay for what is made once per process.
    drop(
        (0..4)
            .map(|_| program.open("copy"))
            .collect::<Result<Vec<_>, _>>()?,
    );
    if node == "-" {
        return states(&program, None, 0);
    }
    states(&program, Some(&node), conversions)?;
    if conversions > 0 {
        speed(&program, &node)
    } else {
        Ok(())
    }
}

/// Each case in a process of its own: memory that another case freed would hide what this one takes.
fn every_case() -> Result<(), Box<dyn std::error::Error>> {
    let program = std::env::current_exe().map_err(|error| error.to_string())?;
    let cases = [
        "- 0",
        "random 0",
        "random 1",
        "random 1000",
        "copy 1000",
        "typed 0",
        "typed 1000",
    ];
    for case in cases {
        let status = std::process::Command::new(&program)
            .args(case.split(' '))
            .status();
        status.map_err(|error| error.to_string())?;
    }
    Ok(())
}
