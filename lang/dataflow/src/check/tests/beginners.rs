//! Mistakes that are typical of who draws a first program: each is told once, at its cause.

use super::*;

fn one(found: &[String], wanted: &str) {
    assert!(
        found.len() == 1 && found[0].starts_with(wanted),
        "{wanted}\n{found:#?}"
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
