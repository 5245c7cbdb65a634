//! Mistakes that are typical of who draws a first program: each is told once, at its cause.

use super::*;

/// A main diagram with one subprogram.
fn calling(main: &str, name: &str, body: &str) -> Vec<String> {
    let main = diagram("main", DiagramKind::Main, main);
    let body = diagram(name, DiagramKind::Subprogram, body);
    told_of(&project(vec![main, body]))
}

fn one(found: &[String], wanted: &str) {
    assert!(
        found.len() == 1 && found[0].starts_with(wanted),
        "{wanted}\n{found:#?}"
    );
}

const RED: &str = "R Led {ledColor=red}\nW Wait and send\nG Led {ledColor=green}\nV Wait and send\nR.CF_OUT > W.CF_IN\nW.CF_OUT > G.CF_IN\nG.CF_OUT > V.CF_IN\n";

#[test]
fn a_ring_that_nothing_starts_is_told_once_at_the_edge_that_closes_it() {
    assert_eq!(told(RED), Vec::<String>::new());
    let closed = format!("{RED}V.CF_OUT > R.CF_IN");
    only(
        &closed,
        "warning: main: Led 'R': 'CF_IN': nothing starts it: these blocks only lead to each other (Led 'R', Wait and send 'W', Led 'G', Wait and send 'V')",
    );
    // What hangs on the ring is not told as well.
    only(
        &format!("{closed}\nS Say\nT Say\nG.CF_OUT > S.CF_IN\nS.CF_OUT > T.CF_IN"),
        "warning: main: Led 'R': 'CF_IN': nothing starts it",
    );
    for start in [
        "B Value generator\nB.OUT > R.CF_IN",
        "B Text programming\nB.CF_OUT > G.CF_IN",
    ] {
        assert_eq!(
            told(&format!("{closed}\n{start}")),
            Vec::<String>::new(),
            "{start}"
        );
    }
    // Through a subprogram.
    let found = calling(
        "C User block of body\nW Wait and send\nC.O0 > W.DATA\nW.OUT > C.I0",
        "body",
        "I Input port\nF Text programming {IO0=I0}\nO Output port\nI.OUT > F.I0\nF.O0 > O.DATA",
    );
    one(
        &found,
        "warning: main: User block 'C': 'I0': nothing starts it: these blocks only lead to each other",
    );
}

#[test]
fn a_block_that_waits_for_itself_is_told() {
    let sum = "A Sensor\nF Text programming {IO0=I0 + I1}\nW Wait and send\nS Say\nA.OUT > F.I0\nF.O0 > W.DATA\nW.OUT > F.I1\nF.O0 > S.DATA";
    only(
        sum,
        "warning: main: Text programming 'F': 'I1': no token ever comes to I1, because what leads here waits for it",
    );
    assert_eq!(
        told(&format!(
            "{sum}\nV Value generator {{varValue=0}}\nV.OUT > F.I1"
        )),
        Vec::<String>::new()
    );
}

