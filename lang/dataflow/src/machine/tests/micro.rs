//! Small cases, one block or one rule each.

use super::*;

fn starts_with(line: &str, wanted: &str) -> bool {
    line.strip_prefix(wanted).is_some()
}

/// A wire that gives only some of the readings: 0 stands for none.
const FEED: &str = "
    A Sensor {VarName=sensorA1}
    G If {condition=data ~= 0}
    A.OUT > G.DATA";

fn only(lines: &[String], label: &str) -> Vec<String> {
    let mut found = Vec::new();
    for line in lines {
        let (time, parts) = line.split_once(": ").expect(line);
        for part in parts.split("; ") {
            let name = part.split([' ', '.']).next().unwrap_or_default();
            if name == label {
                found.push(format!("{time}: {part}"));
            }
        }
    }
    found
}

#[test]
fn a_wait_holds_one_token_and_drops_what_comes_meanwhile() {
    let text = format!(
        "{FEED}\nW Wait and send {{time=30}}\nS Say\nX Say\nG.TRUE > W.DATA\nW.OUT > S.DATA\nW.CF_OUT > X.CF_IN"
    );
    let feed = [(20, 1), (40, 2), (60, 0), (100, 5), (120, 6), (140, 0)];
    let lines = fed(&text, 200, &feed);
    assert_eq!(
        only(&lines, "W"),
        ["50: W 1", "50: W.CF_OUT", "130: W 5", "130: W.CF_OUT"]
    );
}

#[test]
fn a_wait_that_keeps_lets_each_token_go_in_its_turn() {
    let text = format!(
        "{FEED}\nW Wait and send {{time=30 | keep=true}}\nS Say\nX Say\nG.TRUE > W.DATA\nW.OUT > S.DATA\nW.CF_OUT > X.CF_IN"
    );
    let feed = [(20, 1), (40, 2), (60, 0), (100, 5), (120, 6), (140, 0)];
    let mut wanted = Vec::new();
    for (at, value) in [(50, 1), (80, 2), (130, 5), (160, 6)] {
        wanted.extend([format!("{at}: W {value}"), format!("{at}: W.CF_OUT")]);
    }
    assert_eq!(only(&fed(&text, 200, &feed), "W"), wanted);
    // A time that comes while it waits counts from its turn on.
    let (lines, status) = simply(
        "A Value generator {varValue=1}\nT Value generator {varValue=50}\nB Value generator {varValue=2}\nW Wait and send {time=20 | keep=true}\nS Say\nA.OUT > W.DATA\nT.OUT > W.TIME\nB.OUT > W.DATA\nW.OUT > S.DATA",
        200,
    );
    assert_eq!(only(&lines, "W"), ["20: W 1", "70: W 2"]);
    let ended = Status::Ended {
        at: 70,
        with_errors: false,
    };
    assert_eq!(status, ended);
}

#[test]
fn an_inhibitor_stops_for_its_time() {
    let text = "
        A Sensor {VarName=sensorA1}
        T If {condition=data == 2}
        I Flow delay {time=50}
        S Say
        A.OUT > I.DATA
        A.OUT > T.DATA
        T.TRUE > I.STOP
        I.OUT > S.DATA";
    let feed: Vec<(u32, i32)> = (1..=8).map(|at| (20 * at, at as i32)).collect();
    let passed: Vec<String> = only(&fed(text, 160, &feed), "I");
    assert_eq!(
        passed,
        [
            "20: I 1", "40: I 2", "100: I 5", "120: I 6", "140: I 7", "160: I 8"
        ]
    );
    // The stop first: then 2 is lost too.
    let first = text.replace("A.OUT > I.DATA\n        A.OUT > T.DATA", "A.OUT > T.DATA\n        Z Text programming {IO0=I0}\n        A.OUT > Z.I0\n        Z.O0 > I.DATA");
    let passed: Vec<String> = only(&fed(&first, 160, &feed), "I");
    assert_eq!(passed[..2], ["20: I 1", "100: I 5"]);
}

