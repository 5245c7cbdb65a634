//! INIT: what the kernel offers against what is known here.
//!
//! Pure. A feature is used only if the kernel offers it and the agreed version has it; each has a way to do without:
//! no atomic O_TRUNC, the kernel sends a SETATTR; no big writes, 4 KiB at a time; no NOFLUSH, FLUSH is answered;
//! no STREAM, the files are only not seekable and a waiting read holds up a write of the same descriptor;
//! no parallel direct writes, the kernel serialises the writers of a file.

use super::SessionOptions;
use super::abi::{self, fopen, init};
use super::decode::KernelInit;
use super::encode::InitReply;
use crate::limits::{BACKGROUND_MAX, TRANSFER_BYTES_MAX};
use crate::transport::{Access, Opened};

/// Features wanted, each with the first minor version that has it. Left out on purpose: AUTO_INVAL_DATA (a GETATTR for
/// each cached read), WRITEBACK_CACHE (writes would come late or never), ASYNC_DIO (reads become background requests,
/// of which only a few may wait), READDIRPLUS, POSIX_ACL, ABORT_ERROR.
const WANTED: [(u64, u32); 4] = [
    (init::ATOMIC_O_TRUNC, 9),
    (init::BIG_WRITES, 9),
    (init::PARALLEL_DIROPS, 25),
    (init::MAX_PAGES, 28),
];
/// First minor version whose header has FOPEN_STREAM. Stable kernels back to 4.14 have it without saying so.
const STREAM_SINCE: u32 = 31;
/// First minor version with FOPEN_NOFLUSH.
const NOFLUSH_SINCE: u32 = 35;
/// First minor version with FOPEN_PARALLEL_DIRECT_WRITES.
const PARALLEL_WRITES_SINCE: u32 = 38;
/// Bytes of a write without BIG_WRITES.
const SMALL_WRITE_BYTES: u32 = 4096;

/// What was agreed.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Features {
    /// Minor version spoken.
    pub(crate) minor: u32,
    stream: bool,
    noflush: bool,
    parallel_writes: bool,
}

impl Features {
    /// What open files can have with a kernel of this minor version, which may have been given STREAM without saying so.
    pub(crate) fn of_version(minor: u32) -> Self {
        Self {
            minor,
            stream: true,
            noflush: minor >= NOFLUSH_SINCE,
            parallel_writes: minor >= PARALLEL_WRITES_SINCE,
        }
    }

    /// `open_flags` for an open file. Bits that a kernel does not know it ignores.
    pub(crate) fn open_flags(&self, opened: &Opened) -> u32 {
        let parallel = if self.parallel_writes {
            fopen::PARALLEL_DIRECT_WRITES
        } else {
            0
        };
        let stream = if self.stream { fopen::STREAM } else { 0 };
        let access = match opened.access {
            Access::Direct => fopen::DIRECT_IO | parallel,
            Access::Stream => fopen::DIRECT_IO | fopen::NONSEEKABLE | stream | parallel,
            Access::Cached => fopen::KEEP_CACHE,
        };
        let noflush = if self.noflush && !opened.flush {
            fopen::NOFLUSH
        } else {
            0
        };
        access | noflush
    }
}

/// Outcome of INIT.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Negotiated {
    /// Send this and serve.
    Agreed(Features, InitReply),
    /// The kernel speaks a newer major version: send this, and it will ask again with ours.
    AskAgain(InitReply),
    /// No common version.
    TooOld,
}

