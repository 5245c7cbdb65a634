//! Blocks that know the time, wait for several tokens, count, or are called: by hand, each against the machine.

use super::{both, case, faults, main_only, run};
use crate::machine::fixtures::{diagram, project};
use crate::project::{DiagramKind, Policy};

#[test]
fn times_and_gates() {
    both(&case(
        "times",
        &main_only(
            "A Sensor {VarName=sensorA1}
            D Sensor {VarName=sensorD1}
            L Loop {start_border=9 | end_border=2 | increment=-3 | time=45}
            W Wait and send {time=33}
            G Complex filter {preSendTime=100 | condition=data > 21 | count=9 | dispatchTime=30}
            S Switch {cond0=data > 24 | O0=data*2 | cond1=data == 20 | O1=-1 | cond2=data < 30 | sendOnlyFirst=false}
            X Switch {cond0=data > 50 | O0=y = data; y / 2 | cond1=true}
            C Text programming {IO0=loops = I0}
            E Text programming {IO0=waited = I0}
            N Text programming {synch=false | IO0=one = I0 | IO1=two = I1 + 1}
            K Text programming {IO0=failed = failed + 1}
            B Variable {variable=failed = 0}
            Q Text programming {IO0=doubled = I0}
            R Text programming {IO0=single = I0}
            P Text programming {IO0=own = I0}
            H Text programming {IO0=halves = I0}
            M Motors {M3Power=70}
            A.OUT > W.DATA
            W.OUT > E.I0
            L.OUT > C.I0
            L.CF_OUT > M.CF_IN
            A.OUT > G.DATA
            G.OUT > N.I0
            G.FAILURE > K.CF_IN
            A.OUT > S.DATA
            S.O0 > Q.I0
            S.O1 > R.I0
            S.O2 > P.I0
            D.OUT > X.DATA
            X.O0 > H.I0
            X.O1 > N.I1",
        ),
    ));
}

#[test]
fn subprograms_have_states_of_their_own() {
    let main = diagram(
        "main",
        DiagramKind::Main,
        "A Sensor {VarName=sensorA1}
        D Sensor {VarName=sensorD1}
        one User block of delayed
        two User block of delayed
        S Servo motors {synch=true}
        A.OUT > one.I0
        D.OUT > two.I0
        one.O0 > S.S1
        two.O0 > S.S2",
    );
    let inner = diagram(
        "delayed",
        DiagramKind::Subprogram,
        "in Input port {identifier=I0}
        first Text programming {IO0=started = 1}
        wait Wait and send {time=50}
        out Output port {identifier=O0}
        in.OUT > wait.DATA
        wait.OUT > out.DATA",
    );
    both(&case("subprograms", &project(vec![main, inner])));
}

#[test]
fn encoders_count_from_what_they_are_told() {
    both(&case(
        "encoders",
        &main_only(
            "E Encoders
            A Sensor {VarName=sensorA2}
            I If {condition=data == 38}
            F Text programming {IO0=turned = I0 - I1}
            R Complex filter {count=2 | dispatchTime=200}
            M Motors {synch=false}
            A.OUT > I.DATA
            I.TRUE > E.E3_IN
            E.E3_OUT > F.I0
            E.E4_OUT > F.I1
            A.OUT > R.DATA
            R.FAILURE > E.CF_IN
            E.E4_OUT > M.M3",
        ),
    ));
}