#[test]
fn a_filter_is_a_gate() {
    let text = "
        A Sensor {VarName=sensorA1}
        F Complex filter {dispatchTime=50 | count=3 | condition=data > 0}
        S Say
        X Say
        A.OUT > F.DATA
        F.OUT > S.DATA
        F.FAILURE > X.CF_IN";
    let values = [1, 2, -1, 3, 4, -5, -5, 6, 7];
    let feed: Vec<(u32, i32)> = (1..)
        .zip(values)
        .map(|(at, value)| (20 * at, value))
        .collect();
    assert_eq!(
        only(&fed(text, 180, &feed), "F"),
        [
            "20: F 1",
            "80: F 3",
            "140: F.FAILURE",
            "160: F 6",
            "180: F.FAILURE"
        ]
    );
}

#[test]
fn a_loop_counts_by_timer_and_a_start_begins_anew() {
    let text = "L Loop {start_border=1 | end_border=3 | time=100}\nS Say\nX Say {text=end}\nL.OUT > S.DATA\nL.CF_OUT > X.CF_IN";
    let (lines, status) = simply(text, 1000);
    assert_eq!(
        only(&lines, "L"),
        ["100: L 1", "200: L 2", "300: L 3", "300: L.CF_OUT"]
    );
    let ended = Status::Ended {
        at: 300,
        with_errors: false,
    };
    assert_eq!(status, ended);
    let again = format!(
        "{text}\nW Wait and send {{time=150}}\nV Value generator\nV.OUT > W.DATA\nW.CF_OUT > L.CF_IN"
    );
    let (lines, _) = simply(&again, 1000);
    // The loop has an incoming edge now, so the wait alone starts it.
    assert_eq!(
        only(&lines, "L"),
        ["250: L 1", "350: L 2", "450: L 3", "450: L.CF_OUT"]
    );
    let both = format!("{again}\nB Value generator\nB.OUT > L.CF_IN");
    let (lines, _) = simply(&both, 1000);
    assert_eq!(
        only(&lines, "L"),
        [
            "100: L 1",
            "250: L 1",
            "350: L 2",
            "450: L 3",
            "450: L.CF_OUT"
        ]
    );
    let (down, _) = simply(
        &text.replace(
            "start_border=1 | end_border=3",
            "start_border=3 | end_border=1 | increment=-1",
        ),
        1000,
    );
    assert_eq!(only(&down, "L")[..3], ["100: L 3", "200: L 2", "300: L 1"]);
}

#[test]
fn zip_joins_in_order() {
    let text = "
        A Value generator {varValue=a}
        B Value generator {varValue=b}
        P Value generator {varValue=p}
        Q Value generator {varValue=q}
        Z Zip flows
        U Unzip flows
        S Say
        A.OUT > Z.DATA1
        B.OUT > Z.DATA1
        P.OUT > Z.DATA2
        Q.OUT > Z.DATA2
        Z.OUT > U.DATA
        U.OUT2 > S.DATA";
    let (lines, _) = simply(text, 100);
    assert!(lines[0].contains("Z [a, p]; Z [b, q]"), "{}", lines[0]);
    assert!(lines[0].contains("U.OUT2 p; U.OUT2 q"), "{}", lines[0]);
}

#[test]
fn a_chain_of_control_is_a_program() {
    let text = "
        GO Motors {M3Power=50 | M4Power=50}
        W Wait and send {time=1000}
        NO Motors {M3Power=0 | M4Power=0}
        END Stop
        GO.CF_OUT > W.CF_IN
        W.CF_OUT > NO.CF_IN
        NO.CF_OUT > END.IN0";
    let main = diagram("main", DiagramKind::Main, text);
    let mut robot = Script::default();
    let (_, status) = run(&project(vec![main]), 2000, &mut robot, |_, _| {});
    let ended = Status::Ended {
        at: 1000,
        with_errors: false,
    };
    assert_eq!(status, ended);
    assert_eq!(
        robot.commands,
        [
            "power M1 0",
            "power M2 0",
            "power M3 50",
            "power M4 50",
            "power M1 0",
            "power M2 0",
            "power M3 0",
            "power M4 0",
            "rest",
        ]
    );
}

