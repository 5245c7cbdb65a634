//! What is found before anything runs.

mod beginners;
mod limits;
mod subprograms;
mod variables;

use super::*;
use crate::machine::fixtures::{diagram, project};
use crate::project::DiagramKind;
use lang_text::problem::Locale;
use lang_text::problem::Severity;

fn told(text: &str) -> Vec<String> {
    let main = diagram("main", DiagramKind::Main, text);
    told_of(&project(vec![main]))
}

fn told_of(project: &Project) -> Vec<String> {
    let problems = check(project).problems;
    let lines = problems.iter().map(|problem| {
        assert_ne!(problem.words.english, problem.words.russian);
        let level = match problem.severity {
            Severity::Error => "error",
            Severity::Warning => "warning",
            Severity::Note => "note",
        };
        format!("{level}: {}", problem.in_locale(Locale::English))
    });
    lines.collect()
}

/// That exactly one thing is told, and that it begins so.
fn only(text: &str, wanted: &str) {
    let told = told(text);
    assert!(
        told.len() == 1 && told[0].starts_with(wanted),
        "{wanted}\n{told:#?}"
    );
}

#[test]
fn good_programs_have_nothing_to_tell() {
    for text in [
        "A Sensor\nF Text programming {IO0=I0 * 2}\nM Motors\nA.OUT > F.I0\nF.O0 > M.M3",
        "GO Motors\nW Wait and send\nNO Motors {M3Power=0}\nEND Stop\nGO.CF_OUT > W.CF_IN\nW.CF_OUT > NO.CF_IN\nNO.CF_OUT > END.IN0",
        "L Loop\nS Say\nL.OUT > S.DATA",
        "V Variable {variable=n = 0}\nL Loop\nF Text programming {IO0=n = n + I0; n}\nS Say\nL.OUT > F.I0\nF.O0 > S.DATA",
    ] {
        assert_eq!(told(text), Vec::<String>::new(), "{text}");
    }
}

#[test]
fn blocks_ports_and_properties_are_looked_at() {
    only(
        "L Loop {time=0}\nS Say\nL.OUT > S.DATA",
        "error: main: Loop 'L': 'dispatch time (ms)': 0 ms: the time must be above 0",
    );
    only(
        "L Led {ledColor=pink}",
        "error: main: Led 'L': 'color:': 'pink' is none of off, green, orange, red",
    );
    only(
        "L Loop\nW Wait and send {keep=no}\nS Say\nL.OUT > W.DATA\nW.OUT > S.DATA",
        "error: main: Wait and send 'W': 'keep': 'no' is none of true, false",
    );
    only(
        "A Sensor {VarName=sensorA9}\nS Say\nA.OUT > S.DATA",
        "error: main: Sensor 'A': 'Sensor': there is no sensor 'sensorA9'; did you mean 'sensorA1'?",
    );
    only(
        "P Specific input {portName=A1}",
        "error: main: Specific input 'P': 'Port name': 'A1' only tells readings",
    );
    only(
        "W Wait and send {time=soon}",
        "error: main: Wait and send 'W': 'time': 'soon' is not a number",
    );
    only(
        "I Input port\nS Say\nI.OUT > S.DATA",
        "error: main: Input port 'I': input and output ports belong in subprograms",
    );
    only(
        "C User block of nothing",
        "error: main: User block 'C': the subprogram that it calls is not in the project",
    );
    let mut main = diagram("main", DiagramKind::Main, "A Sensor\nS Say\nA.OUT > S.DATA");
    for (port, wanted) in [
        (
            7,
            "error: main: Sensor 'A': it has no port 7: its ports are 0 to 1",
        ),
        (-5, "error: main: Sensor 'A': it has no port -5"),
        (
            i32::MAX,
            "error: main: Sensor 'A': it has no port of the number that the edge says: its ports are 0 to 1",
        ),
        (
            0,
            "error: main: Sensor 'A': an edge begins at CF_IN, which is an input",
        ),
    ] {
        if let Some(from) = &mut main.edges[0].from {
            from.port = port;
        }
        let told = told_of(&project(vec![main.clone()]));
        assert!(told[0].starts_with(wanted), "{told:?}");
    }
    main.edges[0].from = None;
    let told = told_of(&project(vec![main]));
    assert!(
        told[0].starts_with("error: main: ? -> Say 'S': this edge is not attached"),
        "{told:?}"
    );
}

