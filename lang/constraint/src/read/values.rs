//! Values read: as tags, and as attributes `_1` and `_2`.

use super::super::rules::{Binary, Name, Operand, Path, Unary};
use super::super::value::{Value, double};
use super::super::words;
use super::{Reader, is};
use lang_text::xml::{Element, Node};

/// Names of classes that fields of old versions ask for, and what they are called now; the original renames them when it
/// opens a save of such a version, with the field that was put into it.
const OLD_CLASSES: [(&str, &str); 4] = [
    (
        "trik::robotModel::twoD::parts::TwoDInfraredSensor",
        "twoDModel::robotModel::parts::RangeSensor",
    ),
    (
        "trikKitInterpreter::robotModel::twoD::parts::TwoDInfraredSensor",
        "twoDModel::robotModel::parts::RangeSensor",
    ),
    ("trikKitInterpreter::", "trik::"),
    ("commonTwoDModel::", "twoDModel::"),
];

/// A text, with the name of a class as it is now.
fn modern(text: &str) -> Value {
    let renamed = OLD_CLASSES.iter().find_map(|(old, new)| {
        let rest = text.strip_prefix(old)?;
        Some(format!("{new}{rest}"))
    });
    renamed.map_or_else(|| Value::text(text), |text| Value::text(&text))
}

impl Reader {
    /// The name of an object.
    pub(super) fn name(&mut self, text: &str) -> Name {
        Name {
            text: text.into(),
            slot: self.slot(),
            at: self.at,
        }
    }

    /// The path of a property; empty parts are left out. One without a name is an error each time when it is read.
    pub(super) fn path(&mut self, text: &str) -> Path {
        let parts = text.split('.').filter(|part| !part.is_empty());
        let parts: Box<[Box<str>]> = parts.map(Into::into).collect();
        match &parts[..] {
            [] => self.warn(words::empty_path()),
            [one] => self.objects.push(one.clone()),
            [one, other, ..] => self.objects.push(format!("{one}.{other}").into()),
        }
        Path {
            text: text.into(),
            parts,
            slot: self.slot(),
            at: self.at,
        }
    }

    fn slot(&mut self) -> usize {
        self.slots += 1;
        self.slots - 1
    }

    /// As many values as a tag needs: its children, or instead of them its attributes that begin with `_`, by name. Beside
    /// those the tag may have others.
    pub(super) fn operands<const N: usize>(
        &mut self,
        element: &Element<'_>,
        others: &[&str],
    ) -> Option<[Operand; N]> {
        let mut written: Vec<_> = element
            .attributes
            .iter()
            .filter(|(name, _)| name.starts_with('_'))
            .collect();
        if written.is_empty() {
            self.known(element, others);
            let children: [&Element<'_>; N] = self.exactly(element)?;
            let values = children.map(|child| self.value(child));
            return Some(values);
        }
        for (name, _) in &element.attributes {
            if !name.starts_with('_') && !others.contains(&&**name) {
                self.warn(words::strange_attribute(&element.name, name, None));
            }
        }
        if written.len() != N {
            self.error(words::operands(&element.name, N, written.len()));
        }
        if written.len() != N || !element.nodes.is_empty() {
            self.error(words::children(&element.name, N));
            return None;
        }
        written.sort_by(|(left, _), (right, _)| left.cmp(right));
        let values = written.into_iter().map(|(_, text)| self.written(text));
        let values: Vec<_> = values.collect();
        values.try_into().ok()
    }

    /// A value as an attribute: `${path}`, or what it looks like.
    fn written(&mut self, text: &str) -> Operand {
        let path = text
            .strip_prefix("${")
            .and_then(|text| text.strip_suffix('}'));
        match path {
            Some(path) => Operand::Either(self.path(path)),
            None => Operand::Constant(Value::guess(text)),
        }
    }

    /// A value as a tag; nothing where it cannot be read, and then there is a problem.
    fn value(&mut self, element: &Element<'_>) -> Operand {
        let read = self.inside(element, |reader| reader.value_inside(element));
        read.unwrap_or(Operand::Constant(Value::Null))
    }

    fn value_inside(&mut self, element: &Element<'_>) -> Option<Operand> {
        let tag = element.name.to_ascii_lowercase();
        match tag.as_str() {
            "bool" | "int" | "double" | "string" => {
                self.known(element, &["value"]);
                self.nothing_in(element);
                self.constant(element).map(Operand::Constant)
            }
            "variablevalue" => {
                self.known(element, &["name"]);
                let name = self.filled(element, "name")?;
                let parts = name.split('.').map(Into::into).collect();
                Some(Operand::Variable(Path {
                    text: name.into(),
                    parts,
                    slot: 0,
                    at: element.start,
                }))
            }
            "objectstate" => {
                self.known(element, &["object"]);
                let object = self.filled(element, "object")?;
                Some(Operand::State(self.path(object)))
            }
            "typeof" => {
                self.known(element, &["objectId"]);
                let object = self.filled(element, "objectId")?;
                Some(Operand::TypeOf(self.name(object)))
            }
            "minus" => self.unary(element, Unary::Minus),
            "abs" => self.unary(element, Unary::Abs),
            "boundingrect" => self.unary(element, Unary::BoundingRect),
            "sum" => self.binary(element, Binary::Sum),
            "difference" => self.binary(element, Binary::Difference),
            "mul" => self.binary(element, Binary::Mul),
            "min" => self.binary(element, Binary::Min),
            "max" => self.binary(element, Binary::Max),
            "distance" => self.binary(element, Binary::Distance),
            _ => {
                self.unknown(&element.name, words::unknown_value(&element.name));
                None
            }
        }
    }

    fn unary(&mut self, element: &Element<'_>, operation: Unary) -> Option<Operand> {
        let [value] = self.operands(element, &[])?;
        Some(Operand::Unary(operation, Box::new(value)))
    }

    fn binary(&mut self, element: &Element<'_>, operation: Binary) -> Option<Operand> {
        let values = self.operands(element, &[])?;
        Some(Operand::Binary(operation, Box::new(values)))
    }

    fn constant(&mut self, element: &Element<'_>) -> Option<Value> {
        if is(element, "string") {
            return self.present(element, "value").map(modern);
        }
        if is(element, "int") {
            return self.whole(element, "value").map(Value::Int);
        }
        let text = self.filled(element, "value")?;
        if is(element, "bool") {
            return Some(Value::Bool(self.yes_or_no(element, "value", false)));
        }
        let number = double(text.trim());
        if number.is_none() {
            self.error(words::not_a_number(text));
        }
        number.map(Value::Double)
    }

    /// Warns of tags in a tag that has only attributes.
    fn nothing_in(&mut self, element: &Element<'_>) {
        let is_something = |node: &Node<'_>| !matches!(node, Node::Comment(_));
        if element.nodes.iter().any(is_something) {
            self.warn(words::something_in(&element.name));
        }
    }
}
