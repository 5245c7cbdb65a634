//! A document as it was written: names, sections and expressions with their places, whether they mean anything or not.
//!
//! Owns the shape of the tree. Knows no rule of meaning: [`super::model`] is what is left after they are checked.

/// A stretch of the text in bytes, both ends on borders of characters; `start <= end`.
#[derive(Clone, Copy, Debug, Default, Eq, PartialEq, Hash, Ord, PartialOrd)]
pub struct Span {
    /// The first byte.
    pub start: u32,
    /// The byte after the last one.
    pub end: u32,
}

/// A word of the author with its place.
#[derive(Clone, Debug, Default, Eq, PartialEq)]
pub struct Name {
    /// The word.
    pub text: String,
    /// Where it stands.
    pub span: Span,
}

/// A text between `/**` and `*/`: without the stars at the beginnings of lines.
#[derive(Clone, Debug, Default, Eq, PartialEq)]
pub struct Doc {
    /// Its lines.
    pub text: String,
    /// Where it stands, with its signs.
    pub span: Span,
}

/// All models of a text. What could not be read is left out, and told.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Document {
    /// In the order of the text.
    pub models: Vec<ModelText>,
}

/// One `BEGIN ... END;`.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct ModelText {
    /// From `BEGIN` to the last semicolon.
    pub span: Span,
    /// What stands before `BEGIN`.
    pub doc: Option<Doc>,
    /// Behind `BEGIN`.
    pub name: Name,
    /// Behind `PACKAGE:`, with dots.
    pub package: Option<Name>,
    /// In the order of the text.
    pub sections: Vec<Section>,
    /// In the order of the text.
    pub equations: Vec<EquationText>,
    /// What of it could not be read.
    pub damage: Damage,
}

/// What is missing in a tree because it could not be read, which is told already. Rules that would complain of what is
/// missing are silent then.
#[derive(Clone, Copy, Debug, Default, Eq, PartialEq)]
pub struct Damage {
    /// Something was wrong with the text.
    pub any: bool,
    /// Declarations may be missing.
    pub names: bool,
    /// Equations may be missing.
    pub equations: bool,
}

/// What a declared name is.
#[derive(Clone, Copy, Debug, Eq, PartialEq, Hash, Ord, PartialOrd)]
pub enum Kind {
    /// `ACTION`: an input.
    Action,
    /// `PARAM`: a number that is fixed for one robot.
    Param,
    /// `CONST`: a number with a name.
    Const,
    /// `CONFIG`: a part of the configuration.
    Config,
    /// `VAR`: a name for an intermediate value.
    Var,
}

impl Kind {
    /// The word that opens its section.
    pub const fn keyword(self) -> &'static str {
        match self {
            Self::Action => "ACTION",
            Self::Param => "PARAM",
            Self::Const => "CONST",
            Self::Config => "CONFIG",
            Self::Var => "VAR",
        }
    }
}

/// One section of declarations.
#[derive(Clone, Debug, PartialEq)]
pub struct Section {
    /// What its names are.
    pub kind: Kind,
    /// From the keyword to the semicolon.
    pub span: Span,
    /// In the order of the text.
    pub names: Vec<Declaration>,
}

/// One declared name. Unit, range and circle are extensions: `v [m/s] in -2 .. 2`, `theta [rad] in S1`.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Declaration {
    /// What stands before or after it as its documentation.
    pub doc: Option<Doc>,
    /// The name.
    pub name: Name,
    /// Between brackets, as written.
    pub unit: Option<Name>,
    /// Behind `in`.
    pub domain: Option<(Domain, Span)>,
    /// Behind `=`, for constants, with its sign.
    pub value: Option<(f64, Span)>,
}

/// Where a value may be.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Domain {
    /// `S1`: an angle that wraps at a whole turn.
    Circle,
    /// From one number to another, both included.
    Range(f64, f64),
}

/// `d(x) = value;` or `x = value;`.
#[derive(Clone, Debug, PartialEq)]
pub struct EquationText {
    /// From the first sign to the semicolon.
    pub span: Span,
    /// Whose equation it is.
    pub target: Name,
    /// Whether it gives the derivative.
    pub is_derivative: bool,
    /// The right side.
    pub value: ExprText,
}

/// An expression with its place. Trees of it are never deeper than [`crate::limits::DCML_DEPTH`].
#[derive(Clone, Debug, PartialEq)]
pub struct ExprText {
    /// Where.
    pub span: Span,
    /// What.
    pub node: Node,
}

/// The forms of an expression. Parentheses are in the spans alone.
#[derive(Clone, Debug, PartialEq)]
pub enum Node {
    /// A number as it was read; its text is at the span.
    Number(f64),
    /// A name.
    Name(String),
    /// `-x`, and `+x`, which changes nothing.
    Sign(bool, Box<ExprText>),
    /// `a + b + ...` and so on, to the left.
    Binary(Operator, Box<ExprText>, Box<ExprText>),
    /// `sin(x)`: name, arguments.
    Call(Name, Vec<ExprText>),
    /// `a < b`: an extension, for conditions of `piecewise` only.
    Compare(Comparison, Box<ExprText>, Box<ExprText>),
    /// Could not be read, which is told already.
    Broken,
}

/// The four operators.
#[derive(Clone, Copy, Debug, Eq, PartialEq, Hash)]
pub enum Operator {
    /// `+`
    Add,
    /// `-`
    Subtract,
    /// `*`
    Multiply,
    /// `/`
    Divide,
}

/// How two numbers are compared.
#[derive(Clone, Copy, Debug, Eq, PartialEq, Hash)]
pub enum Comparison {
    /// `<`
    Less,
    /// `<=`
    LessOrEqual,
    /// `>`
    Greater,
    /// `>=`
    GreaterOrEqual,
}
