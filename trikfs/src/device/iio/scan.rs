//! What one sample of an IIO buffer looks like, and its numbers.
//!
//! Owns the types of scan elements (`be:s14/16>>2`) and the rule of their places: in the order of their indices,
//! each aligned to its own size, the whole sample to the largest. Source: Documentation/driver-api/iio/buffers.rst
//! and iio_compute_scan_bytes of the kernel. All switched-on channels count, also those that nobody listed.

use super::super::sysfs;
use crate::errno::Error;
use crate::limits;
use config::description::IioDescription;
use std::fmt;
use std::path::Path;

/// Why a device has no scan with the wanted channels: its driver, or what the configuration wants of it.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(super) enum NoScan {
    /// The channel of this name cannot be switched on.
    Off(String),
    /// The numbers of a channel are too long.
    Bits {
        /// Its name.
        channel: String,
        /// Of a number of the device.
        bits: u32,
        /// Of a number of the tuple.
        bytes: usize,
    },
}

impl fmt::Display for NoScan {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Off(channel) => write!(f, "the channel '{channel}' cannot be switched on"),
            Self::Bits {
                channel,
                bits,
                bytes,
            } => write!(
                f,
                "the channel '{channel}' has {bits} bits, which do not fit into {bytes} bytes"
            ),
        }
    }
}

/// One number in a sample.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct Element {
    is_big_endian: bool,
    is_signed: bool,
    /// Bits that count.
    bits: u32,
    /// Bytes in the sample.
    bytes: usize,
    /// Bits below those that count.
    shift: u32,
}

impl Element {
    /// `[be|le]:[s|u]BITS/STORAGE>>SHIFT`
    pub(super) fn parse(text: &str) -> Option<Self> {
        let (order, rest) = text.split_once(':')?;
        let (is_signed, rest) = match rest.split_at_checked(1)? {
            ("s", rest) => (true, rest),
            ("u", rest) => (false, rest),
            _ => return None,
        };
        let (bits, rest) = rest.split_once('/')?;
        let (storage, shift) = rest.split_once(">>")?;
        let is_big_endian = match order {
            "be" => true,
            "le" => false,
            _ => return None,
        };
        let (bits, storage): (u32, u32) = (bits.parse().ok()?, storage.parse().ok()?);
        let shift = shift.parse().ok()?;
        let bytes = match storage {
            8 => 1,
            16 => 2,
            32 => 4,
            64 => 8,
            _ => return None,
        };
        let fits = (1..=storage).contains(&bits) && shift <= storage - bits;
        fits.then_some(Self {
            is_big_endian,
            is_signed,
            bits,
            bytes,
            shift,
        })
    }

    /// The number in its bytes: shifted, cut to its bits, with its sign.
    fn value(&self, bytes: &[u8]) -> i64 {
        let append = |number: u64, byte: &u8| number << 8 | u64::from(*byte);
        let raw = if self.is_big_endian {
            bytes.iter().fold(0, append)
        } else {
            bytes.iter().rev().fold(0, append)
        };
        let unused = 64 - self.bits;
        let top = raw >> self.shift << unused;
        if self.is_signed {
            top.cast_signed() >> unused
        } else {
            (top >> unused).cast_signed()
        }
    }

    /// Whether each value fits into so many bytes with a sign.
    fn fits(&self, size: usize) -> bool {
        let room = if size == 8 { 64 } else { 32 };
        self.bits + u32::from(!self.is_signed) <= room
    }
}

/// The layout of a sample and the wanted numbers in it.
#[derive(Debug, PartialEq, Eq)]
pub(super) struct Scan {
    size: usize,
    /// Place, element and bytes in the tuple, in the order of the tuple.
    wanted: Vec<(usize, Element, usize)>,
}

