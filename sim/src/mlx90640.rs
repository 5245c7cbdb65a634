//! The infrared camera MLX90640 on I2C: status, control, memory of one picture, and calibration.
//!
//! Registers and values have 16 bits, high byte first: a write is register and value, a read goes on from the register.
//! 0x8000 status (bit 3 new data, bit 0 subpage), 0x800D control (bits 9-7 refresh rate: 0.5 Hz doubled for each step),
//! 0x0400 picture (24 rows of 32 pixels, and what follows them), 0x2400 calibration.
//! A pixel is its offset and its signal; offsets are made so that the calibration gives them exactly. Temperatures
//! would need the maker's whole equation: here the floor is cool, walls are cooler, and a ball is warm.

use crate::body::Body;
use crate::errno::NACK;
use crate::random::Random;

/// Where it answers.
pub const ADDRESS: u16 = 0x33;
const ROWS: usize = 24;
const COLUMNS: usize = 32;
/// Of a picture and of the calibration.
const WORDS: usize = 832;
const STATUS: u16 = 0x8000;
const CONTROL: u16 = 0x800D;
const PICTURE: u16 = 0x0400;
const CALIBRATION: u16 = 0x2400;
const NEW_DATA: u16 = 8;
/// Chess pattern, 2 Hz: as after power-on.
const FIRST_CONTROL: u16 = 0x1901;
/// In the calibration: scales of the remainders, their mean, rows, columns, pixels.
const SCALES: usize = 16;
const MEAN: usize = 17;
const OF_ROWS: usize = 18;
const OF_COLUMNS: usize = 24;
const PIXELS: usize = 64;
/// Powers of two by which row and column parts are multiplied; the remainders are as they are.
const ROW_SCALE: u16 = 2;
const COLUMN_SCALE: u16 = 1;
/// Signals of what is seen, in counts.
const WARM: f64 = 260.0;
const COOL: f64 = -60.0;
const NOISE: f64 = 4.0;

/// The camera.
pub struct Mlx90640 {
    calibration: Vec<u16>,
    offsets: Vec<i32>,
    picture: Vec<u16>,
    control: u16,
    status: u16,
    pointer: u16,
    due_s: f64,
}

impl Mlx90640 {
    /// One camera with its own calibration.
    pub fn new(seed: u64) -> Self {
        let mut random = Random::new(seed);
        let mut calibration = vec![0; WORDS];
        calibration[SCALES] = ROW_SCALE << 8 | COLUMN_SCALE << 4;
        calibration[MEAN] = (-60i16) as u16;
        for word in &mut calibration[OF_ROWS..OF_COLUMNS + COLUMNS / 4] {
            *word = random.bits() as u16;
        }
        for word in &mut calibration[PIXELS..PIXELS + ROWS * COLUMNS] {
            // Six bits of remainder; what the rest is for is not needed for a picture.
            *word = (random.bits() as u16) << 10;
        }
        let offsets = (0..ROWS * COLUMNS)
            .map(|pixel| offset(&calibration, pixel / COLUMNS, pixel % COLUMNS))
            .collect();
        Self {
            calibration,
            offsets,
            picture: vec![0; WORDS],
            control: FIRST_CONTROL,
            status: 0,
            pointer: 0,
            due_s: 0.0,
        }
    }

    /// Takes a picture if one is due by now.
    pub fn capture(&mut self, now_s: f64, body: &dyn Body, random: &mut Random) {
        if now_s < self.due_s {
            return;
        }
        let rate_hz = 0.5 * f64::from(1u16 << (self.control >> 7 & 7));
        self.due_s = now_s + 1.0 / rate_hz;
        let subpage = 1 - (self.status & 1);
        self.status = subpage | NEW_DATA;
        let across = |place: usize, size: usize| (2 * place + 1) as f64 / size as f64 - 1.0;
        for row in 0..ROWS {
            for column in 0..COLUMNS {
                let seen = body.pixel(across(column, COLUMNS), across(row, ROWS));
                let is_warm = seen.is_some_and(|seen| seen.red / 2 > seen.green.max(50));
                let signal = if is_warm { WARM } else { COOL } + random.normal() * NOISE;
                let pixel = row * COLUMNS + column;
                self.picture[pixel] = (self.offsets[pixel] + signal.round() as i32) as i16 as u16;
            }
        }
    }

    /// One transaction, as on the wire.
    pub fn transact(&mut self, written: &[u8], read: &mut [u8]) -> Result<(), i32> {
        match *written {
            [] => {}
            [high, low] => self.pointer = u16::from_be_bytes([high, low]),
            [high, low, value_high, value_low] => {
                self.pointer = u16::from_be_bytes([high, low]);
                self.write(u16::from_be_bytes([value_high, value_low]))?;
            }
            _ => return Err(NACK),
        }
        for bytes in read.chunks_mut(2) {
            let word = self.word(self.pointer).to_be_bytes();
            bytes.copy_from_slice(&word[..bytes.len()]);
            self.pointer = self.pointer.wrapping_add(1);
        }
        Ok(())
    }

