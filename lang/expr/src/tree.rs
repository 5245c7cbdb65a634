//! The tree of a text: what was written, with places, for the compiler and for the generators of other languages.
//!
//! Owns plain data and its printing as text of the language. Knows no types and no values.

use super::escape;
use lang_text::problem::Position;
use std::fmt;
use std::rc::Rc;

/// A node by its index in [`Tree::nodes`]; children come before their parents.
pub type Id = u32;

/// An operator with one operand.
#[derive(Clone, Copy, Debug, Eq, PartialEq)]
pub enum Unary {
    /// `-`
    Minus,
    /// `not`
    Not,
    /// `#`
    Length,
    /// `~`
    BitNot,
}

/// An operator with two operands.
#[derive(Clone, Copy, Debug, Eq, PartialEq)]
pub enum Binary {
    /// `or`, `||`
    Or,
    /// `and`, `&&`
    And,
    /// `<`
    Less,
    /// `>`
    Greater,
    /// `<=`
    LessEqual,
    /// `>=`
    GreaterEqual,
    /// `~=`, `!=`
    NotEqual,
    /// `==`
    Equal,
    /// `|`
    BitOr,
    /// `~`
    BitXor,
    /// `&`
    BitAnd,
    /// `<<`
    ShiftLeft,
    /// `>>`
    ShiftRight,
    /// `..`
    Join,
    /// `+`
    Add,
    /// `-`
    Subtract,
    /// `*`
    Multiply,
    /// `/`
    Divide,
    /// `//`
    DivideWhole,
    /// `%`
    Modulo,
    /// `^`
    Power,
}

/// Operators with their signs and precedences; a second sign means the same.
const BINARY: [(Binary, &str, Option<&str>, u8); 21] = [
    (Binary::Or, "or", Some("||"), 0),
    (Binary::And, "and", Some("&&"), 1),
    (Binary::Less, "<", None, 2),
    (Binary::Greater, ">", None, 2),
    (Binary::LessEqual, "<=", None, 2),
    (Binary::GreaterEqual, ">=", None, 2),
    (Binary::NotEqual, "~=", Some("!="), 2),
    (Binary::Equal, "==", None, 2),
    (Binary::BitOr, "|", None, 3),
    (Binary::BitXor, "~", None, 4),
    (Binary::BitAnd, "&", None, 5),
    (Binary::ShiftLeft, "<<", None, 6),
    (Binary::ShiftRight, ">>", None, 6),
    (Binary::Join, "..", None, 7),
    (Binary::Add, "+", None, 8),
    (Binary::Subtract, "-", None, 8),
    (Binary::Multiply, "*", None, 9),
    (Binary::Divide, "/", None, 9),
    (Binary::DivideWhole, "//", None, 9),
    (Binary::Modulo, "%", None, 9),
    (Binary::Power, "^", None, 11),
];

/// Precedence of the operators with one operand.
pub const UNARY_PRECEDENCE: u8 = 10;

impl Binary {
    /// The operator of a sign.
    pub fn of(sign: &str) -> Option<Self> {
        BINARY
            .iter()
            .find(|(_, one, other, _)| *one == sign || *other == Some(sign))
            .map(|(operator, ..)| *operator)
    }

    /// Its usual sign.
    pub fn sign(self) -> &'static str {
        BINARY[self as usize].1
    }

    /// How strongly it binds, from 0.
    pub fn precedence(self) -> u8 {
        BINARY[self as usize].3
    }

    /// Whether `a op b op c` means `a op (b op c)`.
    pub fn is_right(self) -> bool {
        matches!(self, Self::Join | Self::Power)
    }
}

impl Unary {
    /// Its sign.
    pub fn sign(self) -> &'static str {
        match self {
            Self::Minus => "-",
            Self::Not => "not ",
            Self::Length => "#",
            Self::BitNot => "~",
        }
    }
}

/// One element of a table.
#[derive(Clone, Copy, Debug, Eq, PartialEq)]
pub struct Field {
    /// Where to, if that is written.
    pub key: Option<Id>,
    /// What.
    pub value: Id,
}

