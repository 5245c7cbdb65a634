//! Answers and notifications to bytes, in the layout of the protocol's structures.
//!
//! Pure. Owns the translation of our attributes into the kernel's; decides nothing.

use super::abi::{self, notify};
use crate::transport::{Attr, DirEntry, FileKind, StatFs};
use std::time::{Duration, SystemTime, UNIX_EPOCH};

/// Block size that `stat` and `statfs` show.
const BLOCK_BYTES: u32 = 4096;

/// A structure of `N` bytes, filled field by field in the machine's byte order.
struct Packed<const N: usize> {
    bytes: [u8; N],
    at: usize,
}

impl<const N: usize> Packed<N> {
    fn new() -> Self {
        Self {
            bytes: [0; N],
            at: 0,
        }
    }

    fn put<const M: usize>(mut self, field: [u8; M]) -> Self {
        self.bytes[self.at..self.at + M].copy_from_slice(&field);
        self.at += M;
        self
    }

    fn u16(self, value: u16) -> Self {
        self.put(value.to_ne_bytes())
    }

    fn u32(self, value: u32) -> Self {
        self.put(value.to_ne_bytes())
    }

    fn i32(self, value: i32) -> Self {
        self.put(value.to_ne_bytes())
    }

    fn u64(self, value: u64) -> Self {
        self.put(value.to_ne_bytes())
    }

    /// The structure; fields that were not put are zero.
    fn done(self) -> [u8; N] {
        self.bytes
    }
}

/// `fuse_out_header` of a message that `body` bytes follow. `error` is 0 or a positive errno.
pub(crate) fn answer_header(unique: u64, error: i32, body: usize) -> [u8; abi::OUT_HEADER] {
    header(unique, -error, body)
}

/// `fuse_out_header` of a notification that `body` bytes follow.
pub(crate) fn notify_header(code: i32, body: usize) -> [u8; abi::OUT_HEADER] {
    header(0, code, body)
}

fn header(unique: u64, error: i32, body: usize) -> [u8; abi::OUT_HEADER] {
    let length = u32::try_from(abi::OUT_HEADER + body).unwrap_or(u32::MAX);
    Packed::new().u32(length).i32(error).u64(unique).done()
}

/// Seconds and nanoseconds since 1970; times before it have negative seconds, as two's complement.
fn unix_time(time: SystemTime) -> (u64, u32) {
    match time.duration_since(UNIX_EPOCH) {
        Ok(after) => (after.as_secs(), after.subsec_nanos()),
        Err(before) => {
            let before = before.duration();
            match before.subsec_nanos() {
                0 => (before.as_secs().wrapping_neg(), 0),
                nanos => ((before.as_secs() + 1).wrapping_neg(), 1_000_000_000 - nanos),
            }
        }
    }
}

fn file_type(kind: FileKind) -> u32 {
    match kind {
        FileKind::Directory => libc::S_IFDIR,
        FileKind::File => libc::S_IFREG,
    }
}

/// `fuse_attr`, the last 88 bytes of `packed`.
fn put_attr<const N: usize>(packed: Packed<N>, attr: &Attr) -> Packed<N> {
    let (seconds, nanos) = unix_time(attr.modified);
    let links = match attr.kind {
        FileKind::Directory => 2,
        FileKind::File => 1,
    };
    packed
        .u64(attr.ino)
        .u64(attr.size)
        .u64(attr.size.div_ceil(512))
        .u64(seconds)
        .u64(seconds)
        .u64(seconds)
        .u32(nanos)
        .u32(nanos)
        .u32(nanos)
        .u32(file_type(attr.kind) | u32::from(attr.mode & 0o7777))
        .u32(links)
        .u32(attr.uid)
        .u32(attr.gid)
        .u32(0)
        .u32(BLOCK_BYTES)
        .u32(0)
}

/// `fuse_entry_out`: nodeid, generation, entry_valid, attr_valid, their nanoseconds, attr.
pub(crate) fn entry(attr: &Attr) -> [u8; 128] {
    let (entry_ttl, attr_ttl): (Duration, Duration) = (attr.entry_ttl, attr.attr_ttl);
    let packed = Packed::new()
        .u64(attr.ino)
        .u64(0)
        .u64(entry_ttl.as_secs())
        .u64(attr_ttl.as_secs())
        .u32(entry_ttl.subsec_nanos())
        .u32(attr_ttl.subsec_nanos());
    put_attr(packed, attr).done()
}

