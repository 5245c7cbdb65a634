//! Rules of tokens: bounds of queues, types, ends, sources and devices.

use super::*;
use crate::project::Policy;

fn error_of(text: &str) -> String {
    let (lines, status) = simply(text, 200);
    assert!(
        matches!(
            status,
            Status::Ended {
                with_errors: true,
                ..
            }
        ),
        "{lines:?}"
    );
    let last = lines.last().cloned().unwrap_or_default();
    last.split("error: ").nth(1).unwrap_or_default().to_owned()
}

#[test]
fn a_full_queue_loses_the_oldest_keeps_the_newest_or_is_an_error() {
    let text = "
        A Sensor {VarName=sensorA1}
        B Wait and send {time=90}
        Z Zip flows
        S Say
        A.OUT > Z.DATA1
        A.OUT > B.DATA
        B.OUT > Z.DATA2
        Z.OUT > S.DATA";
    let run_with = |policy: Policy, capacity: u16| {
        let mut main = diagram(
            "main",
            DiagramKind::Main,
            &text
                .replace("S Say", "U Unzip flows\nS Say")
                .replace("Z.OUT > S.DATA", "Z.OUT > U.DATA\nU.OUT1 > S.DATA"),
        );
        for edge in &mut main.edges {
            if edge
                .to
                .is_some_and(|end| main.blocks[end.block].name == "Z" && end.port == 0)
            {
                edge.policy = Some(policy);
                edge.capacity = Some(capacity);
            }
        }
        let mut robot = Script::default();
        let (lines, _) = run(&project(vec![main]), 120, &mut robot, |now, robot| {
            robot.readings.insert("A1", vec![now as i32]);
        });
        lines.join("\n")
    };
    // The wait lets the reading of 20 ms go at 110 ms; by then there were 20, 40, 60, 80 and 100.
    assert!(run_with(Policy::Fifo, 1024).contains("U.OUT1 20"));
    assert!(run_with(Policy::Fifo, 2).contains("U.OUT1 80"));
    assert!(run_with(Policy::Latest, 5).contains("U.OUT1 100"));
    let full = run_with(Policy::Error, 2);
    assert!(
        full.contains("error: main: Zip flows 'Z': 'DATA1': 2 tokens wait here already"),
        "{full}"
    );
}

#[test]
fn what_is_no_number_moves_no_motor() {
    for (value, words) in [
        ("fast", "'M3': fast is not a whole number"),
        ("[1, 2]", "'M3': [1, 2] is not a whole number"),
        ("true", "'M3': true is not a whole number"),
        (
            "1e300",
            "is too large: whole numbers are from -2147483647 to 2147483647",
        ),
        ("2147483648", "'M3': 2147483648 is too large"),
    ] {
        let text = format!("V Value generator {{varValue={value}}}\nM Motors\nV.OUT > M.M3");
        let error = error_of(&text);
        assert!(error.contains(words), "{value}: {error}");
    }
    let unit = error_of("W Wait and send {time=10}\nM Motors\nW.CF_OUT > M.M3");
    assert!(
        unit.contains("a control token came here, which has no value"),
        "{unit}"
    );
    let main = diagram(
        "main",
        DiagramKind::Main,
        "V Value generator {varValue='42.5'}\nM Motors\nV.OUT > M.M3",
    );
    let mut robot = Script::default();
    run(&project(vec![main]), 20, &mut robot, |_, _| {});
    assert_eq!(robot.commands, ["power M3 43", "rest"]);
    let not_a_number = error_of("F Text programming {IO0=sqrt(0-1)}\nM Motors\nF.O0 > M.M3");
    assert!(
        not_a_number.contains("not a whole number"),
        "{not_a_number}"
    );
}

