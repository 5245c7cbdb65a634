//! Converters against the machine: the same readings give the same numbers, in both languages.

mod cases;
mod random;

use super::{Target, generate};
use crate::check::check;
use crate::machine::Machine;
use crate::machine::fixtures::{diagram, project};
use crate::machine::trace::Deaf;
use crate::program::Program;
use crate::project::{DiagramKind, Project};
use lang_diagram::brick::{Brick, Command};
use lang_diagram::machine::Status;
use lang_diagram::ports::Port;
use lang_expr::Value;
use std::collections::BTreeMap;
use std::fmt::Write;
use std::path::PathBuf;
use std::process::Command as Run;
use std::rc::Rc;
use tempfile::TempDir;

/// What shows a program's numbers after each tuple.
const LUA: &str = include_str!("tests/driver.lua");
const C: &str = include_str!("tests/driver.c");
const HEADER: &str = "../../converter/include";

/// A robot with some readings, of which a test asks what motors were told.
#[derive(Default)]
struct Robot {
    readings: BTreeMap<&'static str, Vec<i32>>,
    told: BTreeMap<&'static str, i32>,
    /// Where encoders count from.
    zeros: BTreeMap<&'static str, i32>,
}

impl Brick for Robot {
    fn command(&mut self, command: Command<'_>) {
        if let Command::Power {
            port,
            percent: number,
        }
        | Command::Servo {
            port,
            degrees: number,
        } = command
        {
            self.told.insert(port.name(), number);
        } else if let Command::ResetEncoder { port } = command {
            let now = self.readings.get(port.name()).map_or(0, |now| now[0]);
            self.zeros.insert(port.name(), now);
        }
    }

    fn scalar(&mut self, port: Port) -> Option<i32> {
        let zero = self.zeros.get(port.name()).copied().unwrap_or(0);
        self.readings
            .get(port.name())?
            .first()
            .map(|now| now - zero)
    }

    fn vector(&mut self, port: Port, into: &mut Vec<i32>) -> bool {
        let found = self.readings.get(port.name());
        found.is_some_and(|found| {
            into.extend(found);
            true
        })
    }

    fn random(&mut self, low: i32, _: i32) -> i32 {
        low
    }
}

/// The sensors of all programs here: names of variables and ports, and how many numbers each gives.
const SENSORS: [(&str, &str, usize); 6] = [
    ("sensorA1", "A1", 1),
    ("sensorA2", "A2", 1),
    ("sensorD1", "D1", 1),
    ("accelerometer", "AccelerometerPort", 3),
    ("encoder3", "E3", 1),
    ("encoder4", "E4", 1),
];

/// One poll: a number of each sensor, one after the other.
type Row = [i32; 8];

/// A program and its readings.
struct Case {
    name: String,
    program: Rc<Program>,
    rows: Vec<Row>,
}

/// Numbers by their names after each poll; nothing from where the program failed.
type Shown = Vec<BTreeMap<String, f64>>;

/// What a converter has shown, and why it has failed, if it has.
#[derive(Default)]
struct Answer {
    shown: Shown,
    fault: String,
}

fn good(project: &Project) -> Rc<Program> {
    let lowered = check(project);
    let told: Vec<String> = lowered.problems.iter().map(ToString::to_string).collect();
    assert!(!lowered.has_errors(), "{told:#?}");
    Rc::new(lowered.program)
}

fn main_only(text: &str) -> Project {
    project(vec![diagram("main", DiagramKind::Main, text)])
}

fn rows(count: i32) -> Vec<Row> {
    let row = |at: i32| {
        [
            20 + at % 7,
            50 - 3 * (at % 5),
            80 - 9 * (at % 8),
            at,
            -at,
            5 * at % 11,
            7 * at + 100,
            3 - 2 * at,
        ]
    };
    (0..count).map(row).collect()
}

fn case(name: &str, project: &Project) -> Case {
    Case {
        name: name.to_owned(),
        program: good(project),
        rows: rows(40),
    }
}

/// What the machine has after each poll.
fn machine(case: &Case) -> Shown {
    run(case).0
}

