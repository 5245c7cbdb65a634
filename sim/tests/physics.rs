//! Realistic physics against every tick of runs that the real program recorded.
//!
//! Without contacts all bits are the same; with contacts the solvers differ, and the test holds by how much.

use std::io::Read as _;
use std::rc::Rc;

use lang_diagram::lower::{World, lower};
use lang_diagram::read::read;
use sim::judge::json::{self, Value};
use sim::judge::{self, Diagram, Settings, Task, Texts};

/// Runs, and how far they may be off: in pixels and in degrees.
const RUNS: [(&str, f64, f64); 7] = [
    ("p_real_free", 1e-4, 1e-4),
    ("p_real_turns", 1e-4, 1e-4),
    ("p_real_ball", 0.1, 0.1),
    ("p_real_wall", 0.15, 0.2),
    ("p_real_heavy", 0.15, 0.2),
    ("p_real_skittles", 0.1, 0.1),
    ("p_real_sensors", 0.01, 0.02),
];

fn file(name: &str) -> Vec<u8> {
    let path = concat!(env!("CARGO_MANIFEST_DIR"), "/../tests/recorded/runs.zip");
    let mut archive = zip::ZipArchive::new(std::fs::File::open(path).unwrap()).unwrap();
    let mut bytes = Vec::new();
    let mut file = archive.by_name(name).unwrap();
    file.read_to_end(&mut bytes).unwrap();
    bytes
}

fn text(name: &str) -> String {
    String::from_utf8(file(name)).unwrap()
}

/// What the real program recorded: milliseconds, x, y, degrees of each tick.
fn recorded(name: &str) -> Vec<[f64; 4]> {
    let Value::Array(ticks) = json::read(&text(&format!("ticks/{name}.json"))).unwrap() else {
        panic!("{name} is no list");
    };
    let four = |tick: &Value| {
        let Value::Array(parts) = tick else {
            panic!("{tick:?}");
        };
        std::array::from_fn(|index| parts[index].as_f64().unwrap())
    };
    ticks.iter().map(four).collect()
}

fn ours(name: &str) -> Vec<[f64; 4]> {
    let oracle = json::read(&text(&format!("oracle/{name}.json"))).unwrap();
    let path = |key| oracle.get(key).and_then(Value::as_str);
    let mut project = read(&file(path("project").unwrap())).unwrap().project;
    if let Some(field) = path("field") {
        project.world = Some(text(field));
        project.blobs = None;
    }
    let texts = Texts {
        world: project.world.as_deref().unwrap_or_default(),
        blobs: project.blobs.as_deref(),
        templates: Some(&project.templates),
    };
    let (mut task, _) = Task::read(texts).unwrap();
    let lowered = lower(&project, World::default()).unwrap();
    task.plug_in(&project, &lowered.program);
    let mut program = Diagram::new(Rc::new(lowered.program));
    let settings = Settings {
        is_recording: true,
        seed: 1,
        ..Settings::default()
    };
    let outcome = judge::judge(&task, &mut program, &settings);
    outcome.trajectory.poses(0).collect()
}

#[test]
fn every_tick_is_where_the_real_program_was() {
    let mut complaints = Vec::new();
    for (name, px, degrees) in RUNS {
        let (recorded, ours) = (recorded(name), ours(name));
        let (mut far, mut turned, mut equal) = (0.0_f64, 0.0_f64, 0);
        for (there, here) in recorded.iter().zip(&ours) {
            assert_eq!(there[0], here[0], "{name}");
            far = far.max((there[1] - here[1]).hypot(there[2] - here[2]));
            turned = turned.max((there[3] - here[3]).abs());
            equal += u32::from(far == 0.0 && turned == 0.0);
        }
        println!(
            "{name}: {equal} of {} ticks equal, then {far:.6} px, {turned:.6} degrees",
            recorded.len()
        );
        if ours.len() < recorded.len() {
            complaints.push(format!(
                "{name}: {} of {} ticks",
                ours.len(),
                recorded.len()
            ));
        }
        if far > px || turned > degrees {
            complaints.push(format!("{name}: {far} px, {turned} degrees"));
        }
    }
    assert!(complaints.is_empty(), "{}", complaints.join("\n"));
}