#[test]
fn subprograms_do_not_call_themselves_and_have_their_ports() {
    let again = diagram("again", DiagramKind::Subprogram, "C User block of again");
    let main = diagram("main", DiagramKind::Main, "C User block of again");
    let told = told_of(&project(vec![main, again]));
    assert!(
        told[0].contains("User block 'C': the subprogram 'again' calls itself"),
        "{told:?}"
    );
    let body = diagram("body", DiagramKind::Subprogram, "H Say");
    let main = diagram(
        "main",
        DiagramKind::Main,
        "V Value generator\nC User block of body\nV.OUT > C.I1",
    );
    let told = told_of(&project(vec![main, body]));
    assert!(
        told[0].starts_with("warning: main: User block 'C': 'I1': tokens that come to I1 are lost"),
        "{told:?}"
    );
    // Each of two calls of a subprogram that calls three times a third one: 100 are too many only at last.
    let leaf = diagram("leaf", DiagramKind::Subprogram, "H Say");
    let many: String = (0..12)
        .map(|at| format!("C{at} User block of leaf\n"))
        .collect();
    let middle = diagram("middle", DiagramKind::Subprogram, &many);
    let calls: String = (0..9)
        .map(|at| format!("C{at} User block of middle\n"))
        .collect();
    let main = diagram("main", DiagramKind::Main, &calls);
    let told = told_of(&project(vec![main, middle, leaf]));
    assert!(
        told[0].contains("more than 100 diagrams at work"),
        "{told:?}"
    );
}

#[test]
fn expressions_are_looked_at_with_the_types_of_their_inputs() {
    only(
        "A Sensor\nF Text programming {IO0=I0 +}\nS Say\nA.OUT > F.I0\nF.O0 > S.DATA",
        "error: main: Text programming 'F': 'IO0', 1:4 Unexpected end of input",
    );
    only(
        "A Sensor {VarName=lineSensor}\nF Text programming {IO0=I0 + 1}\nS Say\nA.OUT > F.I0\nF.O0 > S.DATA",
        "error: main: Text programming 'F': 'IO0', 1:1",
    );
    only(
        "A Sensor\nF Text programming {IO0=I0 + speed}\nM Motors\nA.OUT > F.I0\nF.O0 > M.M3",
        "error: main: Text programming 'F': 'IO0', 1:6 speed is never given a value",
    );
    only(
        "A Sensor\nI If {condition=data > }\nS Say\nA.OUT > I.DATA\nI.TRUE > S.DATA",
        "error: main: If 'I': 'Condition', 1:",
    );
    only(
        "A Sensor\nF Text programming {IO0=I0 + I1}\nS Say\nA.OUT > F.I0\nF.O0 > S.DATA",
        "error: main: Text programming 'F': 'IO0': it reads I1, which has no edge",
    );
}

#[test]
fn tokens_fit_their_ports() {
    only(
        "A Sensor {VarName=lineSensor}\nM Motors\nA.OUT > M.M3",
        "error: main: Motors 'M': 'M3': a list comes here, but a whole number is needed",
    );
    only(
        "V Value generator {varValue=fast}\nM Motors\nV.OUT > M.M3",
        "error: main: Motors 'M': 'M3': a text comes here, but a whole number is needed",
    );
    only(
        "V Value generator {varValue=[1, 2]}\nL Draw line\nV.OUT > L.COORDS",
        "error: main: Draw line 'L': 'COORDS': a list comes here, but a list of 4 is needed",
    );
    only(
        "W Wait and send\nM Motors\nW.CF_OUT > M.M3",
        "warning: main: Motors 'M': 'M3': a control token comes to M3, which has no value",
    );
    only(
        "A Sensor\nZ Zip flows\nU Unzip flows\nS Say\nA.OUT > Z.DATA1\nZ.OUT > U.DATA\nU.OUT1 > S.DATA",
        "error: main: Zip flows 'Z': 'DATA2': this input has no edge",
    );
    assert_eq!(
        told("V Value generator {varValue=7}\nM Servo motors\nV.OUT > M.S3"),
        Vec::<String>::new()
    );
}