/// What the machine has after each poll, and why it has failed.
fn run(case: &Case) -> (Shown, Option<String>) {
    let mut machine = Machine::new(case.program.clone());
    let mut robot = Robot::default();
    let mut shown = Vec::new();
    for now in (0..=20 * case.rows.len() as u32).step_by(10) {
        let row = &case.rows[(now / 20).saturating_sub(1) as usize];
        let mut at = 0;
        for (_, port, count) in SENSORS {
            robot.readings.insert(port, row[at..at + count].to_vec());
            at += count;
        }
        let status = machine.step(now, &mut robot, &mut Deaf);
        if status != Status::Running {
            break;
        }
        if now > 0 && now % 20 == 0 {
            shown.push(numbers(&machine, &robot));
        }
    }
    let why = machine.errors().first().map(ToString::to_string);
    (shown, why)
}

fn numbers(machine: &Machine, robot: &Robot) -> BTreeMap<String, f64> {
    let variables = machine.variables().filter_map(|(name, value)| {
        let number = match value {
            Value::Int(_) | Value::Float(_) | Value::Bool(_) => value.to_float(),
            Value::Nil | Value::Text(_) | Value::Unset | Value::List(_) => return None,
        };
        Some((name.to_owned(), number))
    });
    let told = robot.told.iter();
    let told = told.map(|(name, &number)| ((*name).to_owned(), f64::from(number)));
    variables.chain(told).collect()
}

fn folder() -> TempDir {
    tempfile::tempdir().expect("a folder")
}

/// The readings as lines of numbers.
fn written(rows: &[Row]) -> String {
    let line = |row: &Row| row.map(|number| number.to_string()).join(" ");
    let lines: Vec<String> = rows.iter().map(line).collect();
    lines.join("\n") + "\n"
}

/// Lines `NAME NUMBER` with an empty line after each poll, as the drivers print them.
fn read(text: &str) -> Answer {
    let mut answer = Answer::default();
    let mut now = BTreeMap::new();
    for line in text.lines() {
        match line.split_once(' ') {
            Some(("fault", why)) => {
                answer.fault = why.to_owned();
                break;
            }
            Some((name, number)) => {
                now.insert(name.to_owned(), number.parse().expect(line));
            }
            None => answer.shown.push(std::mem::take(&mut now)),
        }
    }
    answer
}

fn lua(cases: &[Case]) -> Vec<Answer> {
    let folder = folder();
    std::fs::write(folder.path().join("driver.lua"), LUA).expect("the driver");
    let mut names = Vec::new();
    for (at, case) in cases.iter().enumerate() {
        let text = generate(&case.program, Target::Lua);
        let text = text.unwrap_or_else(|problems| panic!("{}: {problems:#?}", case.name));
        std::fs::write(folder.path().join(format!("{at}.lua")), text).expect("a program");
        std::fs::write(
            folder.path().join(format!("{at}.rows")),
            written(&case.rows),
        )
        .expect("rows");
        names.push(at.to_string());
    }
    let output = Run::new("luajit")
        .arg("driver.lua")
        .args(&names)
        .current_dir(folder.path())
        .output()
        .expect("luajit");
    let text = String::from_utf8_lossy(&output.stdout);
    assert!(
        output.status.success(),
        "{}",
        String::from_utf8_lossy(&output.stderr)
    );
    let answers: Vec<Answer> = text.split("=\n").skip(1).map(read).collect();
    assert_eq!(answers.len(), cases.len());
    answers
}

