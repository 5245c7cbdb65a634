//! Programs of data flow on robots: as text and as saves, changed, watched and stopped while they run.

use super::{Reachable, Running};
use harness::eventually;
use lang_dataflow::{save, text};

/// Drives to 20 cm before the wall and stays there.
const NEAR: &str = "
diagram \"Near\"
  wall: Sensor(VarName = sensorD1)
  slow: \"Text programming\"(IO0 = `speed = max(0-50, min(50, 2 * (I0 - 20)))`, IO1 = `speed`)
  wheels: Motors
  wall.OUT -> slow.I0
  slow.O1 -> wheels.M3
  slow.O1 -> wheels.M4
";

/// A program as the save that the editor would make.
fn saved(source: &str) -> Vec<u8> {
    let project = text::read(source).expect("a program");
    save::save(&project).write().expect("a save")
}

#[test]
fn a_data_flow_program_drives_to_its_distance_and_rests_when_it_is_stopped() {
    let Some(reachable) = Reachable::new() else {
        return;
    };
    for (name, program) in [
        ("near.flow", NEAR.as_bytes().to_vec()),
        ("near.qrs", saved(NEAR)),
    ] {
        let running = reachable.spawn(name, program);
        eventually("a place before the wall", || {
            let distance = reachable.robot.number("sensors/D1/value");
            (distance - 20.0).abs() < 4.0
        });
        let watched = reachable
            .robot
            .home
            .run(&["status", "--robot", reachable.ip()]);
        assert!(watched.stdout.contains(name), "{}", watched.stdout);
        let stopped = reachable
            .robot
            .home
            .run(&["stop", "--robot", reachable.ip()]);
        assert_eq!(stopped.code(), 0, "{}", stopped.stderr);
        assert!(reachable.rests());
        drop(running);
        // Away from the wall again, for the second form; a rest that comes late would take one order away.
        eventually("some way back", || {
            reachable.robot.drive(-40, -40);
            reachable.robot.number("sensors/D1/value") > 45.0
        });
        reachable.robot.write("stop", "1").expect("a rest");
    }
}

#[test]
fn mistakes_of_a_data_flow_program_are_told_where_they_are_and_nothing_moves() {
    let Some(reachable) = Reachable::new() else {
        return;
    };
    let bad = reachable.run(
        "bad.flow",
        "diagram \"Bad\"\n  A: Sensor\n  M: Motors\n  A.OUT -> M.M7\n",
    );
    assert_eq!(bad.code(), 1);
    assert!(
        bad.stderr
            .contains("bad.flow: 4:14 'Motors' has no port 'M7'"),
        "{}",
        bad.stderr
    );
    // A mistake in a formula, and a warning about one that runs: both where they stand in the text.
    let wrong = "diagram \"Wrong\"\n  A: Sensor(VarName = sensorD1)\n  F: \"Text programming\"(IO0 = `I0 + nothing`)\n  A.OUT -> F.I0\n";
    let wrong = reachable.run("wrong.flow", wrong);
    assert_eq!(wrong.code(), 1, "{}", wrong.stdout);
    let told = "wrong.flow: 3:37 Wrong: Text programming 'F': 'IO0': ";
    assert!(wrong.stderr.contains(told), "{}", wrong.stderr);
    let odd =
        "diagram \"Odd\"\n  A: Say(text = hello)\ndiagram \"Other\"\n  B: Say(text = hello)\n";
    let odd = reachable.run("odd.flow", odd);
    assert_eq!(odd.code(), 0, "{}", odd.stderr);
    let told = "warning: 3:1 Other: ";
    assert!(odd.stderr.contains(told), "{}", odd.stderr);
    // What only the run shows ends it: a division by nothing after a first round that drove.
    let source = "diagram \"Late\"\n  L: Loop(end_border = 1, time = 50)\n  F: \"Text programming\"(IO0 = `60 / (1 - I0)`)\n  M: Motors\n  L.OUT -> F.I0\n  F.O0 -> M.M3\n";
    let late = reachable.run("late.flow", source);
    assert_eq!(late.code(), 1, "{}", late.stdout);
    assert!(
        late.stderr
            .contains("3:32 Late: Text programming 'F': 'IO0': Division by zero"),
        "{}",
        late.stderr
    );
    assert!(reachable.rests());
}

