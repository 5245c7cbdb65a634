//! One filter over all values of a tuple together: what makes a [`Fusion`] a [`Converter`].
//!
//! Owns the layout of tuples, the rule for tuples without new time, and what happens at a fault. Knows no equation.
//!
//! A tuple has the values that the filter names, 32 bits each, and may end with `time_us` (see `clock.rs`).
//! A tuple with the same time as the one before is the same sample again, as several sources in one node make them: its
//! result is the last one. After a fault the filter starts over.

use crate::clock::{Clock, Elapsed};
use crate::limits::{FUSED_INPUTS_MAX, FUSED_OUTPUTS_MAX};
use crate::number::Number;
use converter::{Conversion, Converter, Fault, OpenInfo};
use std::ffi::CStr;

/// Bytes of one value.
const VALUE_BYTES: usize = 4;

/// What a filter takes and gives.
#[derive(Clone, Copy, Debug)]
pub struct Layout {
    /// Name in messages.
    pub name: &'static str,
    /// Numbers of values that an input tuple may have, without the time; the largest last.
    pub inputs: &'static [usize],
    /// Numbers of values that an output tuple may have; the largest last.
    pub outputs: &'static [usize],
    /// True if the filter has to know the time between tuples.
    pub is_timed: bool,
}

impl Layout {
    /// How many values the sizes of an opening stand for, and whether a time follows.
    fn count(&self, info: &OpenInfo<'_>) -> Result<(usize, usize, bool), Fault> {
        let (input, output) = (info.input_size, info.output_size);
        let whole = input.is_multiple_of(VALUE_BYTES) && output.is_multiple_of(VALUE_BYTES);
        let (inputs, outputs) = (input / VALUE_BYTES, output / VALUE_BYTES);
        let plain = self.inputs.contains(&inputs);
        let stamped = self.is_timed && inputs > 0 && self.inputs.contains(&(inputs - 1));
        if whole && (plain || stamped) && self.outputs.contains(&outputs) {
            return Ok((inputs - usize::from(stamped), outputs, stamped));
        }
        let sizes = |counts: &[usize]| -> String {
            let sizes = counts.iter().map(|count| (count * VALUE_BYTES).to_string());
            sizes.collect::<Vec<_>>().join(" or ")
        };
        let time = if self.is_timed {
            ", 4 more with a time_us,"
        } else {
            ""
        };
        Err(Fault::new(format!(
            "{}: tuples of {input} to {output} bytes; it takes {}{time} and gives {}",
            self.name,
            sizes(self.inputs),
            sizes(self.outputs)
        )))
    }
}

/// A filter over several values.
pub trait Fusion: Send + Sized {
    /// Kind of the values that it takes.
    type Input: Number;
    /// Kind of the values that it gives.
    type Output: Number;
    /// What it takes and gives. No number of inputs is one more than another, so that a size says whether it has a time.
    const LAYOUT: Layout;
    /// One sentence for lists of converters.
    const DESCRIPTION: &'static CStr;

    /// Makes a filter from the parameters of a node.
    ///
    /// # Errors
    /// A parameter out of its range.
    fn open(info: &OpenInfo<'_>) -> Result<Self, Fault>;

    /// Takes the values of a tuple and fills in the results, which come as zeros.
    ///
    /// # Errors
    /// Values that have no meaning, or no finite result.
    fn step(
        &mut self,
        values: &[Self::Input],
        elapsed: Elapsed,
        results: &mut [Self::Output],
    ) -> Result<Conversion, Fault>;

    /// Forgets all values, as if just opened.
    fn reset(&mut self);
}

/// A converter around a filter over several values.
#[derive(Clone, Copy, Debug)]
pub struct Fused<F: Fusion> {
    filter: F,
    clock: Clock,
    /// Values of an input tuple without the time, of which the others are not used.
    inputs: usize,
    /// The last result and what was done with it, for a sample that comes again.
    last: ([F::Output; FUSED_OUTPUTS_MAX], Conversion),
}

impl<F: Fusion> Fused<F> {
    fn fail(&mut self, reason: &str) -> Fault {
        self.filter.reset();
        self.clock.reset();
        Fault::new(format!("{}: {reason}", F::LAYOUT.name))
    }

