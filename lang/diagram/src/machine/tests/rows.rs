//! Every block of the table: its examples as small programs, and that it tells nothing where it is silent.

use std::collections::HashMap;
use std::rc::Rc;

use super::{Machine, Options, STEP_MS, Sketch, Spot, StandIn, Status, chain, run_with};
use crate::blocks::example::{Example, Stimulus};
use crate::blocks::wait::Every;
use crate::blocks::{Does, Row, Silent, find, table};
use crate::generate::{Language, generate};
use crate::lower::{World, lower};
use crate::machine::trace::Deaf;
use crate::ports::{Kit, Port};
use crate::show::picture::picture;
use crate::stand_in::Placing;
use lang_text::problem::Locale;

/// How long an example may run.
const ENOUGH_MS: u32 = 2000;

/// Where a block does what its examples say: not where it is silent.
fn world(row: &Row) -> World {
    match row.silent {
        Silent::Simulated | Silent::WithoutMailbox | Silent::WithoutGamepad => World::Robot,
        Silent::Never | Silent::Real | Silent::Always => World::default(),
    }
}

/// The diagram of an example.
fn drawn(row: &Row, example: &Example) -> Sketch {
    let mut sketch = Sketch::new();
    let is_newer = row.is_of(Kit::V62);
    let kit = if is_newer { "trikV62Kit" } else { "trikV6Kit" };
    sketch.meta("lastKitId", kit);
    let (main, called) = match example.diagram.split_once('|') {
        None => (example.diagram, None),
        Some((main, inner)) => {
            let called = sketch.subprogram("inner", &[]);
            draw(&mut sketch, inner, |_| panic!("it calls itself"));
            sketch.draw_on(sketch.main());
            (main, Some(called))
        }
    };
    draw(&mut sketch, main, |sketch| match called {
        None => sketch.block(row.kind, example.properties),
        Some(called) => sketch.call(called, &[]),
    });
    sketch
}

/// Blocks and links of one sheet.
fn draw(sketch: &mut Sketch, diagram: &str, mut itself: impl FnMut(&mut Sketch) -> Spot) {
    let mut spots: HashMap<&str, Spot> = HashMap::new();
    for chain in diagram.split(';') {
        let mut last = None;
        for word in chain.split_whitespace() {
            if let Some(arrow) = word.strip_suffix('>') {
                let (from, guard) = last.take().expect("an arrow begins at a block");
                assert_eq!(guard, None, "{diagram}: two arrows");
                last = Some((from, Some(arrow.trim_start_matches('='))));
                continue;
            }
            let spot = *spots.entry(word).or_insert_with(|| match word {
                "*" => itself(sketch),
                "start" => sketch.block("InitialNode", &[]),
                "end" => sketch.block("FinalNode", &[]),
                word if word.starts_with(char::is_uppercase) => other(sketch, word),
                statement => sketch.block("Function", &[("Body", statement)]),
            });
            if let Some((from, guard)) = last.replace((spot, None)) {
                sketch.guarded(from, spot, guard.expect("blocks are divided by arrows"));
            }
        }
    }
}

/// A block with the properties that its word has.
fn other(sketch: &mut Sketch, word: &str) -> Spot {
    let (kind, properties) = word.split_once(':').unwrap_or((word, ""));
    assert!(find(kind).is_some(), "{kind}");
    let properties = properties.split(',').filter(|text| !text.is_empty());
    let properties: Vec<_> = properties
        .map(|property| property.split_once('=').expect("a name and a value"))
        .collect();
    sketch.block(kind, &properties)
}

fn give(robot: &mut StandIn, given: Stimulus) {
    let named = |port| Port::named(port).unwrap_or_else(|| panic!("no port {port}"));
    match given {
        Stimulus::Number(port, number) => drop(robot.readings.insert(named(port), number)),
        Stimulus::Numbers(port, numbers) => {
            robot.vectors.insert(named(port), numbers.to_vec());
        }
        Stimulus::Mail(text) => robot.mail.push_back(text.into()),
        Stimulus::Answer(text) => robot.answers.push_back(text.into()),
        Stimulus::Random(number) => robot.randoms.push_back(number),
    }
}

