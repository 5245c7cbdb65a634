//! Every limit of a drawing.
//!
//! Owns the numbers only; the code that enforces each one names it from here.

/// Width of the controller's display in pixels.
pub const WIDTH: u16 = 320;
/// Its height.
pub const HEIGHT: u16 = 240;
/// Pixels of a picture in each direction.
pub const SIDE_MAX: u16 = 4096;
/// Shapes that are kept one by one; when there are more, the older half becomes one picture.
pub const SHAPES_MAX: usize = 2048;
/// Labels.
pub const LABELS_MAX: usize = 256;
/// Characters of one label.
pub const LABEL_CHARACTERS: usize = 400;
/// Coordinates of shapes are cut to this, either way.
pub const COORDINATE_MAX: i32 = 2000;
/// Pixels of the pen.
pub const PEN_MAX: u16 = 100;
/// Pixels of the height of a letter.
pub const LETTER_MAX: u16 = 240;
/// Height of a letter when none is given.
pub const LETTER: u16 = 18;
/// Bytes of a picture in a file, PNG or JPEG.
pub const FILE_BYTES: usize = 4 << 20;
/// Pixels of such a picture.
pub const PICTURE_PIXELS: usize = 4 << 20;
/// Bytes of one order with its text.
pub const ORDER_BYTES: usize = 4096;
