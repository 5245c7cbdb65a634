//! What is known of variables before anything runs, by the texts and tokens that give them values.

use super::*;

/// What a function computes is known only after the blocks before it; its texts and those of others that read its
/// variables wait for that.
#[test]
fn variables_are_read_after_what_gives_them_their_type_is_understood() {
    let inner = diagram(
        "inner",
        DiagramKind::Subprogram,
        "IN Input port\nF Text programming {IO0=e = I0; i = i + e | IO1=u = 2*e + i; u}\nOUT Output port\nIN.OUT > F.I0\nF.O1 > OUT.DATA",
    );
    let main = diagram(
        "main",
        DiagramKind::Main,
        "V Variable {variable=i = 0}\nA Sensor\nB Sensor {VarName=sensorA2}\nF Text programming {IO0=I0 - I1}\nC User block of inner\nM Motors\nA.OUT > F.I0\nB.OUT > F.I1\nF.O0 > C.I0\nC.O0 > M.M3",
    );
    assert_eq!(told_of(&project(vec![main, inner])), Vec::<String>::new());
    // Of the items of a list nobody knows what they are.
    for text in [
        "L Sensor\nV Text programming {IO0={I0, 1}}\nS Text programming {IO0=x = I0[0]; y = I0[1] | IO1=x + y}\nM Motors\nL.OUT > V.I0\nV.O0 > S.I0\nS.O1 > M.M3",
        "A Variable {variable=k}\nL Sensor\nF Text programming {IO0=k*I0}\nM Motors\nL.OUT > A.IN\nL.OUT > F.I0\nF.O0 > M.M3",
    ] {
        assert_eq!(told(text), Vec::<String>::new(), "{text}");
    }
}

#[test]
fn a_variable_has_the_type_of_the_tokens_that_it_gets() {
    // A text is no number, in whatever order the blocks stand, through a subprogram and through another variable.
    for text in [
        "C Value generator {varValue=north}\nV Variable {variable=k}\nL Sensor\nF Text programming {IO0=k*I0}\nM Motors\nC.OUT > V.IN\nL.OUT > F.I0\nF.O0 > M.M3",
        "F Text programming {IO0=k*I0}\nL Sensor\nM Motors\nV Variable {variable=k}\nC Value generator {varValue=north}\nC.OUT > V.IN\nL.OUT > F.I0\nF.O0 > M.M3",
        "C Value generator {varValue=north}\nW Variable {variable=j}\nV Variable {variable=k}\nL Sensor\nF Text programming {IO0=k*I0}\nM Motors\nC.OUT > W.IN\nW.OUT > V.IN\nL.OUT > F.I0\nF.O0 > M.M3",
    ] {
        only(
            text,
            "error: main: Text programming 'F': 'IO0', 1:1 Type mismatch",
        );
    }
    only(
        "L Object detector\nZ Zip flows\nA Sensor\nB Sensor {VarName=sensorA2}\nV Variable {variable=k}\nM Motors\nS Say\nA.OUT > Z.DATA1\nB.OUT > Z.DATA2\nA.OUT > V.IN\nV.OUT > P.COORDS\nP Draw pixel\nZ.OUT > P.COORDS\nL.OUT > U.DATA\nU Unzip flows\nU.OUT1 > S.DATA",
        "error: main: Draw pixel 'P': 'COORDS': a whole number comes here, but a list of 2 is needed",
    );
    for good in [
        "L Sensor\nV Variable {variable=k}\nF Text programming {IO0=k*I0}\nM Motors\nL.OUT > V.IN\nL.OUT > F.I0\nF.O0 > M.M3",
        // A number may become another number, and come back.
        "C Value generator {varValue=1}\nL Sensor\nV Variable {variable=k}\nF Text programming {IO0=k*I0/2}\nM Motors\nC.OUT > V.IN\nF.O0 > V.IN\nL.OUT > F.I0\nF.O0 > M.M3",
        // Of what it gets nobody knows the kind.
        "C Value generator {varValue=north}\nL Sensor\nV Variable {variable=k}\nF Text programming {IO0=k*I0}\nM Motors\nC.OUT > V.IN\nL.OUT > V.IN\nL.OUT > F.I0\nF.O0 > M.M3",
        "C Message receiver\nL Sensor\nV Variable {variable=n; t}\nF Text programming {IO0=n*I0}\nM Motors\nC.OUT > V.IN\nL.OUT > F.I0\nF.O0 > M.M3",
    ] {
        let found = told(good);
        let is_error = |one: &String| one.starts_with("error");
        assert!(!found.iter().any(is_error), "{good}\n{found:#?}");
    }
}

#[test]
fn a_type_of_which_more_is_known_later_is_no_type() {
    // V looks like a whole number until what F makes of it has come back as a list.
    let text = "C Value generator {varValue=1}\nL Sensor\nV Variable {variable=k}\nF Text programming {IO0={I0, 1}}\nM Motors\nG Text programming {IO0=k .. I0}\nS Say\nC.OUT > V.IN\nV.OUT > F.I0\nF.O0 > V.IN\nL.OUT > G.I0\nG.O0 > S.DATA";
    let found = told(text);
    assert!(
        found.len() == 1 && found[0].contains("tokens can run around"),
        "{found:#?}"
    );
}