#[test]
fn outputs_that_never_give_anything_are_told_with_the_reason() {
    for (text, wanted) in [
        (
            "A Sensor\nF Text programming {IO0=I0}\nS Say\nM Motors\nA.OUT > F.I0\nF.O0 > S.DATA\nF.O1 > M.M4",
            "warning: main: Text programming 'F': 'O1': nothing ever comes from O1, because IO1 is empty",
        ),
        (
            "A Sensor\nF Text programming\nM Motors\nA.OUT > F.I0\nF.O0 > M.M4",
            "warning: main: Text programming 'F': 'O0': nothing ever comes from O0, because IO0 is empty",
        ),
        (
            "A Sensor\nF Text programming {synch=false | IO0=I0 | IO1=I0}\nS Say\nA.OUT > F.I0\nF.O1 > S.DATA",
            "warning: main: Text programming 'F': 'O1': nothing ever comes from O1, because it is computed when a token comes to I1",
        ),
        (
            "A Sensor\nF Switch\nS Say\nA.OUT > F.DATA\nF.O2 > S.DATA",
            "warning: main: Switch 'F': 'O2': nothing ever comes from O2, because cond2 is empty",
        ),
        (
            "R Led\nW Wait and send\nS Led\nR.CF_OUT > W.CF_IN\nW.OUT > S.CF_IN",
            "warning: main: Wait and send 'W': 'OUT': nothing ever comes from OUT, where only what came to DATA leaves: draw the edge from CF_OUT",
        ),
        (
            "W Wait and send\nM Motors\nW.OUT > M.CF_IN",
            "warning: main: Wait and send 'W': 'OUT': nothing ever comes from OUT, where only what came to DATA leaves: draw the edge from CF_OUT",
        ),
        (
            "A Sensor\nP Text on screen\nA.OUT > P.TEXT",
            "warning: main: Text on screen 'P': nothing starts it, because only parameters of it are connected: lead an edge to CF_IN or COORDS",
        ),
        (
            "A Sensor\nP Flow delay {time=50}\nS Say\nA.OUT > P.STOP\nP.OUT > S.DATA",
            "warning: main: Flow delay 'P': nothing starts it, because only parameters of it are connected: lead an edge to DATA",
        ),
    ] {
        only(text, wanted);
    }
    let found = calling(
        "A Sensor\nC User block of PD\nS Say\nM Motors\nA.OUT > C.I0\nC.O0 > S.DATA\nC.O1 > M.M4",
        "PD",
        "I Input port\nF Text programming {IO0=I0}\nO Output port\nI.OUT > F.I0\nF.O0 > O.DATA",
    );
    one(
        &found,
        "warning: main: User block 'C': 'O1': nothing ever comes from O1, because the subprogram 'PD' has no output port O1",
    );
}

#[test]
fn a_text_that_ends_with_an_assignment_is_told_where_it_is() {
    only(
        "A Sensor\nF Text programming {IO0=b = 1; a = I0}\nM Motors\nA.OUT > F.I0\nF.O0 > M.M3",
        "warning: main: Text programming 'F': 'IO0', 1:8 the last statement of IO0 assigns, so O0 gives a control token, which has no value for M3: write `; a` after it",
    );
    // Through a wait, and out of a subprogram.
    only(
        "A Sensor\nF Text programming {IO1=a = I0}\nW Wait and send\nM Motors\nA.OUT > F.I0\nF.O1 > W.DATA\nW.OUT > M.M3",
        "warning: main: Text programming 'F': 'IO1', 1:1 the last statement of IO1 assigns, so O1 gives",
    );
    let found = calling(
        "A Sensor\nC User block of PD\nM Motors\nA.OUT > C.I0\nC.O0 > M.M4",
        "PD",
        "I Input port\nF Text programming {IO0=u = I0}\nO Output port\nI.OUT > F.I0\nF.O0 > O.DATA",
    );
    one(
        &found,
        "warning: PD: Text programming 'F': 'IO0', 1:1 the last statement of IO0 assigns",
    );
    only(
        "A Sensor\nF Text programming {IO0=a = I0}\nI If\nS Say\nA.OUT > F.I0\nF.O0 > I.DATA\nI.TRUE > S.CF_IN",
        "warning: main: Text programming 'F': 'IO0', 1:1 the last statement of IO0 assigns",
    );
    only(
        "R Led\nI If\nS Say\nR.CF_OUT > I.DATA\nI.TRUE > S.CF_IN",
        "warning: main: If 'I': 'DATA': a control token comes to DATA, which has no value",
    );
    // As a start it is as good as any other.
    for good in [
        "A Sensor\nF Text programming {IO0=a = I0}\nS Say\nA.OUT > F.I0\nF.O0 > S.CF_IN",
        "A Sensor\nF Text programming {IO0=a = I0}\nI If {condition=a > 5}\nS Say\nA.OUT > F.I0\nF.O0 > I.DATA\nI.TRUE > S.CF_IN",
    ] {
        assert_eq!(told(good), Vec::<String>::new(), "{good}");
    }
}

