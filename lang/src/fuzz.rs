//! Fuzz targets as plain functions: any bytes may come in, nothing but time and memory within limits may go.
//!
//! Run by tests with mutated saves, and by anybody's fuzzer.

mod constraints;
mod dcml;
mod diagrams;

pub use constraints::constraints;
pub use dcml::dcml;
pub use diagrams::{lowering, project};

use crate::diagram::archive::{self, Entry};
use crate::diagram::read::read;
use crate::expr::reserved::SensorIndex;
use crate::expr::{Compat, Kit, Names, Outside, Source, Store, Value, Wanted, analyse, evaluate};

/// Bytes as a save, and as the files of one: texts between zero bytes, of which every other one is a name. What is read
/// must survive being written, changed and read again.
pub fn reader(bytes: &[u8]) {
    save(bytes);
    let mut parts = bytes.split(|&byte| byte == 0);
    let mut entries = Vec::new();
    while let Some(name) = parts.next() {
        let name = String::from_utf8_lossy(name).into_owned();
        let bytes = parts.next().unwrap_or_default().to_vec();
        entries.push(Entry { name, bytes });
    }
    if let Ok(packed) = archive::pack(&entries) {
        save(&packed);
    }
}

fn save(bytes: &[u8]) {
    let Ok(mut opened) = read(bytes) else {
        return;
    };
    for diagram in &opened.project.diagrams {
        for link in &diagram.links {
            assert!(link.from.is_none_or(|end| end < diagram.blocks.len()));
            assert!(link.to.is_none_or(|end| end < diagram.blocks.len()));
        }
        for block in &diagram.blocks {
            let mut links = block.outgoing.iter().chain(&block.incoming);
            assert!(links.all(|&link| link < diagram.links.len()));
        }
    }
    // What was read has fewer bytes and files than a save may have, but folders and packing may add some.
    let Ok(written) = opened.save.write() else {
        return;
    };
    let again = read(&written).expect("what was written is read");
    assert_eq!(again.project, opened.project);
    opened.save.recover_orphans();
    let recovered = opened.save.project().0;
    let written = opened.save.write().expect("what was recovered is written");
    let again = read(&written).expect("what was changed is read");
    assert_eq!(again.project, recovered);
    opened.save.remove_orphans();
    assert_eq!(opened.save.project().0, recovered);
}

/// A robot that always says the same.
struct Same;

impl Outside for Same {
    fn sensor(&mut self, sensor: SensorIndex) -> Value {
        if sensor.is_multiple_of(2) {
            Value::Int(i32::from(sensor))
        } else {
            Value::ints(&[1, -2, 3])
        }
    }

    fn time(&mut self) -> i32 {
        i32::MAX
    }

    fn print(&mut self, _: &str) {}

    fn random(&mut self, below: i32) -> i32 {
        assert!(below > 0);
        below - 1
    }
}

/// Bytes as expressions with zero bytes between, all of one project; the first byte says how exactly the oddities are
/// kept and what is wanted. Each is run three times, and what its tree prints must read back as what prints the same.
pub fn expression(bytes: &[u8]) {
    let Some((&first, bytes)) = bytes.split_first() else {
        return;
    };
    let compat = [Compat::Studio, Compat::Fixed][usize::from(first & 1)];
    let kit = [Kit::V62, Kit::V6][usize::from(first >> 1 & 1)];
    let wanted = [
        Wanted::Any,
        Wanted::Statements,
        Wanted::Bool,
        Wanted::Int,
        Wanted::Float,
        Wanted::Text,
        Wanted::List,
    ][usize::from(first >> 2) % 7];
    let mut names = if first >> 7 == 1 {
        Names::with_static_types(kit, compat)
    } else {
        Names::new(kit, compat)
    };
    let mut store = Store::default();
    let text = |bytes: &[u8]| String::from_utf8_lossy(bytes).into_owned();
    let mut sources: Vec<_> = bytes
        .split(|&byte| byte == 0)
        .take(16)
        .map(|bytes| Source::new(&text(bytes), wanted))
        .collect();
    for source in &sources {
        if source.tree().root.is_some() {
            let printed = source.tree().to_string();
            let again = Source::new(&printed, wanted);
            // What is printed has more spaces, and may be too long for that.
            if printed.len() <= crate::limits::EXPRESSION_TEXT_MAX {
                assert_eq!(again.tree().to_string(), printed);
            }
        }
    }
    for _ in 0..3 {
        for source in &mut sources {
            if analyse(source, &mut names).is_err() {
                continue;
            }
            let at = names.epoch();
            if let Ok(value) = evaluate(source, &names, &mut store, &mut Same) {
                assert!(value.equals(&value) || value.to_float().is_nan() || holds_nan(&value));
                value.printed();
            }
            // Nothing has changed, and so it is still right.
            assert_eq!(analyse(source, &mut names), Ok(()));
            assert_eq!(names.epoch(), at);
        }
    }
}

fn holds_nan(value: &Value) -> bool {
    match value {
        Value::List(list) => list.items().iter().any(holds_nan),
        value => value.to_float().is_nan(),
    }
}
