//! Real projects on real fields in the arena, against poses that the original recorded.
//!
//! Reads the recorded runs, or is skipped. What sees the floor has no place here.

use std::path::Path;
use std::rc::Rc;

use lang_diagram::lower::{World, lower};
use lang_diagram::machine::trace::Deaf;
use lang_diagram::machine::{Machine, Options, STEP_MS, Status};
use lang_diagram::read::read;
use lang_diagram::stand_in::Pose;
use sim::arena::{Arena, Setup};
use sim::field::Field;

/// Recorded poses every 100 ms have six decimals, so they are off by half of the last one.
const NEAR: f64 = 0.51e-6;
/// The last pose has all digits.
const SAME: f64 = 1e-9;

/// What the original did.
struct Oracle {
    project: String,
    field: Option<String>,
    last: Option<[f64; 4]>,
    poses: Vec<[f64; 4]>,
}

impl Oracle {
    /// Reads the few shapes of JSON that the recorder writes.
    fn read(path: &Path) -> Self {
        let text = std::fs::read_to_string(path).unwrap();
        let string = |key: &str| {
            let rest = after(&text, &format!("\"{key}\":\""))?;
            Some(rest.split('"').next()?.to_owned())
        };
        let poses = after(&text, "\"poses_100ms\":[").unwrap();
        let last = after(&text, "\"last_pose_ms_x_y_deg\":").unwrap();
        Self {
            project: string("project").unwrap(),
            field: string("field"),
            last: last.strip_prefix('[').map(four),
            poses: match poses.find("]]") {
                Some(end) if !poses.starts_with(']') => {
                    poses[..end].split('[').skip(1).map(four).collect()
                }
                _ => Vec::new(),
            },
        }
    }
}

fn after<'a>(text: &'a str, mark: &str) -> Option<&'a str> {
    Some(&text[text.find(mark)? + mark.len()..])
}

fn four(text: &str) -> [f64; 4] {
    let mut numbers = text
        .split([',', ']'])
        .map(|number| number.trim().parse().unwrap());
    std::array::from_fn(|_| numbers.next().unwrap())
}

fn distance(pose: Pose, recorded: [f64; 4]) -> f64 {
    let [_, x, y, degrees] = recorded;
    [pose.x - x, pose.y - y, pose.degrees - degrees]
        .into_iter()
        .fold(0.0, |worst, difference| worst.max(difference.abs()))
}

/// How a recorded run went with us: how many poses were met from the first on, and how far the last one was off.
struct Ran {
    met: usize,
    last: f64,
    first_off: Option<(f64, f64)>,
}

fn run(data: &Path, oracle: &Oracle, fixed: Option<i32>) -> Ran {
    let opened = read(&std::fs::read(data.join(&oracle.project)).unwrap()).unwrap();
    let text = oracle
        .field
        .as_ref()
        .map(|field| std::fs::read_to_string(data.join(field)).unwrap());
    let world = text.or(opened.project.world.clone()).unwrap_or_default();
    let field = Field::read(&world).unwrap().field;
    let program = Rc::new(lower(&opened.project, World::default()).unwrap().program);
    let mut arena = Arena::new(&field, Setup::of(&program));
    arena.robot_mut(0).unwrap().dice.fixed = fixed;
    let mut machine = Machine::new(program, Options::simulated());
    let until = oracle.last.map_or(20_000.0, |last| last[0]);
    let mut poses = oracle.poses.iter().peekable();
    let mut ran = Ran {
        met: 0,
        last: f64::INFINITY,
        first_off: None,
    };
    let mut now = 0;
    while f64::from(now) <= until {
        if now > 0 {
            arena.tick();
        }
        let status = machine.step(now, &mut arena.robot(0), &mut Deaf);
        let pose = arena.robots()[0].pose();
        if let Some(recorded) = poses.next_if(|pose| pose[0] == f64::from(now)) {
            let off = distance(pose, *recorded);
            if off < NEAR && ran.first_off.is_none() {
                ran.met += 1;
            } else if ran.first_off.is_none() {
                ran.first_off = Some((recorded[0], off));
            }
        }
        if let Some(last) = oracle.last.filter(|last| last[0] == f64::from(now)) {
            ran.last = distance(pose, last);
        }
        if status != Status::Running && oracle.last.is_none() {
            break;
        }
        now += STEP_MS;
    }
    ran
}

/// Runs in which the robot sees the floor: another part's matter.
const SEE_THE_FLOOR: [&str; 3] = [
    "example-4._AlongTheLine",
    "grading-solution_full-1_square",
    "grading-solution_full-2_square",
];

/// The random number that the original got, where its rules or its luck fixed one.
fn fixed(name: &str) -> Option<i32> {
    match name {
        "randomizer-solutions" | "randomizer-tasks" => Some(2),
        name if name.starts_with("randomizer") => Some(1),
        _ => None,
    }
}

#[test]
fn every_recorded_pose_is_met_where_no_floor_is_seen() {
    let Some(data) = needs::data() else {
        return;
    };
    let mut count = 0;
    for entry in std::fs::read_dir(data.join("oracle")).unwrap() {
        let path = entry.unwrap().path();
        let name = path.file_stem().unwrap().to_str().unwrap();
        if SEE_THE_FLOOR.contains(&name) {
            continue;
        }
        let oracle = Oracle::read(&path);
        let ran = run(&data, &oracle, fixed(name));
        // Behind its first random number this one is another dance.
        let until = match name {
            "example-15._Dance_in_a_circle" => 6,
            _ => oracle.poses.len(),
        };
        assert!(
            ran.met >= until,
            "{name}: {} of {} poses, then off by {:?}",
            ran.met,
            oracle.poses.len(),
            ran.first_off
        );
        if oracle.last.is_some() {
            assert!(ran.last < SAME, "{name}: last pose off by {}", ran.last);
        }
        count += 1;
    }
    assert!(count >= 40, "only {count} runs");
}

#[test]
fn real_worlds_are_written_as_they_were_read() {
    let Some(data) = needs::data() else {
        return;
    };
    let mut count = 0;
    for folder in ["examples", "course", "grading", "fields", "worlds"] {
        for entry in std::fs::read_dir(data.join(folder)).unwrap() {
            let path = entry.unwrap().path();
            let bytes = std::fs::read(&path).unwrap();
            let text = match path.extension().and_then(|ending| ending.to_str()) {
                Some("xml") => String::from_utf8(bytes).unwrap(),
                _ => read(&bytes).unwrap().project.world.unwrap_or_default(),
            };
            let field = Field::read(&text).unwrap().field;
            let again = Field::read(&field.write()).unwrap().field;
            assert_eq!(again.walls, field.walls, "{}", path.display());
            assert_eq!(again.drawn, field.drawn, "{}", path.display());
            assert_eq!(again.regions, field.regions, "{}", path.display());
            assert_eq!(again.robots, field.robots, "{}", path.display());
            assert_eq!(again.constraints, field.constraints, "{}", path.display());
            count += 1;
        }
    }
    assert!(count >= 40, "only {count} worlds");
}