#[test]
fn tokens_that_a_variable_cannot_take_are_told() {
    only(
        "A Sensor\nV Variable {variable=x; y}\nS Say\nA.OUT > V.IN\nV.OUT > S.DATA",
        "error: main: Variable 'V': 'IN': a whole number comes here, but its 2 variables take the items of a list",
    );
    only(
        "A Sensor\nB Sensor {VarName=sensorA2}\nZ Zip flows\nV Variable {variable=x; y; z}\nS Say\nA.OUT > Z.DATA1\nB.OUT > Z.DATA2\nZ.OUT > V.IN\nV.OUT > S.DATA",
        "error: main: Variable 'V': 'IN': a list of 2 comes here, but it has 3 variables",
    );
    // Whichever comes second ends the program.
    only(
        "C Value generator {varValue=north}\nL Sensor\nV Variable {variable=k}\nW Variable {variable=k}\nS Say\nC.OUT > V.IN\nL.OUT > W.IN\nW.OUT > S.DATA",
        "warning: main: Variable 'W': 'IN': a whole number comes here, but `k` gets a text elsewhere",
    );
    only(
        "C Value generator {varValue=north}\nI Variable {variable=k = 0}\nW Variable {variable=k}\nS Say\nC.OUT > W.IN\nW.OUT > S.DATA",
        "warning: main: Variable 'W': 'IN': a text comes here, but `k` gets a whole number elsewhere",
    );
    // Nothing starts this assignment.
    assert_eq!(
        told(
            "C Value generator {varValue=north}\nV Variable {variable=k = 0}\nS Say\nC.OUT > V.IN\nV.OUT > S.DATA"
        ),
        Vec::<String>::new()
    );
}

#[test]
fn what_is_wrong_with_known_types_is_still_told() {
    only(
        "A Sensor\nF Text programming {IO0=e = I0 | IO1=e + 'a'}\nS Say\nA.OUT > F.I0\nF.O1 > S.DATA",
        "error: main: Text programming 'F': 'IO1', 1:1 Type mismatch",
    );
}

#[test]
fn texts_that_wait_for_each_other_are_looked_at_all_the_same() {
    // Both read and give n, and nobody else gives it a value.
    let both = "A Sensor\nF Text programming {IO0=n = n + I0; {n, n}}\nG Text programming {IO0=n = n - I0}\nM Motors\nA.OUT > F.I0\nA.OUT > G.I0\nF.O0 > M.M3";
    let found = told(both);
    assert!(found.iter().any(|one| one.contains("list")), "{found:#?}");
    let circle = "A Sensor\nF Text programming {IO0=x = y + I0}\nG Text programming {IO0=y = x + 1; 1 + 'a'}\nS Say\nA.OUT > F.I0\nA.OUT > G.I0\nG.O0 > S.DATA";
    let found = told(circle);
    assert!(
        found.iter().any(|one| one.contains("mismatch")),
        "{found:#?}"
    );
}

#[test]
fn a_chain_of_variables_is_followed_in_whatever_order_it_stands() {
    let chain = "A Sensor\nF Text programming {IO0=e + 'x' + I0}\nS Say\nE Variable {variable=e = d + 1}\nD Variable {variable=d = c + 1}\nC Variable {variable=c = b + 1}\nB Variable {variable=b = a + 1}\nZ Variable {variable=a = 0}\nA.OUT > F.I0\nF.O0 > S.DATA";
    let found = told(chain);
    assert!(
        found.iter().any(|one| one.contains("mismatch")),
        "{found:#?}"
    );
}

#[test]
fn many_blocks_that_give_one_variable_cost_what_they_are() {
    let mut text = "I Variable {variable=x = 0}\n".to_owned();
    for number in 0..20_000 {
        text += &format!("V{number} Variable {{variable=x = x + 1}}\n");
    }
    // Looking at each giver for each reader would be half a milliard looks in each pass.
    only(
        &text,
        "warning: main: Variable 'V9999': more than 10000 reactions",
    );
}

#[test]
fn a_name_that_stands_at_many_places_is_compared_once() {
    let variables: Vec<String> = (0..100).map(|at| format!("speed{at} = 1")).collect();
    let found = told(&format!(
        "K Variable {{variable={}; Kp = 2}}\nA Sensor\nF Text programming {{IO0=I0{} + kp}}\nS Say\nA.OUT > F.I0\nF.O0 > S.DATA",
        variables.join("; "),
        " + zzz".repeat(60),
    ));
    assert!(
        found
            .iter()
            .any(|one| one.ends_with("kp is never given a value; did you mean 'Kp'?")),
        "{found:#?}"
    );
}