impl Scan {
    /// Reads the descriptions of the elements that are switched on.
    pub(super) fn read(folder: &Path, channels: &[String]) -> Result<Self, Error> {
        let failed = |error: std::io::Error| super::device_error(folder, &error);
        let mut elements = Vec::new();
        for entry in std::fs::read_dir(folder)
            .map_err(failed)?
            .flatten()
            .take(limits::IIO_FILES_MAX)
        {
            let name = entry.file_name().to_string_lossy().into_owned();
            let Some(name) = name
                .strip_prefix("in_")
                .and_then(|name| name.strip_suffix("_en"))
            else {
                continue;
            };
            if sysfs::read_number::<u32>(&entry.path())? == 0 {
                continue;
            }
            let index: u32 = sysfs::read_number(&folder.join(format!("in_{name}_index")))?;
            let path = folder.join(format!("in_{name}_type"));
            let text = sysfs::read(&path)?;
            let Some(element) = Element::parse(&text) else {
                let shown: String = text.chars().take(32).flat_map(char::escape_debug).collect();
                let what = format!("{}: the type '{shown}' is not known", path.display());
                return Err(Error::Malformed(what));
            };
            elements.push((index, name.to_owned(), element));
        }
        elements.sort_by(|a, b| (a.0, &a.1).cmp(&(b.0, &b.1)));
        Self::new(&elements, channels)
            .map_err(|why| Error::Malformed(format!("{}: {why}", folder.display())))
    }

    /// Finds the place of each channel among the elements, which are in the order of their indices.
    pub(super) fn new(
        elements: &[(u32, String, Element)],
        channels: &[String],
    ) -> Result<Self, NoScan> {
        let mut end = 0usize;
        let mut placed = Vec::new();
        for (_, name, element) in elements {
            let at = end.next_multiple_of(element.bytes);
            placed.push((name, at, *element));
            end = at + element.bytes;
        }
        let largest = elements.iter().map(|(_, _, element)| element.bytes).max();
        let size = end.next_multiple_of(largest.unwrap_or(1));
        let mut wanted = Vec::new();
        for channel in channels {
            let Some((_, at, element)) = placed.iter().find(|(name, _, _)| *name == channel) else {
                return Err(NoScan::Off(channel.clone()));
            };
            let bytes = IioDescription::value_size(channel);
            if !element.fits(bytes) {
                return Err(NoScan::Bits {
                    channel: channel.clone(),
                    bits: element.bits,
                    bytes,
                });
            }
            wanted.push((*at, *element, bytes));
        }
        Ok(Self { size, wanted })
    }

    /// Bytes of a sample.
    pub(super) fn size(&self) -> usize {
        self.size
    }

