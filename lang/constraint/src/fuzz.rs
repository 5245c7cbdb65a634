//! Bytes as the constraints of a field, checked on a world that has everything, and changes.

use std::rc::Rc;

use crate::limits;
use crate::{
    Checker, Missing, Object, ObjectPoint, Point, Rect, Scene, Unfit, Value, Verdict, read,
};
use lang_text::problem::Locale;
use lang_text::xml;

/// A world where almost every name is an object, and what is asked decides the answer.
#[derive(Default)]
struct Anything {
    names: Vec<String>,
    asked: u32,
}

impl Scene for Anything {
    fn find(&mut self, name: &str) -> Option<Object> {
        if name.ends_with('9') || name.len() > 40 {
            return None;
        }
        let known = self.names.iter().position(|known| known == name);
        let at = known.unwrap_or_else(|| {
            self.names.push(name.to_owned());
            self.names.len() - 1
        });
        u32::try_from(at).ok().map(Object)
    }

    fn type_of(&mut self, object: Object) -> Option<&'static str> {
        (!object.0.is_multiple_of(3)).then_some("Anything")
    }

    fn property(&mut self, object: Object, chain: &[Box<str>]) -> Result<Value, Missing> {
        assert!(!chain.is_empty() && (object.0 as usize) < self.names.len());
        self.asked = self.asked.wrapping_add(1);
        let value = match (self.asked + object.0) % 9 {
            0 => Value::Null,
            1 => Value::Bool(true),
            2 => Value::Int(i32::MIN),
            3 => Value::Double(f64::NAN),
            4 => Value::text("9"),
            5 => Value::Point(Point { x: i32::MAX, y: -1 }),
            6 => Value::list([Value::Int(1), Value::Object(Object(0))]),
            7 => Value::Object(Object(0)),
            _ => return Err(Missing::Property(0)),
        };
        if matches!(value, Value::Object(_)) {
            Ok(value)
        } else {
            value.descend(chain, 1)
        }
    }

    fn set_property(&mut self, _: Object, property: &str, _: &Value) -> bool {
        property.len() < 10
    }

    fn is_inside(&mut self, a: Object, b: Object, point: ObjectPoint) -> Result<bool, Unfit> {
        match (a.0 + b.0 + self.asked) % 4 {
            0 => Err(Unfit::NoRegion),
            1 => Err(Unfit::NoPlace),
            2 => Ok(true),
            _ => Ok(point == ObjectPoint::Any),
        }
    }

    fn bounding_rect(&mut self, object: Object) -> Option<Rect> {
        object.0.is_multiple_of(2).then_some(Rect {
            x: i32::MAX,
            y: i32::MIN,
            width: i32::MAX,
            height: i32::MIN,
        })
    }
}

/// Bytes as constraints; what is read is checked for a while, twice with the same result.
pub fn constraints(bytes: &[u8]) {
    let text = String::from_utf8_lossy(bytes);
    let Ok(element) = xml::parse(&text) else {
        return;
    };
    let Ok(rules) = read(&element) else {
        return;
    };
    let rules = Rc::new(rules);
    let run = |locale: Locale| {
        let mut checker = Checker::new(Rc::clone(&rules), locale);
        if bytes.len().is_multiple_of(2) {
            checker = checker.continuing();
        }
        // Whether it is asked why makes no difference.
        let explains = locale == Locale::Russian;
        if explains {
            checker = checker.explaining();
        }
        let (mut scene, mut entries) = (Anything::default(), Vec::new());
        for tick in 1..=20 {
            let limit = u64::from(rules.time_limit_ms());
            checker.check(tick * (limit / 15 + 1), &mut scene, &mut entries);
        }
        let verdict = checker.program_ended(u64::MAX, false, &mut scene, &mut entries);
        assert_ne!(verdict, Verdict::Open);
        let verdicts = 4 * 21 * rules.events();
        assert!(entries.len() <= limits::CONSTRAINT_ENTRIES_MAX + 1 + verdicts);
        for entry in &entries {
            assert!(entry.text.len() <= bytes.len().max(limits::CONSTRAINT_MESSAGE_BYTES) + 1000);
        }
        assert_eq!(checker.explain().is_some(), explains);
        let explanation = checker.explain().into_iter();
        for rule in explanation.flat_map(|one| one.rules) {
            assert!(rule.conditions.len() <= limits::EXPLAINED_CONDITIONS_MAX);
        }
        (verdict, entries.len())
    };
    assert_eq!(run(Locale::English), run(Locale::Russian));
}
