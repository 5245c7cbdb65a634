//! The converter battery_mean: README.md says how it is built and tested.
//!
//! The example to replace by your own: the battery of the TRIK controller behind its voltage divider.
//! The low 10 bits of a little-endian 16-bit word are the voltage, and 1023 stands for 13256 mV.
//! Each output is a little-endian 32-bit number of millivolts, the mean of `count` inputs; the inputs in between give none.

#![forbid(unsafe_code)]

use converter::{Conversion, Converter, Fault, OpenInfo};
use std::ffi::CStr;

/// The state of one open file.
struct BatteryMeanState {
    /// Inputs for one output.
    count: u32,
    /// Inputs since the last output.
    taken: u32,
    /// Sum of their raw values: at most 1000 * 1023.
    sum: u32,
}

impl Converter for BatteryMeanState {
    const DESCRIPTION: &'static CStr =
        c"voltage of the battery in millivolts, mean of `count` samples";
    const INPUT_SIZE: u32 = 2;
    const OUTPUT_SIZE: u32 = 4;

    fn open(info: &OpenInfo<'_>) -> Result<Self, Fault> {
        let count = info.param("count").unwrap_or(4.0);
        // Written so that NaN is refused as well.
        if !(1.0..=1000.0).contains(&count) {
            return Err(Fault::new("battery_mean: count must be from 1 to 1000"));
        }
        Ok(Self {
            count: count as u32,
            taken: 0,
            sum: 0,
        })
    }

    fn convert(&mut self, input: &[u8], output: &mut [u8]) -> Result<Conversion, Fault> {
        let raw = u16::from_le_bytes([input[0], input[1]]);
        if raw == 0xffff {
            // Nothing answers on the bus: never invent a voltage.
            return Err(Fault::new(
                "battery_mean: the converter chip does not answer",
            ));
        }
        self.sum += u32::from(raw & 1023);
        self.taken += 1;
        if self.taken < self.count {
            return Ok(Conversion::Consumed);
        }
        let millivolts = (u64::from(self.sum) * 13256 + 511 * u64::from(self.count))
            / (1023 * u64::from(self.count));
        self.sum = 0;
        self.taken = 0;
        output.copy_from_slice(&(millivolts as u32).to_le_bytes());
        Ok(Conversion::Produced)
    }
}

converter::export_converters! {
    "battery_mean" => BatteryMeanState,
}

#[cfg(test)]
mod tests {
    use super::*;
    use converter::trial::{self, Trial};
    use converter::vectors;
    use std::collections::BTreeMap;

    #[test]
    fn the_vectors_hold() {
        let vectors = vectors::parse(include_str!("../vectors.txt")).unwrap();
        let (input_size, output_size) = (vectors.input_size, vectors.output_size);
        let mut open = trial::opener::<BatteryMeanState>(input_size, output_size, &vectors.params);
        let met = trial::check_vectors(&vectors, &mut open);
        met.unwrap_or_else(|why| panic!("{why}"));
    }

    #[test]
    fn whatever_comes_the_output_is_a_voltage_and_no_state_is_shared() {
        let params = BTreeMap::from([("count".to_owned(), 2.0)]);
        // SEED=5 cargo test repeats a failure.
        let seed = trial::seed();
        let trial = Trial {
            input_size: 2,
            output_size: 4,
            tuples: 20_000,
            seed,
            recorded: &[],
            // For floats there is trial::finite_f32.
            check: &|output| match u32::from_le_bytes(output.try_into().unwrap()) {
                0..=13256 => Ok(()),
                millivolts => Err(format!("{millivolts} mV").into()),
            },
        };
        let mut open = trial::opener::<BatteryMeanState>(2, 4, &params);
        let report = trial::check_properties(&trial, &mut open);
        let report = report.unwrap_or_else(|why| panic!("{why}"));
        println!("seed {seed}: {report:?}");
    }

    #[test]
    fn a_count_out_of_range_is_refused() {
        for count in [0.0, 1001.0, f64::NAN] {
            let params = BTreeMap::from([("count".to_owned(), count)]);
            let refused = trial::opener::<BatteryMeanState>(2, 4, &params)().err();
            let refused = refused.map(|fault| fault.to_string());
            assert_eq!(
                refused.as_deref(),
                Some("battery_mean: count must be from 1 to 1000")
            );
        }
    }
}
