//! How large a program may be, and what is said of one that is larger.

use super::*;
use crate::project::End;
use std::fmt::Write;

/// Blocks `b0`, `b1` and so on, all alike.
fn blocks(count: usize, what: &str) -> String {
    let mut text = String::new();
    for at in 0..count {
        let _ = writeln!(text, "b{at} {what}");
    }
    text
}

/// A chain of so many blocks `Say`, each of which starts the next one.
fn chain(count: usize) -> crate::project::Diagram {
    let text = blocks(count, "Say {text=a}") + "b0.CF_OUT > b1.CF_IN";
    let mut main = diagram("main", DiagramKind::Main, &text);
    let first = main.edges[0].clone();
    for at in 1..count - 1 {
        let mut edge = first.clone();
        edge.id = format!("qrm:/edge/{at}");
        edge.from = edge.from.map(|end| End { block: at, ..end });
        edge.to = edge.to.map(|end| End {
            block: at + 1,
            ..end
        });
        main.edges.push(edge);
    }
    main
}

#[test]
fn a_program_with_too_many_names_is_told_before_it_runs() {
    let mut text = blocks(3000, "If {condition=data > 1}") + "V Value generator {varValue=1}\n";
    for at in 0..3000 {
        let _ = writeln!(text, "V.OUT > b{at}.DATA");
    }
    let main = diagram("main", DiagramKind::Main, &text);
    let told = told_of(&project(vec![main]));
    assert!(told.iter().all(|one| !one.starts_with("error")), "{told:?}");
    let mut text = blocks(4000, "If {condition=data > 1}") + "V Value generator {varValue=1}\n";
    for at in 0..4000 {
        let _ = writeln!(text, "V.OUT > b{at}.DATA");
    }
    let main = diagram("main", DiagramKind::Main, &text);
    let told = told_of(&project(vec![main]));
    assert!(
        told[0].starts_with("error: main: If 'b3")
            && told[0].contains("the program has more than 4096 names"),
        "{told:?}"
    );
}

#[test]
fn names_of_variables_count_too() {
    let statements: Vec<String> = (0..4200).map(|at| format!("v{at} = 1")).collect();
    let told = told(&format!(
        "V Variable {{variable={}}}",
        statements.join("; ")
    ));
    assert!(
        told[0].starts_with("error: main: Variable 'V': the program has more than 4096 names"),
        "{told:?}"
    );
}

#[test]
fn a_long_chain_in_one_instant_is_told_and_is_no_cycle() {
    assert_eq!(told_of(&project(vec![chain(10_000)])), Vec::<String>::new());
    assert_eq!(
        told_of(&project(vec![chain(10_001)])),
        [
            "warning: main: Say 'b10000': more than 10000 reactions of blocks come in one instant, which is all that there is room for: let some of them wait"
        ]
    );
}

/// An edge between ports by their names.
fn edge(diagram: &mut crate::project::Diagram, from: (usize, &str), to: (usize, &str)) {
    let end = |(block, port): (usize, &str)| {
        let row = diagram.blocks[block].row.expect("a row");
        let port = i32::from(row.port(port).expect("a port"));
        Some(End { block, port })
    };
    let (from, to) = (end(from), end(to));
    diagram.edges.push(crate::project::Edge {
        id: format!("qrm:/edge/{}", diagram.edges.len()),
        from,
        to,
        policy: None,
        capacity: None,
        path: Vec::new(),
        gone: None,
    });
}

