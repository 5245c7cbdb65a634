//! Every limit of the language: what may grow, and how far.

/// How many diamonds one condition of a generated program may stand for.
pub const CONDITION_TESTS_MAX: usize = 8;
/// How many statements a structured program may have for each block, because of copies.
pub const COPIES_PER_BLOCK: usize = 2;
/// And beside that.
pub const COPIES_FREE: usize = 64;
/// How deep branches and loops of a structured program may nest.
pub const NESTING_MAX: usize = 40;
/// How deep its loops may nest; Python allows 20.
pub const LOOPS_NESTING_MAX: usize = 12;
/// How deep branches of one state nest in a program over states.
pub const STATES_NESTING_MAX: usize = 6;
