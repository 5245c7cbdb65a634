//! One content hash for names in the cache and for the ledger's checksums.
//!
//! It finds accidents, not attacks: two contents can be chosen so that they collide.
//! Places where that would matter compare the contents as well.

/// 128-bit FNV-1a, fed in pieces. Offset basis and prime are those of the FNV specification
/// (Fowler, Noll, Vo; <http://www.isthe.com/chongo/tech/comp/fnv/>).
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Hash(u128);

impl Hash {
    const BASIS: u128 = 0x6c62_272e_07bb_0142_62b8_2175_6295_c58d;
    const PRIME: u128 = (1 << 88) + 0x13b;

    /// The hash of nothing.
    pub fn new() -> Self {
        Self(Self::BASIS)
    }

    /// The hash of `bytes`.
    pub fn of(bytes: &[u8]) -> Self {
        Self::new().bytes(bytes)
    }

    /// Adds bytes; splitting them differently does not change the result.
    #[must_use]
    pub fn bytes(self, bytes: &[u8]) -> Self {
        Self(bytes.iter().fold(self.0, |hash, byte| {
            (hash ^ u128::from(*byte)).wrapping_mul(Self::PRIME)
        }))
    }

    /// Adds one part of several: the length goes in too, so that the border between parts counts.
    #[must_use]
    pub fn part(self, bytes: &[u8]) -> Self {
        self.bytes(&(bytes.len() as u64).to_le_bytes()).bytes(bytes)
    }

    /// The value.
    pub fn value(self) -> u128 {
        self.0
    }

    /// 32 hexadecimal digits.
    pub fn hex(self) -> String {
        format!("{:032x}", self.0)
    }
}

impl Default for Hash {
    fn default() -> Self {
        Self::new()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_published_vectors_hold() {
        assert_eq!(Hash::of(b"").hex(), "6c62272e07bb014262b821756295c58d");
        assert_eq!(Hash::of(b"a").hex(), "d228cb696f1a8caf78912b704e4a8964");
        assert_eq!(
            Hash::of(b"foobar").hex(),
            "343e1662793c64bf6f0d3597ba446f18"
        );
    }

    #[test]
    fn the_border_between_parts_counts() {
        assert_ne!(
            Hash::new().part(b"ab").part(b"c"),
            Hash::new().part(b"a").part(b"bc")
        );
        assert_eq!(Hash::new().bytes(b"ab").bytes(b"c"), Hash::of(b"abc"));
    }
}
