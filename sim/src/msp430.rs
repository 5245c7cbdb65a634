//! The coprocessor of the controller as a slave on the I2C bus: its register file, byte for byte.
//!
//! Registers: 0x10-0x13 PWM periods of M1-M4 (16 bit, written), 0x14-0x17 duty of M1-M4 (8 bit signed percent, written;
//! beyond 100 is brake), 0x20-0x25 analog A6-A1 (16 bit, read), 0x26 battery (16 bit, read), 0x30 0x31 0x33 0x32
//! encoders E1-E4 (32 bit, read; writing 0 clears), 0xEE version (16 bit, read); the low byte comes first.
//! What the real firmware does with other registers is not known: here they are not acknowledged.
//! There is no watchdog: the last duty stays.

use crate::errno::NACK;

/// Where it answers.
pub const ADDRESS: u16 = 0x48;
const VERSION: u16 = 0x280E;
const PERIOD: u8 = 0x10;
const DUTY: u8 = 0x14;
const ANALOG_LAST: u8 = 0x25;
const BATTERY: u8 = 0x26;
const ENCODERS: [u8; 4] = [0x30, 0x31, 0x33, 0x32];

/// What is in the registers.
#[derive(Debug, Clone)]
pub struct Msp430 {
    /// M1 to M4 as written.
    pub duty: [i8; 4],
    /// M1 to M4 as written.
    pub period: [u16; 4],
    /// A1 to A6.
    pub analog: [u16; 6],
    /// At the divider of the battery.
    pub battery: u16,
    /// E1 to E4.
    pub ticks: [i32; 4],
    /// Encoders that were cleared since [`Msp430::take_cleared`].
    cleared: [bool; 4],
    pointer: u8,
}

impl Default for Msp430 {
    fn default() -> Self {
        Self {
            duty: [0; 4],
            period: [0x1000; 4],
            analog: [0; 6],
            battery: 0,
            ticks: [0; 4],
            cleared: [false; 4],
            pointer: 0,
        }
    }
}

impl Msp430 {
    /// One transaction: bytes written, then bytes read; the error is [`NACK`].
    pub fn transact(&mut self, written: &[u8], read: &mut [u8]) -> Result<(), i32> {
        if let Some((&register, data)) = written.split_first() {
            self.pointer = register;
            if !data.is_empty() {
                self.write(register, data)?;
            }
        }
        if read.is_empty() {
            return Ok(());
        }
        // Nobody drives the lines after the last byte of a register: they are high.
        read.fill(0xFF);
        let (bytes, width) = self.value(self.pointer).ok_or(NACK)?;
        let length = width.min(read.len());
        read[..length].copy_from_slice(&bytes[..length]);
        Ok(())
    }

    /// The bytes of any register, also of those that the bus cannot read back; false if there is no such register.
    pub fn probe(&self, register: u8, read: &mut [u8]) -> bool {
        let written = match register {
            PERIOD..DUTY => {
                let [low, high] = self.period[usize::from(register - PERIOD)].to_le_bytes();
                Some(([low, high, 0, 0], 2))
            }
            DUTY..=0x17 => {
                let [duty] = self.duty[usize::from(register - DUTY)].to_le_bytes();
                Some(([duty, 0, 0, 0], 1))
            }
            _ => self.value(register),
        };
        let Some((bytes, width)) = written else {
            return false;
        };
        read.fill(0xFF);
        let length = width.min(read.len());
        read[..length].copy_from_slice(&bytes[..length]);
        true
    }

    fn write(&mut self, register: u8, data: &[u8]) -> Result<(), i32> {
        match (register, data) {
            (PERIOD..DUTY, &[low, high]) => {
                self.period[usize::from(register - PERIOD)] = u16::from_le_bytes([low, high]);
            }
            (DUTY..=0x17, &[duty]) => {
                self.duty[usize::from(register - DUTY)] = i8::from_le_bytes([duty]);
            }
            (_, &[value]) => {
                let encoder = ENCODERS
                    .iter()
                    .position(|&other| other == register)
                    .ok_or(NACK)?;
                if value == 0 {
                    self.ticks[encoder] = 0;
                    self.cleared[encoder] = true;
                }
            }
            _ => return Err(NACK),
        }
        Ok(())
    }