/// `fuse_attr_out`: attr_valid, its nanoseconds, dummy, attr.
pub(crate) fn attributes(attr: &Attr) -> [u8; 104] {
    let packed = Packed::new()
        .u64(attr.attr_ttl.as_secs())
        .u32(attr.attr_ttl.subsec_nanos())
        .u32(0);
    put_attr(packed, attr).done()
}

/// `fuse_open_out`: fh, open_flags, padding.
pub(crate) fn opened(fh: u64, flags: u32) -> [u8; 16] {
    Packed::new().u64(fh).u32(flags).done()
}

/// `fuse_write_out`, `fuse_poll_out` and `fuse_getxattr_out`: one number and padding.
pub(crate) fn number(value: u32) -> [u8; 8] {
    Packed::new().u32(value).done()
}

/// `fuse_statfs_out`: blocks, bfree, bavail, files, ffree, bsize, namelen, frsize. There is no space to speak of.
pub(crate) fn statfs(stat: &StatFs) -> [u8; 80] {
    Packed::new()
        .u64(0)
        .u64(0)
        .u64(0)
        .u64(stat.files)
        .u64(0)
        .u32(BLOCK_BYTES)
        .u32(stat.name_max)
        .u32(BLOCK_BYTES)
        .done()
}

/// Our side of INIT.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct InitReply {
    pub(crate) minor: u32,
    pub(crate) max_readahead: u32,
    /// Features that are switched on; `flags2` in the upper half.
    pub(crate) flags: u64,
    pub(crate) max_background: u16,
    pub(crate) max_write: u32,
    pub(crate) max_pages: u16,
}

/// `fuse_init_out`: major, minor, max_readahead, flags, max_background, congestion_threshold, max_write, time_gran,
/// max_pages, map_alignment, flags2 and reserved words. Its size has been the same since 7.23.
pub(crate) fn init(reply: &InitReply) -> [u8; 64] {
    let (low, high) = (reply.flags as u32, (reply.flags >> 32) as u32);
    Packed::new()
        .u32(abi::MAJOR)
        .u32(reply.minor)
        .u32(reply.max_readahead)
        .u32(low)
        .u16(reply.max_background)
        .u16(reply.max_background / 4 * 3)
        .u32(reply.max_write)
        .u32(1)
        .u16(reply.max_pages)
        .u16(0)
        .u32(high)
        .done()
}

/// Puts one `fuse_dirent` (ino, off, namelen, type, name, padding to eight bytes) at the start of `out`.
/// The bytes used, or None if it does not fit.
pub(crate) fn directory_entry(out: &mut [u8], entry: &DirEntry<'_>) -> Option<usize> {
    let name = entry.name.as_bytes();
    let end = abi::DIRENT + name.len();
    let padded = end.next_multiple_of(8);
    let out = out.get_mut(..padded)?;
    let head: [u8; abi::DIRENT] = Packed::new()
        .u64(entry.ino)
        .u64(entry.next)
        .u32(u32::try_from(name.len()).ok()?)
        .u32(file_type(entry.kind) >> 12)
        .done();
    out[..abi::DIRENT].copy_from_slice(&head);
    out[abi::DIRENT..end].copy_from_slice(name);
    out[end..].fill(0);
    Some(padded)
}

/// `fuse_notify_poll_wakeup_out`: kh.
pub(crate) fn poll_wakeup(handle: u64) -> [u8; 8] {
    handle.to_ne_bytes()
}

/// `fuse_notify_store_out`: nodeid, offset, size, padding; the data follows.
pub(crate) fn store(node: u64, size: u32) -> [u8; 24] {
    Packed::new().u64(node).u64(0).u32(size).done()
}

/// `fuse_notify_inval_entry_out`: parent, namelen, flags; the name and a zero byte follow.
pub(crate) fn invalidate_entry(parent: u64, name_length: u32) -> [u8; 16] {
    Packed::new().u64(parent).u32(name_length).done()
}

/// `fuse_notify_retrieve_out`: notify_unique, nodeid, offset, size, padding. Asks for the first byte of a file.
pub(crate) fn retrieve(node: u64) -> [u8; 32] {
    Packed::new().u64(0).u64(node).u64(0).u32(1).done()
}