#[test]
fn starts_and_parameters_that_come_as_tokens() {
    both(&case(
        "starts",
        &main_only(
            "A Sensor {VarName=sensorA1}
            D Sensor {VarName=sensorD1}
            I If {condition=data == 23}
            L Loop {time=30}
            W Wait and send {time=200}
            S Switch {cond0=sensorA1 > 22 | O0=z = sensorA1; z | cond1=sensorA1 < 21 | O1=}
            G Complex filter {count=3 | dispatchTime=40}
            V Flow replacer {time=40}
            X Variable {variable=kept = 1}
            N Text programming {IO0=last = I0}
            O Text programming {IO0=held = I0}
            P Text programming {IO0=gated = I0}
            Q Text programming {IO0=open = I0}
            T Text programming {IO0=own = I0; I0 = I0 + 1; more = I0 | IO1=I0}
            U Text programming {IO0=started = time()}
            M Motors {M1Power=150 | M2Power=-7}
            A.OUT > I.DATA
            I.TRUE > L.CF_IN
            A.OUT > L.FROM
            D.OUT > L.TO
            L.OUT > N.I0
            I.TRUE > W.CF_IN
            A.OUT > W.TIME
            W.CF_OUT > U.CF_IN
            A.OUT > W.DATA
            W.OUT > O.I0
            I.FALSE > S.CF_IN
            A.OUT > G.COUNT
            D.OUT > G.DISPATCH_TIME
            D.OUT > G.DATA
            G.OUT > P.I0
            A.OUT > V.TIME
            I.TRUE > V.REPLACE_DATA
            D.OUT > V.DATA
            V.OUT > Q.I0
            S.O0 > X.IN
            A.OUT > T.I0
            I.TRUE > M.CF_IN",
        ),
    ));
}

#[test]
fn the_last_digit_of_a_half_and_the_sign_of_nothing() {
    let texts = [
        "half = 0.49999999999999994 + 0*I0; half",
        "nothing = atan2(0*I0 // -5, -1); up = ceil(0 - I0/30); rest = (0 - I0) % I0; low = (0 - 2147483647 - 1) // (0 - 1 - 0*I0); s = sgn(0*I0); 0.3 - 0.6",
    ];
    let mut main = diagram(
        "main",
        DiagramKind::Main,
        "A Sensor {VarName=sensorA1}
        F Text programming
        M Motors {synch=false}
        A.OUT > F.I0
        F.O0 > M.M3
        F.O1 > M.M4",
    );
    for (at, text) in texts.iter().enumerate() {
        let property = format!("IO{at}");
        main.blocks[1]
            .properties
            .insert(property, (*text).to_owned());
    }
    both(&case("digits", &project(vec![main])));
}

#[test]
fn queues_lose_what_their_edges_say() {
    let mut main = diagram(
        "main",
        DiagramKind::Main,
        "A Sensor {VarName=sensorA1}
        D Sensor {VarName=sensorA2}
        I If {condition=data > 45}
        F Text programming {IO0=sum = I0 + 100 * I1}
        Z Zip flows
        U Unzip flows
        M Motors {synch=false}
        A.OUT > F.I0
        D.OUT > I.DATA
        I.TRUE > F.I1
        A.OUT > Z.DATA1
        I.TRUE > Z.DATA2
        Z.OUT > U.DATA
        U.OUT1 > M.M3",
    );
    for (edge, (policy, capacity)) in
        main.edges
            .iter_mut()
            .zip([(Policy::Latest, 1), (Policy::Fifo, 2), (Policy::Fifo, 1024)])
    {
        edge.policy = Some(policy);
        edge.capacity = Some(capacity);
    }
    both(&case("queues", &project(vec![main])));
}

#[test]
fn a_truth_of_unknown_type_is_no_number() {
    let end = "\nM Motors {synch=false}\nA.OUT > Z.DATA1\nA.OUT > Z.DATA2\nZ.OUT > U.DATA\nU.OUT1 > F.I0\nU.OUT2 > F.I1\nF.O0 > M.M3";
    let begin = "A Sensor {VarName=sensorA1}\nZ Zip flows\nU Unzip flows\nF Text programming {IO0=";
    for text in [
        "(I0 >= I1) * 20",
        "({I0, I1} == {I0, I1}) * 1",
        "-(not I0)",
        "I0 % (I1 == 1)",
        "max(I0 > 1, I1)",
        "I0 > 0 or (I0 == 1) + 1 > 0",
    ] {
        let whole = format!("{begin}{text}}}{end}");
        let (shown, why) = run(&case("truths", &main_only(&whole)));
        assert!(shown.is_empty(), "{text}");
        assert!(why.is_some_and(|why| why.contains("Type mismatch")));
        for fault in faults(&whole) {
            assert_eq!(fault, "F.I1: a truth is no number", "{text}");
        }
    }
}
