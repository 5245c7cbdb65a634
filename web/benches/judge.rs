//! What judging costs in WebAssembly, as a part of what it costs this computer: the same task, judged in turns by the crate
//! itself and by its package under Node.
//!
//! `TRIK_WEB_PACKAGE=DIR cargo bench -p web --bench judge`, where DIR is what `web/build.sh` has built. The task is the line of
//! `examples`, 35 s of model time, with ideal and with realistic physics; the median of all rounds counts, after one that
//! warms up.

use sim::judge::Clock;
use std::path::{Path, PathBuf};
use std::process::Command;
use std::time::Instant;
use web::judged::judge;
use web::project::Project;

const TURNS: usize = 3;
const ROUNDS: usize = 20;
/// Of what the crate itself takes.
const GOAL: f64 = 2.5;

fn median(times_ms: &mut [f64]) -> f64 {
    times_ms.sort_by(f64::total_cmp);
    times_ms[times_ms.len() / 2]
}

/// Times of the crate itself.
fn native(project: &Path, field: &str) -> Vec<f64> {
    let bytes = std::fs::read(project).expect("the project");
    let project = Project::open("line.qrs", bytes, "").0.expect("a project");
    let options = serde_json::json!({ "field": field }).to_string();
    let one = |_| {
        let began = Instant::now();
        let outcome = judge(&project, &options, Clock::default())
            .0
            .expect("an outcome");
        assert_eq!(outcome["verdict"], "accomplished", "{outcome}");
        began.elapsed().as_secs_f64() * 1e3
    };
    (0..=ROUNDS).map(one).skip(1).collect()
}

/// Times of the package.
fn in_node(package: &Path, project: &Path, field: &Path) -> Vec<f64> {
    let script = Path::new(env!("CARGO_MANIFEST_DIR")).join("benches/judge.mjs");
    let mut node = Command::new("node");
    node.arg(script).arg(package).arg(project).arg(field);
    let output = node.arg(ROUNDS.to_string()).output().expect("node");
    let told = String::from_utf8_lossy(&output.stderr).into_owned();
    assert!(output.status.success(), "{told}");
    serde_json::from_slice(&output.stdout).expect("times")
}

fn main() {
    let Some(package) = std::env::var_os("TRIK_WEB_PACKAGE").map(PathBuf::from) else {
        println!("skipped: TRIK_WEB_PACKAGE names no package; web/build.sh builds one");
        return;
    };
    let examples = Path::new(env!("CARGO_MANIFEST_DIR")).join("../examples");
    let project = examples.join("diagrams/line.qrs");
    let ideal = std::fs::read_to_string(examples.join("dataflow/line.xml")).expect("a world");
    let realistic = ideal.replace("realisticPhysics=\"false\"", "realisticPhysics=\"true\"");
    let made = tempfile::tempdir().expect("a folder");
    for (name, world) in [("ideal", ideal), ("realistic", realistic)] {
        let field = made.path().join("line.xml");
        std::fs::write(&field, &world).expect("a world");
        let (mut here, mut there) = (Vec::new(), Vec::new());
        for _ in 0..TURNS {
            here.extend(native(&project, &world));
            there.extend(in_node(&package, &project, &field));
        }
        let (here, there) = (median(&mut here), median(&mut there));
        let ratio = there / here;
        let judged = if ratio <= GOAL { "met" } else { "NOT met" };
        println!(
            "{name:<10} native {here:6.2} ms   Node {there:6.2} ms   {ratio:.2}x   goal <= {GOAL}x {judged}"
        );
    }
}