#[test]
fn cycles_dead_blocks_and_unused_values_are_told() {
    only(
        "V Value generator {varValue=0}\nF Text programming {IO0=I0+1}\nI If {condition=data<10}\nS Say\nV.OUT > F.I0\nF.O0 > I.DATA\nI.TRUE > F.I0\nI.FALSE > S.DATA",
        "warning: main: Text programming 'F': tokens can run around within one instant (Text programming 'F', If 'I')",
    );
    assert_eq!(
        told(
            "W Wait and send\nV Value generator\nS Say\nV.OUT > W.DATA\nW.OUT > S.DATA\nS.CF_OUT > W.CF_IN"
        ),
        Vec::<String>::new()
    );
    let told = told("A Say\nB Say\nA.CF_OUT > B.CF_IN\nB.CF_OUT > A.CF_IN");
    assert!(
        told.iter()
            .any(|one| one.contains("Say 'A': 'CF_IN': nothing starts it")),
        "{told:?}"
    );
    only(
        "V Value generator",
        "warning: main: Value generator 'V': nobody takes what it gives",
    );
    only(
        "A Stop\nS Say",
        "warning: main: Stop 'A': no edge comes to it, so it ends nothing",
    );
    only(
        "A Sensor\nS Say\nA.OUT > S.DATA\nA.OUT > S.DATA",
        "warning: main: Sensor 'A' -> Say 'S': another edge connects the same two ports",
    );
    only(
        "G Gamepad\nE Encoders {E3Clear=false}\nS Say\nE.E3_OUT > S.DATA\nG.WHEEL > E.E4_IN",
        "warning: main: Encoders 'E': 'E3_OUT': this encoder gives nothing until it is reset",
    );
    only(
        "A Sensor\nG Say\nF Text programming {IO0=I0}\nS Say\nA.OUT > F.I0\nG.CF_OUT > F.CF_IN\nF.O0 > S.DATA",
        "warning: main: Text programming 'F': 'CF_IN': a start means nothing to a function that has inputs",
    );
}

#[test]
fn two_masters_of_a_motor_are_told_unless_something_decides() {
    let two = "A Sensor\nB Sensor {VarName=sensorA2}\nM Motors\nA.OUT > M.M3\nB.OUT > M.M3";
    only(
        two,
        "warning: main: Motors 'M': Sensor 'A' and Sensor 'B' both drive M3 and nothing decides",
    );
    let decided = "A Sensor\nI If\nF Text programming {IO0=I0}\nG Text programming {IO0=0 - I0}\nM Motors\nA.OUT > I.DATA\nI.TRUE > F.I0\nI.FALSE > G.I0\nF.O0 > M.M3\nG.O0 > M.M3";
    assert_eq!(told(decided), Vec::<String>::new());
}

#[test]
fn streams_of_different_periods_are_told() {
    only(
        "A Sensor\nL Loop {time=100}\nZ Zip flows\nU Unzip flows\nS Say\nA.OUT > Z.DATA1\nL.OUT > Z.DATA2\nZ.OUT > U.DATA\nU.OUT1 > S.DATA",
        "warning: main: Zip flows 'Z': 'DATA1': tokens come to DATA1 more often than to DATA2",
    );
    only(
        "A Sensor\nB Sensor {VarName=sensorA2}\nR Flow replacer\nM Motors\nA.OUT > R.REPLACE_DATA\nB.OUT > R.DATA\nR.OUT > M.M3",
        "warning: main: Flow replacer 'R': its time of 10 ms is shorter than the 20 ms",
    );
}