#[test]
fn two_blocks_that_drive_the_same_motors_are_told_of_once() {
    // One begins, the other one ends it: each has its time.
    let stops = "M Motors\nA Sensor\nF If {condition=data < 20}\nN Motors {M3Power=0 | M4Power=0}\nA.OUT > F.DATA\nF.TRUE > N.CF_IN";
    assert_eq!(told(stops), Vec::<String>::new());
    only(
        "M Motors\nN Motors {M3Power=0 | M4Power=0}\nW Wait and send\nM.CF_OUT > W.CF_IN",
        "warning: main: Motors 'M': Motors 'M' and Motors 'N' both drive M1, M2, M3, M4 and nothing decides between them",
    );
    only(
        "A Sensor\nB Sensor {VarName=sensorA2}\nM Motors\nN Motors\nA.OUT > M.M3\nB.OUT > N.M3\nA.OUT > M.M4\nB.OUT > N.M4",
        "warning: main: Motors 'M': Motors 'M' and Motors 'N' both drive M3, M4 and nothing decides between them",
    );
}

#[test]
fn a_variable_that_is_read_before_it_has_a_value_is_told() {
    for (texts, place) in [
        (
            "IO0=e = I0 | IO1=u = 0.6*e + 1.5*(e - ep); ep = e; u",
            "'IO1', 1:22",
        ),
        ("IO0=I0 - ep | IO1=ep = I0", "'IO0', 1:6"),
        ("IO0=ep = ep + I0; ep", "'IO0', 1:6"),
    ] {
        let text = format!(
            "A Sensor\nF Text programming {{{texts}}}\nS Say\nA.OUT > F.I0\nF.CF_OUT > S.CF_IN"
        );
        only(
            &text,
            &format!(
                "error: main: Text programming 'F': {place} ep is read before it has a value, because nothing else gives it one: write `ep = 0`"
            ),
        );
        for begun in [
            "V Variable {variable=ep = 0}",
            "V Variable {variable=ep}\nB Value generator {varValue=0}\nB.OUT > V.IN",
        ] {
            assert_eq!(told(&format!("{text}\n{begun}")), Vec::<String>::new());
        }
    }
    // What `and` does not come to is not read.
    let later = "A Sensor\nF Text programming {IO0=ep = I0 > 1000 and ep == 5; ep}\nS Say\nA.OUT > F.I0\nF.O0 > S.DATA";
    assert_eq!(told(later), Vec::<String>::new());
    // Here the second text may be computed first.
    let apart = "A Sensor\nB Sensor\nF Text programming {synch=false | IO0=I0 - ep | IO1=ep = I1}\nS Say\nA.OUT > F.I0\nB.OUT > F.I1\nF.O0 > S.DATA";
    assert_eq!(told(apart), Vec::<String>::new());
}

#[test]
fn a_variable_with_a_name_alone_gives_no_value() {
    only(
        "V Variable {variable=old}\nA Sensor\nF Text programming {IO0=I0 - old}\nS Say\nA.OUT > F.I0\nF.O0 > S.DATA",
        "error: main: Text programming 'F': 'IO0', 1:6 old is never given a value: write `old = ...`",
    );
    only(
        "V Variable {variable=old}\nS Say\nV.OUT > S.DATA",
        "error: main: Variable 'V': 'variable': old is never given a value: write `old = ...`",
    );
}