#[test]
fn a_program_ends_when_nothing_can_happen_any_more() {
    let (_, status) = simply("V Value generator\nS Say\nV.OUT > S.DATA", 1000);
    let at = |at| Status::Ended {
        at,
        with_errors: false,
    };
    assert_eq!(status, at(0));
    let (_, status) = simply("W Wait and send {time=35}", 1000);
    assert_eq!(status, at(40), "a time is rounded up to steps");
    let (_, status) = simply("L Loop {end_border=-1}", 1000);
    assert_eq!(status, at(0), "a loop over nothing is done at once");
    let (_, status) = simply("R Random generator {repeatedly=true}", 1000);
    assert_eq!(status, Status::Running);
    let (_, status) = simply("G Gamepad", 1000);
    assert_eq!(status, Status::Running);
}

#[test]
fn own_names_belong_to_their_block_and_variables_to_all() {
    let text = "
        A Value generator {varValue=1}
        B Value generator {varValue=two}
        F Text programming {IO0=shared = I0 + 41}
        G Text programming {IO0=I0 .. '!'}
        H Text programming {IO0=shared}
        S Say
        X Say
        A.OUT > F.I0
        B.OUT > G.I0
        F.CF_OUT > W.CF_IN
        W Wait and send {time=10}
        W.CF_OUT > H.CF_IN
        G.O0 > S.DATA
        H.O0 > X.DATA";
    let (lines, _) = simply(text, 100);
    assert!(lines[0].contains("[say \"two!\"]"), "{lines:?}");
    assert!(lines[1].contains("[say \"42\"]"), "{lines:?}");
}

#[test]
fn the_type_of_an_input_may_change_from_token_to_token() {
    let text = "
        A Value generator {varValue=1}
        B Value generator {varValue=word}
        C Value generator {varValue=2.5}
        F Text programming {IO0=I0}
        S Say
        A.OUT > F.I0
        B.OUT > F.I0
        C.OUT > F.I0
        F.O0 > S.DATA";
    let (lines, _) = simply(text, 10);
    assert!(
        lines[0].contains("F.O0 1; F.O0 word; F.O0 2.5"),
        "{}",
        lines[0]
    );
    let error = error_of(&text.replace("IO0=I0}", "IO0=I0 + 1}"));
    assert!(
        error.contains("Text programming 'F': 'IO0', 1:1"),
        "{error}"
    );
}

#[test]
fn variables_take_tokens_and_lists() {
    let text = "
        L Value generator {varValue=[3, 4]}
        V Variable {variable=a; b}
        F Text programming {IO0=a * 10 + b}
        S Say
        L.OUT > V.IN
        V.OUT > S.DATA
        V.CF_OUT > F.CF_IN
        F.O0 > S.DATA";
    let (lines, _) = simply(text, 10);
    assert!(
        lines[0].contains("V 3; V.CF_OUT; [say \"3\"]; F.O0 34"),
        "{}",
        lines[0]
    );
    let short = error_of(&text.replace("[3, 4]", "[3]"));
    assert!(
        short.contains("'IN': a list of at least 2 items is needed, this one has 1"),
        "{short}"
    );
    let unset = error_of("V Variable {variable=nobody}\nS Say\nV.OUT > S.DATA");
    assert!(unset.contains("nobody has no value yet"), "{unset}");
}

#[test]
fn a_missing_sensor_is_an_error_and_a_silent_one_a_gap() {
    let error = error_of("A Sensor {VarName=sensorA1}");
    assert!(
        error.contains("main: Sensor 'A': the robot has no such device"),
        "{error}"
    );
    let error = error_of("F Text programming {IO0=sensorA1 + 1}\nM Motors\nF.O0 > M.M3");
    assert!(error.contains("sensorA1 says nothing"), "{error}");
    let main = diagram(
        "main",
        DiagramKind::Main,
        "A Sensor {VarName=sensorA1}\nS Say\nA.OUT > S.DATA",
    );
    let (mut machine, mut robot) = (machine(&project(vec![main])), Script::default());
    robot.readings.insert("A1", vec![5]);
    machine.step(0, &mut robot, &mut Deaf);
    machine.step(20, &mut robot, &mut Deaf);
    robot.readings.clear();
    for now in [40, 60, 80] {
        assert_eq!(machine.step(now, &mut robot, &mut Deaf), Status::Running);
    }
    robot.readings.insert("A1", vec![6]);
    machine.step(100, &mut robot, &mut Deaf);
    assert_eq!(robot.commands, ["say \"5\"", "say \"6\""]);
    assert_eq!(machine.warnings().len(), 1);
}