fn c(case: &Case) -> Answer {
    let folder = folder();
    let mut plan = super::plan::Plan::of(&case.program, Target::C);
    let body = super::steps::body(&mut plan);
    plan.settle();
    assert!(
        plan.problems.is_empty(),
        "{}: {:#?}",
        case.name,
        plan.problems
    );
    let text = super::file::assemble(&plan, &body);
    let mut puts = String::new();
    for &sensor in &plan.inputs {
        let name = super::plan::sensor_name(sensor);
        let at = SENSORS
            .iter()
            .position(|(one, ..)| *one == name)
            .expect(name);
        let from: usize = SENSORS[..at].iter().map(|(_, _, count)| count).sum();
        let _ = write!(puts, " PUT({}, {from})", SENSORS[at].2);
    }
    let mut shows = String::new();
    for &port in &plan.outputs {
        let (name, field) = (port.name(), plan.told(port));
        let _ = write!(shows, " NUMBER_OF(\"{name}\", s->v_{field})");
    }
    for (name, field) in plan.variables() {
        let _ = write!(shows, " VALUE_OF(\"{name}\", s->v_{field})");
    }
    let file = format!("{text}\n#define INPUTS{puts}\n#define ALL{shows}\n{C}");
    std::fs::write(folder.path().join("program.c"), file).expect("a program");
    std::fs::write(folder.path().join("rows"), written(&case.rows)).expect("rows");
    let header = PathBuf::from(env!("CARGO_MANIFEST_DIR")).join(HEADER);
    let compiled = Run::new("gcc")
        .args(["-std=gnu99", "-O1", "-Wall", "-Wextra", "-Werror", "-I"])
        .arg(header)
        .args(["-o", "program", "program.c", "-lm"])
        .current_dir(folder.path())
        .output()
        .expect("gcc");
    let told = String::from_utf8_lossy(&compiled.stderr);
    assert!(compiled.status.success(), "{}: {told}", case.name);
    let output = Run::new(folder.path().join("program"))
        .arg(folder.path().join("rows"))
        .output()
        .expect("the program");
    assert!(
        output.status.success(),
        "{}: {:?}",
        case.name,
        output.status
    );
    read(&String::from_utf8_lossy(&output.stdout))
}

/// Whole numbers to the bit, others to the last digits.
fn agree(case: &Case, wanted: &Shown, got: &Answer, language: &str) {
    let got = &got.shown;
    assert_eq!(wanted.len(), got.len(), "{} in {language}", case.name);
    for (poll, (wanted, got)) in wanted.iter().zip(got).enumerate() {
        // Motors are told nothing at first, and a converter says 0.
        let is_new = |name: &&String| !wanted.contains_key(*name);
        let new: Vec<_> = got.keys().filter(is_new).collect();
        let are_at_rest = new.iter().all(|name| got[*name] == 0.0);
        assert!(
            are_at_rest,
            "{} in {language}: poll {poll}: {new:?}",
            case.name
        );
        for (name, wanted) in wanted {
            let Some(&got) = got.get(name) else {
                panic!("{} in {language}: poll {poll}: no {name}", case.name);
            };
            let is_whole = wanted.fract() == 0.0 && wanted.abs() < 9e15;
            let is_good = match is_whole {
                true => *wanted == got && wanted.is_sign_negative() == got.is_sign_negative(),
                false => (wanted - got).abs() <= 1e-12 * wanted.abs().max(1.0),
            } || wanted.is_nan() && got.is_nan()
                || wanted.is_infinite() && *wanted == got;
            assert!(
                is_good,
                "{} in {language}: poll {poll}: {name} is {got}, not {wanted}",
                case.name
            );
        }
    }
}

/// Both languages give what the machine gives, and something at all.
fn both(case: &Case) {
    let (wanted, why) = run(case);
    assert_eq!(
        wanted.len(),
        case.rows.len(),
        "{} ended: {why:?}",
        case.name
    );
    assert!(
        wanted.iter().any(|poll| !poll.is_empty()),
        "{} gave nothing",
        case.name
    );
    if needs::tool("luajit") {
        let got = lua(std::slice::from_ref(case)).remove(0);
        agree(case, &wanted, &got, "Lua");
    }
    if needs::tool("gcc") {
        agree(case, &wanted, &c(case), "C");
    }
}

#[test]
fn two_layers_that_follow_a_wall() {
    both(&case(
        "walls",
        &main_only(
            "A Sensor {VarName=sensorA1}
            D Sensor {VarName=sensorD1}
            F Text programming {IO0=u = max(0-30, min(30, 2*(I0-20))) | IO1=50 - u | IO2=50 + u}
            C If {condition=data < 25}
            E Text programming {IO0=60 | IO1=0 - 60}
            SL Flow replacer {time=100}
            SR Flow delay {time=70}
            M Motors {synch=false}
            A.OUT > F.I0
            D.OUT > C.DATA
            C.TRUE > E.I0
            F.O1 > SL.DATA
            F.O2 > SR.DATA
            E.O0 > SL.REPLACE_DATA
            E.O1 > SR.STOP
            SL.OUT > M.M3
            SR.OUT > M.M4",
        ),
    ));
}

