//! Converters of my robot: the battery behind its voltage divider, calmed by a mean.
//!
//! The low 10 bits of a little-endian 16-bit word are the voltage, 1023 stands for 13256 mV.
//! Each output is a little-endian 32-bit number of millivolts, the mean of `count` inputs; the inputs in between give none.

#![forbid(unsafe_code)]

use converter::{Conversion, Converter, Fault, OpenInfo};
use std::ffi::CStr;

/// The state of one open file.
struct BatteryMean {
    /// Inputs for one output.
    count: u32,
    /// Inputs since the last output.
    taken: u32,
    /// Sum of their raw values: at most 1000 * 1023.
    sum: u32,
}

impl Converter for BatteryMean {
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
    "battery_mean" => BatteryMean,
}