#[test]
fn encoders_messages_and_the_gamepad_give_what_comes() {
    let main = diagram(
        "main",
        DiagramKind::Main,
        "
        E Encoders {E3Clear=true | E4Clear=false}
        R Message receiver
        G Gamepad
        V Value generator {varValue=100}
        S Say
        X Say
        U Unzip flows
        E.E3_OUT > S.DATA
        E.E4_OUT > X.DATA
        V.OUT > E.E4_IN
        R.OUT > U.DATA
        U.OUT2 > S.DATA
        G.BUTTON > U.DATA
        G.WHEEL > S.DATA
        W Wait and send {time=10}
        W.CF_OUT > E.CF_IN",
    );
    let mut robot = Script::default();
    for port in ["E3", "E4"] {
        robot.readings.insert(port, vec![7]);
    }
    let (lines, _) = run(&project(vec![main]), 60, &mut robot, |now, robot| {
        if now == 40 {
            robot.mail.push_back((Some(3), "hello".to_owned()));
        }
    });
    let all = lines.join("\n");
    assert!(
        all.contains("[reset E4]") && all.contains("[reset E3]"),
        "{all}"
    );
    assert!(all.contains("20: E.E3_OUT 7; E.E4_OUT 107"), "{all}");
    assert!(all.contains("R [3, hello]"), "{all}");
    assert!(all.contains("U.OUT2 hello"), "{all}");
}

#[test]
fn files_are_read_by_words_and_lines() {
    let read = |properties: &str| {
        let text = format!(
            "F Read file {{fileName=notes | {properties}}}\nS Say\nX Say\nF.OUT > S.DATA\nF.CF_OUT > X.CF_IN"
        );
        let main = diagram("main", DiagramKind::Main, &text);
        let mut robot = Script::default();
        robot
            .files
            .insert("notes".to_owned(), "one  two\nthree\n".to_owned());
        run(&project(vec![main]), 20, &mut robot, |_, _| {}).0[0].clone()
    };
    let words = read("isbyWords=true");
    assert!(
        words.starts_with("0: F one; F two; F three; F.CF_OUT; "),
        "{words}"
    );
    let lines = read("isbyWords=false");
    assert!(
        lines.starts_with("0: F one  two; F three; F.CF_OUT; "),
        "{lines}"
    );
    let error = error_of("F Read file {fileName=nothing}");
    assert!(error.contains("there is no file 'nothing'"), "{error}");
}

#[test]
fn a_late_step_makes_up_for_timers_and_not_for_readings() {
    let main = diagram(
        "main",
        DiagramKind::Main,
        "L Loop {start_border=1 | end_border=5 | time=10}\nA Sensor {VarName=sensorA1}\nS Say\nX Say\nL.OUT > S.DATA\nA.OUT > X.DATA",
    );
    let mut robot = Script::default();
    robot.readings.insert("A1", vec![9]);
    let mut machine = machine(&project(vec![main]));
    for now in [1000, 1010, 1055, 1060] {
        machine.step(now, &mut robot, &mut Deaf);
    }
    assert_eq!(
        robot.commands,
        ["say \"1\"", "say \"2\"", "say \"9\"", "say \"9\""]
    );
    machine.step(1070, &mut robot, &mut Deaf);
    assert_eq!(robot.commands.last().map(String::as_str), Some("say \"3\""));
}

#[test]
fn stopping_rests_once() {
    let main = diagram("main", DiagramKind::Main, "M Motors\nA Gamepad");
    let (mut machine, mut robot) = (machine(&project(vec![main])), Script::default());
    machine.step(0, &mut robot, &mut Deaf);
    machine.stop(&mut robot, &mut Deaf);
    machine.stop(&mut robot, &mut Deaf);
    machine.step(10, &mut robot, &mut Deaf);
    assert_eq!(
        robot.commands.iter().filter(|one| *one == "rest").count(),
        1
    );
}

