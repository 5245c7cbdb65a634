//! Arbitrary bytes as expressions: nothing but time and memory within limits may go.
//!
//! Run by tests with mutated texts, and by any fuzzer.

use crate::reserved::SensorIndex;
use crate::{Compat, Kit, Names, Outside, Source, Store, Value, Wanted, analyse, evaluate};

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
    match value.list() {
        Some(list) => list.items().iter().any(holds_nan),
        None => value.to_float().is_nan(),
    }
}
