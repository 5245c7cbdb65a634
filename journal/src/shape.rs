//! The lengths inside a record, checked before the library takes memory for what they promise.
//!
//! Owns the parts of which each kind of record consists, as far as they say how long something is. What they mean is known to
//! the library.

use mcap::records::op;

/// A part of a record.
enum Part {
    /// So many bytes.
    Fixed(usize),
    /// A length of 32 bits, and so many bytes.
    Counted,
    /// The same, and in these bytes pairs of which each half is counted.
    Words,
}

use Part::{Counted, Fixed, Words};

/// The parts of a record with this opcode up to the last that is counted; nothing for one without any.
fn parts(opcode: u8) -> &'static [Part] {
    match opcode {
        op::HEADER => &[Counted, Counted],
        op::SCHEMA => &[Fixed(2), Counted, Counted, Counted],
        op::CHANNEL => &[Fixed(4), Counted, Counted, Words],
        op::CHUNK => &[Fixed(28), Counted, Fixed(8)],
        op::MESSAGE_INDEX => &[Fixed(2), Counted],
        op::CHUNK_INDEX => &[Fixed(32), Counted, Fixed(8), Counted, Fixed(16)],
        op::ATTACHMENT => &[Fixed(16), Counted, Counted, Fixed(8 + 4)],
        op::ATTACHMENT_INDEX => &[Fixed(40), Counted, Counted],
        op::STATISTICS => &[Fixed(42), Counted],
        op::METADATA => &[Counted, Words],
        op::METADATA_INDEX => &[Fixed(16), Counted],
        _ => &[],
    }
}

/// Whether everything that a record counts is in it.
pub(crate) fn is_whole(opcode: u8, record: &[u8]) -> bool {
    let mut rest = record;
    parts(opcode).iter().all(|part| {
        match part {
            Fixed(bytes) => take(&mut rest, *bytes).map(|_| true),
            Counted => counted(&mut rest).map(|_| true),
            Words => counted(&mut rest).map(are_words),
        }
        .unwrap_or(false)
    })
}

fn are_words(mut bytes: &[u8]) -> bool {
    while !bytes.is_empty() {
        if counted(&mut bytes)
            .and_then(|_| counted(&mut bytes))
            .is_none()
        {
            return false;
        }
    }
    true
}

fn take<'a>(rest: &mut &'a [u8], bytes: usize) -> Option<&'a [u8]> {
    let (taken, after) = rest.split_at_checked(bytes)?;
    *rest = after;
    Some(taken)
}

fn counted<'a>(rest: &mut &'a [u8]) -> Option<&'a [u8]> {
    let length = take(rest, 4)?.try_into().map(u32::from_le_bytes).ok()?;
    take(rest, usize::try_from(length).ok()?)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_is_counted_is_in_the_record() {
        let header = [&[1, 0, 0, 0][..], b"p", &[2, 0, 0, 0], b"lb"].concat();
        assert!(is_whole(op::HEADER, &header));
        assert!(!is_whole(op::HEADER, &header[..header.len() - 1]));
        let mut long = header;
        long[8] = 0xff;
        assert!(!is_whole(op::HEADER, &long));
        let words = [&[8, 0, 0, 0][..], &[0; 8]].concat();
        let channel = |words: &[u8]| [&[0; 12][..], words].concat();
        assert!(is_whole(op::CHANNEL, &channel(&words)));
        let mut beyond = channel(&words);
        beyond[16] = 9;
        assert!(!is_whole(op::CHANNEL, &beyond));
        // Kinds that count nothing are for the library.
        assert!(is_whole(op::MESSAGE, &[]) && is_whole(0x80, &[1]));
    }
}
