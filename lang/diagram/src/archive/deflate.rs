//! Packed bytes of both containers: the border to the crate that unpacks.

use flate2::{Crc, Decompress, FlushDecompress, Status};

/// Unpacks one piece after another, with one set of tables.
pub(super) struct Unpacker {
    inner: Decompress,
    has_header: bool,
}

impl Unpacker {
    /// For streams of zlib, which have a header and a checksum.
    pub(super) fn new() -> Self {
        Self::of(true)
    }

    /// For the bare streams of a zip.
    pub(super) fn bare() -> Self {
        Self::of(false)
    }

    fn of(has_header: bool) -> Self {
        let inner = Decompress::new(has_header);
        Self { inner, has_header }
    }

    /// The piece, if it has exactly as many bytes as it should; takes no more memory than that.
    pub(super) fn unpack(&mut self, packed: &[u8], length: usize) -> Option<Vec<u8>> {
        self.inner.reset(self.has_header);
        // One more, so that a longer piece is seen.
        let mut piece = Vec::with_capacity(length + 1);
        let finish = FlushDecompress::Finish;
        let status = self.inner.decompress_vec(packed, &mut piece, finish).ok()?;
        let is_whole = status == Status::StreamEnd && piece.len() == length;
        is_whole.then_some(piece)
    }
}

/// The checksum of a zip.
pub(super) fn checksum(bytes: &[u8]) -> u32 {
    let mut sum = Crc::new();
    sum.update(bytes);
    sum.sum()
}
