//! One filter for each value of a tuple: what makes a [`Filter`] a [`Converter`].
//!
//! Owns the layout of tuples, the limit on state and what happens at a fault. Knows no equation.

use crate::limits::STATE_BYTES_MAX;
use crate::number::Number;
use converter::{Conversion, Converter, Fault, OpenInfo};
use std::ffi::CStr;

/// Bytes of one value.
const VALUE_BYTES: usize = 4;

/// A filter of one sequence of values.
pub trait Filter: Clone + Send + Sized {
    /// Kind of the values.
    type Value: Number;
    /// Name in messages.
    const NAME: &'static str;
    /// One sentence for lists of converters.
    const DESCRIPTION: &'static CStr;

    /// Makes a filter from the parameters of a node.
    ///
    /// # Errors
    /// A parameter out of its range.
    fn open(info: &OpenInfo<'_>) -> Result<Self, Fault>;

    /// Takes the next value and gives the next result; absent while there is none yet.
    ///
    /// # Errors
    /// A value for which the equation has no finite result.
    fn step(&mut self, value: Self::Value) -> Result<Option<Self::Value>, Fault>;

    /// Forgets all values, as if just opened.
    fn reset(&mut self);

    /// Bytes of state of one filter.
    fn state_bytes(&self) -> usize {
        size_of::<Self>()
    }
}

/// The fault of a filter whose result is not a finite number.
pub(crate) fn overflow() -> Fault {
    Fault::new("the result is not a finite number")
}

/// A filter of its own for each value of the tuple.
#[derive(Clone, Debug)]
pub struct Lanes<F> {
    filters: Vec<F>,
}

impl<F: Filter> Lanes<F> {
    /// Forgets everything and names the value at fault.
    fn fail(&mut self, lane: usize, reason: &str) -> Fault {
        for filter in &mut self.filters {
            filter.reset();
        }
        Fault::new(format!("{}: value {lane}: {reason}", F::NAME))
    }
}

impl<F: Filter> Converter for Lanes<F> {
    const DESCRIPTION: &'static CStr = F::DESCRIPTION;

    fn open(info: &OpenInfo<'_>) -> Result<Self, Fault> {
        let size = info.input_size;
        if size != info.output_size || size == 0 || !size.is_multiple_of(VALUE_BYTES) {
            return Err(Fault::new(format!(
                "{}: tuples of {size} to {} bytes; it needs equal sizes, a multiple of {VALUE_BYTES}",
                F::NAME,
                info.output_size
            )));
        }
        let filter = F::open(info)?;
        let lanes = size / VALUE_BYTES;
        let state_bytes = filter.state_bytes().saturating_mul(lanes);
        if state_bytes > STATE_BYTES_MAX {
            return Err(Fault::new(format!(
                "{}: {lanes} values need {state_bytes} bytes of state, the limit is {STATE_BYTES_MAX}",
                F::NAME
            )));
        }
        Ok(Self {
            filters: vec![filter; lanes],
        })
    }

    /// All values are checked before any filter sees one, and all filters take their value even if an earlier one fails.
    fn convert(&mut self, input: &[u8], output: &mut [u8]) -> Result<Conversion, Fault> {
        let (values, _) = input.as_chunks::<VALUE_BYTES>();
        if let Some(lane) = values
            .iter()
            .position(|bytes| F::Value::decode(*bytes).is_none())
        {
            return Err(self.fail(lane, "not a finite number"));
        }
        let mut conversion = Conversion::Produced;
        let mut fault = None;
        let (results, _) = output.as_chunks_mut::<VALUE_BYTES>();
        for (lane, ((filter, bytes), result)) in
            self.filters.iter_mut().zip(values).zip(results).enumerate()
        {
            match F::Value::decode(*bytes).map(|value| filter.step(value)) {
                Some(Ok(Some(value))) => *result = value.encode(),
                Some(Ok(None)) | None => conversion = Conversion::Consumed,
                Some(Err(reason)) => fault = fault.or(Some((lane, reason))),
            }
        }
        match fault {
            Some((lane, reason)) => Err(self.fail(lane, reason.text())),
            None => Ok(conversion),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::moving_average::MovingAverage;
    use crate::rate::Rate;
    use converter::Direction;
    use std::collections::BTreeMap;

    fn open<F: Filter>(sizes: (usize, usize), params: &[(&str, f64)]) -> Result<Lanes<F>, Fault> {
        let params: BTreeMap<String, f64> = params
            .iter()
            .map(|(name, value)| ((*name).to_owned(), *value))
            .collect();
        Lanes::open(&OpenInfo {
            direction: Direction::Read,
            input_size: sizes.0,
            output_size: sizes.1,
            node: "accel",
            params: &params,
            log: &|_| (),
        })
    }

    fn bytes(values: &[f32]) -> Vec<u8> {
        values
            .iter()
            .flat_map(|value| value.to_le_bytes())
            .collect()
    }

    #[test]
    fn tuples_must_be_whole_values_of_equal_sizes() {
        let refused = |sizes| open::<Rate<i32>>(sizes, &[]).unwrap_err().to_string();
        let text = "rate: tuples of 6 to 6 bytes; it needs equal sizes, a multiple of 4";
        assert_eq!(refused((6, 6)), text);
        assert_eq!(
            refused((4, 8)),
            "rate: tuples of 4 to 8 bytes; it needs equal sizes, a multiple of 4"
        );
        assert!(open::<Rate<i32>>((65_536, 65_536), &[]).is_ok());
    }

    #[test]
    fn state_has_a_limit() {
        let refused =
            open::<MovingAverage<i32>>((65_536, 65_536), &[("window", 256.0)]).unwrap_err();
        let text = refused.text();
        assert!(
            text.starts_with("moving_average: 16384 values need "),
            "{text}"
        );
        assert!(
            text.ends_with(" bytes of state, the limit is 1048576"),
            "{text}"
        );
    }

    #[test]
    fn after_a_fault_every_lane_begins_afresh() {
        let mut rate = open::<Rate<f32>>((8, 8), &[]).unwrap();
        let mut output = [0; 8];
        assert_eq!(
            rate.convert(&bytes(&[1.0, 2.0]), &mut output),
            Ok(Conversion::Consumed)
        );
        let fault = rate
            .convert(&bytes(&[5.0, f32::NAN]), &mut output)
            .unwrap_err();
        assert_eq!(fault.text(), "rate: value 1: not a finite number");
        // Without the fresh start this would be a difference over two periods.
        assert_eq!(
            rate.convert(&bytes(&[9.0, 9.0]), &mut output),
            Ok(Conversion::Consumed)
        );
        assert_eq!(
            rate.convert(&bytes(&[10.0, 8.0]), &mut output),
            Ok(Conversion::Produced)
        );
        assert_eq!(output.as_slice(), bytes(&[1.0, -1.0]));
        let fault = rate.convert(&bytes(&[f32::MAX, f32::MIN]), &mut output);
        assert!(fault.is_ok(), "3.4e38 - 10 is a float");
        let fault = rate
            .convert(&bytes(&[f32::MIN, 0.0]), &mut output)
            .unwrap_err();
        assert_eq!(
            fault.text(),
            "rate: value 0: the result is not a finite number"
        );
    }
}
