//! Pictures of the camera for people: what it sees, as JPEG files.
//!
//! Owns their size and quality. Nothing is rendered before somebody asks.

use crate::limits::{PHOTO_HEIGHT, PHOTO_QUALITY, PHOTO_WIDTH};
use crate::shared::Shared;
use crate::world::colour;
use jpeg_encoder::{ColorType, Encoder};

/// One picture; with a fault, brighter or darker by up to `noise` in each row. Empty if it cannot be made.
///
/// The machine is free between the rows, so a robot that turns is seen as by a real camera: row after row.
pub fn jpeg(shared: &Shared, noise: f64) -> Vec<u8> {
    let across = |place: u16, size: u16| f64::from(2 * place + 1) / f64::from(size) - 1.0;
    let mut rgb = Vec::with_capacity(3 * usize::from(PHOTO_WIDTH) * usize::from(PHOTO_HEIGHT));
    for row in 0..PHOTO_HEIGHT {
        let mut machine = shared.machine();
        let brighter = machine.random.within(noise);
        for column in 0..PHOTO_WIDTH {
            let seen = machine
                .body()
                .pixel(across(column, PHOTO_WIDTH), across(row, PHOTO_HEIGHT))
                .unwrap_or(colour(0, 0, 0));
            let part = |part: u8| (f64::from(part) + brighter).clamp(0.0, 255.0) as u8;
            rgb.extend([part(seen.red), part(seen.green), part(seen.blue)]);
        }
    }
    let mut file = Vec::new();
    let encoder = Encoder::new(&mut file, PHOTO_QUALITY);
    match encoder.encode(&rgb, PHOTO_WIDTH, PHOTO_HEIGHT, ColorType::Rgb) {
        Ok(()) => file,
        Err(_) => Vec::new(),
    }
}