#[test]
fn an_element_that_is_no_number_moves_no_motor() {
    for (list, text) in [
        ("[100, fast]", "I0[1] + 50"),
        ("[1, 2]", "I0[5]*2 + 60"),
        ("[1, two]", "max(I0[1], 30)"),
    ] {
        let text = format!(
            "V Value generator {{varValue={list}}}\nF Text programming {{IO0={text}}}\nM Motors\nV.OUT > F.I0\nF.O0 > M.M3"
        );
        let error = error_of(&text);
        assert!(
            error.contains("A number is needed, and this is"),
            "{text}: {error}"
        );
    }
}

#[test]
fn lists_may_change_what_they_hold_from_token_to_token() {
    let text = "
        A Value generator {varValue=[1.5, 2]}
        B Value generator {varValue=[1, 2]}
        C Value generator {varValue=[a, b]}
        F Text programming {IO0=I0[0]}
        S Say
        A.OUT > F.I0
        B.OUT > F.I0
        C.OUT > F.I0
        F.O0 > S.DATA";
    let (lines, _) = simply(text, 10);
    assert!(
        lines[0].contains("F.O0 1.5; F.O0 1; F.O0 a"),
        "{}",
        lines[0]
    );
}

#[test]
fn units_go_through_a_wait_and_a_start_of_a_switch_gives_the_last_token() {
    let (lines, _) = simply(
        "G Motors\nW Wait and send {time=50}\nN Motors {M3Power=0 | M4Power=0}\nG.CF_OUT > W.DATA\nW.OUT > N.CF_IN",
        100,
    );
    assert_eq!(lines.len(), 2);
    assert!(
        lines[1].starts_with("50: W") && lines[1].contains("[power M3 0]"),
        "{lines:?}"
    );
    let (lines, _) = simply(
        "V Value generator {varValue=7}\nW Wait and send {time=10}\nC Switch {O0=}\nS Say\nV.OUT > C.DATA\nW.CF_OUT > C.CF_IN\nC.O0 > S.DATA",
        100,
    );
    assert!(lines[1].contains("C.O0 7"), "{lines:?}");
}

#[test]
fn a_loop_that_is_started_again_and_again_keeps_one_timer_and_no_program_waits_for_a_void_one() {
    let main = diagram(
        "main",
        DiagramKind::Main,
        "A Sensor\nL Loop {time=2000000000}\nS Say\nA.OUT > L.CF_IN\nL.OUT > S.DATA",
    );
    let (mut machine, mut robot) = (machine(&project(vec![main])), Script::default());
    robot.readings.insert("A1", vec![1]);
    for now in (0..20_000).step_by(10) {
        machine.step(now, &mut robot, &mut Deaf);
    }
    assert_eq!(machine.timers.len(), 1);
    let (_, status) = simply(
        "L Loop {time=500}\nV Value generator {varValue=-5}\nW Wait and send {time=20}\nB Value generator {varValue=1}\nB.OUT > L.CF_IN\nV.OUT > W.DATA\nW.OUT > L.TO\nW.CF_OUT > L.CF_IN",
        1000,
    );
    assert!(matches!(status, Status::Ended { at: 20, .. }), "{status:?}");
}

#[test]
fn what_waits_for_ever_is_bounded_by_its_weight() {
    let main = diagram(
        "main",
        DiagramKind::Main,
        "R Message receiver\nW Wait and send {time=9000000}\nZ Zip flows\nU Unzip flows\nS Say\nR.OUT > Z.DATA1\nR.OUT > W.DATA\nW.OUT > Z.DATA2\nZ.OUT > U.DATA\nU.OUT1 > S.DATA",
    );
    let (mut machine, mut robot) = (machine(&project(vec![main])), Script::default());
    for now in (0..200).step_by(10) {
        robot
            .mail
            .extend((0..100).map(|_| (Some(1), "x".repeat(60_000))));
        machine.step(now, &mut robot, &mut Deaf);
    }
    assert!(machine.queued <= limits::QUEUED_CELLS_MAX);
    assert!(machine.dropped().count() > 0);
    assert_eq!(machine.status(), Status::Running);
}