/// A node.
#[derive(Clone, Debug, PartialEq)]
pub enum Node {
    /// `nil`
    Nil,
    /// `true`, `false`
    Bool(bool),
    /// A whole number as written.
    Int(Rc<str>),
    /// Another number as written.
    Float(Rc<str>),
    /// A text without its quotes.
    Text(Rc<str>),
    /// A text that is the only argument of a call without brackets, with its quotes and escapes: TRIK Studio leaves
    /// them on.
    RawText(Rc<str>),
    /// A name.
    Name(Rc<str>),
    /// An operator and its operand.
    Unary(Unary, Id),
    /// An operator and its operands.
    Binary(Binary, Id, Id),
    /// `table[index]` or `table.name`
    Index {
        /// What has elements.
        table: Id,
        /// Which one.
        index: Id,
    },
    /// `function(arguments)`
    Call {
        /// What is called.
        function: Id,
        /// With what.
        arguments: Vec<Id>,
    },
    /// `object:name(arguments)`, which nothing understands.
    Method {
        /// Of what.
        object: Id,
        /// Its name.
        name: Id,
        /// With what.
        arguments: Vec<Id>,
    },
    /// `{ ... }`, or several expressions with commas between.
    Table {
        /// The elements.
        fields: Vec<Field>,
        /// Whether the braces are missing.
        bare: bool,
    },
    /// `target = value`
    Assign {
        /// A name or an element.
        target: Id,
        /// What it becomes.
        value: Id,
    },
    /// Several statements; none, for an empty text.
    Block(Vec<Id>),
}

/// A whole text.
#[derive(Clone, Debug, Default)]
pub struct Tree {
    /// All nodes.
    pub nodes: Vec<Node>,
    /// Where each begins: brackets around it do not count.
    pub places: Vec<Position>,
    /// The node that is everything; `None` if the text has errors.
    pub root: Option<Id>,
}

impl Tree {
    /// A node.
    pub fn node(&self, id: Id) -> &Node {
        &self.nodes[id as usize]
    }

    /// Where a node begins.
    pub fn place(&self, id: Id) -> Position {
        self.places[id as usize]
    }

    /// The statements of the text, in order.
    pub fn statements(&self) -> Vec<Id> {
        let Some(root) = self.root else {
            return Vec::new();
        };
        if let Node::Block(statements) = self.node(root) {
            return statements.clone();
        }
        vec![root]
    }

    /// Calls `visit` with the direct children of a node, in the order of the text.
    pub fn children(&self, id: Id, mut visit: impl FnMut(Id)) {
        match self.node(id) {
            Node::Unary(_, operand) => visit(*operand),
            Node::Binary(_, left, right) => {
                visit(*left);
                visit(*right);
            }
            Node::Index { table, index } => {
                visit(*table);
                visit(*index);
            }
            Node::Call {
                function,
                arguments,
            } => {
                visit(*function);
                arguments.iter().for_each(|&child| visit(child));
            }
            Node::Method {
                object,
                name,
                arguments,
            } => {
                visit(*object);
                visit(*name);
                arguments.iter().for_each(|&child| visit(child));
            }
            Node::Table { fields, .. } => {
                for field in fields {
                    field.key.into_iter().for_each(&mut visit);
                    visit(field.value);
                }
            }
            Node::Assign { target, value } => {
                visit(*target);
                visit(*value);
            }
            Node::Block(statements) => statements.iter().for_each(|&child| visit(child)),
            Node::Nil
            | Node::Bool(_)
            | Node::Int(_)
            | Node::Float(_)
            | Node::Text(_)
            | Node::RawText(_)
            | Node::Name(_) => {}
        }
    }

