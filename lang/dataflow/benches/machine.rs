//! How fast tokens go: through a chain of ten functions, on one core, and how that compares to evaluating the ten
//! expressions alone, and to the same chain in Node-RED.
//!
//! `cargo bench -p lang-dataflow --bench machine`; the best of several runs counts. Node-RED is measured if `NODE_RED` names a
//! folder `node_modules` that has it: `npm install --prefix DIR node-red`.

use lang_dataflow::check::check;
use lang_dataflow::machine::Machine;
use lang_dataflow::machine::trace::Deaf;
use lang_dataflow::text;
use lang_diagram::brick::{self, Brick};
use lang_diagram::machine::Status;
use lang_diagram::ports::Port;
use lang_expr::{Compat, Kit, Names, Outside, Source, Store, Value, Wanted};
use std::fmt::Write;
use std::hint::black_box;
use std::process::Command;
use std::rc::Rc;
use std::time::{Duration, Instant};

const CHAIN: usize = 10;
const POLLS: u32 = 20_000;
const RUNS: u32 = 5;
/// Sensors that feed the chain at each poll.
const SENSORS: usize = 20;

/// A robot whose readings count up, and which is told nothing that takes time.
struct Robot(i32);

impl Brick for Robot {
    fn command(&mut self, command: brick::Command<'_>) {
        black_box(&command);
    }

    fn scalar(&mut self, _port: Port) -> Option<i32> {
        self.0 = (self.0 + 1) % 100;
        Some(self.0)
    }

    fn vector(&mut self, _port: Port, _into: &mut Vec<i32>) -> bool {
        false
    }

    fn random(&mut self, low: i32, _high: i32) -> i32 {
        low
    }
}

/// Nothing outside of the expressions.
struct Nothing;

impl Outside for Nothing {
    fn sensor(&mut self, _sensor: u16) -> Value {
        Value::Nil
    }

    fn time(&mut self) -> i32 {
        0
    }

    fn print(&mut self, _text: &str) {}

    fn random(&mut self, _below: i32) -> i32 {
        0
    }
}

/// Sensors into a chain of functions into a motor.
fn program() -> String {
    let mut text = "diagram \"chain\"\n".to_owned();
    for at in 0..SENSORS {
        let _ = writeln!(text, "  A{at}: Sensor(VarName = sensorA1)");
    }
    for at in 0..CHAIN {
        let _ = writeln!(text, "  F{at}: \"Text programming\"(IO0 = `I0 * 3 % 101`)");
    }
    text.push_str("  M: Motors\n");
    for at in 0..SENSORS {
        let _ = writeln!(text, "  A{at}.OUT -> F0.I0");
    }
    for at in 1..CHAIN {
        let _ = writeln!(text, "  F{}.O0 -> F{at}.I0", at - 1);
    }
    let _ = writeln!(text, "  F{}.O0 -> M.M3", CHAIN - 1);
    text
}

fn best(mut run: impl FnMut() -> Duration) -> Duration {
    (0..RUNS).map(|_| run()).min().unwrap_or_default()
}

/// What the machine takes for a token that goes through a block.
fn through_blocks() -> f64 {
    let project = text::read(&program()).expect("a program");
    let checked = check(&project);
    assert!(!checked.has_errors(), "{:?}", checked.problems);
    let program = Rc::new(checked.program);
    let took = best(|| {
        let mut machine = Machine::new(program.clone());
        let mut robot = Robot(0);
        machine.step(0, &mut robot, &mut Deaf);
        let begin = Instant::now();
        for poll in 1..=POLLS {
            let status = machine.step(20 * poll, &mut robot, &mut Deaf);
            assert_eq!(status, Status::Running);
        }
        begin.elapsed()
    });
    // Each token of a sensor becomes one at each function and one at the motor.
    let tokens = f64::from(POLLS) * (SENSORS * (CHAIN + 1)) as f64;
    took.as_secs_f64() * 1e9 / tokens
}

/// What the expressions take alone.
fn expressions() -> f64 {
    let mut names = Names::new(Kit::V62, Compat::Fixed);
    let mut store = Store::default();
    let slot = names.declare("I0", &Value::Int(1)).expect("a name");
    let mut source = Source::new("I0 * 3 % 101", Wanted::Any);
    lang_expr::analyse(&mut source, &mut names).expect("an expression");
    let count = POLLS * 100;
    let took = best(|| {
        let begin = Instant::now();
        for at in 0..count {
            store
                .set(slot, Value::Int((at % 100) as i32))
                .expect("room");
            let value = lang_expr::evaluate(&source, &names, &mut store, &mut Nothing);
            black_box(value.expect("a value"));
        }
        begin.elapsed()
    });
    took.as_secs_f64() * 1e9 / f64::from(count)
}

/// What Node-RED takes for a token that goes through a function.
fn node_red() -> Option<f64> {
    const TOKENS: u32 = 100_000;
    let modules = std::env::var_os("NODE_RED")?;
    let script = concat!(env!("CARGO_MANIFEST_DIR"), "/benches/node_red.js");
    let run = || {
        let output = Command::new("node")
            .arg(script)
            .arg(&modules)
            .arg(TOKENS.to_string())
            .output()
            .expect("node");
        let told = String::from_utf8_lossy(&output.stderr);
        assert!(output.status.success(), "{told}");
        let text = String::from_utf8_lossy(&output.stdout);
        text.trim().parse::<f64>().expect(&text)
    };
    Some((0..3).map(|_| run()).fold(f64::INFINITY, f64::min))
}

fn main() {
    let (blocks, alone) = (through_blocks(), expressions());
    let million = 1000.0 / blocks;
    println!(
        "a token through a block   {blocks:6.1} ns, {million:.2} million a second (goal >= 2)"
    );
    println!(
        "its expression alone      {alone:6.1} ns, {:.2} of that",
        alone / blocks
    );
    match node_red() {
        Some(other) => println!(
            "the same in Node-RED      {other:6.1} ns, {:.1} times that",
            other / blocks
        ),
        None => println!("the same in Node-RED      not measured: NODE_RED names no folder"),
    }
}
