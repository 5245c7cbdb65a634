//! Tokens that do not fit are told of where they arrive, also if they come through subprograms.

use super::*;

/// A main diagram with the subprograms `inner` and `outer`, of which `outer` calls `inner`.
fn nested(main: &str, inner: &str) -> Vec<String> {
    let outer = "I Input port\nJ Input port {identifier=I1}\nC User block of inner\nO Output port\nP Output port {identifier=O1}\nI.OUT > C.I0\nJ.OUT > C.I1\nC.O0 > O.DATA\nC.O1 > P.DATA";
    told_of(&project(vec![
        diagram("main", DiagramKind::Main, main),
        diagram("outer", DiagramKind::Subprogram, outer),
        diagram("inner", DiagramKind::Subprogram, inner),
    ]))
}

fn errors(told: Vec<String>) -> Vec<String> {
    let errors = told.into_iter().filter(|one| one.starts_with("error"));
    errors.collect()
}

const LIST: &str = "'M3': a list comes here, but a whole number is needed";

#[test]
fn a_list_among_numbers_is_found_behind_a_subprogram() {
    // Both go out of the same port, made inside.
    let told = nested(
        "A Sensor\nC User block of outer\nM Motors\nA.OUT > C.I0\nC.O0 > M.M3",
        "I Input port\nF Text programming {IO0={I0, 2}}\nO Output port\nP Output port\nI.OUT > F.I0\nI.OUT > O.DATA\nF.O0 > P.DATA",
    );
    assert_eq!(errors(told), [format!("error: main: Motors 'M': {LIST}")]);
    // Both come in by the same port, and the motors are inside.
    let told = nested(
        "A Sensor\nB Sensor {VarName=lineSensor}\nC User block of outer\nA.OUT > C.I0\nB.OUT > C.I0",
        "I Input port\nM Motors\nI.OUT > M.M3",
    );
    assert_eq!(errors(told), [format!("error: inner: Motors 'M': {LIST}")]);
    // Numbers of several kinds are right.
    let told = nested(
        "A Sensor\nF Text programming {IO0=I0 / 2.5}\nC User block of outer\nM Motors\nA.OUT > F.I0\nA.OUT > C.I0\nF.O0 > C.I0\nC.O0 > M.M3",
        "I Input port\nO Output port\nI.OUT > O.DATA",
    );
    assert_eq!(errors(told), Vec::<String>::new());
}

#[test]
fn a_list_that_a_function_hands_on_stays_a_list() {
    for text in ["I0", "n = 1; I0"] {
        let told = nested(
            "V Text programming {IO0={1, 2}}\nC User block of outer\nV.O0 > C.I0",
            &format!(
                "I Input port\nF Text programming {{IO0={text}}}\nM Motors\nI.OUT > F.I0\nF.O0 > M.M3"
            ),
        );
        assert_eq!(
            errors(told),
            [format!("error: inner: Motors 'M': {LIST}")],
            "{text}"
        );
    }
}

#[test]
fn a_word_is_looked_at_behind_a_subprogram() {
    let told = nested(
        "G Value generator {varValue=green}\nP Value generator {varValue=pink}\nC User block of outer\nL Led\nG.OUT > C.I0\nP.OUT > C.I0\nC.O0 > L.DATA",
        "I Input port\nO Output port\nI.OUT > O.DATA",
    );
    assert_eq!(
        errors(told),
        ["error: main: Led 'L': 'DATA': 'pink' is none of off, green, orange, red"]
    );
}
