//! What rows are put together from: blocks and properties of each kind, and properties that several blocks share.
//!
//! Owns no rows.

use super::{Category, Content, Does, Kits, Property, Row, Silent, Type};

/// A block without picture and examples, of all kits, which does something everywhere. Names are in English and Russian.
pub(super) const fn block(
    category: Category,
    kind: &'static str,
    [shown, russian]: [&'static str; 2],
    does: Does,
    properties: &'static [Property],
    text: [&'static str; 2],
) -> Row {
    Row {
        kind,
        shown,
        russian,
        category,
        kits: Kits::Both,
        silent: Silent::Never,
        properties,
        text,
        icon: "",
        does,
        examples: &[],
    }
}

/// A property whose text is an expression.
pub(super) const fn expression(
    name: &'static str,
    shown: [&'static str; 2],
    wanted: Type,
    default: &'static str,
) -> Property {
    property(name, shown, Content::Expression(wanted), default)
}

/// A property of another content.
pub(super) const fn property(
    name: &'static str,
    [shown, russian]: [&'static str; 2],
    content: Content,
    default: &'static str,
) -> Property {
    Property {
        name,
        shown,
        russian,
        content,
        default,
    }
}

/// A flag.
pub(super) const fn flag(
    name: &'static str,
    shown: [&'static str; 2],
    default: &'static str,
) -> Property {
    property(name, shown, Content::Flag, default)
}

/// A variable that is assigned to.
pub(super) const fn variable(name: &'static str, default: &'static str) -> Property {
    property(name, ["Variable", "Переменная"], Content::Variable, default)
}

/// How a reading is compared.
pub(super) const SIGN: Property = property(
    "Sign",
    ["Sign", "Сравнение"],
    Content::Choice(SIGNS),
    "greater",
);
pub(super) const SIGNS: &[&str] = &["greater", "less", "notLess", "notGreater", "equals"];
/// The sign of blocks that send.
pub(super) const ENVELOPE: &str = "<rect class=\"i\" x=\"-14\" y=\"-9\" width=\"28\" height=\"19\"/><path class=\"i\" d=\"M-14 -9L0 3L14 -9\"/>";
pub(crate) const REDRAW: Property = flag("Redraw", ["Redraw", "Перерисовать"], "true");
pub(crate) const EVALUATE: Property = flag("Evaluate", ["Evaluate", "Вычислять"], "false");
pub(super) const COLORS: &[&str] = &[
    "white",
    "black",
    "red",
    "darkRed",
    "green",
    "darkGreen",
    "blue",
    "darkBlue",
    "cyan",
    "darkCyan",
    "magenta",
    "darkMagenta",
    "yellow",
    "darkYellow",
    "gray",
    "darkGray",
    "lightGray",
];