#[test]
fn each_colour_of_the_camera_is_a_sensor_and_a_name_in_texts() {
    let main = diagram(
        "main",
        DiagramKind::Main,
        "R Sensor {VarName=colorSensorR}\nB Sensor {VarName=colorSensorB}\nF Text programming {IO0=I0 + colorSensorG * 10}\nS Say\nX Say\nR.OUT > F.I0\nF.O0 > S.DATA\nB.OUT > X.DATA",
    );
    let mut robot = Script::default();
    robot.readings.insert("ColorSensorPort", vec![1, 2, 3]);
    let (lines, _) = run(&project(vec![main]), 20, &mut robot, |_, _| {});
    assert!(lines[0].starts_with("20: R 1; B 3; F.O0 21"), "{lines:?}");
    let absent = error_of("R Sensor {VarName=colorSensorR}\nS Say\nR.OUT > S.DATA");
    assert!(
        absent.contains("Sensor 'R': the robot has no such device"),
        "{absent}"
    );
    let absent = error_of("F Text programming {IO0=colorSensorG}\nS Say\nF.O0 > S.DATA");
    assert!(absent.contains("colorSensorG says nothing"), "{absent}");
}

#[test]
fn what_a_wait_keeps_is_bounded_and_is_gone_at_the_end() {
    let at = Target { node: 1, port: 2 };
    for (letter, most) in [
        ("x".repeat(60_000), limits::QUEUED_CELLS_MAX as usize / 3750),
        ("x".to_owned(), limits::QUEUE_MAX),
    ] {
        let main = diagram(
            "main",
            DiagramKind::Main,
            "R Message receiver\nW Wait and send {time=9000000 | keep=true}\nS Say\nR.OUT > W.DATA\nW.OUT > S.CF_IN",
        );
        let (mut machine, mut robot) = (machine(&project(vec![main])), Script::default());
        for now in (0..200).step_by(10) {
            robot
                .mail
                .extend((0..100).map(|_| (Some(1), letter.clone())));
            machine.step(now, &mut robot, &mut Deaf);
        }
        let kept = machine.waiting_at(at);
        assert!(kept > most / 2 && kept <= most, "{kept} of {most}");
        assert!(machine.queued <= limits::QUEUED_CELLS_MAX);
        let lost: Vec<Target> = machine.dropped().map(|(at, _)| at).collect();
        assert_eq!(lost, [at]);
        assert_eq!(machine.status(), Status::Running);
        machine.stop(&mut robot, &mut Deaf);
        assert_eq!((machine.waiting_at(at), machine.queued), (0, 0));
    }
}

#[test]
fn one_large_token_does_not_take_the_place_of_all_that_a_wait_keeps() {
    let at = Target { node: 1, port: 2 };
    let main = diagram(
        "main",
        DiagramKind::Main,
        "R Message receiver\nW Wait and send {time=9000000 | keep=true}\nS Say\nR.OUT > W.DATA\nW.OUT > S.CF_IN",
    );
    let (mut machine, mut robot) = (machine(&project(vec![main])), Script::default());
    // As if other blocks had nearly all that there is.
    machine.queued = limits::QUEUED_CELLS_MAX - 100;
    let letters = ["x".to_owned(), "x".repeat(60_000), "x".to_owned()];
    for (letter, now) in [0, 0, 0, 1, 2].into_iter().zip((0..).step_by(10)) {
        robot.mail.push_back((Some(1), letters[letter].clone()));
        machine.step(now, &mut robot, &mut Deaf);
    }
    // Of five tokens the first is held and the large one is lost.
    assert_eq!(machine.waiting_at(at), 3);
    let lost: Vec<_> = machine.dropped().collect();
    assert_eq!(lost, [(at, 1)]);
}