/// Turns on the spot for ever, and counts its readings.
const TURN: &str = "
diagram \"Turn\"
  count: Variable(variable = \"n = 0; power = 20\")
  wall: Sensor(VarName = sensorD1)
  turn: \"Text programming\"(IO0 = `n = n + 1; power + 0*I0`)
  wheels: Motors
  wall.OUT -> turn.I0
  turn.O0 -> wheels.M3
";

/// Whether a motor turns.
fn turns(reachable: &Reachable, motor: u8) -> bool {
    reachable.robot.duty(motor).is_ok_and(|duty| duty != 0)
}

#[test]
fn a_data_flow_program_is_changed_watched_and_stopped_while_it_runs() {
    let Some(reachable) = Reachable::new() else {
        return;
    };
    let trik = |arguments: &[&str]| {
        let ip = reachable.ip();
        let all: Vec<&str> = arguments.iter().copied().chain(["--robot", ip]).collect();
        reachable.robot.home.run(&all)
    };
    let file = reachable.robot.home.0.file("turn.flow", TURN);
    let file = file.to_str().expect("a name in UTF-8").to_owned();
    let mut command =
        reachable
            .robot
            .home
            .command(&["run", &file, "--watch", "--robot", reachable.ip()]);
    let running = Running::new(&mut command);
    eventually("it turns", || turns(&reachable, 3));
    // A save changes the wheel; the variables stay.
    reachable
        .robot
        .home
        .0
        .file("turn.flow", TURN.replace("wheels.M3", "wheels.M4"));
    eventually("the other wheel turns", || turns(&reachable, 4));
    eventually("what was changed is told", || {
        running
            .said()
            .contains("turn.flow is changed: 4 blocks kept, 0 new, 0 gone")
    });
    let set = trik(&["set", "power=power + 5"]);
    assert_eq!(set.code(), 0, "{}", set.stderr);
    // The first look begins to listen; one line for each change. A busy machine may be slow to tell of one.
    eventually("what it does is told", || {
        let watched = trik(&["watch", "--seconds", "2"]);
        assert_eq!(watched.code(), 0, "{}", watched.stderr);
        ["power = 25", "turn.O0 -> 25", "wall.OUT -> "]
            .iter()
            .all(|told| watched.stdout.contains(told))
    });
    let stopped = trik(&["break", "wheels", "--file", &file, "--if", "data > 20"]);
    assert_eq!(stopped.code(), 0, "{}", stopped.stderr);
    assert!(
        stopped.stdout.contains("wheels.M4 gets 25"),
        "{}",
        stopped.stdout
    );
    eventually("its motors rest", || reachable.rests());
    let next = trik(&["step"]);
    assert_eq!(next.code(), 0, "{}", next.stderr);
    assert!(next.stdout.contains("turn.I0 gets "), "{}", next.stdout);
    let changed = trik(&["break", "n", "--change", "--file", &file]);
    assert_eq!(changed.code(), 0, "{}", changed.stderr);
    assert!(changed.stdout.contains(": n was "), "{}", changed.stdout);
    let none = trik(&["break", "powr", "--change"]);
    assert_eq!(none.code(), 1);
    assert!(
        none.stderr.contains("did you mean 'power'?"),
        "{}",
        none.stderr
    );
    assert_eq!(trik(&["continue"]).code(), 0);
    eventually("it turns again", || turns(&reachable, 4));
    let refused = trik(&["set", "pwer=1"]);
    assert_eq!(refused.code(), 1);
    assert!(
        refused.stderr.contains("did you mean 'power'?"),
        "{}",
        refused.stderr
    );
    assert_eq!(trik(&["stop"]).code(), 0);
    assert!(reachable.rests());
    drop(running);
}

#[test]
fn another_main_diagram_of_a_file_runs_and_is_changed_on_a_robot() {
    let Some(reachable) = Reachable::new() else {
        return;
    };
    let home = &reachable.robot.home;
    let both = |turn: &str| format!("diagram \"Still\"\n  hello: Say(text = hello)\n{turn}");
    for (name, content) in [
        ("both.flow", both(TURN).into_bytes()),
        ("both.qrs", saved(&both(TURN))),
    ] {
        let file = home.0.file(name, content);
        let file = file.to_str().expect("a name in UTF-8");
        let robot = ["--robot", reachable.ip()];
        let run = |diagram| [["run", file, "--diagram", diagram].as_slice(), &robot].concat();
        let refused = home.run(&run("Trun"));
        assert_eq!(refused.code(), 2, "{}", refused.stdout);
        let told = "there are: Still, Turn; did you mean 'Turn'?";
        assert!(refused.stderr.contains(told), "{}", refused.stderr);
        let mut watched = run("Turn");
        watched.push("--watch");
        let running = Running::new(&mut home.command(&watched));
        eventually("it turns", || turns(&reachable, 3));
        let changed = both(&TURN.replace("wheels.M3", "wheels.M4"));
        home.0.file(
            name,
            match name.ends_with("flow") {
                true => changed.into_bytes(),
                false => saved(&changed),
            },
        );
        eventually("the other wheel turns", || turns(&reachable, 4));
        let stopped = home.run(&["stop", robot[0], robot[1]]);
        assert_eq!(stopped.code(), 0, "{}", stopped.stderr);
        eventually("its motors rest", || reachable.rests());
        drop(running);
    }
}

#[test]
fn a_data_flow_program_is_debugged_in_one_talk() {
    let Some(reachable) = Reachable::new() else {
        return;
    };
    let home = &reachable.robot.home;
    let file = home.0.file("turn.flow", TURN);
    let file = file.to_str().expect("a name in UTF-8");
    let mut command = home.command(&["debug", file, "--robot", reachable.ip()]);
    let typed = "break wheels\ndprintf wheels power is {power}\nc\nset power=30\nc\nprint power\nreload\nrn\nbreak nowhere\n\
        present\ndelete\nwatch n if n > 20\nc\nq\n";
    let said = harness::tools::run(&mut command, typed.as_bytes()).good();
    for told in [
        "before the first block",
        "wheels.M3 gets 20",
        "wheels.M3 gets 30",
        "(trik) print power\n30\n",
        "power is 20\n",
        "power is 30\n",
        "n was 20 and is 21, by line ",
        "changed: 4 blocks kept, 0 new, 0 gone",
        "past, ",
    ] {
        assert!(said.contains(told), "{told}: {said}");
    }
    // It was started for the talk, and is ended with it.
    eventually("its motors rest", || reachable.rests());
}
