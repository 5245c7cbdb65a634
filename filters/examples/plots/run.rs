//! The filters as a host sees them: opened by name in the shared library's table, tuple by tuple.

use converter::abi::{Instance, descriptors};
use converter::{Conversion, Direction, OpenInfo};
use trikfs_filters::number::Number;

/// An opened filter for `I` values in and `O` out.
pub struct Filter<const I: usize, const O: usize>(Instance);

impl<const I: usize, const O: usize> Filter<I, O> {
    /// Opens a filter.
    ///
    /// # Panics
    /// If there is none, or it refuses the parameters: a mistake in this program.
    pub fn open(name: &str, params: &[(&str, f64)]) -> Self {
        let named = params
            .iter()
            .map(|(name, value)| ((*name).to_owned(), *value));
        let params = named.collect();
        let info = OpenInfo {
            direction: Direction::Read,
            input_size: 4 * I,
            output_size: 4 * O,
            node: name,
            params: &params,
            log: &|_| (),
        };
        let library = descriptors(trikfs_filters::trikfs_library_entry()).expect("our own library");
        let descriptor = library
            .iter()
            .find(|d| d.name() == name)
            .expect("a filter of ours");
        Self(
            descriptor
                .open(&info)
                .unwrap_or_else(|fault| panic!("{fault}")),
        )
    }

    /// What becomes of a tuple of whole numbers; absent while there is nothing yet.
    pub fn step<V: Number>(&mut self, values: [i32; I]) -> Option<[f64; O]> {
        let input = values.map(i32::to_le_bytes);
        let mut output = [[0; 4]; O];
        match self
            .0
            .convert(input.as_flattened(), output.as_flattened_mut())
        {
            Ok(Conversion::Produced) => {
                Some(output.map(|bytes| V::decode(bytes).expect("a number").real()))
            }
            Ok(Conversion::Consumed) => None,
            Err(fault) => panic!("{fault}"),
        }
    }
}
