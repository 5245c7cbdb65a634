//! Generated programs tell the devices what the diagram tells them, in the same order.

use std::path::PathBuf;
use std::rc::Rc;

use lang_diagram::generate::{Language, Options, generate};
use lang_diagram::lower::{World, lower};
use lang_diagram::machine::trace::Deaf;
use lang_diagram::machine::{self, Machine, STEP_MS, Status};
use lang_diagram::project::Project;
use lang_diagram::stand_in::{Placing, StandIn};

use crate::host;

/// Commands that are compared of a program without end.
pub const ENOUGH: usize = 200;
/// Commands that programs over files leave out.
const LACKING: [&str; 14] = [
    "redraw",
    "clear",
    "pen",
    "background",
    "pixel",
    "line",
    "rectangle",
    "ellipse",
    "arc",
    "smile",
    "marker",
    "camera",
    "calibrate",
    "video",
];
/// Regulators that work in each step: after a hundred blocks the original goes on at another moment of its step, when
/// the encoders have been read anew; a text has no such moments. Their powers may be off by a little.
const NEAR: [&str; 1] = ["21._Arc_movement"];
const FAR: i32 = 10;
const WORLD: World = World::Simulated {
    mailbox: false,
    gamepad: false,
};

/// What is plugged in and what it says; buttons are pressed now and then.
pub fn robot(project: &Project) -> StandIn {
    use lang_diagram::ports::Port;
    let placing = project.world.as_deref().map(Placing::of_world);
    let mut robot = StandIn::new(placing.unwrap_or_default());
    for (name, reading) in [
        ("A1", 45),
        ("A2", 20),
        ("A3", 60),
        ("A4", 10),
        ("A5", 33),
        ("A6", 5),
        ("D1", 60),
        ("D2", 15),
    ] {
        robot.readings.insert(Port::named(name).unwrap(), reading);
    }
    for name in ["Enter", "Down"] {
        robot.readings.insert(Port::named(name).unwrap(), 1);
    }
    for (name, numbers) in [
        ("LineSensorPort", vec![17, 0, 40]),
        ("ColorSensorPort", vec![200, 10, 30]),
        ("AccelerometerPort", vec![1, 2, 4096]),
        ("LidarPort", vec![100; 360]),
        ("GamepadPad1PosPort", vec![30, -50]),
    ] {
        robot.vectors.insert(Port::named(name).unwrap(), numbers);
    }
    robot
}

/// The commands in order, without what is the same: how a motor is held, and rest at the end.
fn commands(robot: &StandIn) -> Vec<String> {
    let lines = robot
        .log
        .iter()
        .map(|(_, line)| line.replace(" brake", " float"));
    let mut lines: Vec<String> = lines.collect();
    while lines.last().is_some_and(|line| line == "rest") {
        lines.pop();
    }
    lines
}

/// The commands with their times, but for rest, which ends a program when nothing else is to come.
pub fn moments(robot: &StandIn) -> Vec<(u32, String)> {
    let lines = robot.log.iter();
    let told = lines.map(|(at, line)| (*at, line.replace(" brake", " float")));
    told.filter(|(_, line)| line != "rest")
        .take(ENOUGH)
        .collect()
}

/// What the diagram tells; whether it ended.
fn diagram(project: &Project) -> (Vec<String>, bool) {
    let (robot, has_ended, _) = run(project, WORLD);
    (commands(&robot), has_ended)
}

/// The robot after the diagram has run, whether it has ended, and whether there was an error.
pub fn run(project: &Project, world: World) -> (StandIn, bool, bool) {
    let program = Rc::new(lower(project, world).unwrap().program);
    let mut machine = Machine::new(program, machine::Options::default());
    let mut robot = robot(project);
    let mut now = 0;
    let mut status = machine.step(now, &mut robot, &mut Deaf);
    while status == Status::Running && robot.log.len() < ENOUGH && now < host::MODEL_MS {
        now += STEP_MS;
        robot.tick();
        status = machine.step(now, &mut robot, &mut Deaf);
    }
    for error in machine.errors() {
        println!("the diagram: {error}");
    }
    let has_failed = !machine.errors().is_empty();
    (robot, status != Status::Running, has_failed)
}

/// Whether two commands have the same words and nearly the same numbers.
fn near(one: &str, other: &str) -> bool {
    let (one, other): (Vec<_>, Vec<_>) = (one.split(' ').collect(), other.split(' ').collect());
    one.len() == other.len()
        && one.iter().zip(&other).all(|(one, other)| {
            match (one.parse::<i32>(), other.parse::<i32>()) {
                (Ok(one), Ok(other)) => (one - other).abs() <= FAR,
                _ => one == other,
            }
        })
}

fn shim(name: &str) -> PathBuf {
    crate::root().join("lang/diagram/tests/generate").join(name)
}

/// Runs all projects in a language beside the machine.
fn compare(test: &str, language: Language, tool: &str, shim_name: &str) {
    if !needs::tool(tool) {
        return;
    }
    let folder = crate::scratch(test);
    let shim = shim(shim_name);
    let mut complaints = Vec::new();
    let drawn = crate::drawn::projects();
    for (name, project) in drawn.into_iter().chain(crate::projects()) {
        let options = Options {
            world: WORLD,
            ..Options::default()
        };
        let Ok(generated) = generate(&project, language, options) else {
            println!("{name}: refused");
            continue;
        };
        let path = folder.join(format!("program.{}", language.ending()));
        std::fs::write(&path, &generated.text).unwrap();
        let (mut wanted, ends) = diagram(&project);
        if language == Language::Lua {
            // The tree has no display, no marker and no switch for the camera.
            wanted.retain(|line| !LACKING.iter().any(|word| line.starts_with(word)));
        }
        let mut robot = robot(&project);
        let outcome = host::run(&[tool, shim.to_str().unwrap()], &path, &mut robot, ENOUGH);
        let told = commands(&robot);
        let common = wanted.len().min(told.len());
        let is_near = NEAR.contains(&name.as_str());
        let differs = (0..common)
            .find(|&at| wanted[at] != told[at] && !(is_near && near(&wanted[at], &told[at])));
        if let Some(at) = differs {
            complaints.push(format!(
                "{name}: command {at}: {} and not {}",
                told[at], wanted[at]
            ));
        } else if is_near && told.len().abs_diff(wanted.len()) * 10 <= wanted.len() {
            println!("{name}: {common} commands nearly alike");
        } else if outcome != Ok(ends) || (ends && told.len() != wanted.len()) {
            let (told, wanted) = (told.len(), wanted.len());
            complaints.push(format!(
                "{name}: {outcome:?} with {told}, not {ends} with {wanted}"
            ));
        } else {
            println!(
                "{name}: {common} commands alike, {}",
                if ends { "to the end" } else { "without end" }
            );
        }
    }
    let _ = std::fs::remove_dir_all(&folder);
    assert!(complaints.is_empty(), "{}", complaints.join("\n"));
}

#[test]
fn javascript_does_what_the_diagram_does() {
    compare("equal-javascript", Language::JavaScript, "node", "shim.js");
}

#[test]
fn python_does_what_the_diagram_does() {
    compare("equal-python", Language::Python, "python3", "shim.py");
}

#[test]
fn lua_does_what_the_diagram_does() {
    compare("equal-lua", Language::Lua, "luajit", "shim.lua");
}
