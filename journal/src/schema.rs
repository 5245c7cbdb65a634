//! Names and texts of message types, as ros2msg has them.
//!
//! Owns the mangling of names into what readers of these types take, and the text of a type made from a layout. Types of other
//! people are in `standard`.

use crate::layout::Layout;
use crate::standard::HEADER;
use std::collections::HashSet;
use std::fmt::Write;

/// The encoding of all schemas here.
pub const ENCODING: &str = "ros2msg";
/// The encoding of all messages here.
pub const MESSAGE_ENCODING: &str = "cdr";
/// The package of types that are made from a format.
const PACKAGE: &str = "trik_msgs";
/// The line between a type and those that it needs.
const RULE: &str =
    "================================================================================";

/// Names that are taken, so that each new one is another.
#[derive(Debug, Default)]
pub(crate) struct Names(HashSet<String>);

impl Names {
    /// The name if it is free, else with the first number after it that makes it so.
    pub(crate) fn take(&mut self, name: String) -> String {
        let mut free = name.clone();
        let mut number = 2;
        while !self.0.insert(free.clone()) {
            free = format!("{name}{number}");
            number += 1;
        }
        free
    }
}

/// The type of a node: `sensors/A1` becomes `SensorsA1`. Readers take letters and digits, a capital first.
pub(crate) fn type_of(path: &str) -> String {
    let words = path.split(|c: char| !c.is_ascii_alphanumeric());
    let name: String = words
        .filter(|word| !word.is_empty())
        .map(|word| word[..1].to_ascii_uppercase() + &word[1..])
        .collect();
    match name.as_bytes().first() {
        Some(first) if first.is_ascii_alphabetic() => name,
        _ => format!("Node{name}"),
    }
}

/// The name of a schema.
pub(crate) fn schema_of(type_name: &str) -> String {
    format!("{PACKAGE}/msg/{type_name}")
}

/// Names of fields as readers take them: small letters, digits and single `_`, a letter first and no `_` last. Other names
/// become that, and each stays another one.
pub(crate) fn field_names(names: &[String]) -> Vec<String> {
    // Those of the fields before them.
    let mut taken = Names(HashSet::from(["header".to_owned(), "sequence".to_owned()]));
    names
        .iter()
        .map(|name| {
            let words = name.split('_').filter(|word| !word.is_empty());
            let small: Vec<String> = words.map(str::to_ascii_lowercase).collect();
            let small = small.join("_");
            let is_fine = small.starts_with(|c: char| c.is_ascii_lowercase());
            taken.take(if is_fine { small } else { format!("n{small}") })
        })
        .collect()
}

/// The text of the type of a node with this layout.
pub(crate) fn text_of(layout: &Layout) -> String {
    let mut text = String::from("std_msgs/Header header\nuint32 sequence\n");
    // Writing to a string cannot fail.
    let _ = match layout {
        Layout::Bytes(size) => writeln!(text, "uint8[{size}] data"),
        Layout::Text(_) => writeln!(text, "string data"),
        Layout::Fields(fields) => {
            for (field, name) in fields.iter().zip(field_names(&layout.names())) {
                let _ = writeln!(text, "{} {name}", field.kind.ros());
            }
            Ok(())
        }
    };
    for (name, fields) in HEADER {
        let _ = write!(text, "{RULE}\nMSG: {name}\n{fields}");
    }
    text
}

/// The text of a type with those that it needs after it.
pub(crate) fn with_needed(fields: &str, needed: &[(&str, &str)]) -> String {
    let mut text = fields.to_owned();
    for (name, fields) in needed {
        let _ = write!(text, "{RULE}\nMSG: {name}\n{fields}");
    }
    text
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_of_nodes_become_types() {
        for (path, name) in [
            ("sensors/A1", "SensorsA1"),
            ("motors/M3/speed", "MotorsM3Speed"),
            ("floor_left", "FloorLeft"),
            ("3d", "Node3d"),
            ("\u{fc}", "Node"),
        ] {
            assert_eq!(type_of(path), name, "{path}");
        }
        let mut names = Names::default();
        assert_eq!(names.take("A".to_owned()), "A");
        assert_eq!(names.take("A".to_owned()), "A2");
        assert_eq!(names.take("A".to_owned()), "A3");
    }

    #[test]
    fn names_of_fields_are_what_readers_take_and_stay_different() {
        let names = ["x", "X", "_y_", "a__b", "1", "sequence", "__"].map(str::to_owned);
        assert_eq!(
            field_names(&names),
            ["x", "x2", "y", "a_b", "n1", "sequence2", "n"]
        );
    }

    #[test]
    fn a_layout_is_a_type() {
        let layout = Layout::parse("i32 x, >u16 y").unwrap();
        let text = text_of(&layout);
        assert!(
            text.starts_with("std_msgs/Header header\nuint32 sequence\nint32 x\nuint16 y\n====="),
            "{text}"
        );
        assert!(text.contains("MSG: std_msgs/Header\nbuiltin_interfaces/Time stamp\n"));
        assert!(text.contains("MSG: builtin_interfaces/Time\nint32 sec\nuint32 nanosec\n"));
        assert!(text_of(&Layout::Bytes(4)).contains("uint8[4] data\n"));
        assert!(text_of(&Layout::Text(4)).contains("string data\n"));
    }
}