    fn show(&self, id: Id, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self.node(id) {
            Node::Nil => f.write_str("nil"),
            Node::Bool(truth) => write!(f, "{truth}"),
            Node::Int(text) | Node::Float(text) | Node::Name(text) | Node::RawText(text) => {
                f.write_str(text)
            }
            Node::Text(text) => write!(f, "\"{}\"", escape::escape(text)),
            Node::Unary(operator, operand) => {
                f.write_str(operator.sign())?;
                // Two minus signs in a row begin a comment.
                let is_minus = |id| matches!(self.node(id), Node::Unary(Unary::Minus, _));
                if *operator == Unary::Minus && is_minus(*operand) {
                    return self.show_bracketed(*operand, true, f);
                }
                self.show_operand(*operand, UNARY_PRECEDENCE, f)
            }
            Node::Binary(operator, left, right) => {
                let here = operator.precedence();
                let (of_left, of_right) = if operator.is_right() {
                    (here + 1, here)
                } else {
                    (here, here + 1)
                };
                self.show_operand(*left, of_left, f)?;
                write!(f, " {} ", operator.sign())?;
                self.show_operand(*right, of_right, f)
            }
            Node::Index { table, index } => {
                self.show_prefix(*table, f)?;
                f.write_str("[")?;
                self.show(*index, f)?;
                f.write_str("]")
            }
            Node::Call {
                function,
                arguments,
            } => {
                self.show_prefix(*function, f)?;
                self.show_arguments(arguments, f)
            }
            Node::Method {
                object,
                name,
                arguments,
            } => {
                self.show_prefix(*object, f)?;
                f.write_str(":")?;
                self.show(*name, f)?;
                self.show_arguments(arguments, f)
            }
            Node::Table { fields, bare } => self.show_table(fields, *bare, f),
            Node::Assign { target, value } => {
                self.show(*target, f)?;
                f.write_str(" = ")?;
                self.show(*value, f)
            }
            Node::Block(statements) => {
                for (position, statement) in statements.iter().enumerate() {
                    let separator = if position == 0 { "" } else { "; " };
                    f.write_str(separator)?;
                    self.show(*statement, f)?;
                }
                Ok(())
            }
        }
    }

    fn show_arguments(&self, arguments: &[Id], f: &mut fmt::Formatter<'_>) -> fmt::Result {
        if let [only] = arguments
            && matches!(self.node(*only), Node::RawText(_))
        {
            f.write_str(" ")?;
            return self.show(*only, f);
        }
        f.write_str("(")?;
        self.show_list(arguments, f)?;
        f.write_str(")")
    }

    fn show_list(&self, ids: &[Id], f: &mut fmt::Formatter<'_>) -> fmt::Result {
        for (position, id) in ids.iter().enumerate() {
            if position > 0 {
                f.write_str(", ")?;
            }
            self.show(*id, f)?;
        }
        Ok(())
    }

    fn show_table(&self, fields: &[Field], bare: bool, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        if !bare {
            f.write_str("{")?;
        }
        for (position, field) in fields.iter().enumerate() {
            if position > 0 {
                f.write_str(", ")?;
            }
            if let Some(key) = field.key {
                f.write_str("[")?;
                self.show(key, f)?;
                f.write_str("] = ")?;
            }
            self.show(field.value, f)?;
        }
        if !bare {
            f.write_str("}")?;
        }
        Ok(())
    }

    /// With brackets, if it binds less than `least`.
    fn show_operand(&self, id: Id, least: u8, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let binds = match self.node(id) {
            Node::Binary(operator, ..) => operator.precedence(),
            Node::Unary(..) => UNARY_PRECEDENCE,
            Node::Nil
            | Node::Bool(_)
            | Node::Int(_)
            | Node::Float(_)
            | Node::Text(_)
            | Node::RawText(_)
            | Node::Name(_)
            | Node::Index { .. }
            | Node::Call { .. }
            | Node::Method { .. }
            | Node::Table { .. }
            | Node::Assign { .. }
            | Node::Block(_) => u8::MAX,
        };
        self.show_bracketed(id, binds < least, f)
    }

    /// With brackets, unless it can be indexed and called as it stands.
    fn show_prefix(&self, id: Id, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let is_prefix = matches!(
            self.node(id),
            Node::Name(_) | Node::Index { .. } | Node::Call { .. } | Node::Method { .. }
        );
        self.show_bracketed(id, !is_prefix, f)
    }

    fn show_bracketed(&self, id: Id, brackets: bool, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        if brackets {
            f.write_str("(")?;
        }
        self.show(id, f)?;
        if brackets {
            f.write_str(")")?;
        }
        Ok(())
    }
}

impl fmt::Display for Tree {
    /// The text again, in one line and with no more brackets than it needs.
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        self.root.map_or(Ok(()), |root| self.show(root, f))
    }
}