#[test]
fn a_switch_takes_the_first_that_holds_or_all() {
    let text = |first: &str| {
        format!(
            "A Sensor {{VarName=sensorA1}}\nW Switch {{sendOnlyFirst={first} | cond0=data>0 | O0=data*2 | cond1=data==0 | O1=data | cond2=data>2}}\nS Say\nX Say\nA.OUT > W.DATA\nW.O0 > S.DATA\nW.O1 > S.DATA\nW.O2 > S.DATA\nW.CF_OUT > X.CF_IN"
        )
    };
    let feed = [(20, 3), (40, 0), (60, -1)];
    assert_eq!(
        only(&fed(&text("true"), 60, &feed), "W"),
        [
            "20: W.O0 6",
            "20: W.CF_OUT",
            "40: W.O1 0",
            "40: W.CF_OUT",
            "60: W.CF_OUT"
        ]
    );
    assert_eq!(
        only(&fed(&text("false"), 20, &feed), "W"),
        ["20: W.O0 6", "20: W.O2 3", "20: W.CF_OUT"]
    );
}

#[test]
fn an_unsynchronized_function_answers_each_input_alone() {
    let text = |first: &str| {
        format!(
            "A Value generator {{varValue=2}}\nB Value generator {{varValue=5}}\nF Text programming {{synch=false | IO0=I0+1 | IO1=I0*I1}}\nS Say\nW Wait and send {{time=20}}\nF.O0 > S.DATA\nF.O1 > S.DATA\n{first}"
        )
    };
    let (lines, _) = simply(&text("A.OUT > F.I0\nB.OUT > W.DATA\nW.OUT > F.I1"), 100);
    assert_eq!(only(&lines, "F"), ["0: F.O0 3", "20: F.O1 10"]);
    let (lines, status) = simply(&text("B.OUT > F.I1\nA.OUT > W.DATA\nW.OUT > F.I0"), 100);
    let error = lines.last().cloned().unwrap_or_default();
    assert!(
        error.contains("error: main: Text programming 'F': 'IO1': I0 has no value yet"),
        "{error}"
    );
    assert!(matches!(
        status,
        Status::Ended {
            at: 0,
            with_errors: true
        }
    ));
}

#[test]
fn a_cycle_within_an_instant_ends_or_is_an_error() {
    let text = "
        V Value generator {varValue=0}
        F Text programming {IO0=I0+1}
        I If {condition=data<10}
        S Say
        V.OUT > F.I0
        F.O0 > I.DATA
        I.TRUE > F.I0
        I.FALSE > S.DATA";
    let (lines, status) = simply(text, 100);
    assert!(
        lines[0].contains("I.FALSE 10; [say \"10\"]"),
        "{}",
        lines[0]
    );
    assert!(matches!(
        status,
        Status::Ended {
            at: 0,
            with_errors: false
        }
    ));
    let (lines, status) = simply(&text.replace("data<10", "true"), 100);
    assert!(matches!(
        status,
        Status::Ended {
            at: 0,
            with_errors: true
        }
    ));
    let error = lines[0].split("error: ").nth(1).unwrap_or_default();
    assert!(error.contains("10000 times within one instant"), "{error}");
    assert!(
        error.contains("Text programming 'F'") && error.contains("If 'I'"),
        "{error}"
    );
}

#[test]
fn a_list_is_printed_with_its_items() {
    let text =
        "V Value generator {varValue=[1, 2.5]}\nF Text programming {IO0=print(I0)}\nV.OUT > F.I0";
    let main = diagram("main", DiagramKind::Main, text);
    let mut robot = Script::default();
    run(&project(vec![main]), 10, &mut robot, |_, _| {});
    assert!(
        robot.commands.iter().any(|told| told.contains("[1, 2.5]")),
        "{:?}",
        robot.commands
    );
}

/// What ends a program.
fn last_words(main: crate::project::Diagram) -> String {
    let (lines, _) = run(&project(vec![main]), 10, &mut Script::default(), |_, _| {});
    let error = lines.iter().find_map(|line| line.split("error: ").nth(1));
    error.unwrap_or_default().to_owned()
}

#[test]
fn many_reactions_without_a_cycle_are_no_cycle() {
    use crate::project::End;
    // All these send to one block, which reacts again and again.
    let mut text = String::from("V Value generator {varValue=1}\nS Say\n");
    for at in 0..5100 {
        text.push_str(&format!("b{at} Text programming {{IO0=1}}\n"));
    }
    text.push_str("b0.O0 > S.DATA\n");
    let mut main = diagram("main", DiagramKind::Main, &text);
    let first = main.edges[0].clone();
    for block in 3..5102 {
        let mut edge = first.clone();
        edge.from = edge.from.map(|end| End { block, ..end });
        main.edges.push(edge);
    }
    assert_eq!(
        last_words(main),
        "main: Say 'S': more than 10000 reactions of blocks come in one instant, which is all that there is room for: let some of them wait"
    );
}

