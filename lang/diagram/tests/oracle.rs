//! Real projects on the stand-in, against poses and ends that the real program recorded.
//!
//! Reads the recorded runs, or is skipped. Runs with walls or light have no place here; where a few
//! readings or random numbers decide, they are given by script.

use std::path::Path;
use std::rc::Rc;

use lang_diagram::check::check;
use lang_diagram::lower::{World, lower};
use lang_diagram::machine::trace::Deaf;
use lang_diagram::machine::{Machine, Options, STEP_MS, Status};
use lang_diagram::ports::Port;
use lang_diagram::read::read;
use lang_diagram::stand_in::{Placing, Pose, StandIn};
use lang_text::problem::Severity;

/// Recorded poses every 100 ms have six decimals, so they are off by half of the last one.
const NEAR: f64 = 0.51e-6;
/// The last pose has all digits.
const SAME: f64 = 1e-9;

/// What the real program did.
struct Oracle {
    project: String,
    field: Option<String>,
    ends_by_itself: bool,
    last: Option<[f64; 4]>,
    poses: Vec<[f64; 4]>,
    /// Times and properties of what devices were told: the first 60.
    events: Vec<(u32, String)>,
}

impl Oracle {
    /// Reads the few shapes of JSON that the recorder writes.
    fn read(path: &Path) -> Self {
        let text = std::fs::read_to_string(path).unwrap();
        let string = |key: &str| {
            Some(
                after(&text, &format!("\"{key}\":\""))?
                    .split('"')
                    .next()?
                    .to_owned(),
            )
        };
        let poses = after(&text, "\"poses_100ms\":[").unwrap();
        let last = after(&text, "\"last_pose_ms_x_y_deg\":").unwrap();
        Self {
            project: string("project").unwrap(),
            field: string("field"),
            ends_by_itself: text.contains("\"ends_by_itself\":true"),
            last: last.strip_prefix('[').map(four),
            poses: match poses.find("]]") {
                Some(end) if !poses.starts_with(']') => {
                    poses[..end].split('[').skip(1).map(four).collect()
                }
                _ => Vec::new(),
            },
            events: events(&text),
        }
    }
}

/// `[30,"display","DisplayPort","smiles",false]` as `(30, "smiles")`.
fn events(text: &str) -> Vec<(u32, String)> {
    const PORTS: [&str; 5] = [
        "DisplayPort",
        "LedPort",
        "MarkerPort",
        "ShellPort",
        "SpeakerPort",
    ];
    let mut found = Vec::new();
    let events = after(text, "\"device_events\":[").unwrap_or_default();
    for piece in events
        .split("[")
        .filter(|piece| PORTS.iter().any(|port| piece.contains(port)))
    {
        let mut parts = piece.split(',');
        let time = parts.next().unwrap().parse().unwrap();
        let property = parts.nth(2).unwrap().trim_matches('"').to_owned();
        found.push((time, property));
    }
    found
}

