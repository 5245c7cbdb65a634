//! Every limit of this crate: how far data-flow programs, their queues and their texts may grow.

/// Blocks of a project, instances of subprograms counted each time.
pub const NODES_MAX: usize = 200_000;
/// Edges of a project, likewise.
pub const EDGES_MAX: usize = 2_000_000;
/// Tokens that wait at one port; an edge may say less.
pub const QUEUE_MAX: usize = 1024;
/// Blocks of a program that becomes a converter.
pub const CONVERTER_NODES_MAX: usize = 5000;
/// Instants that a converter makes up for between two tuples; what is due later happens in one.
pub const CONVERTER_INSTANTS_MAX: u32 = 100;
/// Bytes of tokens that wait in a converter in C.
pub const C_BYTES_MAX: usize = 64 << 20;
/// Items of a list that is written in a converter in C, whose values are copied.
pub const C_ITEMS_MAX: usize = 64;
/// How deep expressions of a converter are nested: LuaJIT takes 200 levels, two for each bracket, and some stand around it.
pub const GENERATED_DEPTH_MAX: usize = 80;
/// What tokens that wait at all ports weigh together: each 1, and one more for 16 bytes of text and for each item.
pub const QUEUED_CELLS_MAX: u32 = 1_000_000;
/// Nodes that are looked at to find who drives a motor together with whom.
pub const WRITER_WALKS_MAX: usize = 2_000_000;
/// Tokens that are on their way within one instant.
pub const DELIVERIES_MAX: usize = 1_000_000;
/// Places for them in the beginning; a power of two.
pub const DELIVERIES_MIN: usize = 16;
/// Reactions of blocks within one instant.
pub const FIRINGS_MAX: u32 = 10_000;
/// Edges that are looked at to count the reactions of the first instant; after that nothing is said of them.
pub const INSTANT_LOOKS_MAX: usize = 2_000_000;
/// Items of a list that is a token.
pub const ITEMS_MAX: usize = 4096;
/// Bytes of a text that is a token.
pub const TEXT_BYTES_MAX: usize = 64 << 10;
/// Bytes of all texts of properties, instances counted each time.
pub const TEXTS_BYTES_MAX: usize = 4 << 20;
/// Instances of diagrams, the main one included.
pub const INSTANCES_MAX: usize = 100;
/// How deep calls may nest.
pub const DEPTH_MAX: usize = 16;
/// Messages of other robots that are taken in one instant.
pub const MAIL_MAX: usize = 100;
/// Words or lines that one reading of a file gives.
pub const PIECES_MAX: usize = 4096;
/// Blocks of a cycle that a message names.
pub const NAMED_MAX: usize = 8;
/// Names of a list in a message.
pub const LISTED_MAX: usize = 20;
/// Characters of a text that a message repeats.
pub const REPEATED_MAX: usize = 60;
/// Kinds of tokens that are told apart at one port of a subprogram; each text is one of its own.
pub const KINDS_MAX: usize = 16;
/// How often types and periods are handed on along edges; at the end of a chain that is longer in the wrong order they stay
/// unknown.
pub const PASSES_MAX: usize = 12;
/// How often the types of a program are inferred, each time with fewer variables whose type is taken from their tokens.
pub const GUESSES_MAX: usize = 3;
/// Pairs of blocks that are looked at for one motor.
pub const WRITER_PAIRS_MAX: usize = 64;
/// Reactions before the limit of an instant from which the blocks are remembered that may be a cycle.
pub const REMEMBERED_MAX: u32 = 64;
/// Bytes of a program as text.
pub const SOURCE_BYTES_MAX: usize = 32 << 20;
/// Diagrams of a program as text.
pub const SOURCE_DIAGRAMS_MAX: usize = 10_000;
/// Blocks of a program as text.
pub const SOURCE_BLOCKS_MAX: usize = 100_000;
/// Edges of a program as text.
pub const SOURCE_EDGES_MAX: usize = 400_000;
/// Bytes of an id in it: what a save can hold.
pub const SOURCE_ID_BYTES_MAX: usize = 512;
/// Bytes of a name in an id that is made of it.
pub const SOURCE_ID_NAME_BYTES_MAX: usize = 120;
/// Bytes of a label that is made of a caption.
pub const LABEL_BYTES_MAX: usize = 60;
/// Properties of all its blocks, and its keys.
pub const SOURCE_PROPERTIES_MAX: usize = 1_000_000;
/// Names that are compared with all those that are not known.
pub const NAMES_COMPARED_MAX: usize = 5000;
/// Blocks of one picture.
pub const PICTURE_BLOCKS_MAX: usize = 5000;
/// Edges of one picture.
pub const PICTURE_EDGES_MAX: usize = 2 * PICTURE_BLOCKS_MAX;
/// Corners of one edge in a picture.
pub const PICTURE_CORNERS_MAX: usize = 64;
/// Blocks beside which a way around others may run, the nearest ones.
pub const ROUTE_BOXES_MAX: usize = 100;
/// Corners that are tried for one such way.
pub const ROUTE_STEPS_MAX: usize = 20_000;
/// Blocks and empty squares that are looked at for all ways of a picture, or of all pictures of a project that are drawn together;
/// after that edges stay as they were drawn.
pub const ROUTE_LOOKS_MAX: usize = 4_000_000;
/// Characters of a property in a picture.
pub const PICTURE_PROPERTY_MAX: usize = 48;
/// Characters of a property in a sentence.
pub const SENTENCE_PROPERTY_MAX: usize = 400;
/// Own names of a block; their bits are in one byte.
pub const OWN_NAMES_MAX: usize = 8;
/// Bytes of what a debugger tells of variables, of ports, and of waiting tokens, each.
pub const TOLD_BYTES: usize = 16 << 10;
/// Characters of one text that it tells.
pub const TOLD_CHARACTERS_MAX: usize = 1000;
/// Ports whose last tokens a debugger keeps.
pub const TAP_PORTS_MAX: usize = 1000;
/// Blocks whose reactions a debugger counts.
pub const TAP_BLOCKS_MAX: usize = 1000;
/// What such a token weighs at most; of a longer one the text is kept that is told.
pub const TAP_CELLS_MAX: u32 = 64;
/// For how many milliseconds after a look tokens are kept for the next one.
pub const TAP_MS: u32 = 5000;
/// Blocks of a program of which a recording has what happens; of more it has how much that was.
pub const DIARY_BLOCKS_MAX: usize = 5000;
/// Bytes that a recording has of that in a millisecond: ten minutes of it are less than a page takes.
pub const DIARY_BYTES_PER_MS: usize = 20;
/// The same at once, or one block: a line of a recording with variables is no longer than it may be.
pub const DIARY_BYTES_MAX: usize = 4 << 10;
/// Characters of one text in it.
pub const DIARY_CHARACTERS_MAX: usize = 100;
/// Milliseconds after which a block that goes on is named again: of a black box the beginning may be gone.
pub const DIARY_NAMES_MS: u32 = 10_000;
