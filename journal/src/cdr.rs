//! CDR (XCDR1, little endian): values one after the other, each at a multiple of its size.
//!
//! Owns the bytes. After a head of four bytes, from which alignment is counted, come the fields without names. What the
//! fields are is known to the types. Reading believes nothing.

/// Little endian, plain CDR.
const HEAD: [u8; 4] = [0, 1, 0, 0];

/// A message that is written.
#[derive(Clone, Debug)]
pub struct Writer(Vec<u8>);

impl Default for Writer {
    fn default() -> Self {
        Self(HEAD.to_vec())
    }
}

macro_rules! puts {
    ($($(#[$what:meta])* $put:ident($kind:ty),)+) => {
        $($(#[$what])* pub fn $put(&mut self, value: $kind) -> &mut Self {
            self.align(size_of::<$kind>());
            self.0.extend_from_slice(&value.to_le_bytes());
            self
        })+
    };
}

impl Writer {
    /// Nothing but the head.
    pub fn new() -> Self {
        Self::default()
    }

    puts! {
        /// Eight bits.
        u8(u8),
        /// 32 bits.
        u32(u32),
        /// 32 bits, signed.
        i32(i32),
        /// 32 bits.
        f32(f32),
        /// 64 bits.
        f64(f64),
    }

    fn align(&mut self, size: usize) {
        let at = self.0.len() - HEAD.len();
        let filled = at.next_multiple_of(size) + HEAD.len();
        self.0.resize(filled, 0);
    }

    /// A number as its bytes, little endian; there are 1, 2, 4 or 8.
    pub fn number(&mut self, bytes: &[u8]) -> &mut Self {
        self.align(bytes.len());
        self.0.extend_from_slice(bytes);
        self
    }

    /// A text; zero bytes end it.
    pub fn string(&mut self, text: &str) -> &mut Self {
        let text = text.split('\0').next().unwrap_or_default();
        self.u32(u32::try_from(text.len() + 1).unwrap_or(u32::MAX));
        self.0.extend_from_slice(text.as_bytes());
        self.0.push(0);
        self
    }

    /// A sequence, each element by itself.
    pub fn sequence<T>(&mut self, all: &[T], put: impl Fn(&mut Self, &T)) -> &mut Self {
        self.u32(u32::try_from(all.len()).unwrap_or(u32::MAX));
        for one in all {
            put(self, one);
        }
        self
    }

    /// Bytes as they are: a fixed array, or the elements of a sequence.
    pub fn bytes(&mut self, bytes: &[u8]) -> &mut Self {
        self.0.extend_from_slice(bytes);
        self
    }

    /// The message.
    pub fn finish(self) -> Vec<u8> {
        self.0
    }
}

/// A message that is read. Each call gives None once there is not enough, or the bytes are not what is asked for.
#[derive(Clone, Debug)]
pub struct Reader<'a> {
    all: &'a [u8],
    at: usize,
}

impl<'a> Reader<'a> {
    /// None if the head is another one.
    pub fn new(message: &'a [u8]) -> Option<Self> {
        message.starts_with(&HEAD).then_some(Self {
            all: message,
            at: HEAD.len(),
        })
    }

    /// So many bytes, from where they begin.
    pub fn bytes(&mut self, size: usize) -> Option<&'a [u8]> {
        let end = self.at.checked_add(size)?;
        let bytes = self.all.get(self.at..end)?;
        self.at = end;
        Some(bytes)
    }

    /// A number of 1, 2, 4 or 8 bytes.
    pub fn number(&mut self, size: usize) -> Option<&'a [u8]> {
        let from_head = self.at - HEAD.len();
        self.at = from_head.checked_next_multiple_of(size)? + HEAD.len();
        self.bytes(size)
    }

    /// 32 bits.
    pub fn u32(&mut self) -> Option<u32> {
        let bytes = self.number(4)?;
        Some(u32::from_le_bytes(bytes.try_into().ok()?))
    }

    /// 32 bits, signed.
    pub fn i32(&mut self) -> Option<i32> {
        self.u32().map(u32::cast_signed)
    }

    /// Eight bits.
    pub fn u8(&mut self) -> Option<u8> {
        self.bytes(1).map(|bytes| bytes[0])
    }

    /// A text.
    pub fn string(&mut self) -> Option<&'a str> {
        let size = usize::try_from(self.u32()?).ok()?;
        let (text, end) = self.bytes(size)?.split_at_checked(size.checked_sub(1)?)?;
        (end == [0]).then(|| std::str::from_utf8(text).ok())?
    }

    /// Whether all bytes were read.
    pub fn is_at_end(&self) -> bool {
        self.at == self.all.len()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn hex(bytes: &[u8]) -> String {
        bytes.iter().map(|byte| format!("{byte:02x}")).collect()
    }

    // The examples were made by another implementation: sensor_msgs/Range of Jazzy and JointState, by rosbags.
    #[test]
    fn filler_is_counted_from_after_the_head() {
        let mut range = Writer::new();
        range.i32(1_700_000_000).u32(250_000_000).string("front");
        range.u8(1).f32(0.5).f32(0.1).f32(0.8).f32(0.25);
        assert_eq!(
            hex(&range.finish()),
            "0001000000f1536580b2e60e0600000066726f6e740001000000003fcdcccc3dcdcc4c3f0000803e"
        );
        let mut joints = Writer::new();
        joints.i32(1_700_000_000).u32(250_000_000).string("front");
        joints.sequence(&["M3", "M4"], |out, name| {
            out.string(name);
        });
        joints.sequence(&[1.0, 2.0], |out, one| {
            out.f64(*one);
        });
        joints.sequence::<f64>(&[], |out, one| {
            out.f64(*one);
        });
        joints.sequence(&[30.0, -30.0], |out, one| {
            out.f64(*one);
        });
        assert_eq!(
            hex(&joints.finish()),
            concat!(
                "0001000000f1536580b2e60e0600000066726f6e740000000200000003000000",
                "4d330000030000004d3400000200000000000000000000000000f03f00000000",
                "0000004000000000020000000000000000003e400000000000003ec0"
            )
        );
    }

    #[test]
    fn what_was_written_is_read_back() {
        let mut out = Writer::new();
        out.u8(7).string("\u{fc}ber").f64(1.5).i32(-3);
        let message = out.finish();
        let mut read = Reader::new(&message).unwrap();
        assert_eq!(read.u8(), Some(7));
        assert_eq!(read.string(), Some("\u{fc}ber"));
        assert_eq!(read.number(8), Some(&1.5_f64.to_le_bytes()[..]));
        assert_eq!(read.i32(), Some(-3));
        assert!(read.is_at_end());
        assert_eq!(read.u8(), None);
    }

    #[test]
    fn bytes_that_are_no_message_are_none() {
        assert!(Reader::new(&[0, 0, 0, 0, 1]).is_none());
        for body in [
            &[0_u8, 0, 0, 0][..],
            &[5, 0, 0, 0, b'a'],
            &[2, 0, 0, 0, b'a', b'b'],
            &[255, 255, 255, 255],
        ] {
            let mut message = HEAD.to_vec();
            message.extend_from_slice(body);
            assert_eq!(Reader::new(&message).unwrap().string(), None, "{body:?}");
        }
    }
}