    /// The wanted numbers of one sample, which has all its bytes.
    pub(super) fn decode(&self, sample: &[u8], tuple: &mut [u8]) {
        let mut rest = tuple;
        for (at, element, bytes) in &self.wanted {
            let value = element.value(&sample[*at..at + element.bytes]);
            let (here, behind) = rest.split_at_mut(*bytes);
            // Values fit: `new` has seen to it.
            here.copy_from_slice(&value.to_le_bytes()[..*bytes]);
            rest = behind;
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn elements(types: &[(&str, &str)]) -> Vec<(u32, String, Element)> {
        let element = |text: &str| Element::parse(text).expect(text);
        let all = (0..).zip(types);
        all.map(|(index, (name, text))| (index, (*name).to_owned(), element(text)))
            .collect()
    }

    fn scan(types: &[(&str, &str)], channels: &[&str]) -> Result<Scan, NoScan> {
        let channels: Vec<_> = channels.iter().map(|name| (*name).to_owned()).collect();
        Scan::new(&elements(types), &channels)
    }

    const ACCELEROMETER: [(&str, &str); 4] = [
        ("accel_x", "be:s14/16>>2"),
        ("accel_y", "be:s14/16>>2"),
        ("accel_z", "be:s14/16>>2"),
        ("timestamp", "le:s64/64>>0"),
    ];

    #[test]
    fn the_accelerometer_has_16_bytes_with_14_bits_on_the_left() {
        let scan = scan(
            &ACCELEROMETER,
            &["timestamp", "accel_x", "accel_y", "accel_z"],
        )
        .unwrap();
        assert_eq!(scan.size(), 16);
        let mut sample = vec![0x40, 0x00, 0xff, 0xfc, 0x80, 0x03, 0x99, 0x99];
        sample.extend(0x0102_0304_0506_0708i64.to_le_bytes());
        let mut tuple = [0; 20];
        scan.decode(&sample, &mut tuple);
        let mut wanted = 0x0102_0304_0506_0708i64.to_le_bytes().to_vec();
        // 0x4000 >> 2 = 4096; 0xfffc >> 2 = -1; 0x8003 >> 2 = -8192, the low bits are not part of it.
        for value in [4096i32, -1, -8192] {
            wanted.extend(value.to_le_bytes());
        }
        assert_eq!(tuple.to_vec(), wanted);
    }

    #[test]
    fn each_type_gives_the_number_that_was_computed_by_hand() {
        for (text, bytes, value) in [
            ("le:s16/16>>0", &[0x34, 0x12][..], 0x1234i64),
            ("le:s16/16>>0", &[0xff, 0xff], -1),
            ("le:u16/16>>0", &[0xff, 0xff], 65_535),
            ("be:s16/16>>0", &[0x80, 0x00], -32_768),
            ("be:s14/16>>2", &[0x7f, 0xff], 8_191),
            ("be:u12/16>>4", &[0xab, 0xcd], 0xabc),
            ("le:s12/16>>4", &[0x0f, 0x80], -2_048),
            ("le:s8/8>>0", &[0x80], -128),
            ("be:s24/32>>8", &[0xff, 0xff, 0xfe, 0x77], -2),
            ("le:u31/32>>1", &[0xff, 0xff, 0xff, 0xff], 0x7fff_ffff),
            ("le:s64/64>>0", &[0, 0, 0, 0, 0, 0, 0, 0x80], i64::MIN),
            ("be:s1/8>>7", &[0x80], -1),
        ] {
            assert_eq!(
                Element::parse(text).expect(text).value(bytes),
                value,
                "{text}"
            );
        }
    }

    #[test]
    fn elements_are_aligned_to_their_size_and_the_sample_to_the_largest() {
        let types = [
            ("a", "le:u8/8>>0"),
            ("b", "le:s32/32>>0"),
            ("c", "le:s16/16>>0"),
        ];
        let made = scan(&types, &["c", "b", "a"]).unwrap();
        let places: Vec<_> = made.wanted.iter().map(|(at, _, _)| *at).collect();
        assert_eq!((made.size(), places), (12, vec![8, 4, 0]));
        assert_eq!(scan(&ACCELEROMETER[..3], &["accel_z"]).unwrap().size(), 6);
        assert_eq!(scan(&ACCELEROMETER[2..], &["accel_z"]).unwrap().size(), 16);
    }

    #[test]
    fn types_that_cannot_be_are_refused() {
        for text in [
            "",
            "be",
            "be:s",
            "be:s16",
            "be:s16/16",
            "xe:s16/16>>0",
            "be:x16/16>>0",
            "be:s17/16>>0",
            "be:s16/16>>1",
            "be:s0/16>>0",
            "be:s16/17>>0",
            "be:s16/128>>0",
            "be:s8/8X2>>0",
            "be:s16/16>>-1",
            "be:s16/16>>4294967296",
            "be:\u{e9}16/16>>0",
        ] {
            assert_eq!(Element::parse(text), None, "{text}");
        }
    }

    #[test]
    fn a_channel_that_is_off_or_too_wide_is_refused() {
        assert_eq!(
            scan(&ACCELEROMETER, &["accel_q"]).unwrap_err().to_string(),
            "the channel 'accel_q' cannot be switched on"
        );
        assert_eq!(
            scan(&[("v", "le:u32/32>>0")], &["v"])
                .unwrap_err()
                .to_string(),
            "the channel 'v' has 32 bits, which do not fit into 4 bytes"
        );
    }
}
