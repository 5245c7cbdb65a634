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