    fn write(&mut self, value: u16) -> Result<(), i32> {
        match self.pointer {
            // Only the bit of new data can be cleared; the subpage is the camera's.
            STATUS => self.status &= value | !NEW_DATA,
            CONTROL => self.control = value,
            _ => return Err(NACK),
        }
        Ok(())
    }

    /// A register; what is not described reads 0.
    fn word(&self, register: u16) -> u16 {
        let within = |first: u16| usize::from(register.wrapping_sub(first));
        match register {
            STATUS => self.status,
            CONTROL => self.control,
            _ if within(PICTURE) < WORDS => self.picture[within(PICTURE)],
            _ if within(CALIBRATION) < WORDS => self.calibration[within(CALIBRATION)],
            _ => 0,
        }
    }
}

/// The offset of a pixel as the maker computes it from the calibration.
fn offset(calibration: &[u16], row: usize, column: usize) -> i32 {
    let scales = calibration[SCALES];
    let nibble = |first: usize, index: usize| {
        let value = i32::from(calibration[first + index / 4] >> (4 * (index % 4)) & 0xF);
        if value > 7 { value - 16 } else { value }
    };
    let of_row = nibble(OF_ROWS, row) << (scales >> 8 & 0xF);
    let of_column = nibble(OF_COLUMNS, column) << (scales >> 4 & 0xF);
    let word = calibration[PIXELS + row * COLUMNS + column];
    let remainder = i32::from(word as i16 >> 10);
    i32::from(calibration[MEAN] as i16) + of_row + of_column + (remainder << (scales & 0xF))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::robots;

    fn words(camera: &mut Mlx90640, register: u16, count: usize) -> Vec<u16> {
        let mut bytes = vec![0; 2 * count];
        camera
            .transact(&register.to_be_bytes(), &mut bytes)
            .unwrap();
        let words = bytes.chunks(2);
        words
            .map(|word| u16::from_be_bytes([word[0], word[1]]))
            .collect()
    }

    /// -60 + (-1 << 2) + (3 << 1) + 5 = -53.
    #[test]
    fn an_offset_is_the_sum_of_its_parts() {
        let mut calibration = vec![0; WORDS];
        calibration[SCALES] = 0x0210;
        calibration[MEAN] = 0xFFC4;
        calibration[OF_ROWS + 1] = 0x00F0;
        calibration[OF_COLUMNS] = 0x0300;
        calibration[PIXELS + 5 * COLUMNS + 2] = 5 << 10;
        assert_eq!(offset(&calibration, 5, 2), -53);
        calibration[PIXELS + 5 * COLUMNS + 2] = 0xFC00;
        assert_eq!(offset(&calibration, 5, 2), -59);
    }

    #[test]
    fn a_picture_less_its_offsets_is_what_is_seen() {
        let mut camera = Mlx90640::new(1);
        let mut random = Random::new(2);
        let body = robots::by_name("two-wheels").unwrap().body();
        camera.capture(0.0, body.as_ref(), &mut random);
        assert_eq!(words(&mut camera, STATUS, 1), [NEW_DATA | 1]);
        let picture = words(&mut camera, PICTURE, WORDS);
        let calibration = words(&mut camera, CALIBRATION, WORDS);
        for (pixel, &raw) in picture.iter().enumerate().take(ROWS * COLUMNS) {
            let signal =
                i32::from(raw as i16) - offset(&calibration, pixel / COLUMNS, pixel % COLUMNS);
            assert!((-90..-30).contains(&signal), "{pixel}: {signal}");
        }
    }

    #[test]
    fn new_data_is_cleared_by_the_read_and_comes_at_the_rate_that_was_set() {
        let mut camera = Mlx90640::new(1);
        let mut random = Random::new(2);
        let body = robots::by_name("bare").unwrap().body();
        camera.capture(0.0, body.as_ref(), &mut random);
        camera.transact(&[0x80, 0, 0, 0x30], &mut []).unwrap();
        assert_eq!(words(&mut camera, STATUS, 1), [1]);
        // 4 Hz.
        camera.transact(&[0x80, 0x0D, 0x19, 0x81], &mut []).unwrap();
        assert_eq!(words(&mut camera, CONTROL, 1), [0x1981]);
        camera.capture(0.49, body.as_ref(), &mut random);
        assert_eq!(
            words(&mut camera, STATUS, 1),
            [1],
            "the first one took 2 Hz"
        );
        camera.capture(0.5, body.as_ref(), &mut random);
        assert_eq!(words(&mut camera, STATUS, 1), [NEW_DATA]);
        camera.capture(0.75, body.as_ref(), &mut random);
        assert_eq!(words(&mut camera, STATUS, 1), [NEW_DATA | 1]);
    }

    #[test]
    fn half_a_register_is_not_acknowledged() {
        let mut camera = Mlx90640::new(1);
        assert_eq!(camera.transact(&[0x80], &mut []), Err(NACK));
        assert_eq!(camera.transact(&[0x24, 0, 1, 2], &mut []), Err(NACK));
        let mut odd = [0; 3];
        camera.transact(&[0x80, 0x0D], &mut odd).unwrap();
        assert_eq!(odd, [0x19, 0x01, 0]);
    }
}