/// A whole message that drops all cached bytes and attributes of a file, to be written to the device at once.
///
/// For the process that keeps the connection when the filesystem itself has died.
/// `fuse_notify_inval_inode_out`: ino, off, len; an offset and a length of zero mean everything.
pub fn invalidate_message(ino: u64) -> [u8; 40] {
    let header = notify_header(notify::INVAL_INODE, 24);
    Packed::new().put(header).u64(ino).done()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn attr(kind: FileKind) -> Attr {
        Attr {
            ino: 3,
            kind,
            size: 513,
            mode: 0o644,
            uid: 5,
            gid: 6,
            modified: UNIX_EPOCH + Duration::new(10, 11),
            attr_ttl: Duration::new(1, 2),
            entry_ttl: Duration::new(3, 4),
        }
    }

    fn u32_at(bytes: &[u8], at: usize) -> u32 {
        u32::from_ne_bytes(bytes[at..at + 4].try_into().unwrap())
    }

    fn u64_at(bytes: &[u8], at: usize) -> u64 {
        u64::from_ne_bytes(bytes[at..at + 8].try_into().unwrap())
    }

    #[test]
    fn an_entry_is_laid_out_as_the_kernel_reads_it() {
        let bytes = entry(&attr(FileKind::File));
        assert_eq!([0, 8, 16, 24].map(|at| u64_at(&bytes, at)), [3, 0, 3, 1]);
        assert_eq!([32, 36].map(|at| u32_at(&bytes, at)), [4, 2]);
        assert_eq!(
            [40, 48, 56, 64, 72, 80].map(|at| u64_at(&bytes, at)),
            [3, 513, 2, 10, 10, 10]
        );
        let words = [88, 92, 96, 100, 104, 108, 112, 116, 120, 124].map(|at| u32_at(&bytes, at));
        assert_eq!(words, [11, 11, 11, 0o100_644, 1, 5, 6, 0, 4096, 0]);
    }

    #[test]
    fn attributes_carry_their_own_time_to_live() {
        let bytes = attributes(&attr(FileKind::Directory));
        assert_eq!(u64_at(&bytes, 0), 1);
        assert_eq!(u32_at(&bytes, 8), 2);
        assert_eq!(u64_at(&bytes, 16), 3);
        assert_eq!(u32_at(&bytes, 76), 0o040_644);
        assert_eq!(u32_at(&bytes, 80), 2);
    }

    #[test]
    fn times_before_1970_round_down() {
        assert_eq!(
            unix_time(UNIX_EPOCH - Duration::from_secs(2)),
            (2_u64.wrapping_neg(), 0)
        );
        let time = UNIX_EPOCH - Duration::new(1, 250_000_000);
        assert_eq!(unix_time(time), (2_u64.wrapping_neg(), 750_000_000));
    }

    #[test]
    fn directory_entries_are_padded_and_never_cut() {
        let entry = DirEntry {
            ino: 9,
            kind: FileKind::Directory,
            name: "motors",
            next: 2,
        };
        let mut out = [0xff; 40];
        assert_eq!(directory_entry(&mut out, &entry), Some(32));
        assert_eq!([0, 8].map(|at| u64_at(&out, at)), [9, 2]);
        assert_eq!([16, 20].map(|at| u32_at(&out, at)), [6, 4]);
        assert_eq!(&out[24..33], b"motors\0\0\xff");
        assert_eq!(directory_entry(&mut out[..31], &entry), None);
    }

    #[test]
    fn an_invalidation_is_a_whole_message() {
        let bytes = invalidate_message(77);
        assert_eq!([0, 4].map(|at| u32_at(&bytes, at)), [40, 2]);
        assert_eq!([8, 16, 24, 32].map(|at| u64_at(&bytes, at)), [0, 77, 0, 0]);
    }

    #[test]
    fn errors_are_negative_in_the_header() {
        let bytes = answer_header(8, libc::EIO, 0);
        assert_eq!(u32_at(&bytes, 0), 16);
        assert_eq!(u32_at(&bytes, 4), (-5_i32) as u32);
        assert_eq!(u64_at(&bytes, 8), 8);
    }
}