    /// The bytes of a register that can be read, and how many count.
    fn value(&self, register: u8) -> Option<([u8; 4], usize)> {
        let word = |value: u16| {
            let [low, high] = value.to_le_bytes();
            Some(([low, high, 0, 0], 2))
        };
        match register {
            0x20..=ANALOG_LAST => word(self.analog[usize::from(ANALOG_LAST - register)]),
            BATTERY => word(self.battery),
            0xEE => word(VERSION),
            _ => {
                let encoder = ENCODERS.iter().position(|&other| other == register)?;
                Some((self.ticks[encoder].to_le_bytes(), 4))
            }
        }
    }

    /// Which encoders were cleared since the last call.
    pub fn take_cleared(&mut self) -> [bool; 4] {
        std::mem::take(&mut self.cleared)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn read<const N: usize>(chip: &mut Msp430, register: u8) -> Result<[u8; N], i32> {
        let mut bytes = [0; N];
        chip.transact(&[register], &mut bytes)?;
        Ok(bytes)
    }

    #[test]
    fn the_registers_are_where_the_board_has_them() {
        let mut chip = Msp430 {
            analog: [0x101, 0x102, 0x103, 0x104, 0x105, 0x3FF],
            battery: 943,
            ticks: [1, -2, 0x0102_0304, -1],
            ..Msp430::default()
        };
        assert_eq!(read(&mut chip, 0x25), Ok([0x01, 0x01]), "A1");
        assert_eq!(read(&mut chip, 0x20), Ok([0xFF, 0x03]), "A6");
        assert_eq!(read(&mut chip, 0x26), Ok([0xAF, 0x03]), "battery");
        assert_eq!(read(&mut chip, 0x30), Ok([1, 0, 0, 0]), "E1");
        assert_eq!(read(&mut chip, 0x31), Ok([0xFE, 0xFF, 0xFF, 0xFF]), "E2");
        assert_eq!(read(&mut chip, 0x33), Ok([4, 3, 2, 1]), "E3 is 0x33");
        assert_eq!(read(&mut chip, 0x32), Ok([0xFF; 4]), "E4 is 0x32");
        assert_eq!(read(&mut chip, 0xEE), Ok([0x0E, 0x28]), "version");
        assert_eq!(
            read(&mut chip, 0x26),
            Ok([0xAF]),
            "byte data is the low byte"
        );
    }

    #[test]
    fn motors_and_periods_are_written() {
        let mut chip = Msp430::default();
        chip.transact(&[0x14, 50], &mut []).unwrap();
        chip.transact(&[0x17, 0xCE], &mut []).unwrap();
        chip.transact(&[0x16, 0x7F], &mut []).unwrap();
        assert_eq!(chip.duty, [50, 0, 127, -50]);
        chip.transact(&[0x12, 0x10, 0x27], &mut []).unwrap();
        assert_eq!(chip.period, [4096, 4096, 10_000, 4096]);
        let mut seen = [0; 2];
        assert!(chip.probe(0x12, &mut seen) && seen == [0x10, 0x27]);
        assert!(chip.probe(0x17, &mut seen) && seen == [0xCE, 0xFF]);
        assert!(!chip.probe(0x99, &mut seen));
    }

    #[test]
    fn writing_zero_clears_an_encoder_and_other_values_do_not() {
        let mut chip = Msp430 {
            ticks: [9; 4],
            ..Msp430::default()
        };
        chip.transact(&[0x33, 1], &mut []).unwrap();
        chip.transact(&[0x32, 0], &mut []).unwrap();
        assert_eq!(chip.ticks, [9, 9, 9, 0]);
        assert_eq!(chip.take_cleared(), [false, false, false, true]);
        assert_eq!(chip.take_cleared(), [false; 4]);
    }

    #[test]
    fn other_registers_and_lengths_are_not_acknowledged() {
        let mut chip = Msp430::default();
        assert_eq!(read::<2>(&mut chip, 0x14), Err(NACK), "no read-back");
        assert_eq!(read::<1>(&mut chip, 0x99), Err(NACK));
        assert_eq!(chip.transact(&[0x99, 1], &mut []), Err(NACK));
        assert_eq!(chip.transact(&[0x14, 1, 2], &mut []), Err(NACK));
        assert_eq!(chip.transact(&[0x10, 1], &mut []), Err(NACK));
        assert_eq!(
            chip.transact(&[], &mut []),
            Ok(()),
            "a probe of the address"
        );
    }
}
