//! Every limit of this crate: how far rules of tasks may grow.

/// How deep tags of constraints may nest, with templates put in.
pub const CONSTRAINT_DEPTH_MAX: usize = 64;
/// Tags of constraints, with templates put in.
pub const CONSTRAINT_TAGS_MAX: usize = 100_000;
/// Events and constraints of one field.
pub const CONSTRAINT_EVENTS_MAX: usize = 10_000;
/// Bytes of all templates, each as often as it is put in.
pub const TEMPLATE_TEXT_MAX: usize = 4 << 20;
/// How deep templates may use templates.
pub const TEMPLATE_DEPTH_MAX: usize = 32;
/// Names that are compared with one that is nobody's, to find what was meant.
pub const NAMES_COMPARED: usize = 500;
/// A limit of time below this, in ms, was meant in seconds: no robot does anything in it.
pub const TIME_LIMIT_SHORT_MS: u32 = 100;
/// Entries of one report that are no verdict.
pub const CONSTRAINT_ENTRIES_MAX: usize = 10_000;
/// Bytes of all of them.
pub const CONSTRAINT_ENTRIES_BYTES: usize = 8 << 20;
/// Different errors of rules that are remembered, and errors of one event that are told.
pub const CONSTRAINT_COMPLAINTS_MAX: usize = 100;
/// Bytes of one message with its places filled.
pub const CONSTRAINT_MESSAGE_BYTES: usize = 64 << 10;
/// Rules that an explanation tells of.
pub const EXPLAINED_RULES_MAX: usize = 8;
/// Conditions of one of them.
pub const EXPLAINED_CONDITIONS_MAX: usize = 24;
/// Characters of a condition or a value in one.
pub const EXPLAINED_CHARS_MAX: usize = 120;
