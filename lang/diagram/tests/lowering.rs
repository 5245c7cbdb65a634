//! Random projects through check, lowering and machine.

use lang_diagram::fuzz::{lowering, project};
use proptest::prelude::*;

proptest! {
    #![proptest_config(ProptestConfig::with_cases(400))]

    #[test]
    fn any_bytes_are_a_project_that_does_no_harm(bytes in proptest::collection::vec(any::<u8>(), 0..400)) {
        lowering(&bytes);
    }

    /// Mostly links between few blocks: these run on.
    #[test]
    fn well_linked_projects_do_no_harm(
        first in any::<u8>(),
        blocks in proptest::collection::vec((4_u8..90, any::<[u8; 6]>()), 1..12),
        links in proptest::collection::vec((0_u8..12, 0_u8..12, 0_u8..16), 1..30),
    ) {
        let mut bytes = vec![first, 0];
        for (kind, rest) in blocks {
            bytes.push(kind);
            bytes.extend(rest);
        }
        for (from, to, guard) in links {
            bytes.extend([200, from, to, guard, 0]);
        }
        lowering(&bytes);
    }
}

#[test]
fn bytes_say_blocks_and_links() {
    // An If whose condition is the text with number 12, and a link from the start to it.
    let rows = lang_diagram::blocks::table();
    let index = rows.take_while(|row| row.kind != "IfBlock").count() as u8;
    let project = project(&[0, 4 + index, 1, 12, 200, 0, 1, 0, 0]);
    let diagram = &project.diagrams[0];
    assert_eq!(diagram.blocks[1].properties["Condition"], "x > 0");
    assert_eq!(diagram.links[0].to, Some(1));
    assert_eq!(
        (
            diagram.blocks[0].outgoing.len(),
            diagram.blocks[1].incoming.len()
        ),
        (1, 1)
    );
}