#[test]
fn lists_and_what_functions_give_are_known_along_the_way() {
    for good in [
        "G Sensor {VarName=gyroscope}\nF Text programming {IO0=I0[0] * 2}\nM Motors\nG.OUT > F.I0\nF.O0 > M.M3",
        "R Sensor {VarName=colorSensorR}\nF Text programming {IO0=I0 + colorSensorG % 2}\nM Motors\nR.OUT > F.I0\nF.O0 > M.M3",
        "G Gamepad\nI If {condition=data[0] > 1}\nS Say\nG.PAD > I.DATA\nI.TRUE > S.CF_IN",
        "R Read file\nM Motors\nR.OUT > M.M3",
        "A Sensor\nF Text programming {IO0=I0 / 2}\nG Text programming {IO0=I0 + 1}\nM Motors\nA.OUT > F.I0\nF.O0 > G.I0\nG.O0 > M.M3",
        "V Value generator {varValue=[1, 2]}\nF Text programming {IO0=I0[1]}\nM Servo motors\nV.OUT > F.I0\nF.O0 > M.S3",
    ] {
        assert_eq!(told(good), Vec::<String>::new(), "{good}");
    }
    only(
        "A Sensor\nF Text programming {IO0={I0, 1}}\nM Motors\nA.OUT > F.I0\nF.O0 > M.M3",
        "error: main: Motors 'M': 'M3': a list comes here",
    );
    only(
        "A Sensor\nF Text programming {IO0=I0 .. '!'}\nG Text programming {IO0=I0 * 2}\nM Motors\nA.OUT > F.I0\nF.O0 > G.I0\nG.O0 > M.M3",
        "error: main: Text programming 'G': 'IO0', 1:1",
    );
    only(
        "L Loop {increment=0}\nS Say\nL.OUT > S.DATA",
        "error: main: Loop 'L': 'increment_step': the step is 0",
    );
    for sensor in ["sensorA1", "colorSensorR"] {
        only(
            &format!("V Variable {{variable={sensor}}}"),
            &format!(
                "error: main: Variable 'V': 'variable': '{sensor}' is not a name of a variable"
            ),
        );
    }
}

#[test]
fn a_square_in_a_loop_has_nothing_to_tell_and_a_condition_compares() {
    let square = "L Loop {end_border=3 | time=1000}\nGO Motors\nW Wait and send\nTURN Motors {M3Power=0 | M4Power=40}\nE Wait and send {time=900}\nNO Motors {M3Power=0 | M4Power=0}\nL.OUT > GO.CF_IN\nGO.CF_OUT > W.CF_IN\nW.CF_OUT > TURN.CF_IN\nL.CF_OUT > E.CF_IN\nE.CF_OUT > NO.CF_IN";
    assert_eq!(told(square), Vec::<String>::new());
    only(
        "A Sensor\nI If {condition=data = 5}\nS Say\nA.OUT > I.DATA\nI.TRUE > S.DATA",
        "error: main: If 'I': 'Condition': the condition assigns a value",
    );
    for text in [
        "T Value generator {varValue=1}\nL Loop\nS Say\nT.OUT > L.TO\nL.OUT > S.DATA",
        "T Value generator {varValue=1}\nL Wait and send\nS Say\nT.OUT > L.TIME\nL.CF_OUT > S.CF_IN",
    ] {
        let told = told(text);
        assert!(
            told.iter()
                .any(|one| one.contains("'L': nothing starts it")),
            "{told:?}"
        );
    }
}

#[test]
fn an_error_is_never_lost_among_warnings() {
    let mut main = diagram("main", DiagramKind::Main, "A Sensor\nS Say\nA.OUT > S.DATA");
    let twin = main.edges[0].clone();
    main.edges.extend(std::iter::repeat_n(twin, 3000));
    for (at, port) in [(0, 77), (3000, 300)] {
        let mut bad = main.clone();
        if let Some(to) = &mut bad.edges[at].to {
            to.port = port;
        }
        let checked = check(&project(vec![bad]));
        assert!(checked.has_errors());
        assert_eq!(checked.problems[0].severity, Severity::Error);
    }
    let checked = check(&project(vec![main.clone()]));
    assert!(!checked.has_errors());
    main.blocks[1]
        .properties
        .insert("text".to_owned(), "x".repeat(5 << 20));
    let checked = check(&project(vec![main]));
    assert!(checked.has_errors());
    assert!(
        checked.problems[0]
            .to_string()
            .contains("more than 4 MiB of text in names and properties; each call of a subprogram has a copy of its own")
    );
}

