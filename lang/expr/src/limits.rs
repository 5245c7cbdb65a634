//! Every limit of this crate: how far expressions and their values may grow.

/// Bytes of one expression's text.
pub const EXPRESSION_TEXT_MAX: usize = 64 << 10;
/// How deep an expression may nest, and how many operators of one precedence may stand in a row.
pub const EXPRESSION_DEPTH_MAX: u16 = 200;
/// Problems that are told of one text; more of them help nobody.
pub const EXPRESSION_PROBLEMS_MAX: usize = 50;
/// How often types are inferred anew because a variable was widened.
pub const EXPRESSION_PASSES_MAX: usize = 64;
/// Names of one project: variables, ports, functions.
pub const NAMES_MAX: usize = 4096;
/// Types of table elements that are still open, in one project.
pub const OPEN_TYPES_MAX: usize = 16 << 10;
/// Elements of one table.
pub const LIST_MAX: usize = 100_000;
/// Tables in tables.
pub const LIST_DEPTH_MAX: u16 = 32;
/// Cells of one value: an element of a table, or 16 bytes of text.
pub const VALUE_CELLS_MAX: u32 = 500_000;
/// Cells of all variables of a project.
pub const STORE_CELLS_MAX: u32 = 1_000_000;
/// Bytes of one text value.
pub const TEXT_MAX: usize = 1 << 20;
/// Bytes of a text value that can be a number.
pub const NUMBER_TEXT_MAX: usize = 1000;
/// Cells that one evaluation may compare, copy or make.
pub const EVALUATION_CELLS_MAX: u32 = 4_000_000;
/// Numbers on the stack of a list of steps; what needs more of them runs as a tree.
pub const STEPS_HEIGHT_MAX: usize = 16;