/// Answers INIT. `page_bytes` is the size of a memory page.
pub(crate) fn negotiate(
    kernel: &KernelInit,
    options: &SessionOptions,
    page_bytes: usize,
) -> Negotiated {
    let mut reply = InitReply {
        minor: abi::MINOR.min(options.minor_max),
        max_readahead: kernel.max_readahead.min(TRANSFER_BYTES_MAX as u32),
        flags: 0,
        max_background: BACKGROUND_MAX,
        max_write: SMALL_WRITE_BYTES,
        max_pages: 0,
    };
    if kernel.major > abi::MAJOR {
        return Negotiated::AskAgain(reply);
    }
    if kernel.major < abi::MAJOR || kernel.minor < abi::MINOR_MIN {
        return Negotiated::TooOld;
    }
    let minor = reply.minor.min(kernel.minor);
    reply.minor = minor;
    for (bit, since) in WANTED {
        if minor >= since {
            reply.flags |= kernel.flags & !options.withhold & bit;
        }
    }
    if reply.flags & init::BIG_WRITES != 0 {
        reply.max_write = TRANSFER_BYTES_MAX as u32;
    }
    if reply.flags & init::MAX_PAGES != 0 {
        reply.max_pages =
            u16::try_from(TRANSFER_BYTES_MAX.div_ceil(page_bytes.max(1))).unwrap_or(u16::MAX);
    }
    let mut features = Features::of_version(minor);
    // A version held down on purpose must do without it.
    features.stream = options.minor_max >= STREAM_SINCE;
    Negotiated::Agreed(features, reply)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Everything that a kernel could offer.
    const ALL: u64 = u64::MAX;

    fn agreed(minor: u32, flags: u64, options: &SessionOptions) -> (Features, InitReply) {
        let kernel = KernelInit {
            major: 7,
            minor,
            max_readahead: 1 << 20,
            flags,
        };
        match negotiate(&kernel, options, 4096) {
            Negotiated::Agreed(features, reply) => (features, reply),
            other => panic!("{other:?}"),
        }
    }

    fn open_flags(features: &Features, access: Access, flush: bool) -> u32 {
        features.open_flags(&Opened {
            fh: 1,
            access,
            flush,
        })
    }

    const BASE: u64 = init::ATOMIC_O_TRUNC | init::BIG_WRITES | init::PARALLEL_DIROPS;

    #[test]
    fn the_controllers_kernel_gets_what_it_knows() {
        let (features, reply) = agreed(26, 0x1f_ffff, &SessionOptions::default());
        assert_eq!(reply.minor, 26);
        assert_eq!(reply.flags, BASE);
        assert_eq!(
            (reply.max_write, reply.max_pages, reply.max_readahead),
            (131_072, 0, 131_072)
        );
        let expected = fopen::DIRECT_IO | fopen::STREAM | fopen::NONSEEKABLE;
        assert_eq!(open_flags(&features, Access::Stream, false), expected);
        assert_eq!(
            open_flags(&features, Access::Direct, false),
            fopen::DIRECT_IO
        );
        assert_eq!(
            open_flags(&features, Access::Cached, false),
            fopen::KEEP_CACHE
        );
    }

    #[test]
    fn newer_kernels_get_more() {
        let (features, reply) = agreed(31, ALL, &SessionOptions::default());
        assert_eq!((reply.minor, reply.flags), (31, BASE | init::MAX_PAGES));
        assert_eq!(reply.max_pages, 32);
        assert_eq!(
            open_flags(&features, Access::Direct, false),
            fopen::DIRECT_IO
        );

        let (features, reply) = agreed(36, ALL, &SessionOptions::default());
        assert_eq!((reply.minor, reply.flags), (36, BASE | init::MAX_PAGES));
        assert_eq!(
            open_flags(&features, Access::Direct, false),
            fopen::DIRECT_IO | fopen::NOFLUSH
        );
        assert_eq!(
            open_flags(&features, Access::Direct, true),
            fopen::DIRECT_IO
        );

        let (features, reply) = agreed(45, ALL, &SessionOptions::default());
        assert_eq!((reply.minor, reply.flags), (45, BASE | init::MAX_PAGES));
        let expected = fopen::DIRECT_IO | fopen::PARALLEL_DIRECT_WRITES | fopen::NOFLUSH;
        assert_eq!(open_flags(&features, Access::Direct, false), expected);
        assert_eq!(
            open_flags(&features, Access::Cached, false),
            fopen::KEEP_CACHE | fopen::NOFLUSH
        );
    }

    #[test]
    fn a_kernel_from_the_future_is_spoken_to_in_the_version_known_here() {
        let (features, reply) = agreed(99, ALL, &SessionOptions::default());
        assert_eq!((features.minor, reply.minor), (45, 45));
    }

    #[test]
    fn a_version_held_down_suppresses_the_newer_bits() {
        let options = SessionOptions {
            minor_max: 26,
            ..SessionOptions::default()
        };
        let (features, reply) = agreed(45, ALL, &options);
        assert_eq!((reply.minor, reply.flags, reply.max_pages), (26, BASE, 0));
        let expected = fopen::DIRECT_IO | fopen::NONSEEKABLE;
        assert_eq!(open_flags(&features, Access::Stream, false), expected);
        assert_eq!(
            open_flags(&features, Access::Direct, false),
            fopen::DIRECT_IO
        );
    }

    #[test]
    fn what_is_not_offered_or_withheld_is_not_switched_on() {
        let (_, reply) = agreed(45, 0, &SessionOptions::default());
        assert_eq!(
            (reply.flags, reply.max_write, reply.max_pages),
            (0, 4096, 0)
        );
        let options = SessionOptions {
            withhold: init::ATOMIC_O_TRUNC,
            ..SessionOptions::default()
        };
        let (_, reply) = agreed(45, ALL, &options);
        assert_eq!(
            reply.flags,
            (BASE | init::MAX_PAGES) & !init::ATOMIC_O_TRUNC
        );
    }

    #[test]
    fn large_memory_pages_make_for_few_of_them() {
        let kernel = KernelInit {
            major: 7,
            minor: 45,
            max_readahead: 0,
            flags: ALL,
        };
        let Negotiated::Agreed(_, reply) = negotiate(&kernel, &SessionOptions::default(), 65_536)
        else {
            panic!()
        };
        assert_eq!(reply.max_pages, 2);
    }

    #[test]
    fn other_major_versions_are_told_ours_or_refused() {
        let with = |major, minor| {
            let kernel = KernelInit {
                major,
                minor,
                ..KernelInit::default()
            };
            negotiate(&kernel, &SessionOptions::default(), 4096)
        };
        assert!(matches!(
            with(8, 0),
            Negotiated::AskAgain(InitReply {
                minor: 45,
                flags: 0,
                ..
            })
        ));
        assert_eq!(with(6, 40), Negotiated::TooOld);
        assert_eq!(with(7, 25), Negotiated::TooOld);
    }
}