#[test]
fn operators_and_functions() {
    let texts = [
        "a = I0 / 7; b = I0 // 7; c = I1 % 7; d = -I0 // 4; e = (I0 - 22) % 5; f = I0 << 3; g = (I0 - 30) >> 2; h = I0 & 12 | 3 ~ I1; i = ~I0; j = 2 ^ (I0 / 10); k = 100000 * 100000 + I0; l = (100000 * 100000 + I0) | 0; m = 1 << 40; n = (0 - 5) >> 40; zero = -(I0 - I0)",
        "o = sin(I0) + cos(I1) * ln(I0) - exp(I0 / 50); p = atan2(I0, I1) + asin(0.3) - acos(0.2) + atan(I0); q = sgn(I0 - 23) + ceil(I0 / 3) + floor(0 - I0 / 3); r = sqrt(I0) + abs(I0 - 30) + min(I0, 22) + max(I1, 23); s = pi * I0; big = floor(I0 * 1e9)",
        "t = I0 > 22 and not (I1 <= 50) or I0 == 21; u = I0 ~= 23; w = time(); x = sensorA2 * 2; y = I0 - (I1 - 3) - 2; z = 2 ^ 3 ^ (1 + 1) / (3 * (I0 + 1)); at = 5; made = 6 + at; number = made - -3",
        "I0",
    ];
    let mut main = diagram(
        "main",
        DiagramKind::Main,
        "A Sensor {VarName=sensorA1}
        D Sensor {VarName=sensorD1}
        F Text programming
        M Motors {synch=false}
        A.OUT > F.I0
        D.OUT > F.I1
        F.O3 > M.M3",
    );
    let function = &mut main.blocks[2];
    for (at, text) in texts.iter().enumerate() {
        let property = format!("IO{at}");
        function.properties.insert(property, (*text).to_owned());
    }
    both(&case("operators", &project(vec![main])));
}