#[test]
fn misspelt_names_and_unknown_functions_are_told_with_what_was_meant() {
    let of = |text: &str| {
        format!(
            "K Variable {{variable=Kp = 2}}\nA Sensor\nF Text programming {{IO0={text}}}\nS Say\nA.OUT > F.I0\nF.O0 > S.DATA"
        )
    };
    for (text, wanted) in [
        (
            "i0 + 1",
            "1:1 i0 is never given a value; did you mean 'I0'?",
        ),
        (
            "I0 * kp",
            "1:6 kp is never given a value; did you mean 'Kp'?",
        ),
        (
            "I0 + senzorA1",
            "1:6 senzorA1 is never given a value; did you mean 'sensorA1'?",
        ),
        (
            "I0 + zzz",
            "1:6 zzz is never given a value: write `zzz = ...`",
        ),
        (
            "clamp(I0, 0, 50)",
            "1:1 there is no function clamp; there are: time, sensor,",
        ),
        (
            "I0 + flor(2.5)",
            "1:6 there is no function flor; did you mean 'floor'?; there are: ",
        ),
    ] {
        only(
            &of(text),
            &format!("error: main: Text programming 'F': 'IO0', {wanted}"),
        );
    }
}

#[test]
fn values_that_end_the_program_are_told_by_their_types() {
    let near = |to: &str| {
        format!("A Sensor\nI If\nL Led\nM Motors\nP Paint settings\nA.OUT > I.DATA\nI.TRUE > {to}")
    };
    only(
        &near("L.DATA"),
        "error: main: Led 'L': 'DATA': a whole number comes here, but one of these words is needed: off, green, orange, red",
    );
    only(
        &near("P.BACKGROUND_COLOR"),
        "error: main: Paint settings 'P': 'BACKGROUND_COLOR': a whole number comes here, but one of these words",
    );
    for yellow in [
        "V Value generator {varValue=\"yellow\"}\nL Led\nV.OUT > L.DATA",
        "V Value generator\nF Text programming {IO0=\"yellow\"}\nL Led\nV.OUT > F.I0\nF.O0 > L.DATA",
    ] {
        only(
            yellow,
            "error: main: Led 'L': 'DATA': 'yellow' is none of off, green, orange, red",
        );
        assert_eq!(told(&yellow.replace("yellow", "Red")), Vec::<String>::new());
    }
    for go in [
        "V Value generator {varValue=\"go\"}\nM Motors\nV.OUT > M.M3",
        "A Sensor\nF Text programming {IO0=\"go\"}\nM Motors\nA.OUT > F.I0\nF.O0 > M.M3",
    ] {
        only(
            go,
            "error: main: Motors 'M': 'M3': a text comes here, but a whole number is needed",
        );
    }
    only(
        "A Sensor\nI If {condition=data < \"25\"}\nS Say\nA.OUT > I.DATA\nI.TRUE > S.CF_IN",
        "warning: main: If 'I': 'Condition', 1:1 `<` compares a number with a text, and neither is smaller: write a number without quotes",
    );
}

#[test]
fn motors_in_a_program_without_time_are_told() {
    only(
        "M Motors {M3Power=60 | M4Power=60}",
        "warning: main: Motors 'M': the program ends in the instant in which it begins",
    );
    only(
        "P Specific input\nS Say\nP.CF_OUT > S.CF_IN",
        "warning: main: Specific input 'P': the program ends in the instant in which it begins",
    );
    for good in [
        "M Motors\nW Wait and send\nM.CF_OUT > W.CF_IN",
        "M Motors {M3Power=0 | M4Power=0}",
        "M Servo motors {S1Angle=20}",
        "M Motors\nR Random generator {repeatedly=true}\nS Say\nR.OUT > S.DATA",
        "M Motors\nF Read file\nS Say\nF.OUT > S.DATA",
    ] {
        assert_eq!(told(good), Vec::<String>::new(), "{good}");
    }
}

