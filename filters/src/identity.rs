//! Identity: y[n] = x[n], for any bytes.
//!
//! The converter to begin with when a library is to be tried at all, and the yardstick for the cost of the others.
//! Cost: one copy of the tuple.

use converter::{Conversion, Converter, Fault, OpenInfo};
use std::ffi::CStr;

/// Copies each tuple. It has no parameters and takes tuples of any size, as long as both sizes are equal.
#[derive(Clone, Copy, Debug)]
pub struct Identity;

impl Converter for Identity {
    const DESCRIPTION: &'static CStr = c"copies each tuple as it is";

    fn open(info: &OpenInfo<'_>) -> Result<Self, Fault> {
        if info.input_size == info.output_size {
            return Ok(Self);
        }
        Err(Fault::new(format!(
            "identity: tuples of {} to {} bytes; it needs equal sizes",
            info.input_size, info.output_size
        )))
    }

    fn convert(&mut self, input: &[u8], output: &mut [u8]) -> Result<Conversion, Fault> {
        output.copy_from_slice(input);
        Ok(Conversion::Produced)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use converter::Direction;
    use std::collections::BTreeMap;

    fn open(input_size: usize, output_size: usize) -> Result<Identity, Fault> {
        let params = BTreeMap::new();
        let direction = Direction::Read;
        Identity::open(&OpenInfo {
            direction,
            input_size,
            output_size,
            node: "n",
            params: &params,
            log: &|_| (),
        })
    }

    #[test]
    fn bytes_pass_unchanged() {
        let mut output = [0; 3];
        assert_eq!(
            open(3, 3).unwrap().convert(&[1, 2, 255], &mut output),
            Ok(Conversion::Produced)
        );
        assert_eq!(output, [1, 2, 255]);
    }

    #[test]
    fn unequal_sizes_are_refused() {
        let refused = open(3, 4).unwrap_err();
        assert_eq!(
            refused.text(),
            "identity: tuples of 3 to 4 bytes; it needs equal sizes"
        );
    }
}
