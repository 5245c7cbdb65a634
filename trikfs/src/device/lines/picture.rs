//! JPEG pictures that follow each other in a stream of bytes.
//!
//! Owns where a picture begins and ends: it is a chain of markers with lengths (ITU-T T.81, annex B), so a smaller
//! picture inside of one is no end of it. What the picture shows is not looked at. Pure; reads nothing.

use super::super::cutter::{Cut, fill};

const START: u8 = 0xd8;
const END: u8 = 0xd9;
const SCAN: u8 = 0xda;
/// Markers without a length: restarts, and a temporary one.
const RESTARTS: std::ops::RangeInclusive<u8> = 0xd0..=0xd7;
const TEMPORARY: u8 = 0x01;

/// What the next byte is.
#[derive(Clone, Copy)]
enum Next {
    /// Anything outside of a picture.
    Outside,
    /// Behind a 0xff outside of a picture.
    Begin,
    /// The 0xff of a marker.
    Marker,
    /// What kind of marker it is.
    Kind,
    /// The two bytes of its length.
    LengthHigh(u8),
    LengthLow(u8, u8),
    /// One of so many bytes that belong to it.
    Body(u8, u16),
    /// Compressed points.
    Points,
    /// Behind a 0xff among them.
    AmongPoints,
}

/// Bytes to pictures.
pub(super) struct Pictures {
    picture: Vec<u8>,
    next: Next,
    damaged: u32,
}

impl Default for Pictures {
    fn default() -> Self {
        Self {
            picture: Vec::new(),
            next: Next::Outside,
            damaged: 0,
        }
    }
}

impl Pictures {
    /// Gives the picture up; the byte may begin another one.
    fn lose(&mut self, byte: u8) -> Next {
        self.damaged += 1;
        self.picture.clear();
        if byte == 0xff {
            Next::Begin
        } else {
            Next::Outside
        }
    }

    fn begin(&mut self) -> Next {
        self.picture.clear();
        self.picture.extend([0xff, START]);
        Next::Marker
    }

    /// Behind the kind of a marker that is neither an end nor a start.
    fn after_kind(&mut self, kind: u8) -> Next {
        match kind {
            // More of the same may stand before the kind.
            0xff => Next::Kind,
            0 => self.lose(kind),
            TEMPORARY => Next::Marker,
            kind if RESTARTS.contains(&kind) => Next::Marker,
            kind => Next::LengthHigh(kind),
        }
    }

    /// Takes one byte; true if it ends a picture.
    fn take(&mut self, byte: u8, size: usize) -> bool {
        let is_inside = !matches!(self.next, Next::Outside | Next::Begin);
        if is_inside {
            if self.picture.len() == size {
                self.next = self.lose(byte);
                return false;
            }
            self.picture.push(byte);
        }
        self.next = match (self.next, byte) {
            (Next::Outside, 0xff) | (Next::Begin, 0xff) => Next::Begin,
            (Next::Begin, START) if size >= 2 => self.begin(),
            (Next::Outside | Next::Begin, _) => Next::Outside,
            (Next::Marker, 0xff) => Next::Kind,
            (Next::Marker, _) => self.lose(byte),
            (Next::Kind | Next::AmongPoints, END) => {
                self.next = Next::Outside;
                return true;
            }
            // The end was lost.
            (Next::Kind | Next::AmongPoints, START) => {
                self.damaged += 1;
                self.begin()
            }
            (Next::Kind, kind) => self.after_kind(kind),
            (Next::LengthHigh(kind), high) => Next::LengthLow(kind, high),
            (Next::LengthLow(kind, high), low) => match u16::from_be_bytes([high, low]) {
                0 | 1 => self.lose(low),
                2 => behind(kind),
                length => Next::Body(kind, length - 2),
            },
            (Next::Body(kind, 1), _) => behind(kind),
            (Next::Body(kind, left), _) => Next::Body(kind, left - 1),
            (Next::Points, 0xff) => Next::AmongPoints,
            (Next::Points, _) => Next::Points,
            // A 0xff of the points themselves, or a mark between two parts of them.
            (Next::AmongPoints, 0) => Next::Points,
            (Next::AmongPoints, kind) if RESTARTS.contains(&kind) => Next::Points,
            (Next::AmongPoints, 0xff) => Next::AmongPoints,
            (Next::AmongPoints, kind) => self.after_kind(kind),
        };
        false
    }
}

