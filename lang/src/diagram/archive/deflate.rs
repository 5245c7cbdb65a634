//! Packed bytes of the old container: the border to the crate that unpacks.

use flate2::{Decompress, FlushDecompress, Status};

/// Unpacks one piece after another, with one set of tables.
pub(super) struct Unpacker(Decompress);

impl Unpacker {
    /// For streams of zlib, which have a header and a checksum.
    pub(super) fn new() -> Self {
        Self(Decompress::new(true))
    }

    /// The piece, if it has exactly as many bytes as it should; takes no more memory than that.
    pub(super) fn unpack(&mut self, packed: &[u8], length: usize) -> Option<Vec<u8>> {
        self.0.reset(true);
        // One more, so that a longer piece is seen.
        let mut piece = Vec::with_capacity(length + 1);
        let finish = FlushDecompress::Finish;
        let status = self.0.decompress_vec(packed, &mut piece, finish).ok()?;
        let is_whole = status == Status::StreamEnd && piece.len() == length;
        is_whole.then_some(piece)
    }
}
