//! Packed bytes and checksums of both containers: the border to the crate that packs.

use flate2::{Compress, Compression, Crc, Decompress, FlushCompress, FlushDecompress, Status};

/// Unpacks one piece after another, with one set of tables.
pub(super) struct Unpacker {
    inner: Decompress,
    has_header: bool,
}

impl Unpacker {
    /// For bare deflate, or for streams of zlib with header and checksum.
    pub(super) fn new(has_header: bool) -> Self {
        Self {
            inner: Decompress::new(has_header),
            has_header,
        }
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

/// Packs bytes as bare deflate; `None` if that does not make them shorter.
pub(super) fn pack(bytes: &[u8]) -> Option<Vec<u8>> {
    let mut packed = Vec::with_capacity(bytes.len());
    let mut inner = Compress::new(Compression::default(), false);
    let status = inner.compress_vec(bytes, &mut packed, FlushCompress::Finish);
    (status.ok()? == Status::StreamEnd && packed.len() < bytes.len()).then_some(packed)
}

/// CRC-32 of IEEE 802.3, as zip has it.
pub(super) fn checksum(bytes: &[u8]) -> u32 {
    let mut crc = Crc::new();
    crc.update(bytes);
    crc.sum()
}
