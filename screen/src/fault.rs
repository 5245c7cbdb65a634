//! Why an order or a picture is refused.
//!
//! Owns the reasons and their words, which the author of the program reads: the blame is always the caller's.

mod words;

use crate::limits;
use std::fmt;

/// One reason.
#[derive(Clone, Debug, Eq, PartialEq)]
pub enum Fault {
    /// An order of more than [`limits::ORDER_BYTES`].
    LongOrder,
    /// A word that is no order, and the orders.
    Order(String, &'static str),
    /// A word instead of one of the numbers that an order has first: the order, how many numbers, the word.
    Number(String, usize, String),
    /// Words after all numbers of an order: the order, how many numbers, the words.
    MoreWords(String, usize, String),
    /// More texts than [`limits::LABELS_MAX`].
    Labels,
    /// A name of no colour, and the usual names.
    Colour(String, &'static str),
    /// A file that is no picture.
    NoPicture,
    /// A JPEG file that is damaged, in the words of its reader.
    Jpeg(String),
    /// A PNG file that is damaged, in the words of its reader.
    Png(String),
    /// A picture of more pixels than [`limits::SIDE_MAX`] in a row or [`limits::PICTURE_PIXELS`] in all: width, height.
    Pixels(usize, usize),
    /// A PNG file that cannot be counted.
    PngSize,
    /// A name of no format of pixels.
    Format(String),
    /// A width or height below 0.
    Side(i32),
    /// Too few numbers for a picture: width, height, how many are needed, how many there are.
    FewNumbers(u16, u16, usize, usize),
}

impl fmt::Display for Fault {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::LongOrder => write!(f, "an order has at most {} bytes", limits::ORDER_BYTES),
            Self::Order(verb, orders) => {
                write!(
                    f,
                    "'{verb}' is no order for the display; there are {orders}"
                )
            }
            Self::Number(verb, count, word) => {
                write!(f, "{verb} takes {count} numbers first, not '{word}'")
            }
            Self::MoreWords(verb, count, words) => {
                write!(f, "{verb} takes {count} numbers and no more: '{words}'")
            }
            Self::Labels => write!(
                f,
                "there are {} labels already: call removeLabels()",
                limits::LABELS_MAX
            ),
            Self::Colour(name, names) => {
                write!(f, "'{name}' is no colour; there are {names} and #rrggbb")
            }
            Self::NoPicture => f.write_str("this is neither a PNG nor a JPEG picture"),
            Self::Jpeg(why) => write!(f, "the JPEG picture cannot be read: {why}"),
            Self::Png(why) => write!(f, "the PNG picture cannot be read: {why}"),
            Self::Pixels(width, height) => write!(
                f,
                "the picture has {width} x {height} pixels, more than {} in a row or {} in all",
                limits::SIDE_MAX,
                limits::PICTURE_PIXELS
            ),
            Self::PngSize => f.write_str("the PNG picture is too large"),
            Self::Format(name) => write!(
                f,
                "'{name}' is no format of pixels; there are rgb32, rgb888 and grayscale8"
            ),
            Self::Side(size) => write!(f, "{size} is no width or height"),
            Self::FewNumbers(width, height, needed, there) => write!(
                f,
                "{width} x {height} pixels need {needed} numbers, there are {there}"
            ),
        }
    }
}

impl Fault {
    /// The sentence in Russian.
    pub fn russian(&self) -> String {
        words::russian(self)
    }
}

impl std::error::Error for Fault {}

/// For callers whose own errors are texts for the author of the program.
impl From<Fault> for String {
    fn from(fault: Fault) -> Self {
        fault.to_string()
    }
}