/// What follows a marker with its body.
fn behind(kind: u8) -> Next {
    if kind == SCAN {
        Next::Points
    } else {
        Next::Marker
    }
}

impl Cut for Pictures {
    fn cut(&mut self, input: &[u8], is_end: bool, tuple: &mut [u8]) -> (usize, bool) {
        for (index, &byte) in input.iter().enumerate() {
            if self.take(byte, tuple.len()) {
                fill(tuple, &self.picture);
                self.picture.clear();
                return (index + 1, true);
            }
        }
        if is_end {
            // The writer has left inside a picture: the next one begins anew.
            self.damaged += u32::from(!self.picture.is_empty());
            self.picture.clear();
            self.next = Next::Outside;
        }
        (input.len(), false)
    }

    fn take_damaged(&mut self) -> u32 {
        std::mem::take(&mut self.damaged)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    /// Start, a body with a smaller picture in it, points with a stuffed 0xff and a restart, the end.
    const PICTURE: &[u8] =
        b"\xff\xd8\xff\xe1\x00\x08\xff\xd8\xff\xd9ab\xff\xda\x00\x03x12\xff\x003\xff\xd04\xff\xd9";

    /// All pictures of some bytes that come in pieces, and how much was damaged.
    fn all(bytes: &[u8], size: usize, piece: usize) -> (Vec<Vec<u8>>, u32) {
        let mut pictures = Pictures::default();
        let (mut found, mut tuple) = (Vec::new(), vec![0; size]);
        for mut part in bytes.chunks(piece) {
            while !part.is_empty() {
                let (taken, is_made) = pictures.cut(part, false, &mut tuple);
                if is_made {
                    found.push(tuple.clone());
                }
                part = &part[taken..];
            }
        }
        pictures.cut(&[], true, &mut tuple);
        (found, pictures.take_damaged())
    }

    #[test]
    fn a_picture_ends_behind_its_points_and_not_in_a_body() {
        for piece in [1, 2, 7, 1000] {
            let bytes = [b"noise\xff\xff", PICTURE, b"\xff\x00", PICTURE].concat();
            let (found, damaged) = all(&bytes, 40, piece);
            assert_eq!((found.len(), damaged), (2, 0), "{piece}");
            for picture in found {
                assert_eq!(&picture[..PICTURE.len()], PICTURE);
                assert!(picture[PICTURE.len()..].iter().all(|&byte| byte == 0));
            }
        }
        let exactly = all(PICTURE, PICTURE.len(), 5);
        assert_eq!(exactly, (vec![PICTURE.to_vec()], 0));
    }

    #[test]
    fn what_is_torn_or_too_long_is_counted_and_the_next_one_is_found() {
        for cut in 2..PICTURE.len() {
            let bytes = [&PICTURE[..cut], PICTURE, PICTURE, PICTURE, PICTURE].concat();
            let (found, damaged) = all(&bytes, 64, 3);
            // A body whose length reaches into the next pictures takes those with it; where it ends at a marker of the
            // next one, both together are a picture, as far as markers tell.
            let is_seamless = [10, 16].contains(&cut);
            assert!(damaged >= 1 || is_seamless, "{cut}: {found:?}");
            assert!((1..=4).contains(&found.len()), "{cut}: {found:?}");
            assert!(
                found.iter().any(|picture| picture.starts_with(PICTURE)),
                "{cut}"
            );
        }
        let (found, damaged) = all(&[PICTURE, PICTURE].concat(), PICTURE.len() - 1, 4);
        assert_eq!((found.len(), damaged), (0, 2));
        assert_eq!(all(&PICTURE[..9], 64, 64), (Vec::new(), 1));
    }

    proptest! {
        #[test]
        fn any_bytes_are_taken_in_any_pieces(
            bytes in proptest::collection::vec(prop_oneof![Just(0xff), Just(0xd8), Just(0xd9), Just(0xda), 0..4_u8], 0..400),
            piece in 1..50_usize,
        ) {
            prop_assert_eq!(all(&bytes, 16, piece), all(&bytes, 16, 1));
        }
    }
}
