//! What a robot program draws: a list of shapes and texts, and the pixels that they become.
//!
//! Pure: words in, a list out; a list in, pixels out. Knows no files, no devices and no language of programs. The list
//! is for those who want to know what was drawn, the pixels are for those who look.

pub mod colour;
pub mod drawing;
pub mod fault;
pub mod letters;
pub mod limits;
pub mod order;
pub mod paint;
pub mod picture;
pub mod pixels;

pub use drawing::Drawing;
pub use fault::Fault;
pub use pixels::Pixels;

#[cfg(test)]
mod tests;