/// What the real devices would have told of one of our commands.
fn told(line: &str) -> &'static [&'static str] {
    match line.split(' ').next().unwrap_or_default() {
        "clear" => &["smiles", "sadSmiles", "objects"],
        "smile" => &["smiles", "sadSmiles"],
        "label" | "pixel" | "line" | "rectangle" | "ellipse" | "arc" => &["objects"],
        "background" => &["background"],
        "led" => &["color"],
        "say" | "print" => &["lastPhrase"],
        "marker" => &["isDown", "color"],
        _ => &[],
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

struct Ran {
    /// How many recorded poses were met, from the first one on.
    met: usize,
    status: Status,
    pose: Pose,
    robot: StandIn,
}

/// Runs a project, with a script before each step, until it ends or all recorded poses are through.
fn run(data: &Path, oracle: &Oracle, script: impl Fn(&mut StandIn)) -> Ran {
    let opened = read(&std::fs::read(data.join(&oracle.project)).unwrap()).unwrap();
    let field = oracle
        .field
        .as_ref()
        .map(|field| std::fs::read_to_string(data.join(field)).unwrap());
    let world = field.or(opened.project.world.clone()).unwrap_or_default();
    let lowered = lower(&opened.project, World::default()).unwrap();
    let mut machine = Machine::new(Rc::new(lowered.program), Options::simulated());
    let mut robot = StandIn::new(Placing::of_world(&world));
    let mut poses = oracle.poses.iter().peekable();
    let (mut met, mut is_met, mut now) = (0, true, 0);
    loop {
        if now > 0 {
            robot.tick();
        }
        script(&mut robot);
        let status = machine.step(now, &mut robot, &mut Deaf);
        if let Some(recorded) = poses.next_if(|pose| pose[0] == f64::from(now)) {
            is_met = is_met && distance(robot.pose, *recorded) < NEAR;
            met += usize::from(is_met);
        }
        let is_over = poses.peek().is_none() && !oracle.ends_by_itself;
        if status != Status::Running || is_over || now > 60_000 {
            assert!(machine.errors().is_empty(), "{:?}", machine.errors());
            return Ran {
                met,
                status,
                pose: robot.pose,
                robot,
            };
        }
        now += STEP_MS;
    }
}

/// All recorded poses are met. `ends`: the program itself ended the run, so its end and the last pose are the same too.
fn meets(name: &str, ends: bool, script: impl Fn(&mut StandIn)) {
    let Some(data) = needs::data() else {
        return;
    };
    let oracle = Oracle::read(&data.join("oracle").join(format!("{name}.json")));
    let ran = run(&data, &oracle, script);
    assert!(!oracle.poses.is_empty());
    assert_eq!(ran.met, oracle.poses.len(), "{name}: poses met");
    if ends {
        let last = oracle.last.unwrap();
        let Status::Ended { at, with_errors } = ran.status else {
            panic!("{name} goes on");
        };
        assert_eq!(f64::from(at), last[0], "{name}: end");
        assert!(!with_errors);
        assert!(
            distance(ran.pose, last) < SAME,
            "{name}: {:?} {last:?}",
            ran.pose
        );
    }
}

fn none(_: &mut StandIn) {}

#[test]
fn timers_around_the_corner() {
    meets("example-1._AroundTheCorner_time", true, none);
}

#[test]
fn encoders_around_the_corner() {
    meets("example-2._AroundTheCorner_encoder", true, none);
}

#[test]
fn a_value_that_is_set() {
    meets("example-5._DirectlySetValue", true, none);
}

#[test]
fn arcs_with_parameters() {
    meets("example-21._Arc_movement", true, none);
}

#[test]
fn the_labyrinth_by_subprograms() {
    // Success ends the recorded run before the program does.
    meets("stepik-example17-at-start", false, none);
}

#[test]
fn programs_that_stand_and_show() {
    meets("example-12._Array_to_screen", true, none);
    meets("example-11.2_Values_to_screen_in_one_second", false, none);
    meets("example-13._Switch_action", false, none);
    meets("example-16._Changing_variable_to_buttons", false, none);
    meets("example-19._Smiles", false, none);
    meets("example-6._AlongTheLineVideo", false, none);
}

#[test]
fn solutions_of_the_course() {
    for name in [
        "stepik-move-forward--e873613c",
        "stepik-move-forward--e873613c-move-forward",
        "stepik-hello-world--44746332-hello-world",
        "stepik-smile--54cf23d6-smile",
    ] {
        meets(name, true, none);
    }
    // Ended from outside: by success or failure of the task.
    for name in [
        "stepik-circle--2b37410e",
        "stepik-image-control--f9f07153",
        "stepik-monster--79c0f8ff",
        "stepik-monster--79c0f8ff-monster1",
        "stepik-smile--54cf23d6",
    ] {
        meets(name, false, none);
    }
}

#[test]
fn the_solution_of_nothing() {
    meets("grading-solution_zero-1_square", true, none);
    meets("grading-solution_zero-2_square", true, none);
}

#[test]
fn random_numbers_by_script() {
    for name in [
        "randomizer-solutions-ts-randomizer",
        "randomizer-tasks-ts-finish1-test",
    ] {
        meets(name, false, |robot| robot.randoms = [1].into());
    }
    meets("randomizer-solutions", false, |robot| {
        robot.randoms.push_back(2)
    });
}

/// The infrared sensor of example 8: 50 px before the centre, against a wall whose face is at 245 px.
fn wall_ahead(robot: &mut StandIn) {
    let cm = (245.0 - (robot.pose.x + 75.0)) * 5.6 / 16.0;
    let reading = (cm.ceil() as i32).clamp(0, 80);
    robot.readings.insert(Port::named("A1").unwrap(), reading);
}

#[test]
fn a_wait_for_a_distance_is_also_answered_by_the_refresh_of_its_variable() {
    meets("example-8._TouchObstacle_distanceSensor", false, wall_ahead);
}

#[test]
fn devices_are_told_when_the_real_ones_were() {
    let Some(data) = needs::data() else {
        return;
    };
    for name in [
        "example-11.2_Values_to_screen_in_one_second",
        "example-12._Array_to_screen",
        "example-16._Changing_variable_to_buttons",
        "example-19._Smiles",
        "example-21._Arc_movement",
        "example-23._Parallel_tasks",
        "example-6._AlongTheLineVideo",
        "stepik-circle--2b37410e",
        "stepik-hello-world--44746332-hello-world",
        "stepik-image-control--f9f07153",
        "stepik-smile--54cf23d6",
    ] {
        let oracle = Oracle::read(&data.join("oracle").join(format!("{name}.json")));
        let ran = run(&data, &oracle, none);
        let ours: Vec<(u32, String)> = ran
            .robot
            .log
            .iter()
            .flat_map(|(now, line)| {
                told(line)
                    .iter()
                    .map(|property| (*now, (*property).to_owned()))
            })
            .take(oracle.events.len())
            .collect();
        assert!(!oracle.events.is_empty(), "{name}");
        assert_eq!(ours, oracle.events, "{name}");
    }
}

#[test]
fn threads_of_the_first_moment_begin_with_the_real_ones() {
    meets("example-23._Parallel_tasks", false, none);
}

#[test]
fn every_project_runs_without_a_panic() {
    let Some(data) = needs::data() else {
        return;
    };
    let mut count = 0;
    for folder in ["examples", "course", "grading", "structure"] {
        for entry in std::fs::read_dir(data.join(folder)).unwrap() {
            let path = entry.unwrap().path();
            if path.extension().is_none_or(|ending| ending != "qrs") {
                continue;
            }
            let opened = read(&std::fs::read(&path).unwrap()).unwrap();
            for world in [World::default(), World::Robot] {
                let lowered = lower(&opened.project, world).unwrap();
                let mut machine = Machine::new(Rc::new(lowered.program), Options::of(world));
                let mut robot = StandIn::default();
                for port in Port::all() {
                    robot.readings.insert(port, 30);
                }
                for now in (0..20_000).step_by(STEP_MS as usize) {
                    robot.tick();
                    machine.step(now, &mut robot, &mut Deaf);
                }
                count += 1;
            }
        }
    }
    assert!(count > 50, "only {count} runs");
}

#[test]
fn projects_that_the_real_program_runs_have_no_errors() {
    let Some(data) = needs::data() else {
        return;
    };
    let mut count = 0;
    for entry in std::fs::read_dir(data.join("oracle")).unwrap() {
        let oracle = Oracle::read(&entry.unwrap().path());
        let opened = read(&std::fs::read(data.join(&oracle.project)).unwrap()).unwrap();
        for problem in check(&opened.project, World::default()) {
            assert!(
                problem.severity < Severity::Error,
                "{}: {problem}",
                oracle.project
            );
            count += 1;
        }
    }
    // The field solutions carry blocks of EV3 and subprograms that nobody calls.
    assert!(count > 20, "only {count} remarks");
}