#[test]
fn too_many_names_are_told_before_anything_moves() {
    let mut text = String::new();
    for at in 0..5000 {
        text.push_str(&format!("F{at} Text programming {{IO0=I0}}\n"));
    }
    text.push_str("V Value generator\nV.OUT > F0.I0\n");
    let mut main = diagram("main", DiagramKind::Main, &text);
    for at in 1..5000 {
        let mut edge = main.edges[0].clone();
        edge.from = Some(crate::project::End {
            block: at - 1,
            port: 3,
        });
        edge.to = Some(crate::project::End { block: at, port: 2 });
        main.edges.push(edge);
    }
    let (lines, status) = run(&project(vec![main]), 10, &mut Script::default(), |_, _| {});
    assert!(lines[0].contains("more than 4096 names"), "{lines:?}");
    assert!(matches!(
        status,
        Status::Ended {
            at: 0,
            with_errors: true
        }
    ));
}

#[test]
fn a_silent_encoder_is_a_gap_and_a_missing_one_an_error() {
    let error = error_of("E Encoders\nS Say\nE.E3_OUT > S.DATA");
    assert!(
        error.contains("Encoders 'E': the robot has no such device"),
        "{error}"
    );
    let main = diagram(
        "main",
        DiagramKind::Main,
        "E Encoders {E4Clear=false}\nS Say\nE.E3_OUT > S.DATA",
    );
    let (mut machine, mut robot) = (machine(&project(vec![main])), Script::default());
    robot.readings.insert("E3", vec![5]);
    machine.step(0, &mut robot, &mut Deaf);
    robot.readings.clear();
    for now in [20, 40] {
        assert_eq!(machine.step(now, &mut robot, &mut Deaf), Status::Running);
    }
    assert_eq!(machine.warnings().len(), 1);
}

#[test]
fn a_pad_is_told_while_it_is_touched_and_once_when_it_is_let_go() {
    let main = diagram(
        "main",
        DiagramKind::Main,
        "G Gamepad\nS If {condition=true}\nB If {condition=true}\nG.PAD > S.DATA\nG.BUTTON > B.DATA",
    );
    let port = |variable| Port::shown_by(variable).expect(variable).name();
    let (pressed, place) = (port("gamepadPad2Pressed"), port("gamepadPad2"));
    let button = port("gamepadButton3");
    let (lines, _) = run(
        &project(vec![main]),
        100,
        &mut Script::default(),
        |now, robot| {
            let is_touched = (40..70).contains(&now);
            robot.readings.insert(pressed, vec![i32::from(is_touched)]);
            robot.readings.insert(place, vec![10, -20]);
            robot.readings.insert(button, vec![i32::from(now == 60)]);
        },
    );
    assert_eq!(
        lines,
        [
            "40: G.PAD [2, 10, -20]",
            "60: G.PAD [2, 10, -20]; G.BUTTON [3, 1]",
            "80: G.PAD [2, 0, 0]",
        ]
    );
}

/// What `check` says of such programs before they run.
#[test]
fn a_variable_that_is_read_before_it_has_a_value_ends_the_program() {
    for texts in [
        "IO0=e = I0 | IO1=u = 0.6*e + 1.5*(e - ep); ep = e; u",
        "IO0=I0 - ep | IO1=ep = I0",
        "IO0=ep = ep + I0; ep",
        "IO0=I0 > 1000 and ep > 5 | IO1=ep = I0",
    ] {
        let text = format!("V Value generator\nF Text programming {{{texts}}}\nV.OUT > F.I0");
        let error = error_of(&text);
        assert!(
            error.contains("Text programming 'F': 'IO"),
            "{texts}: {error}"
        );
    }
    // An element makes its table, and what `and` does not come to is not read.
    for texts in ["IO0=a[0] = 5; a[0]", "IO0=ep = I0 > 1000 and ep == 5; ep"] {
        let text = format!("V Value generator\nF Text programming {{{texts}}}\nV.OUT > F.I0");
        let (_, status) = simply(&text, 100);
        let has_failed = format!("{status:?}").contains("true");
        assert!(!has_failed, "{texts}: {status:?}");
    }
}
