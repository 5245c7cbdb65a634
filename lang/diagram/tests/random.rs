//! Projects made at random: written and read again, changed, and with strange texts in all places.

use lang_diagram::project::Project;
use lang_diagram::read::read;
use lang_diagram::sketch::Sketch;
use proptest::collection::vec;
use proptest::prelude::*;

const KINDS: [&str; 6] = [
    "InitialNode",
    "Timer",
    "IfBlock",
    "Function",
    "Fork",
    "FinalNode",
];

/// A text that XML can carry.
fn text() -> impl Strategy<Value = String> {
    "[\\PC\n\t<>&\"']{0,12}"
}

/// A block: which kind, and a property.
fn block() -> impl Strategy<Value = (usize, String, String)> {
    (0..KINDS.len(), "[A-Za-z]{1,6}", text())
}

/// A link between blocks by their numbers; some ends hang loose.
fn link() -> impl Strategy<Value = (Option<usize>, Option<usize>, String)> {
    let end = || prop::option::weighted(0.9, 0..20_usize);
    (end(), end(), text())
}

fn sketch() -> impl Strategy<Value = Sketch> {
    let parameter = (text(), text(), text());
    let diagram = (
        vec(block(), 1..12),
        vec(link(), 0..20),
        vec(parameter, 0..3),
    );
    (vec(diagram, 1..4), text()).prop_map(|(diagrams, world)| {
        let mut sketch = Sketch::new();
        sketch.world(&world);
        for (at, (blocks, links, parameters)) in diagrams.iter().enumerate() {
            let sheet = if at == 0 {
                sketch.main()
            } else {
                let parameters: Vec<_> = parameters
                    .iter()
                    .map(|(name, kind, default)| (&**name, &**kind, &**default))
                    .collect();
                sketch.subprogram("sub", &parameters)
            };
            let mut spots: Vec<_> = blocks
                .iter()
                .map(|(kind, key, value)| sketch.block(KINDS[*kind], &[(key, value)]))
                .collect();
            let arguments: Vec<&str> = parameters.iter().map(|one| &*one.2).collect();
            spots.push(sketch.call(sheet, &arguments));
            for (from, to, guard) in links {
                let spot = |end: &Option<usize>| end.map(|end| spots[end % spots.len()]);
                sketch.connect(spot(from), spot(to), guard);
            }
        }
        sketch
    })
}

fn read_again(bytes: &[u8]) -> Project {
    let opened = read(bytes).unwrap_or_else(|problems| panic!("{problems:?}"));
    assert_eq!(opened.problems, []);
    opened.project
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(64))]

    #[test]
    fn what_is_written_is_read_as_the_same(sketch in sketch()) {
        let bytes = sketch.qrs().unwrap();
        prop_assert_eq!(read_again(&bytes), sketch.project());
        prop_assert_eq!(read(&bytes).unwrap().save.write().unwrap(), bytes);
    }

    #[test]
    fn a_changed_property_is_the_only_thing_that_changes(
        sketch in sketch(), which in any::<prop::sample::Index>(), value in text()
    ) {
        let mut opened = read(&sketch.qrs().unwrap()).unwrap();
        let mut expected = opened.project.clone();
        let blocks = &mut expected.diagrams[0].blocks;
        let block = which.index(blocks.len());
        blocks[block].properties.insert("Power".to_owned(), value.clone());
        opened.save.set_property(&blocks[block].id, "Power", &value).unwrap();
        prop_assert_eq!(read_again(&opened.save.write().unwrap()), expected);
    }

    #[test]
    fn orphans_of_any_project_are_none(sketch in sketch()) {
        let mut save = read(&sketch.qrs().unwrap()).unwrap().save;
        prop_assert_eq!(save.orphans(), []);
        prop_assert_eq!(save.recover_orphans(), 0);
        prop_assert_eq!(save.remove_orphans(), 0);
    }

    #[test]
    fn strange_orders_to_a_debugger_do_no_harm(bytes in vec(any::<u8>(), 0..600)) {
        lang_diagram::fuzz::debugging(&bytes);
    }

    #[test]
    fn changes_of_a_person_are_taken_back_and_made_again(bytes in vec(any::<u8>(), 0..1500)) {
        lang_diagram::fuzz::edits(&bytes);
    }

    #[test]
    fn strange_bytes_do_no_harm(bytes in vec(any::<u8>(), 0..300)) {
        lang_diagram::fuzz::reader(&bytes);
    }

    #[test]
    fn strange_files_do_no_harm(
        files in vec(("(metaInfo.xml|worldModel.xml|tree/(logical|graphical)/[a-z./\\\\]{0,6})", "[<>/=\"'&;a-c \n!-]{0,60}"), 0..6)
    ) {
        let parts: Vec<String> = files.into_iter().flat_map(|(name, text)| [name, text]).collect();
        lang_diagram::fuzz::reader(parts.join("\0").as_bytes());
    }
}
