//! Test vectors of converters as text: one opening of one converter, inputs and what must become of them.
//!
//! Owns the format, which every way to run a converter shares (Rust, C, Lua, `trikfs convert --vectors`, a mount):
//!
//! ```text
//! # any comment
//! params window=4 other=0.5
//! size 4 4
//! 01000000 > 01000000
//! 02000000 > consumed
//! ff000000 > fault
//! ```
//! Bytes are hexadecimal. `params` may be empty or left out. Knows nothing of files; it is given the text.

use crate::error::{Error, VectorsFault};
use crate::limits::{TUPLE_BYTES_MAX, VECTORS_BYTES_MAX};
use std::collections::BTreeMap;

/// One file of vectors.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Vectors {
    /// Parameters of the opening.
    pub params: BTreeMap<String, f64>,
    /// Bytes of an input tuple.
    pub input_size: usize,
    /// Bytes of an output tuple.
    pub output_size: usize,
    /// Inputs in order, each with the line where it stands and what must come of it.
    pub steps: Vec<Step>,
}

/// One input and its result.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Step {
    /// Line of the file, from 1.
    pub line: usize,
    /// Input tuple.
    pub input: Vec<u8>,
    /// What the converter must do.
    pub expected: Expected,
}

/// What a converter must do with an input.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Expected {
    /// Give these bytes.
    Output(Vec<u8>),
    /// Take the input and give nothing.
    Consumed,
    /// Refuse the input.
    Fault,
}

/// Parses a file of vectors.
///
/// # Errors
/// [`Error::Vectors`] for the first line that is none.
pub fn parse(text: &str) -> Result<Vectors, Error> {
    let refused = |line, why| Error::Vectors { line, why };
    if text.len() > VECTORS_BYTES_MAX {
        return Err(refused(0, VectorsFault::TooLong));
    }
    let mut vectors = Vectors::default();
    for (index, line) in text.lines().enumerate() {
        parse_line(&mut vectors, index + 1, line.trim()).map_err(|why| refused(index + 1, why))?;
    }
    if vectors.steps.is_empty() {
        return Err(refused(0, VectorsFault::None));
    }
    Ok(vectors)
}

/// Parses one line into `vectors`.
fn parse_line(vectors: &mut Vectors, number: usize, line: &str) -> Result<(), VectorsFault> {
    if line.is_empty() || line.starts_with('#') {
        return Ok(());
    }
    if let Some((input, expected)) = line.split_once('>') {
        if vectors.input_size == 0 {
            return Err(VectorsFault::NoSize);
        }
        let expected = match expected.trim() {
            "consumed" => Expected::Consumed,
            "fault" => Expected::Fault,
            hex => Expected::Output(sized(hex, vectors.output_size)?),
        };
        let input = sized(input.trim(), vectors.input_size)?;
        vectors.steps.push(Step {
            line: number,
            input,
            expected,
        });
        return Ok(());
    }
    let mut words = line.split_whitespace();
    match words.next() {
        Some("params") => {
            for word in words {
                let (name, value) = word
                    .split_once('=')
                    .ok_or_else(|| VectorsFault::NotAParam(word.to_owned()))?;
                let value = value
                    .parse()
                    .map_err(|_| VectorsFault::NotANumber(value.to_owned()))?;
                vectors.params.insert(name.to_owned(), value);
            }
        }
        Some("size") => {
            let mut size = || {
                words
                    .next()
                    .and_then(|word| word.parse().ok())
                    .ok_or(VectorsFault::NotASize)
            };
            let sizes = (size()?, size()?);
            if [sizes.0, sizes.1]
                .iter()
                .any(|size| !(1..=TUPLE_BYTES_MAX).contains(size))
            {
                return Err(VectorsFault::SizeRange);
            }
            if !vectors.steps.is_empty() {
                return Err(VectorsFault::LateSize);
            }
            (vectors.input_size, vectors.output_size) = sizes;
        }
        _ => return Err(VectorsFault::Unknown),
    }
    Ok(())
}

/// Decodes a hexadecimal tuple of the given size.
fn sized(hex: &str, size: usize) -> Result<Vec<u8>, VectorsFault> {
    let digits: Option<Vec<u8>> = hex
        .chars()
        .map(|c| c.to_digit(16).map(|digit| digit as u8))
        .collect();
    let digits = digits.filter(|digits| digits.len() == 2 * size);
    let digits = digits.ok_or_else(|| VectorsFault::NotHex(hex.to_owned(), size))?;
    Ok(digits
        .chunks_exact(2)
        .map(|pair| pair[0] << 4 | pair[1])
        .collect())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_file_is_one_opening_and_its_vectors() {
        let vectors =
            parse("# c\nparams a=1 b=-0.5\nsize 2 1\n\n01ff > 0A\n0000 > consumed\n0000>fault\n")
                .unwrap();
        assert_eq!(
            vectors.params,
            BTreeMap::from([("a".to_owned(), 1.0), ("b".to_owned(), -0.5)])
        );
        assert_eq!((vectors.input_size, vectors.output_size), (2, 1));
        let step = |line, input: [u8; 2], expected| Step {
            line,
            input: input.to_vec(),
            expected,
        };
        let steps = [
            step(5, [1, 255], Expected::Output(vec![10])),
            step(6, [0, 0], Expected::Consumed),
            step(7, [0, 0], Expected::Fault),
        ];
        assert_eq!(vectors.steps, steps);
    }

    #[test]
    fn a_line_that_is_no_vector_is_named() {
        let refused = |text| parse(text).unwrap_err().to_string();
        assert_eq!(
            refused("size 1 1\n0g > 00"),
            "line 2: '0g' is not 1 bytes in hexadecimal"
        );
        assert_eq!(
            refused("size 1 1\n00 > 0000"),
            "line 2: '0000' is not 1 bytes in hexadecimal"
        );
        assert_eq!(refused("size 1"), "line 1: a size is a number of bytes");
        assert_eq!(
            refused("size 1 65537"),
            "line 1: a tuple has 1 to 65536 bytes"
        );
        assert_eq!(
            refused("00 > 00"),
            "line 1: the size must stand before the first vector"
        );
        assert_eq!(
            refused("size 1 1\n00 > 00\nsize 2 2"),
            "line 3: the size stands before the first vector"
        );
        assert_eq!(refused("params a"), "line 1: 'a' is not name=number");
        assert_eq!(
            refused("hello"),
            "line 1: neither params, size nor a vector"
        );
        assert_eq!(refused("size 1 1"), "line 0: no vectors");
    }
}
