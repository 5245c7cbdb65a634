//! Bytes read from a position, as pread(2) gives them.
//!
//! Owns the one copy of that arithmetic.

/// Copies what `content` has from `offset` on; returns how much that was, 0 after the end.
pub fn copy_at(content: &[u8], offset: u64, out: &mut [u8]) -> usize {
    let rest = usize::try_from(offset)
        .ok()
        .and_then(|at| content.get(at..));
    let rest = rest.unwrap_or(&[]);
    let n = rest.len().min(out.len());
    out[..n].copy_from_slice(&rest[..n]);
    n
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_position_behind_the_end_gives_nothing() {
        let mut out = [0; 2];
        assert_eq!(copy_at(b"abc", 0, &mut out), 2);
        assert_eq!(copy_at(b"abc", 2, &mut out), 1);
        assert_eq!(&out, b"cb");
        assert_eq!(copy_at(b"abc", 4, &mut out), 0);
        assert_eq!(copy_at(b"abc", u64::MAX, &mut out), 0);
    }
}
