//! Colours and their names.
//!
//! Owns what a colour is and how a text says it. `names` has the names: those of Qt, because the robot's own runtime asks
//! Qt for them.

mod names;

use crate::fault::Fault;
use embedded_graphics::pixelcolor::{Rgb888, RgbColor};

/// Red, green and blue, 0 to 255 each.
#[derive(Clone, Copy, Debug, Default, Eq, Hash, PartialEq)]
pub struct Colour {
    /// Red.
    pub red: u8,
    /// Green.
    pub green: u8,
    /// Blue.
    pub blue: u8,
}

/// What a drawing begins with.
pub const BLACK: Colour = colour(0, 0, 0);
/// The background of a drawing whose program names none.
pub const WHITE: Colour = colour(255, 255, 255);

/// A colour from its parts.
pub const fn colour(red: u8, green: u8, blue: u8) -> Colour {
    Colour { red, green, blue }
}

impl Colour {
    /// From `0xRRGGBB`; what is above is left out.
    pub const fn from_number(number: u32) -> Self {
        let [_, red, green, blue] = number.to_be_bytes();
        colour(red, green, blue)
    }

    /// `0xRRGGBB`.
    pub fn number(self) -> u32 {
        u32::from_be_bytes([0, self.red, self.green, self.blue])
    }

    /// From a name in any case, `#rgb` or `#rrggbb`.
    ///
    /// # Errors
    /// No such colour; the text names those that there are.
    pub fn named(name: &str) -> Result<Self, Fault> {
        let wanted = name.trim().to_ascii_lowercase();
        if let Some(number) = wanted.strip_prefix('#').and_then(hexadecimal) {
            return Ok(Self::from_number(number));
        }
        names::number(&wanted)
            .map(Self::from_number)
            .ok_or_else(|| Fault::Colour(name.to_owned(), names::USUAL))
    }

    /// As the display has it: 5 bits red, 6 green, 5 blue.
    pub fn rgb565(self) -> u16 {
        u16::from(self.red >> 3) << 11 | u16::from(self.green >> 2) << 5 | u16::from(self.blue >> 3)
    }
}

fn hexadecimal(digits: &str) -> Option<u32> {
    if !digits.bytes().all(|digit| digit.is_ascii_hexdigit()) {
        return None;
    }
    match digits.len() {
        3 => {
            let short = u32::from_str_radix(digits, 16).ok()?;
            Some((short & 0xf00) * 0x1100 + (short & 0xf0) * 0x110 + (short & 0xf) * 0x11)
        }
        6 => u32::from_str_radix(digits, 16).ok(),
        _ => None,
    }
}

impl From<Colour> for Rgb888 {
    fn from(from: Colour) -> Self {
        Self::new(from.red, from.green, from.blue)
    }
}

impl From<Rgb888> for Colour {
    fn from(from: Rgb888) -> Self {
        colour(from.r(), from.g(), from.b())
    }
}
