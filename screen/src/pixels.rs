//! Pixels of a rectangle, in full colour, and what displays and viewers want of them.
//!
//! Owns the buffer and its formats; what is painted into it is for `paint`.

use crate::colour::Colour;
use crate::limits;
use embedded_graphics::Pixel;
use embedded_graphics::draw_target::DrawTarget;
use embedded_graphics::geometry::{OriginDimensions, Point, Size};
use embedded_graphics::pixelcolor::Rgb888;
use std::convert::Infallible;

/// Pixels, row by row from the upper left corner. A pixel may be absent: what is behind it is seen.
#[derive(Clone, Debug, Eq, PartialEq)]
pub struct Pixels {
    width: u16,
    height: u16,
    pixels: Vec<Option<Colour>>,
}

impl Pixels {
    /// All pixels alike; absent with None. Sides are cut to [`limits::SIDE_MAX`].
    pub fn new(width: u16, height: u16, all: Option<Colour>) -> Self {
        let (width, height) = (width.min(limits::SIDE_MAX), height.min(limits::SIDE_MAX));
        let count = usize::from(width) * usize::from(height);
        Self {
            width,
            height,
            pixels: vec![all; count],
        }
    }

    /// From three bytes for each pixel; missing ones are absent pixels.
    pub fn from_rgb(width: u16, height: u16, bytes: &[u8]) -> Self {
        let mut pixels = Self::new(width, height, None);
        for (pixel, rgb) in pixels.pixels.iter_mut().zip(bytes.chunks_exact(3)) {
            *pixel = Some(crate::colour::colour(rgb[0], rgb[1], rgb[2]));
        }
        pixels
    }

    /// Pixels from left to right.
    pub fn width(&self) -> u16 {
        self.width
    }

    /// Pixels from top to bottom.
    pub fn height(&self) -> u16 {
        self.height
    }

    /// The colour at a place; None outside and where there is no pixel.
    pub fn at(&self, x: i32, y: i32) -> Option<Colour> {
        *self.pixels.get(self.index(x, y)?)?
    }

    fn index(&self, x: i32, y: i32) -> Option<usize> {
        let (x, y) = (u16::try_from(x).ok()?, u16::try_from(y).ok()?);
        (x < self.width && y < self.height)
            .then(|| usize::from(y) * usize::from(self.width) + usize::from(x))
    }

    /// Sets one pixel; outside nothing happens.
    pub fn set(&mut self, x: i32, y: i32, colour: Colour) {
        if let Some(index) = self.index(x, y) {
            self.pixels[index] = Some(colour);
        }
    }

    /// Fills a part of a row, both ends among it; what is outside costs nothing.
    pub fn fill_row(&mut self, y: i32, from: i32, to: i32, colour: Colour) {
        let to = to.min(i32::from(self.width) - 1);
        if let (Some(first), Some(last)) = (self.index(from.max(0), y), self.index(to, y))
            && first <= last
        {
            self.pixels[first..=last].fill(Some(colour));
        }
    }

    /// Puts others over these, its corner at (x, y).
    pub fn put(&mut self, over: &Self, x: i32, y: i32) {
        for row in 0..i32::from(over.height) {
            for column in 0..i32::from(over.width) {
                if let Some(colour) = over.at(column, row) {
                    self.set(x + column, y + row, colour);
                }
            }
        }
    }

    /// The same picture in another size, each pixel from the nearest.
    pub fn scaled(&self, width: u16, height: u16) -> Self {
        let mut scaled = Self::new(width, height, None);
        if self.pixels.is_empty() {
            return scaled;
        }
        let (width, height) = (usize::from(scaled.width), usize::from(scaled.height));
        for (index, pixel) in scaled.pixels.iter_mut().enumerate() {
            let x = index % width * usize::from(self.width) / width;
            let y = index / width * usize::from(self.height) / height;
            *pixel = self.pixels[y * usize::from(self.width) + x];
        }
        scaled
    }

    /// As large as fits into a rectangle, with its sides in proportion.
    pub fn fitted(&self, width: u16, height: u16) -> Self {
        let [own_width, own_height, width, height] =
            [self.width, self.height, width, height].map(u32::from);
        if own_width == 0 || own_height == 0 {
            return self.clone();
        }
        let (fitted_width, fitted_height) = if own_width * height > own_height * width {
            (width, own_height * width / own_width)
        } else {
            (own_width * height / own_height, height)
        };
        let side = |side: u32| u16::try_from(side.max(1)).unwrap_or(limits::SIDE_MAX);
        self.scaled(side(fitted_width), side(fitted_height))
    }

    fn colours(&self) -> impl Iterator<Item = Colour> {
        self.pixels.iter().map(|pixel| pixel.unwrap_or_default())
    }

    /// As the display takes it: RGB565, the low byte first, row by row. Absent pixels are black.
    pub fn to_rgb565(&self) -> Vec<u8> {
        self.colours()
            .flat_map(|colour| colour.rgb565().to_le_bytes())
            .collect()
    }

    /// From what a display has.
    pub fn from_rgb565(width: u16, height: u16, bytes: &[u8]) -> Self {
        let mut pixels = Self::new(width, height, None);
        for (pixel, two) in pixels.pixels.iter_mut().zip(bytes.chunks_exact(2)) {
            let packed = u16::from_le_bytes([two[0], two[1]]);
            // The highest bits again as the lowest, so that white is white.
            let wide = |bits: u16, count: u16| {
                u8::try_from(bits << (8 - count) | bits >> (2 * count - 8)).unwrap_or(u8::MAX)
            };
            let (red, green, blue) = (packed >> 11, packed >> 5 & 0x3f, packed & 0x1f);
            *pixel = Some(crate::colour::colour(
                wide(red, 5),
                wide(green, 6),
                wide(blue, 5),
            ));
        }
        pixels
    }

    /// Three bytes for each pixel. Absent pixels are black.
    pub fn to_rgb(&self) -> Vec<u8> {
        self.colours()
            .flat_map(|colour| [colour.red, colour.green, colour.blue])
            .collect()
    }

    /// A PNG file. Absent pixels are black.
    pub fn to_png(&self) -> Vec<u8> {
        let mut file = Vec::new();
        let mut encoder = png::Encoder::new(&mut file, self.width.into(), self.height.into());
        encoder.set_color(png::ColorType::Rgb);
        encoder.set_depth(png::BitDepth::Eight);
        // Writing to memory fails only for a picture without pixels, which makes an empty file.
        let written = encoder
            .write_header()
            .and_then(|mut writer| writer.write_image_data(&self.to_rgb()));
        if written.is_err() {
            file.clear();
        }
        file
    }

    /// A PPM file, which all viewers of pictures open (netpbm, format P6).
    pub fn to_ppm(&self) -> Vec<u8> {
        let mut file = format!("P6\n{} {}\n255\n", self.width, self.height).into_bytes();
        file.extend(self.to_rgb());
        file
    }
}

impl OriginDimensions for Pixels {
    fn size(&self) -> Size {
        Size::new(self.width.into(), self.height.into())
    }
}

impl DrawTarget for Pixels {
    type Color = Rgb888;
    type Error = Infallible;

    fn draw_iter<I>(&mut self, pixels: I) -> Result<(), Infallible>
    where
        I: IntoIterator<Item = Pixel<Rgb888>>,
    {
        for Pixel(Point { x, y }, colour) in pixels {
            self.set(x, y, colour.into());
        }
        Ok(())
    }
}