    /// The results of a tuple, kept in `last`.
    fn step(&mut self, input: &[u8], outputs: usize) -> Result<(), Fault> {
        let (values, _) = input.as_chunks::<VALUE_BYTES>();
        let mut decoded = [F::Input::ZERO; FUSED_INPUTS_MAX];
        for (lane, (place, bytes)) in decoded.iter_mut().zip(&values[..self.inputs]).enumerate() {
            *place = F::Input::decode(*bytes)
                .ok_or_else(|| Fault::new(format!("value {lane}: not a finite number")))?;
        }
        let stamp = values
            .get(self.inputs)
            .copied()
            .map_or(0, u32::from_le_bytes);
        let elapsed = self.clock.elapsed(stamp)?;
        if elapsed == Elapsed::Nothing {
            return Ok(());
        }
        let (results, done) = &mut self.last;
        results.fill(F::Output::ZERO);
        let results = &mut results[..outputs];
        *done = self
            .filter
            .step(&decoded[..self.inputs], elapsed, results)?;
        Ok(())
    }
}

impl<F: Fusion> Converter for Fused<F> {
    const DESCRIPTION: &'static CStr = F::DESCRIPTION;

    fn open(info: &OpenInfo<'_>) -> Result<Self, Fault> {
        let (inputs, _, stamped) = F::LAYOUT.count(info)?;
        let clock = match (F::LAYOUT.is_timed, stamped) {
            (false, _) => Clock::None,
            (true, true) => Clock::Stamp(None),
            (true, false) => Clock::period(F::LAYOUT.name, info)?,
        };
        Ok(Self {
            filter: F::open(info)?,
            clock,
            inputs,
            last: ([F::Output::ZERO; FUSED_OUTPUTS_MAX], Conversion::Consumed),
        })
    }

    fn convert(&mut self, input: &[u8], output: &mut [u8]) -> Result<Conversion, Fault> {
        if let Err(reason) = self.step(input, output.len() / VALUE_BYTES) {
            return Err(self.fail(reason.text()));
        }
        let (results, done) = &self.last;
        let (places, _) = output.as_chunks_mut::<VALUE_BYTES>();
        for (place, result) in places.iter_mut().zip(results) {
            *place = result.encode();
        }
        Ok(*done)
    }
}

#[cfg(test)]
pub(crate) mod tests {
    use super::*;
    use converter::Direction;
    use std::collections::BTreeMap;

    /// Opens a filter for so many input values (a time counts as one) and output values.
    pub(crate) fn open<F: Fusion>(
        values: (usize, usize),
        params: &[(&str, f64)],
    ) -> Result<Fused<F>, Fault> {
        let named = params
            .iter()
            .map(|(name, value)| ((*name).to_owned(), *value));
        let params: BTreeMap<String, f64> = named.collect();
        Fused::open(&OpenInfo {
            direction: Direction::Read,
            input_size: values.0 * VALUE_BYTES,
            output_size: values.1 * VALUE_BYTES,
            node: "n",
            params: &params,
            log: &|_| (),
        })
    }

    /// The results of one tuple; empty if it was consumed.
    pub(crate) fn step<F: Fusion, const N: usize>(
        filter: &mut Fused<F>,
        values: &[F::Input],
        time_us: Option<u32>,
    ) -> Result<[F::Output; N], String> {
        let mut input: Vec<u8> = values.iter().flat_map(|value| value.encode()).collect();
        input.extend(time_us.iter().flat_map(|time| time.to_le_bytes()));
        let mut output = [[0; VALUE_BYTES]; N];
        let done = filter.convert(&input, output.as_flattened_mut());
        match done {
            Ok(Conversion::Produced) => Ok(output.map(|bytes| F::Output::decode(bytes).unwrap())),
            Ok(Conversion::Consumed) => Err("consumed".to_owned()),
            Err(fault) => Err(fault.to_string()),
        }
    }