#[test]
fn diagrams_that_are_not_run_are_looked_at_and_forbid_nothing() {
    let main = diagram("main", DiagramKind::Main, "S Say");
    let lonely = diagram(
        "lonely",
        DiagramKind::Subprogram,
        "L Led {ledColor=pink}\nF Text programming {IO0=1 +}\nC User block of deep",
    );
    let deep = diagram(
        "deep",
        DiagramKind::Subprogram,
        "W Wait and send {time=soon}",
    );
    let other = diagram("other", DiagramKind::Main, "L Led {ledColor=blue}");
    let project = project(vec![main, lonely, deep, other]);
    let found = told_of(&project);
    let wanted = [
        "warning: lonely: nothing that runs calls it",
        "warning: lonely: Led 'L': 'color:': 'pink'",
        "warning: lonely: Text programming 'F': 'IO0', 1:",
        "warning: deep: nothing that runs calls it",
        "warning: deep: Wait and send 'W': 'time': 'soon' is not a number",
        "warning: other: it is not run, because 'main' is: in a program as text, write `run` after the name",
        "warning: other: Led 'L': 'color:': 'blue'",
    ];
    assert_eq!(found.len(), wanted.len(), "{found:#?}");
    for (found, wanted) in found.iter().zip(wanted) {
        assert!(found.starts_with(wanted), "{wanted}\n{found}");
    }
    assert!(!check(&project).has_errors());
}

#[test]
fn times_that_are_none_are_told() {
    for (time, words) in [("0", "0 ms"), ("-5", "-5 ms")] {
        only(
            &format!("W Wait and send {{time={time}}}\nS Say\nW.CF_OUT > S.CF_IN"),
            &format!("warning: main: Wait and send 'W': 'time': {words}: it waits 10 ms"),
        );
        for (block, opens, property) in [
            ("Flow replacer", "REPLACE_DATA", "replacing time"),
            ("Flow delay", "STOP", "delay time"),
        ] {
            only(
                &format!(
                    "A Sensor\nB Sensor {{VarName=sensorA2}}\nR {block} {{time={time}}}\nM Motors\nA.OUT > R.{opens}\nB.OUT > R.DATA\nR.OUT > M.M3"
                ),
                &format!(
                    "warning: main: {block} 'R': '{property}': {words}: its window is over at once"
                ),
            );
        }
    }
    // A token brings the time.
    let brought = "V Value generator\nT Value generator {varValue=1}\nW Wait and send {time=0}\nS Say\nV.OUT > W.TIME\nT.OUT > W.DATA\nW.OUT > S.DATA";
    assert_eq!(told(brought), Vec::<String>::new());
    for (property, shown) in [
        ("dispatchTime", "dispatch time"),
        ("preSendTime", "time before first send"),
    ] {
        let body = diagram(
            "body",
            DiagramKind::Subprogram,
            &format!(
                "I Input port\nF Complex filter {{{property}=-1}}\nS Say\nI.OUT > F.DATA\nF.OUT > S.DATA"
            ),
        );
        let main = diagram(
            "main",
            DiagramKind::Main,
            "A Sensor\nC User block of body\nD User block of body\nA.OUT > C.I0\nA.OUT > D.I0",
        );
        // Once for both calls.
        let wanted = format!(
            "warning: body: Complex filter 'F': '{shown}': -1 ms: a time below 0 counts as 0; write 0 or more"
        );
        assert_eq!(told_of(&project(vec![main, body])), [wanted]);
    }
}