/// Runs an example: what was told, errors, and when it ended.
fn played(row: &Row, example: &Example) -> (Vec<String>, Vec<String>, Option<u32>) {
    let world = world(row);
    let lowered = lower(&drawn(row, example).project(), world).unwrap();
    let mut machine = Machine::new(Rc::new(lowered.program), Options::of(world));
    let mut robot = StandIn::new(Placing::default());
    let mut given = example.given.iter().peekable();
    let mut end = None;
    for now in (0..=ENOUGH_MS).step_by(STEP_MS as usize) {
        if now > 0 {
            robot.tick();
        }
        while let Some((_, one)) = given.next_if(|(from, _)| *from <= now) {
            give(&mut robot, *one);
        }
        if let Status::Ended { at, .. } = machine.step(now, &mut robot, &mut Deaf) {
            end = Some(at);
            break;
        }
    }
    let log = robot.log.into_iter().map(|(_, line)| line);
    let errors = machine.errors().iter();
    let errors = errors.map(|error| error.words.english.clone());
    (log.collect(), errors.collect(), end)
}

#[test]
fn every_block_does_what_its_examples_say() {
    for row in table() {
        assert!(!row.examples.is_empty(), "{} has no example", row.kind);
        for example in row.examples {
            let (log, errors, end) = played(row, example);
            let mut told = example.told.to_vec();
            if row.silent == Silent::Always {
                // A former block shares the examples of the present one.
                told.clear();
            }
            told.push("rest");
            assert_eq!(
                (log.iter().map(String::as_str).collect(), errors),
                (told, vec![]),
                "{} {:?}",
                row.kind,
                example.properties
            );
            if example.end.is_some() {
                assert_eq!(end, example.end, "{} {:?}", row.kind, example.properties);
            }
        }
    }
}

#[test]
fn every_block_is_drawn_and_generated() {
    for row in table() {
        for example in row.examples {
            let project = drawn(row, example).project();
            let svg = picture(&project.diagrams[0], Locale::Russian);
            assert!(svg.contains(row.icon), "{}", row.kind);
            let generated = generate(&project, Language::JavaScript, Default::default());
            match (row.does, generated) {
                // Nobody can be asked there.
                (Does::Ask, generated) => assert!(generated.is_err()),
                (_, Err(problems)) => panic!("{}: {}", row.kind, problems[0]),
                (Does::Wait(wait), Ok(generated)) => {
                    let every = match wait.every {
                        Every::Step => STEP_MS.to_string(),
                        Every::Ms(ms) => ms.to_string(),
                    };
                    let looks = format!("script.wait({every})");
                    assert!(generated.text.contains(&looks), "{}", generated.text);
                }
                (_, Ok(generated)) => assert!(!generated.text.is_empty()),
            }
        }
    }
}

#[test]
fn every_block_that_waits_has_an_example_of_when_it_goes_on() {
    for row in table() {
        let Does::Wait(_) = row.does else {
            continue;
        };
        let begins = if world(row) == World::Robot { 0 } else { 30 };
        let waits = |example: &Example| example.end.is_some_and(|end| end > begins);
        assert!(row.examples.iter().any(waits), "{}", row.kind);
    }
}

#[test]
fn what_is_silent_somewhere_tells_nothing_there() {
    for row in table() {
        let silent = match row.silent {
            Silent::Never => continue,
            Silent::Simulated | Silent::WithoutMailbox | Silent::WithoutGamepad => World::default(),
            Silent::Real | Silent::Always => World::Robot,
        };
        let sketch = chain(&[(row.kind, &[]), ("Function", &[("Body", "print(1)")])]);
        let ran = run_with(&sketch, 100, Options::of(silent), silent, |_| {});
        let log = ran.robot.log.iter().map(|(_, line)| line.as_str());
        let lines: Vec<_> = log.collect();
        assert_eq!(lines, ["print \"1\"", "rest"], "{}", row.kind);
    }
}
