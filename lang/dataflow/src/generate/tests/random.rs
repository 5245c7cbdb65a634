//! Programs of chance: blocks that compute, steer and wait, between sensors and motors.

use super::{Case, Target, agree, c, generate, lua, machine, rows, run};
use crate::check::check;
use crate::machine::fixtures::{diagram, project};
use crate::project::DiagramKind;
use needs::Random;
use std::fmt::Write;
use std::rc::Rc;

/// Expressions of two inputs.
const TEXTS: [&str; 23] = [
    "I0 + I1",
    "I0 * 3 - I1 / 4",
    "I0 // 3 + I1 % 4",
    "x = I0; x + y",
    "y = y * 0.5 + I1; y",
    "max(I0, I1) - min(I0, 5)",
    "abs(I0 - 40) * sin(I1)",
    "-I0 << 2 | I1 & 7",
    "I0 > 30 and I1 < 60",
    "(I0 > I1) * 20",
    "{I0, I1}[1] + 0 * I0",
    "z = floor(I0 / 3); z",
    "I0 ~= I1 or I0 == 23",
    "sgn(I0 - I1) * 15",
    "time() / 10 + I0 - I1",
    "n = n + 1; n * 2 + 0 * (I0 + I1)",
    "I0 == I1",
    "not I0",
    "({I0, I1} == {I1, I0}) * 1",
    "l = {I0, I1}; l[0] + l[1]",
    "l = {I0, I1}; l[I0 == I1]",
    "I1 > 40 or I0 > 20 or -I0 < 3",
    "l = {3, I1}; l[1] * 2",
];
const CONDITIONS: [&str; 6] = [
    "data > 20",
    "data < 50",
    "data ~= 23",
    "data // 2 == 11",
    "x > 3 or data > 30",
    "not (data > 24)",
];

/// Motors that something of what there is drives.
fn motors(random: &mut Random, outs: &[String], (blocks, edges): (&mut String, &mut String)) {
    for port in ["M1", "M2", "M3", "M4"] {
        let from = &outs[random.below(outs.len())];
        // A motor takes no truth: numbers alone.
        let _ = writeln!(blocks, "n{port} Text programming {{IO0=I0 * 1}}");
        let _ = writeln!(edges, "{from} > n{port}.I0\nn{port}.O0 > M.{port}");
    }
}

/// The text of a program.
fn text(random: &mut Random) -> String {
    let mut blocks = String::from(
        "B Variable {variable=x = 1.0; y = 2.0; z = 0; n = 0}
        A Sensor {VarName=sensorA1}
        D Sensor {VarName=sensorD1}
        M Motors {synch=false}\n",
    );
    let mut edges = String::new();
    let mut outs = vec!["A.OUT".to_owned(), "D.OUT".to_owned()];
    for at in 0..3 + random.below(9) {
        let from = |random: &mut Random, outs: &[String]| outs[random.below(outs.len())].clone();
        let (one, other) = (from(random, &outs), from(random, &outs));
        let ms = 10 * random.below(12);
        let made = match random.below(10) {
            0..=2 => {
                let (first, second) = (TEXTS[random.below(23)], TEXTS[random.below(23)]);
                let waits = random.below(4) > 0;
                let _ = writeln!(
                    blocks,
                    "b{at} Text programming {{IO0={first} | IO1={second} | synch={waits}}}"
                );
                let _ = writeln!(edges, "{one} > b{at}.I0\n{other} > b{at}.I1");
                vec![format!("b{at}.O0"), format!("b{at}.O1")]
            }
            3 => {
                let condition = CONDITIONS[random.below(6)];
                let _ = writeln!(blocks, "b{at} If {{condition={condition}}}");
                let _ = writeln!(edges, "{one} > b{at}.DATA");
                vec![format!("b{at}.TRUE"), format!("b{at}.FALSE")]
            }
            4 => {
                let shown = ["Flow replacer", "Flow delay"][random.below(2)];
                let opens = ["REPLACE_DATA", "STOP"][usize::from(shown == "Flow delay")];
                let _ = writeln!(blocks, "b{at} {shown} {{time={ms}}}");
                let _ = writeln!(edges, "{one} > b{at}.{opens}\n{other} > b{at}.DATA");
                vec![format!("b{at}.OUT")]
            }
            5 => {
                let _ = writeln!(blocks, "b{at} Wait and send {{time={ms}}}");
                let _ = writeln!(edges, "{one} > b{at}.DATA");
                vec![format!("b{at}.OUT")]
            }
            6 => {
                let (condition, count) = (CONDITIONS[random.below(6)], random.below(30));
                let _ = writeln!(
                    blocks,
                    "b{at} Complex filter {{condition={condition} | count={count} | dispatchTime={ms}}}"
                );
                let _ = writeln!(edges, "{one} > b{at}.DATA");
                vec![format!("b{at}.OUT")]
            }
            7 | 8 => {
                // After these nobody knows the types before the program runs.
                let _ = writeln!(blocks, "z{at} Zip flows\nb{at} Unzip flows");
                let _ = writeln!(edges, "{one} > z{at}.DATA1\n{other} > z{at}.DATA2");
                let _ = writeln!(edges, "z{at}.OUT > b{at}.DATA");
                vec![format!("b{at}.OUT1"), format!("b{at}.OUT2")]
            }
            _ => {
                let (condition, value) = (CONDITIONS[random.below(6)], CONDITIONS[0]);
                let _ = writeln!(
                    blocks,
                    "b{at} Switch {{cond0={condition} | O0=data * 2 | cond1={value} | O1= | sendOnlyFirst=false}}"
                );
                let _ = writeln!(edges, "{one} > b{at}.DATA");
                vec![format!("b{at}.O0"), format!("b{at}.O1")]
            }
        };
        outs.extend(made);
    }
    motors(random, &outs, (&mut blocks, &mut edges));
    blocks + &edges
}

