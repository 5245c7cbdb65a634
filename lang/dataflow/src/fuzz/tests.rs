//! Random programs: what holds for all of them.

use super::*;
use proptest::prelude::*;

#[test]
fn many_of_the_programs_that_are_made_may_run() {
    let ran = (0..400u32).filter(|seed| {
        let mut random = needs::Random::new(*seed);
        let bytes: Vec<u8> = (0..200).map(|_| random.byte()).collect();
        program(&bytes)
    });
    let ran = ran.count();
    assert!(ran > 20, "{ran} of 400");
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 400, ..ProptestConfig::default() })]

    #[test]
    fn programs_of_bytes_do_the_same_twice_and_after_they_were_written(
        bytes in proptest::collection::vec(any::<u8>(), 0..400)
    ) {
        program(&bytes);
    }

    #[test]
    fn strange_orders_to_a_debugger_do_no_harm(
        bytes in proptest::collection::vec(any::<u8>(), 0..600)
    ) {
        debugging(&bytes);
    }

    #[test]
    fn what_is_written_as_a_save_is_read_as_it_was(
        bytes in proptest::collection::vec(any::<u8>(), 0..300)
    ) {
        let project = project(&bytes);
        let written = save::save(&project).write().expect("a save");
        let opened = lang_diagram::read::read(&written).expect("a project");
        let (again, _) = read::project(&opened.save);
        // Edges of a save stand in the order of the blocks where they begin; one that begins nowhere, or at no port, is
        // kept loose.
        let ordered = |project: &Project| {
            let mut project = project.clone();
            project.meta.clear();
            for diagram in &mut project.diagrams {
                diagram.edges.retain(|edge| edge.from.is_some_and(|end| end.port != -1));
                diagram.edges.sort_by_key(|edge| edge.from.map_or(usize::MAX, |end| end.block));
                for edge in &mut diagram.edges {
                    edge.to = edge.to.filter(|end| end.port != -1);
                    edge.capacity = edge.capacity.filter(|&places| places > 0);
                }
            }
            text::write(&project)
        };
        prop_assert_eq!(ordered(&again), ordered(&project));
    }

    #[test]
    fn damaged_saves_are_read_or_refused(
        seed in proptest::collection::vec(any::<u8>(), 0..200),
        at in any::<prop::sample::Index>(),
        byte in any::<u8>(),
    ) {
        let mut bytes = save::save(&project(&seed)).write().expect("a save");
        let at = at.index(bytes.len());
        bytes[at] = byte;
        reader(&bytes);
    }
}

#[test]
fn what_fuzzing_of_the_debugger_begins_with_does_no_harm() {
    let seeds = [
        &include_bytes!("../../../../fuzz/seeds/flowdebug/flowdebug1")[..],
        include_bytes!("../../../../fuzz/seeds/flowdebug/flowdebug2"),
        include_bytes!("../../../../fuzz/seeds/flowdebug/flowdebug3"),
        include_bytes!("../../../../fuzz/seeds/flowdebug/flowdebug4"),
    ];
    seeds.into_iter().for_each(debugging);
}

#[test]
fn many_blocks_and_edges_take_bounded_time() {
    use crate::machine::fixtures::{diagram, project};
    // 10,000 blocks in a row, each with an edge to the next.
    let mut text = String::from("V Value generator\n");
    for at in 0..10_000 {
        text.push_str(&format!("W{at} Wait and send\n"));
    }
    text.push_str("V.OUT > W0.DATA\n");
    let mut main = diagram("main", DiagramKind::Main, &text);
    for at in 1..10_000 {
        let mut edge = main.edges[0].clone();
        edge.from = Some(End { block: at, port: 3 });
        edge.to = Some(End {
            block: at + 1,
            port: 2,
        });
        main.edges.push(edge);
    }
    let checked = check(&project(vec![main]));
    assert!(!checked.has_errors(), "{:?}", checked.problems.first());
    let mut machine = Machine::new(Rc::new(checked.program));
    let mut robot = Robot::new(&[]);
    for step in 0..100 {
        machine.step(step * 10, &mut robot, &mut Deaf);
    }
    assert_eq!(machine.status(), Status::Running);
    // A fan of edges that multiply themselves ends with an error, not with all memory.
    let mut fan = diagram(
        "main",
        DiagramKind::Main,
        "V Value generator\nA If {condition=true}\nB If {condition=true}\nV.OUT > A.DATA",
    );
    for _ in 0..300 {
        for (from, to) in [(1, 2), (2, 1)] {
            let mut edge = fan.edges[0].clone();
            edge.from = Some(End {
                block: from,
                port: 2,
            });
            edge.to = Some(End { block: to, port: 1 });
            fan.edges.push(edge);
        }
    }
    let checked = check(&project(vec![fan]));
    let mut machine = Machine::new(Rc::new(checked.program));
    machine.step(0, &mut robot, &mut Deaf);
    assert!(matches!(
        machine.status(),
        Status::Ended {
            with_errors: true,
            ..
        }
    ));
}