/// One token becomes 5000, and each of those 90,000: no more of them wait than there is room for.
#[test]
fn an_instant_that_grows_without_end_is_told_before_it_is_gone_through() {
    const MIDDLE: usize = 5000;
    let text = format!(
        "G Value generator\nV Value generator\n{}{}",
        blocks(MIDDLE, "Value generator"),
        blocks(90_000, "Say {text=a}")
    );
    let mut main = diagram("main", DiagramKind::Main, &text);
    for at in 2..2 + MIDDLE {
        edge(&mut main, (0, "OUT"), (at, "CF_IN"));
        edge(&mut main, (at, "OUT"), (1, "CF_IN"));
    }
    for at in 2 + MIDDLE..main.blocks.len() {
        edge(&mut main, (1, "OUT"), (at, "CF_IN"));
    }
    assert_eq!(
        told_of(&project(vec![main])),
        [
            "warning: main: Value generator 'V': more than 10000 reactions of blocks come in one instant, which is all that there is room for: let some of them wait"
        ]
    );
}

/// Edges into queues let nothing react, and there may be many of them.
#[test]
fn edges_of_an_instant_are_looked_at_up_to_a_bound() {
    const MIDDLE: usize = 600;
    const SAY: usize = 20;
    let busy = |queues: usize| {
        let text = format!(
            "G Value generator\nV Value generator\n{}",
            blocks(MIDDLE, "Value generator")
        );
        let mut main = diagram("main", DiagramKind::Main, &text);
        let say = diagram("say", DiagramKind::Main, &blocks(SAY, "Say {text=a}"));
        let waits = blocks(queues, "Text programming {IO0=I0}");
        let waits = diagram("waits", DiagramKind::Main, &waits);
        main.blocks.extend(waits.blocks);
        main.blocks.extend(say.blocks);
        for at in 2..2 + MIDDLE {
            edge(&mut main, (0, "OUT"), (at, "CF_IN"));
            edge(&mut main, (at, "OUT"), (1, "CF_IN"));
        }
        for at in 2 + MIDDLE..2 + MIDDLE + queues {
            edge(&mut main, (1, "OUT"), (at, "I0"));
        }
        for at in 2 + MIDDLE + queues..main.blocks.len() {
            edge(&mut main, (1, "OUT"), (at, "CF_IN"));
        }
        let told = told_of(&project(vec![main]));
        told.iter().any(|one| one.contains("come in one instant"))
    };
    assert!(busy(100));
    assert!(!busy(crate::limits::INSTANT_LOOKS_MAX / 430));
}

/// Each edge of the call stands for all output ports of its name: together they would be billions.
#[test]
fn many_output_ports_and_many_edges_of_a_call_cost_what_they_are() {
    let text = format!("C User block of body\n{}", blocks(49_000, "Say {text=a}"));
    let mut main = diagram("main", DiagramKind::Main, &text);
    for at in 1..main.blocks.len() {
        edge(&mut main, (0, "O0"), (at, "CF_IN"));
    }
    let body = blocks(50_000, "Output port");
    let body = diagram("body", DiagramKind::Subprogram, &body);
    let told = told_of(&project(vec![main, body]));
    assert!(!told.is_empty());
    for one in told {
        assert!(one.starts_with("warning: body: Output port 'b"), "{one}");
    }
}

#[test]
fn many_rings_of_two_cost_what_they_are() {
    let text = blocks(20_000, "Wait and send");
    let mut main = diagram("main", DiagramKind::Main, &text);
    for at in (0..main.blocks.len()).step_by(2) {
        edge(&mut main, (at, "CF_OUT"), (at + 1, "CF_IN"));
        edge(&mut main, (at + 1, "CF_OUT"), (at, "CF_IN"));
    }
    let told = told_of(&project(vec![main]));
    assert!(!told.is_empty());
    for (at, one) in told.iter().enumerate() {
        let wanted = format!("warning: main: Wait and send 'b{}': 'CF_IN'", 2 * at);
        assert!(one.starts_with(&wanted), "{wanted}: {one}");
    }
}