    /// Gives the sum of its two values and the elapsed milliseconds.
    struct Sum;

    impl Fusion for Sum {
        type Input = i32;
        type Output = f32;
        const LAYOUT: Layout = Layout {
            name: "sum",
            inputs: &[2, 4],
            outputs: &[1, 2],
            is_timed: true,
        };
        const DESCRIPTION: &'static CStr = c"for the test";

        fn open(_: &OpenInfo<'_>) -> Result<Self, Fault> {
            Ok(Self)
        }

        fn step(
            &mut self,
            values: &[i32],
            elapsed: Elapsed,
            results: &mut [f32],
        ) -> Result<Conversion, Fault> {
            let Some(seconds) = elapsed.seconds() else {
                return Ok(Conversion::Consumed);
            };
            results[0] = values.iter().sum::<i32>() as f32;
            results[1] = (seconds * 1000.0) as f32;
            Ok(Conversion::Produced)
        }

        fn reset(&mut self) {}
    }

    #[test]
    fn sizes_say_how_many_values_and_whether_there_is_a_time() {
        let mut plain = open::<Sum>((2, 2), &[("period_ms", 5.0)]).unwrap();
        assert_eq!(
            step::<Sum, 2>(&mut plain, &[1, 2], None),
            Err("consumed".to_owned())
        );
        assert_eq!(step(&mut plain, &[1, 2], None), Ok([3.0, 5.0]));
        // A time in the tuple counts more than a period, which may be meant for another stage.
        let mut stamped = open::<Sum>((3, 2), &[("period_ms", 5.0)]).unwrap();
        assert!(step::<Sum, 2>(&mut stamped, &[1, 2], Some(9)).is_err());
        assert_eq!(step(&mut stamped, &[1, 2], Some(2009)), Ok([3.0, 2.0]));
        assert!(open::<Sum>((5, 2), &[]).is_ok());
    }

    #[test]
    fn other_sizes_and_a_missing_period_are_refused() {
        let refused = |values| open::<Sum>(values, &[]).err().unwrap().to_string();
        assert_eq!(
            refused((1, 2)),
            "sum: tuples of 4 to 8 bytes; it takes 8 or 16, 4 more with a time_us, and gives 4 or 8"
        );
        assert_eq!(
            refused((2, 3)),
            "sum: tuples of 8 to 12 bytes; it takes 8 or 16, 4 more with a time_us, and gives 4 or 8"
        );
        assert_eq!(
            refused((2, 2)),
            "sum: period_ms is missing, and the tuple does not end with a time_us"
        );
        let refused = open::<Sum>((2, 2), &[("period_ms", 0.5)]).err().unwrap();
        assert_eq!(
            refused.text(),
            "sum: period_ms must be a whole number from 1 to 3600000, not 0.5"
        );
    }

    #[test]
    fn the_same_time_is_the_same_sample() {
        let mut sum = open::<Sum>((3, 2), &[]).unwrap();
        assert!(step::<Sum, 2>(&mut sum, &[1, 2], Some(1000)).is_err());
        assert_eq!(step(&mut sum, &[1, 2], Some(2000)), Ok([3.0, 1.0]));
        assert_eq!(step(&mut sum, &[7, 7], Some(2000)), Ok([3.0, 1.0]));
        assert_eq!(
            step::<Sum, 2>(&mut sum, &[1, 2], Some(1999)),
            Err("sum: time went back by 1 us".to_owned())
        );
        // The fault was a fresh start.
        assert_eq!(
            step::<Sum, 2>(&mut sum, &[1, 2], Some(1)),
            Err("consumed".to_owned())
        );
    }
}