/// Whether only the machine sees the mistake: a variable that changes its type, or a number that may have a fraction where
/// a whole one is needed. Values in a converter are numbers, truths and lists.
fn is_of_the_machine_alone(why: &str, text: &str) -> bool {
    let block = why.split('\'').nth(1).unwrap_or_default();
    let mut lines = text.lines().map(str::trim);
    let line = lines.find(|line| line.split(' ').next() == Some(block));
    let wholes = ["//", "%", "<<"];
    let asks = |line: &str| wholes.iter().any(|one| line.contains(one));
    why.contains("mismatched types") || why.contains("Type mismatch") && line.is_some_and(asks)
}

/// Good programs from a seed on; some fail at a token, and converters have to fail at the same one.
fn cases(count: usize, seed: u32) -> Vec<Case> {
    let mut cases = Vec::new();
    for at in 0.. {
        if cases.len() == count {
            break;
        }
        assert!(at < 40 * count, "too few programs are good");
        let text = text(&mut Random::new(seed.wrapping_add(at as u32)));
        let main = project(vec![diagram("main", DiagramKind::Main, &text)]);
        let lowered = check(&main);
        if lowered.has_errors() {
            continue;
        }
        let case = Case {
            name: format!("program {at}:\n{text}"),
            program: Rc::new(lowered.program),
            rows: rows(30),
        };
        let why = run(&case).1.unwrap_or_default();
        if !is_of_the_machine_alone(&why, &text) {
            cases.push(Case {
                name: format!("{}, which fails: {why:?}", case.name),
                ..case
            });
        }
    }
    cases
}

#[test]
fn programs_of_chance_do_in_lua_what_they_do_here() {
    if !needs::tool("luajit") {
        return;
    }
    let cases = cases(300, 7);
    let is_no_number = |case: &&Case| case.name.contains("Type mismatch");
    assert!(cases.iter().filter(is_no_number).count() > 3);
    for (case, got) in cases.iter().zip(lua(&cases)) {
        agree(case, &machine(case), &got, "Lua");
    }
}

#[test]
fn programs_of_chance_do_in_c_what_they_do_here() {
    if !needs::tool("gcc") {
        return;
    }
    for case in cases(12, 77) {
        agree(&case, &machine(&case), &c(&case), "C");
    }
}

#[test]
fn what_is_written_is_written_again_alike() {
    for case in cases(5, 777) {
        for target in Target::ALL {
            assert_eq!(
                generate(&case.program, target),
                generate(&case.program, target)
            );
        }
    }
}