#[test]
fn a_cycle_of_many_blocks_is_a_cycle() {
    let mut text = String::from("V Value generator {varValue=1}\n");
    for at in 0..100 {
        text.push_str(&format!("b{at} Text programming {{IO0=I0}}\n"));
    }
    text.push_str("V.OUT > b0.I0\nb99.O0 > b0.I0\n");
    for at in 1..100 {
        text.push_str(&format!("b{}.O0 > b{at}.I0\n", at - 1));
    }
    let error = last_words(diagram("main", DiagramKind::Main, &text));
    assert!(
        error.contains("10000 times within one instant without an end (Text"),
        "{error}"
    );
}

#[test]
fn each_call_has_its_own_state() {
    let inner = diagram(
        "gate",
        DiagramKind::Subprogram,
        "
        HIGH Input port {identifier=I0}
        LOW Input port {identifier=I1}
        G Flow replacer {time=100}
        O Output port {identifier=O0}
        HIGH.OUT > G.REPLACE_DATA
        LOW.OUT > G.DATA
        G.OUT > O.DATA",
    );
    let main = diagram(
        "main",
        DiagramKind::Main,
        "
        V Value generator {varValue=7}
        A Sensor {VarName=sensorA1}
        ONE User block of gate
        TWO User block of gate
        S Say
        X Say
        V.OUT > ONE.I0
        A.OUT > ONE.I1
        A.OUT > TWO.I1
        ONE.O0 > S.DATA
        TWO.O0 > X.DATA",
    );
    let project = project(vec![main, inner]);
    let mut robot = Script::default();
    robot.readings.insert("A1", vec![3]);
    let (lines, _) = run(&project, 100, &mut robot, |_, _| {});
    assert_eq!(only(&lines, "ONE"), ["0: ONE.O0 7", "100: ONE.O0 3"]);
    assert_eq!(
        only(&lines, "TWO"),
        [
            "20: TWO.O0 3",
            "40: TWO.O0 3",
            "60: TWO.O0 3",
            "80: TWO.O0 3",
            "100: TWO.O0 3"
        ]
    );
}

#[test]
fn a_call_without_outputs_runs_its_body_whose_blocks_start_first() {
    let inner = diagram(
        "body",
        DiagramKind::Subprogram,
        "
        HELLO Say {text=begun}
        I Input port {identifier=CF_IN}
        S Say {text=token}
        I.OUT > S.CF_IN",
    );
    let main = diagram("main", DiagramKind::Main, "C User block of body");
    let (lines, _) = run(
        &project(vec![main, inner]),
        20,
        &mut Script::default(),
        |_, _| {},
    );
    assert_eq!(lines, ["0: I; [say \"begun\"]; [say \"token\"]"]);
}

#[test]
fn several_blocks_read_one_sensor_and_each_edge_delivers_once() {
    let text = "
        A Sensor {VarName=sensorA1}
        B Sensor {VarName=sensorA1}
        S Say
        X Say
        Y Say
        A.OUT > S.DATA
        A.OUT > X.DATA
        A.OUT > Y.DATA
        B.OUT > Y.DATA";
    let lines = fed(text, 20, &[(20, 4)]);
    assert!(starts_with(&lines[0], "20: A 4; B 4; "), "{}", lines[0]);
    assert_eq!(lines[0].matches("[say \"4\"]").count(), 4);
}

#[test]
fn motors_are_told_once_in_an_instant_and_the_last_one_counts() {
    let text = "
        A Value generator {varValue=30}
        B Value generator {varValue=250}
        C Value generator {varValue=-0.5}
        M Motors
        N Specific input {portName=M3 | portImpulse=10}
        A.OUT > M.M3
        B.OUT > M.M4
        C.OUT > M.M1
        M.CF_OUT > N.CF_IN";
    let main = diagram("main", DiagramKind::Main, text);
    let mut robot = Script::default();
    run(&project(vec![main]), 20, &mut robot, |_, _| {});
    assert_eq!(
        robot.commands,
        ["power M1 -1", "power M3 10", "power M4 100", "rest"]
    );
}
