//! Letters of fixed width: Latin and Cyrillic.
//!
//! Owns which font stands for which height. Fonts are bitmaps, so above the largest one letters grow in whole steps; a
//! character that no font has is a question mark.

use crate::drawing::Label;
use crate::pixels::Pixels;
use embedded_graphics::Drawable;
use embedded_graphics::geometry::Point;
use embedded_graphics::mono_font::iso_8859_5::{
    FONT_4X6, FONT_5X8, FONT_6X10, FONT_6X13, FONT_8X13, FONT_9X15, FONT_9X18, FONT_10X20,
};
use embedded_graphics::mono_font::{MonoFont, MonoTextStyle};
use embedded_graphics::text::{Baseline, Text};

/// By their heights, the greatest last.
const FONTS: [&MonoFont<'static>; 8] = [
    &FONT_4X6,
    &FONT_5X8,
    &FONT_6X10,
    &FONT_6X13,
    &FONT_8X13,
    &FONT_9X15,
    &FONT_9X18,
    &FONT_10X20,
];

/// The font for this height in pixels, and how many times it is enlarged.
fn font(height: u16) -> (&'static MonoFont<'static>, i32) {
    let height = u32::from(height);
    let largest = FONTS[FONTS.len() - 1];
    if height >= 2 * largest.character_size.height {
        let times = height / largest.character_size.height;
        return (largest, i32::try_from(times).unwrap_or(1));
    }
    let fits = |font: &&&MonoFont| font.character_size.height <= height;
    (FONTS.iter().rev().find(fits).unwrap_or(&FONTS[0]), 1)
}

/// Paints a text with its upper left corner at (x, y).
pub fn paint(pixels: &mut Pixels, label: &Label, x: i32, y: i32) {
    let (font, times) = font(label.height);
    let style = MonoTextStyle::new(font, label.colour.into());
    let at = |x, y| Text::with_baseline(&label.text, Point::new(x, y), style, Baseline::Top);
    if times == 1 {
        let Ok(_) = at(x, y).draw(pixels);
        return;
    }
    let lines = label.text.split('\n').count();
    let columns = label
        .text
        .split('\n')
        .map(|line| line.chars().count())
        .max();
    let side = |count: usize, size: u32| {
        u16::try_from(count.saturating_mul(size as usize)).unwrap_or(u16::MAX)
    };
    // What would be beyond the display is not worth its memory.
    let width = side(columns.unwrap_or(0), font.character_size.width).min(pixels.width());
    let height = side(lines, font.character_size.height).min(pixels.height());
    let mut small = Pixels::new(width, height, None);
    let Ok(_) = at(0, 0).draw(&mut small);
    for row in 0..i32::from(height) * times {
        for column in 0..i32::from(width) * times {
            if let Some(colour) = small.at(column / times, row / times) {
                pixels.set(x + column, y + row, colour);
            }
        }
    }
}