#[test]
fn a_wait_that_keeps_more_than_it_lets_go_is_told() {
    let of = |properties: &str| {
        format!("A Sensor\nW Wait and send {{{properties}}}\nS Say\nA.OUT > W.DATA\nW.OUT > S.DATA")
    };
    only(
        &of("time=100 | keep=true"),
        "warning: main: Wait and send 'W': 'DATA': a token comes every 20 ms and each is held for 100 ms",
    );
    for good in ["time=100", "time=20 | keep=true", "time=15 | keep=1"] {
        assert_eq!(told(&of(good)), Vec::<String>::new(), "{good}");
    }
    // What `keep` is for: a burst that ends.
    let burst = "L Loop {start_border=1 | end_border=4 | time=10}\nW Wait and send {time=100 | keep=true}\nS Say\nL.OUT > W.DATA\nW.OUT > S.DATA";
    assert_eq!(told(burst), Vec::<String>::new());
}

#[test]
fn many_waits_that_keep_cost_what_they_are() {
    let mut text = "A Sensor\n".to_owned();
    let mut edges = String::new();
    for number in 0..20_000 {
        text += &format!("W{number} Wait and send {{time=100 | keep=true}}\n");
        edges += &format!("A.OUT > W{number}.DATA\n");
    }
    // Looking for loops before each of them would be half a milliard steps.
    let found = told(&(text + &edges));
    assert!(
        found[0].contains("warning: main: Wait and send"),
        "{}",
        found[0]
    );
}

#[test]
fn loops_without_a_body_or_without_a_number_are_told() {
    only(
        "L Loop\nS Say\nL.CF_OUT > S.CF_IN",
        "warning: main: Loop 'L': 'OUT': nothing happens at its numbers",
    );
    for (bounds, counts) in [
        ("start_border=5 | end_border=1", "from 5 to 1 by steps of 1"),
        (
            "start_border=1 | end_border=5 | increment=-2",
            "from 1 to 5 by steps of -2",
        ),
    ] {
        only(
            &format!("L Loop {{{bounds}}}\nS Say\nL.OUT > S.DATA"),
            &format!("warning: main: Loop 'L': it counts {counts}"),
        );
    }
    // A token brings the last number.
    let brought = "V Value generator\nL Loop {end_border=-1}\nS Say\nV.OUT > L.TO\nV.OUT > L.CF_IN\nL.OUT > S.DATA";
    assert_eq!(told(brought), Vec::<String>::new());
}

#[test]
fn conditions_that_are_always_the_same_or_compare_different_kinds_are_told() {
    let of = |sensor: &str, condition: &str| {
        format!(
            "A Sensor {{VarName={sensor}}}\nI If {{condition={condition}}}\nS Say\nA.OUT > I.DATA\nI.TRUE > S.CF_IN"
        )
    };
    for condition in ["true", "1 > 0", "not false", "'a' == 'b'"] {
        only(
            &of("sensorA1", condition),
            "warning: main: If 'I': 'Condition': the condition is the same for every token",
        );
    }
    for (sensor, condition, kinds) in [
        (
            "sensorA1",
            "data == 'near'",
            "a number with a text that is no number",
        ),
        (
            "sensorA1",
            "'far' ~= data",
            "a text that is no number with a number",
        ),
        ("gyroscope", "data == 3", "a list with a number"),
        ("gyroscope", "data ~= 'up'", "a list with a text"),
    ] {
        only(
            &of(sensor, condition),
            &format!("warning: main: If 'I': 'Condition', 1:1 the condition compares {kinds}"),
        );
    }
    for good in [
        "data == '5'",
        "time() > 1000",
        "sensorA2 > 5",
        "data + 1 == 2.5",
    ] {
        assert_eq!(told(&of("sensorA1", good)), Vec::<String>::new(), "{good}");
    }
    // What opens a gate for all, and the last way of a switch.
    for good in [
        "A Sensor\nF Complex filter\nS Say\nA.OUT > F.DATA\nF.OUT > S.DATA",
        "A Sensor\nW Switch {cond0=data > 5 | O0=1 | cond1=true | O1=2}\nS Say\nA.OUT > W.DATA\nW.O0 > S.DATA\nW.O1 > S.DATA",
    ] {
        assert_eq!(told(good), Vec::<String>::new(), "{good}");
    }
}
