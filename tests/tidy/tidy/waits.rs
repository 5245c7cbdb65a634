//! Rules of waiting: a test waits for what it needs, never for a time in which that should have come.

use super::{none, sources};

/// Tests that pause for a time, how often, and why that is no waiting for something else to be done.
const PAUSES: [(&str, usize, &str); 22] = [
    ("bridge/src/http.rs", 1, "between two looks"),
    ("page/src/server/tests.rs", 1, "between two looks"),
    ("tests/harness/i2c_bus.rs", 1, "a slow bus is slow"),
    ("tests/harness/mount.rs", 1, "between two looks"),
    ("tests/harness/wait.rs", 1, "between two looks"),
    (
        "tests/it/converters/isolated.rs",
        1,
        "a process that nobody asks for a while",
    ),
    ("tests/it/devices/program.rs", 1, "between two looks"),
    ("tests/it/mount/sample_bus.rs", 1, "between two looks"),
    ("trik/src/remote/output.rs", 1, "between two looks"),
    ("trik/src/script/tests.rs", 2, "in model time"),
    ("trik/tests/it/examples.rs", 2, "between two looks"),
    ("trik/tests/it/hold.rs", 1, "between two looks"),
    (
        "trik/tests/it/programs.rs",
        2,
        "a program that drives for a second, and a slow one",
    ),
    (
        "trik/tests/it/rerecord.rs",
        3,
        "between two looks, until a recorder is killed, and a stall",
    ),
    ("trik/tests/it/rig.rs", 1, "between two looks"),
    ("trikd/tests/it/crash.rs", 1, "between two looks"),
    ("trikd/tests/it/crowds.rs", 1, "between two bytes"),
    (
        "trikd/tests/it/frames.rs",
        3,
        "keepalives at their rate, and programs that print at theirs",
    ),
    (
        "trikd/tests/it/gamepad.rs",
        1,
        "lines at a rate below that of the clock",
    ),
    (
        "trikd/tests/it/javascript_served.rs",
        1,
        "between two looks",
    ),
    ("trikd/tests/it/programs.rs", 2, "programs at their rate"),
    (
        "trikd/tests/it/rig.rs",
        2,
        "keepalives at their rate, and between two looks",
    ),
];

/// Scripts of tests in other languages that pause, how often, and why: those of the page in a browser, and of what is
/// installed.
const SCRIPTS: [(&str, usize, &str); 15] = [
    ("cross/board/guest.sh", 1, "between two looks"),
    (
        "cross/install/controller/usr/lib/trikfs/common.sh",
        1,
        "the product: between two signals",
    ),
    ("cross/install/test.sh", 1, "between two looks"),
    (
        "cross/install/test/boot.sh",
        4,
        "what would come back, in two places; between two looks; a program that does nothing",
    ),
    (
        "cross/install/test/scripts.sh",
        2,
        "what would come back, and what would be replaced",
    ),
    (
        "cross/serve.sh",
        2,
        "between two looks, and keepalives at their rate",
    ),
    ("page/app/e2e/around.e2e.js", 1, "between two looks"),
    ("page/app/e2e/bench.js", 2, "measures for a time"),
    ("page/app/e2e/figures.js", 2, "measures for a time"),
    (
        "page/app/e2e/instruments.e2e.js",
        5,
        "what would move, in four places, and what would be its own",
    ),
    (
        "page/app/e2e/past.e2e.js",
        1,
        "values that last in a recording",
    ),
    ("page/app/e2e/robot.js", 1, "between two looks"),
    (
        "page/app/e2e/shots.js",
        4,
        "pictures of the last six seconds",
    ),
    (
        "page/app/e2e/viewer.js",
        1,
        "one that reads nothing for a time",
    ),
    ("page/app/e2e/world.e2e.js", 2, "pictures that would come"),
];

/// Seconds from which a program that sleeps is one that has to be ended.
const FOR_EVER_S: f64 = 20.0;

/// Whether a line pauses: a call, or the program `sleep` for a time that somebody waits out.
fn pauses(line: &str) -> bool {
    let calls = line
        .match_indices("sleep(")
        .filter(|(at, _)| {
            let before = line[..*at].chars().next_back();
            !before.is_some_and(|letter| letter.is_alphanumeric() || letter == '_')
        })
        .any(|(at, word)| seconds(&line[at + word.len()..]).is_none_or(|time| time < FOR_EVER_S));
    let waits = ["setTimeout(", "waitForTimeout("]
        .iter()
        .any(|call| line.contains(call));
    let programs = line
        .match_indices("sleep ")
        .any(|(at, word)| seconds(&line[at + word.len()..]).is_some_and(|time| time < FOR_EVER_S));
    calls || waits || programs
}

/// The number that a text begins with.
fn seconds(text: &str) -> Option<f64> {
    let end = text.find(|letter: char| !letter.is_ascii_digit() && letter != '.');
    text[..end.unwrap_or(text.len())].parse().ok()
}

#[test]
fn no_script_of_a_test_sleeps_until_something_should_have_happened() {
    assert!(pauses("await page.waitForTimeout(300);") && pauses("    sleep 2"));
    let mut found = Vec::new();
    for ending in ["js", "sh", "ts"] {
        for folder in ["cross", "page/app/e2e", "tests"] {
            super::files(&super::root().join(folder), ending, &mut found);
        }
    }
    let mut page = Vec::new();
    super::files(&super::root().join("page/app/src"), "ts", &mut page);
    page.retain(|path| path.to_string_lossy().ends_with(".test.ts"));
    found.extend(page);
    assert!(found.len() > 20, "only {} scripts", found.len());
    let mut complaints = Vec::new();
    for path in found {
        let text = std::fs::read_to_string(&path).unwrap();
        let name = path.strip_prefix(super::root()).unwrap().to_str().unwrap();
        let is_code = |line: &&str| !["#", "//", "*"].iter().any(|sign| line.starts_with(sign));
        let lines = text.lines().map(str::trim_start).filter(is_code);
        let count = lines.filter(|line| pauses(line)).count();
        let listed = SCRIPTS.iter().find(|(path, ..)| *path == name);
        let allowed = listed.map_or(0, |(_, count, _)| *count);
        if count != allowed {
            complaints.push(format!(
                "{name}: {count} pauses, not {allowed}: wait for what has to come, or list why time is what is tested"
            ));
        }
    }
    none(&complaints);
}

#[test]
fn no_test_sleeps_until_something_should_have_happened() {
    assert!(
        pauses("std::thread::sleep(PAUSE)") && pauses("time.sleep(0.5)") && pauses("sleep 0.2;")
    );
    assert!(!pauses("asleep(pid)") && !pauses("exec sleep 1000") && !pauses("time.sleep(1000)"));
    let mut complaints = Vec::new();
    for source in sources() {
        let product = source.product().lines().count();
        let first = if source.is_test() { 0 } else { product };
        let found = source
            .code()
            .filter(|(number, line)| *number > first && pauses(line))
            .count();
        let listed = PAUSES.iter().find(|(path, ..)| *path == source.path);
        let allowed = listed.map_or(0, |(_, count, _)| *count);
        if found != allowed && !source.path.starts_with("tests/tidy/") {
            complaints.push(format!(
                "{}: {found} pauses, not {allowed}: wait with `eventually`, or list why time is what is tested",
                source.path
            ));
        }
    }
    none(&complaints);
}
