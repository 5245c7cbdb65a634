//! Every limit of this crate: how far models and their solutions may grow.

/// Bytes of a DCML document.
pub const DCML_TEXT_MAX: usize = 32 << 20;
/// How deep the tree of an expression of DCML may be: its nesting, and operators in a row.
pub const DCML_DEPTH: usize = 500;
/// Operations of one tape of a model, before those that nobody needs are gone.
pub const DCML_OPERATIONS_MAX: usize = 1 << 20;
/// Elements of a Jacobian of a model.
pub const DCML_JACOBIAN_MAX: usize = 1 << 20;
/// Steps of differentiation: operations that depend on an input, for all inputs together.
pub const DCML_JACOBIAN_STEPS_MAX: usize = 1 << 24;
/// Values that a batch of states keeps for each state at the same time.
pub const DCML_BATCH_ROWS_MAX: usize = 1 << 16;
/// Values and results of a model that is written in Java, whose methods end at 64 KiB.
pub const DCML_JAVA_VALUES: usize = 3000;
/// The same in Lua, whose functions end at 65536 constants.
pub const DCML_LUA_VALUES: usize = 30_000;
/// Steps of one solution of a model.
pub const DCML_STEPS_MAX: usize = 10_000_000;
/// Events of one solution of a model.
pub const DCML_EVENTS_MAX: usize = 100_000;
/// Words and signs of a document.
pub const DCML_TOKENS: usize = 4_000_000;
/// Errors of a document that are told, and as many warnings.
pub const DCML_DIAGNOSTICS: usize = 200;
/// Names among which the nearest to a mistyped one is looked for.
pub const DCML_WORDS_COMPARED: usize = 2000;
/// Bytes of a name that may be a mistyped one.
pub const DCML_WORD_COMPARED_BYTES: usize = 64;
/// Names of a loop, and bytes of a word, that a message shows.
pub const DCML_SHOWN: usize = 40;
/// Power of a base unit in a unit; none of use has a higher one.
pub const DCML_UNIT_POWER: i16 = 30;
/// Bytes of a name that is set as a symbol with an index.
pub const DCML_SYMBOL_BYTES: usize = 60;
/// Local names of a function in Lua, which allows 200.
pub const DCML_LUA_LOCALS: usize = 150;
/// Bytes of a written expression that becomes a part of another one.
pub const DCML_INLINE_BYTES: usize = 100;
/// Characters of a name in a written model; longer ones are cut.
pub const DCML_WRITTEN_NAME: usize = 60;