#[test]
fn small_slips_are_told() {
    let of = |text: &str| {
        format!(
            "A Sensor\nF Text programming {{IO0={text}}}\nS Say\nA.OUT > F.I0\nA.OUT > F.I1\nF.O0 > S.DATA"
        )
    };
    for (text, at) in [
        ("I0 I1", "1:1"),
        ("a = 2; I0 + a; I1", "1:8"),
        ("5 I0", "1:1"),
    ] {
        only(
            &of(text),
            &format!(
                "warning: main: Text programming 'F': 'IO0', {at} nobody takes this value, because another statement follows"
            ),
        );
    }
    for good in ["print(I0); I1", "a = I0; a"] {
        assert_eq!(told(&of(good)), Vec::<String>::new(), "{good}");
    }
    only(
        "A Sensor\nI If {condition=}\nS Say\nA.OUT > I.DATA\nI.FALSE > S.CF_IN",
        "warning: main: If 'I': 'Condition': the condition is empty: write one, such as `data > 0`",
    );
    only(
        "M Motors {M3Power=150}\nW Wait and send\nM.CF_OUT > W.CF_IN",
        "warning: main: Motors 'M': 'M3=': a power of 150 counts as 100",
    );
    only(
        "P Specific input {portName=M2 | portImpulse=-200}\nW Wait and send\nP.CF_OUT > W.CF_IN",
        "warning: main: Specific input 'P': 'Impulse': a power of -200 counts as -100",
    );
    only(
        "R Random generator {fromNumber=10 | toNumber=0}\nS Say\nR.OUT > S.DATA",
        "warning: main: Random generator 'R': 'upper border': the upper border 0 is below the lower one 10, so they count as 0 to 10",
    );
}

#[test]
fn what_an_edge_says_of_a_queue_that_is_none_is_told() {
    let text = "A Sensor\nF Text programming {IO0=I0}\nM Motors\nA.OUT > F.I0\nF.O0 > M.M3";
    for (at, capacity, wanted) in [
        (
            0,
            Some(0),
            Some("Sensor 'A' -> Text programming 'F': a queue of 0 places counts as 1"),
        ),
        (
            0,
            Some(2000),
            Some("Sensor 'A' -> Text programming 'F': a queue of 2000 places counts as 1024"),
        ),
        (0, Some(16), None),
        (0, None, None),
        (
            1,
            Some(2000),
            Some(
                "Text programming 'F' -> Motors 'M': what this edge says of a queue has no effect, because M3 waits for no other input",
            ),
        ),
    ] {
        let mut main = diagram("main", DiagramKind::Main, text);
        main.edges[at].policy = Some(crate::project::Policy::Fifo);
        main.edges[at].capacity = capacity;
        let found = told_of(&project(vec![main]));
        match wanted {
            Some(wanted) => one(&found, &format!("warning: main: {wanted}")),
            None => assert_eq!(found, Vec::<String>::new()),
        }
    }
}

#[test]
fn a_ring_through_several_output_ports_of_one_name_is_told_once() {
    let found = calling(
        "C User block of body\nW Wait and send\nC.O0 > W.DATA\nW.OUT > C.I0",
        "body",
        "I Input port\nF Text programming {IO0=I0}\nO Output port\nP Output port\nI.OUT > F.I0\nF.O0 > O.DATA\nF.O0 > P.DATA",
    );
    one(
        &found,
        "warning: main: User block 'C': 'I0': nothing starts it: these blocks only lead to each other",
    );
    // Without a wait on the way it is a cycle, and names blocks only.
    let found = calling(
        "V Value generator\nC User block of body\nF Text programming {synch=false | IO0=I0}\nV.OUT > F.I0\nF.O0 > C.I0\nC.O0 > F.I0",
        "body",
        "I Input port\nO Output port\nP Output port\nI.OUT > O.DATA\nI.OUT > P.DATA",
    );
    one(
        &found,
        "warning: main: User block 'C': tokens can run around within one instant (User block 'C', Text programming 'F', Input port 'I', Output port 'O', Output port 'P'):",
    );
}

#[test]
fn many_rings_and_long_ones_cost_what_they_are() {
    let mut text = String::new();
    let mut edges = String::new();
    for number in 0..20_000 {
        text += &format!("W{number} Wait and send\n");
        edges += &format!("W{number}.CF_OUT > W{}.CF_IN\n", (number + 1) % 20_000);
    }
    only(
        &(text + &edges),
        "warning: main: Wait and send 'W0': 'CF_IN': nothing starts it: these blocks only lead to each other (Wait and send 'W0', Wait and send 'W1',",
    );
}