#[test]
fn a_constant_is_a_token_and_no_longer_than_one() {
    let list = |items: usize| {
        let items = vec!["1"; items].join(",");
        format!(
            "V Value generator {{varValue=[{items}]}}\nL Text programming {{IO0=#I0}}\nV.OUT > L.I0"
        )
    };
    let errors = |text: &str| -> Vec<String> {
        let told = told(text).into_iter();
        told.filter(|one| one.starts_with("error")).collect()
    };
    assert_eq!(errors(&list(4096)), Vec::<String>::new());
    assert_eq!(
        errors(&list(4097)),
        [
            "error: main: Value generator 'V': 'data': this value is too large for a token: a list has at most 4096 items, a text at most 65536 bytes"
        ]
    );
}

#[test]
fn a_text_that_is_a_number_is_told_where_a_number_is_wanted() {
    for gives in [
        "V Value generator {varValue='50'}\nM Servo motors\nV.OUT > M.S1",
        "V Text programming {IO0=\"50\"}\nM Servo motors\nV.O0 > M.S1",
    ] {
        only(
            gives,
            "warning: main: Servo motors 'M': 'S1': a text comes here that is a number, and counts as that",
        );
    }
    only(
        "V Text programming {IO0=\"fast\"}\nM Motors\nV.O0 > M.M3",
        "error: main: Motors 'M': 'M3': a text comes here, but a whole number is needed",
    );
}

#[test]
fn numbers_beyond_what_a_property_takes_are_numbers() {
    for number in ["-2147483648", "2147483648", "1e300", "1e400"] {
        only(
            &format!("L Loop {{start_border={number}}}\nS Say\nL.OUT > S.DATA"),
            &format!(
                "error: main: Loop 'L': 'start_index': {number} is beyond the numbers that this property takes: -2147483647 to 2147483647"
            ),
        );
    }
    only(
        "L Loop {increment=1e300}\nS Say\nL.OUT > S.DATA",
        "error: main: Loop 'L': 'increment_step': 1e300 is beyond",
    );
    only(
        "L Loop {end_border=inf}\nS Say\nL.OUT > S.DATA",
        "error: main: Loop 'L': 'border': 'inf' is not a number, and",
    );
}

#[test]
fn numbers_that_do_not_fit_where_they_come_are_told_there() {
    for (text, wanted) in [
        (
            "V Value generator {varValue=1e6}\nW Wait and send\nM Motors\nV.OUT > M.M3\nM.CF_OUT > W.CF_IN",
            "warning: main: Motors 'M': 'M3': a power of 1000000 counts as 100: write a number from -100 to 100",
        ),
        (
            "V Text programming {IO0=0 - 101}\nW Wait and send\nM Specific input\nV.O0 > M.DATA\nM.CF_OUT > W.CF_IN",
            "warning: main: Specific input 'M': 'DATA': a power of -101 counts as -100: write a number from -100 to 100",
        ),
        (
            "V Value generator {varValue=1e10}\nW Wait and send\nV.OUT > W.TIME\nS Sensor\nS.OUT > W.DATA\nT Say\nW.OUT > T.DATA",
            "error: main: Wait and send 'W': 'TIME': 1e+10 is too large: whole numbers are from -2147483647 to 2147483647",
        ),
        (
            "V Text programming {IO0=60 * 60 * 1000 * 1000}\nW Wait and send\nV.O0 > W.TIME\nS Sensor\nS.OUT > W.DATA\nT Say\nW.OUT > T.DATA",
            "error: main: Wait and send 'W': 'TIME': 3.6e+09 is too large: whole numbers are from -2147483647 to 2147483647",
        ),
    ] {
        only(text, wanted);
    }
    for text in [
        "V Value generator {varValue=100}\nW Wait and send\nM Motors\nV.OUT > M.M3\nM.CF_OUT > W.CF_IN",
        // An angle has the range of its servo, which the configuration says.
        "V Value generator {varValue=120}\nW Wait and send\nM Servo motors\nV.OUT > M.S1\nM.CF_OUT > W.CF_IN",
    ] {
        assert_eq!(told(text), Vec::<String>::new(), "{text}");
    }
}
