//! Every limit of this crate: how far diagrams, their saves, programs and texts may grow.

/// Bytes of a save as it comes, in any container.
pub const SAVE_BYTES: usize = 32 << 20;
/// Bytes of all entries of a save, unpacked.
pub const SAVE_UNPACKED_BYTES: usize = 48 << 20;
/// Bytes of one unpacked entry: the largest real ones are embedded images.
pub const ENTRY_BYTES: usize = 24 << 20;
/// How many bytes one packed byte can become: no stream of deflate does better (zlib's own documentation).
pub const UNPACKED_BYTES_OF_ONE: usize = 1032;
/// Entries of a save; the largest real one has 1500. What a zip without extensions can count.
pub const ENTRIES: usize = 65_535;
/// Bytes of an entry's name.
pub const ENTRY_NAME_BYTES: usize = 1024;
/// Objects that all lists of a save may name together; an object is named about four times.
pub const REFERENCES: usize = 300_000;
/// Blocks of a project that is run.
pub const NODES_MAX: usize = 2_000_000;
/// Threads that live at the same time, as in the original.
pub const THREADS_MAX: usize = 100;
/// Calls of subprograms that have not returned, as in the original.
pub const STACK_MAX: usize = 4000;
/// Messages that wait for one thread.
pub const MESSAGES_MAX: usize = 10_000;
/// Names of threads that one fork remembers.
pub const FORK_NAMES_MAX: usize = 10_000;
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
/// Blocks of a project that is written as text.
pub const GENERATED_BLOCKS_MAX: usize = 20_000;
/// Functions of a program that is written as text.
pub const GENERATED_FUNCTIONS_MAX: usize = 1000;
/// How deep an expression may nest that is written as text.
pub const GENERATED_DEPTH_MAX: usize = 100;
/// Blocks of one picture.
pub const PICTURE_BLOCKS_MAX: usize = 5000;
/// Corners of one link in a picture.
pub const PICTURE_CORNERS_MAX: usize = 64;
/// Breakpoints of a debugger, and threads that it holds alone.
pub const BREAKPOINTS_MAX: usize = 1000;
/// Variables that a debugger watches.
pub const WATCHES_MAX: usize = 100;
/// Bytes of a condition or a line of a breakpoint.
pub const CONDITION_MAX: usize = 4096;
/// Lines of breakpoints that wait for somebody to take them; the oldest are lost.
pub const DEBUG_LINES_MAX: usize = 1000;
/// Bytes of such a line.
pub const DEBUG_LINE_BYTES_MAX: usize = 1024;
/// Steps after which the past of a program has a copy of it: a second.
pub const HISTORY_STEPS: usize = 100;
/// Blocks after which it has one.
pub const HISTORY_BLOCKS: u64 = 2000;
/// Bytes that the past of a program takes on a PC.
pub const HISTORY_BYTES: usize = 64 << 20;
/// Moments and steps of the past that are looked at before a search pauses for orders: a millisecond on a PC.
pub const SEARCH_WORK: u64 = 4000;
/// How many of those a moment counts for at which a condition or a variable is looked at.
pub const SEARCH_LOOK_WORK: u64 = 50;
/// Bytes of an order to a debugger.
pub const ORDER_BYTES_MAX: usize = 16_384;
/// Bytes of what a refusal repeats of it.
pub const ORDER_WORD_BYTES_MAX: usize = 64;
/// Names that a refusal lists.
pub const NAMES_LISTED_MAX: usize = 20;
/// Characters of a name or a value that a debugger tells.
pub const TOLD_CHARACTERS_MAX: usize = 1000;
/// Bytes after which it tells of no more threads; a whole state is shorter than 256 KiB.
pub const TOLD_THREADS_BYTES: usize = 48 << 10;
/// Bytes after which it tells of no more calls of a thread.
pub const TOLD_CALLS_BYTES: usize = 16 << 10;
/// Bytes after which it tells of no more variables, or breakpoints.
pub const TOLD_VARIABLES_BYTES: usize = 96 << 10;
/// Bytes after which it tells of no more lines of breakpoints at once.
pub const TOLD_LINES_BYTES: usize = 64 << 10;
/// Lines that a stand-in keeps of what it was told.
pub const LOG_LINES_MAX: usize = 100_000;
/// Areas that are looked at for one text of a picture; pictures with more are not for people.
pub const PICTURE_AREAS_MAX: usize = 2000;
/// Rounds after which what changes in a program that is written as text counts as unclear.
pub const GENERATED_ROUNDS_MAX: usize = 64;
/// Characters of a name in a program that is written as text.
pub const GENERATED_NAME_MAX: usize = 60;
/// Characters of a property in a picture.
pub const PICTURE_PROPERTY_MAX: usize = 48;
/// Objects of a save to which a person adds: two for each block and link.
pub const EDIT_OBJECTS_MAX: usize = 60_000;
/// Bytes of a text that a person writes into a block.
pub const EDIT_TEXT_BYTES: usize = 64 << 10;
/// Bytes of what changes were, about; the oldest ones cannot be taken back then.
pub const EDIT_HISTORY_BYTES: usize = 128 << 20;
/// How far from the origin a block may be put, in px.
pub const EDIT_PLACE_MAX: f64 = 100_000.0;
/// Characters of an id or a name that a refusal repeats, and of the name of a type.
pub const EDIT_ID_SHOWN: usize = 120;