#[test]
fn lists() {
    both(&case(
        "lists",
        &main_only(
            "A Sensor {VarName=accelerometer}
            S Sensor {VarName=sensorA1}
            T Sensor {VarName=sensorA2}
            F Text programming {IO0=x = I0[0]; y = I0[1] + I0[2]; n = #I0; mine = {x, y, 3}; mine[1] = x * 2; mine[3] = 7; z = mine[1] + mine[3] + #mine; equal = {1, 2} == {1, 2}; other = I0 == mine; mine}
            Z Zip flows
            U Unzip flows
            V Variable {variable=p; q; r; s}
            M Motors {synch=false}
            A.OUT > F.I0
            F.O0 > V.IN
            S.OUT > Z.DATA1
            T.OUT > Z.DATA2
            Z.OUT > U.DATA
            U.OUT1 > M.M3
            U.OUT2 > M.M4",
        ),
    ));
}

#[test]
fn what_has_no_place_in_a_converter_is_told_with_its_block() {
    let program = good(&main_only(
        "A Sensor {VarName=sensorA1}
        S Say
        R Random generator
        T Text programming {IO0='a' .. I0}
        L Text programming {IO0={{1, 2}, 3}}
        N Text programming {IO0=random(3)}
        A.OUT > S.DATA
        A.OUT > T.I0
        A.OUT > L.I0
        A.OUT > N.I0",
    ));
    let told = |target| -> Vec<String> {
        let problems = generate(&program, target).expect_err("refused");
        problems.iter().map(ToString::to_string).collect()
    };
    insta::assert_snapshot!(told(Target::Lua).join("\n"));
    assert_eq!(told(Target::Lua), told(Target::C));
}

#[test]
fn each_colour_of_the_camera_is_an_input_of_a_converter() {
    let program = good(&main_only(
        "R Sensor {VarName=colorSensorR}
        F Text programming {IO0=I0 - colorSensorB}
        M Motors
        R.OUT > F.I0
        F.O0 > M.M3",
    ));
    for target in Target::ALL {
        let text = generate(&program, target).expect("a converter");
        for name in ["colorSensorR", "colorSensorB"] {
            assert!(text.contains(name), "{name}: {text}");
        }
    }
}

#[test]
fn a_wait_that_keeps_has_no_place_in_a_converter() {
    let program = good(&main_only(
        "A Sensor {VarName=sensorA1}
        W Wait and send {keep=true}
        M Motors
        A.OUT > W.DATA
        W.OUT > M.M3",
    ));
    for target in Target::ALL {
        let problems = generate(&program, target).expect_err("refused");
        let told: Vec<String> = problems.iter().map(ToString::to_string).collect();
        assert_eq!(
            told,
            [
                "main: Wait and send 'W': a wait that keeps what comes meanwhile has no place in a converter: switch 'keep' off"
            ]
        );
    }
}

/// What both languages say of a program that fails.
fn faults(text: &str) -> Vec<String> {
    let case = case("fails", &main_only(text));
    let mut faults = Vec::new();
    if needs::tool("luajit") {
        faults.extend(
            lua(std::slice::from_ref(&case))
                .into_iter()
                .map(|one| one.fault),
        );
    }
    if needs::tool("gcc") {
        faults.push(c(&case).fault);
    }
    faults
}

#[test]
fn what_fails_names_its_block() {
    let begin = "A Sensor {VarName=sensorA1}\nF Text programming {IO0=";
    let end = "}\nM Motors {synch=false}\nA.OUT > F.I0\nF.O0 > M.M3";
    for (text, told) in [
        ("100 / (I0 - 22)", "F.I0: division by 0"),
        ("t = {1, 2}; t[I0 - 21]", "F.I0: an index is below 0"),
        ("I0 * 1e300 * 1e300", "M.M3: the number is too large"),
    ] {
        for fault in faults(&format!("{begin}{text}{end}")) {
            assert!(fault.starts_with(told), "{text}: {fault}");
        }
    }
    let keeps = "\nK Text programming {IO0=kept = I0}\nA.OUT > K.I0";
    let runs =
        "A Sensor {VarName=sensorA1}\nI If {condition=data > 0}\nA.OUT > I.DATA\nI.TRUE > I.DATA";
    for fault in faults(&format!("{runs}{keeps}")) {
        assert!(
            fault.starts_with("I.DATA: too many reactions in one instant"),
            "{fault}"
        );
    }
    for fault in faults(&format!(
        "A Sensor {{VarName=sensorA1}}\nS Stop\nA.OUT > S.IN0{keeps}"
    )) {
        assert_eq!(fault, "ENODEV: the program has ended");
    }
    // A condition is asked also where nothing follows from it.
    let asks = "A Sensor {VarName=sensorA1}\nI If {condition=1 / (data - 21) > 0}\nA.OUT > I.DATA";
    for fault in faults(&format!("{asks}{keeps}")) {
        assert!(fault.starts_with("I.DATA: division by 0"), "{fault}");
    }
}

#[test]
fn a_program_without_sensors_or_numbers_converts_nothing() {
    let program = good(&main_only("S Motors {M3Power=10}"));
    let problems = generate(&program, Target::Lua).expect_err("refused");
    assert!(problems[0].words.english.contains("reads no sensor"));
    let silent = good(&main_only(
        "A Sensor {VarName=sensorA1}\nI If\nA.OUT > I.DATA",
    ));
    let problems = generate(&silent, Target::C).expect_err("refused");
    assert!(problems[0].words.english.contains("nothing to show"));
}

#[test]
fn names_are_nobody_elses() {
    let main = main_only(
        "s Sensor {VarName=sensorA1}
        end Text programming {IO0=sensorA1_ = I0; fail = 1; while_ = 2; token = 3; struct_ = 4; ITEMS = 5; UNIT = 6; FIELD = 7; DELIVERIES_MAX = 8; TYPE_sensorA1 = 9; now = 10; us = 11; I0}
        end_I0 Text programming {IO0=end_I0_2 = I0}
        M Motors {synch=false}
        s.OUT > end.I0
        s.OUT > end_I0.I0
        end.O0 > M.M3",
    );
    both(&case("names", &main));
}

#[test]
fn a_program_as_it_is_written() {
    let program = good(&main_only(
        "A Sensor {VarName=sensorA1}
        F Text programming {IO0=e = I0 - 20; e * 0.5}
        C If {condition=data > 0}
        M Motors {synch=false}
        A.OUT > F.I0
        F.O0 > C.DATA
        C.TRUE > M.M3
        C.FALSE > M.M4",
    ));
    let whole = generate(&program, Target::Lua).expect("a module");
    let from = whole.find("names.reactions[1]").unwrap_or_default();
    let to = whole.find("local function fire").unwrap_or_default();
    insta::assert_snapshot!(&whole[from..to]);
}
