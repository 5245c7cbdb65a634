//! Generated programs tell devices the same at the same moments: projects with several timers, to the step.

use std::io::{Cursor, Read};

use lang_diagram::generate::{Language, Options, generate};
use lang_diagram::lower::World;
use lang_diagram::project::Project;

use crate::{equal, host};

/// What is not the same, with the reason.
enum Differs {
    /// The moments are.
    Numbers(&'static str),
    /// Not even those.
    Moments(&'static str),
}

/// Projects that name a gamepad.
const GAMEPAD: [&str; 4] = [
    "g_var_button",
    "g_var_connected",
    "g_var_pad",
    "g_var_wheel",
];

const DIFFERENT: [(&str, Differs); 8] = [
    (
        "g_var_objsize",
        Differs::Numbers("an object sensor that is not there is an empty text in a diagram"),
    ),
    (
        "l2_say_values",
        Differs::Numbers("a diagram says 1e+10 for a round number"),
    ),
    (
        "l_marker_seen",
        Differs::Moments("a timer in a loop follows another one, and then itself"),
    ),
    (
        "m2_kill_joined",
        Differs::Moments("Join waits for a thread that was killed"),
    ),
    (
        "m_subprogram",
        Differs::Moments("a timer of a subprogram follows a timer in one call only"),
    ),
    (
        "p_wheels_m1",
        Differs::Numbers("a timer leads on before variables of sensors are renewed"),
    ),
    (
        "s3_object_color_camera",
        Differs::Numbers("an object sensor that is not there is an empty text in a diagram"),
    ),
    (
        "s_wait_gyro_light",
        Differs::Moments("a wait for a sensor sees it before variables are renewed"),
    ),
];

/// As the robot of the simulator has it, so that all blocks of the projects do something; with a gamepad where a project
/// names one, because without it the diagram fails at the name.
fn world(name: &str) -> World {
    World::Simulated {
        mailbox: false,
        gamepad: GAMEPAD.contains(&name),
    }
}

/// The recorded projects in which a timer may follow another one.
fn projects() -> Vec<(String, Project)> {
    let runs = std::fs::read(crate::root().join("tests/recorded/runs.zip")).unwrap();
    let mut runs = zip::ZipArchive::new(Cursor::new(runs)).unwrap();
    let mut projects = Vec::new();
    for index in 0..runs.len() {
        let mut file = runs.by_index(index).unwrap();
        let Some(name) = file
            .name()
            .unwrap()
            .strip_prefix("projects/")
            .map(str::to_owned)
        else {
            continue;
        };
        let mut bytes = Vec::new();
        file.read_to_end(&mut bytes).unwrap();
        let Ok(opened) = lang_diagram::read::read(&bytes) else {
            continue;
        };
        let diagrams = opened.project.diagrams.iter();
        let blocks = diagrams.flat_map(|diagram| &diagram.blocks);
        if blocks.filter(|block| &*block.kind == "Timer").count() > 1 {
            projects.push((name.trim_end_matches(".qrs").to_owned(), opened.project));
        }
    }
    projects
}

#[test]
fn generated_programs_keep_the_steps_of_the_diagram() {
    if !needs::tool("node") {
        return;
    }
    let folder = crate::scratch("timers");
    let shim = crate::root().join("lang/diagram/tests/generate/shim.js");
    let tool = ["node", shim.to_str().unwrap()];
    let path = folder.join("program.js");
    let (mut all, mut kept, mut complaints) = (0, 0, Vec::new());
    for (name, project) in projects() {
        let world = world(&name);
        let options = Options {
            world,
            ..Options::default()
        };
        let Ok(generated) = generate(&project, Language::JavaScript, options) else {
            println!("{name}: refused");
            continue;
        };
        std::fs::write(&path, &generated.text).unwrap();
        let (wanted, _, has_failed) = equal::run(&project, world);
        let mut robot = equal::robot(&project);
        let outcome = host::run(&tool, &path, &mut robot, equal::ENOUGH);
        let (told, wanted) = (equal::moments(&robot), equal::moments(&wanted));
        // It has the names of its gamepad, and says what they are.
        let says_something = wanted.iter().any(|(_, line)| line.starts_with("say"));
        assert!(!GAMEPAD.contains(&&*name) || says_something, "{name}");
        // A program that fails where the diagram does stops by itself.
        let is_equal = told == wanted && (outcome.is_ok() || has_failed);
        let times = |moments: &[(u32, String)]| -> Vec<(u32, String)> {
            let verb = |text: &str| text.split(' ').next().unwrap_or_default().to_owned();
            moments.iter().map(|(at, text)| (*at, verb(text))).collect()
        };
        let keeps_steps = is_equal || outcome.is_ok() && times(&told) == times(&wanted);
        kept += u32::from(keeps_steps);
        all += 1;
        let known = DIFFERENT.iter().find(|(known, _)| *known == name);
        let expected = match known {
            None => (true, true),
            Some((_, Differs::Numbers(_))) => (false, true),
            Some((_, Differs::Moments(_))) => (false, false),
        };
        if (is_equal, keeps_steps) != expected {
            complaints.push(format!("{name}: {outcome:?}\n  {told:?}\n  {wanted:?}"));
        }
    }
    let _ = std::fs::remove_dir_all(&folder);
    println!("{kept} of {all} programs keep the steps");
    assert!(kept >= 67 && all == 71, "{kept} of {all}");
    for (name, differs) in &DIFFERENT {
        let (Differs::Numbers(why) | Differs::Moments(why)) = differs;
        println!("{name}: {why}");
    }
    assert!(complaints.is_empty(), "{}", complaints.join("\n"));
}
