//! Every limit of a recording.
//!
//! Owns the numbers only; the code that enforces each one names it from here.

/// Fields of one `format`, as in a configuration.
pub const FIELDS_MAX: usize = 1024;
/// Bytes of one tuple, as in a configuration.
pub const TUPLE_BYTES_MAX: usize = 4 << 20;
/// Bytes of the text of a `format`: that many fields with names of 64 bytes.
pub const FORMAT_BYTES_MAX: usize = 128 << 10;
/// Nodes of one recording: ids of channels have 16 bits, and a configuration has at most 4096 nodes.
pub const NODES_MAX: usize = 8192;
/// Bytes of a reason or a line of the log.
pub const TEXT_BYTES_MAX: usize = 8 << 10;
/// Bytes that are compressed together. A chunk begins with nothing known, so smaller ones make a file larger; larger ones take
/// more memory of a recorder, more of them is lost by damage, and more is decompressed to find one message.
pub const CHUNK_BYTES: u64 = 128 << 10;
/// Bytes of one record that a reader takes: a chunk may be one tuple long, and what frames it.
pub const RECORD_BYTES_MAX: usize = 16 << 20;
/// Bytes of one attachment that a reader takes.
pub const ATTACHMENT_BYTES_MAX: u64 = 64 << 20;
/// Bytes of the summary that a reader takes: a chunk index has some 100 bytes and those of its channels.
pub const SUMMARY_BYTES_MAX: u64 = 256 << 20;
/// Chunks that are read back for the newest value of every node, before only the nodes without one are looked for.
pub const CHUNKS_BACK: usize = 4;
/// Bytes of a chunk that are decompressed at most for each byte of it: lz4 reaches 255.
pub const INFLATION_MAX: u64 = 256;
