//! Pictures that lie on a floor: files in a project to outlines and pixels.
//!
//! Owns which formats there are and their limits. SVG becomes outlines, so it is sharp from every place; what the original
//! does not show of it (clips, masks, filters) is not shown here. PNG and JPEG stay pixels. No other file is opened,
//! whatever a picture names. Knows neither the field nor where a picture lies on it.

mod words;

use lang_text::problem::Words;
use screen::{Fault, Pixels};
use std::fmt;
use usvg::tiny_skia_path as skia;

use super::colour::Tint;
use super::gradient::Gradient;
use super::outline::{Affine, Outline};
use super::raster::Rule;
use crate::limits;

/// Why a file is not shown. The author of the project can change that.
#[derive(Clone, Debug, Eq, PartialEq)]
pub enum Refusal {
    /// It is no picture.
    Fault(Fault),
    /// A byte that Base64 has not.
    NotBase64(usize),
    /// It has more than [`limits::PICTURE_BYTES`].
    TooLong,
    /// It has no bytes.
    Empty,
    /// An SVG of so many bytes.
    LongSvg(usize),
    /// An SVG with sizes that its reader does not bear.
    StrangeSvg,
    /// An SVG that is damaged, in the words of its reader.
    Svg(String),
    /// An SVG of so many lines and areas.
    ManyLayers(usize),
}

impl fmt::Display for Refusal {
    fn fmt(&self, out: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Fault(why) => write!(out, "{why}"),
            Self::NotBase64(at) => write!(out, "byte {at} of the picture is not Base64"),
            Self::TooLong => write!(
                out,
                "the picture has more than {} bytes",
                limits::PICTURE_BYTES
            ),
            Self::Empty => out.write_str("the picture is empty"),
            Self::LongSvg(bytes) => write!(
                out,
                "the SVG has {bytes} bytes, more than {}: make a PNG of it",
                limits::SVG_BYTES
            ),
            Self::StrangeSvg => {
                out.write_str("the SVG cannot be read: a size in it is too strange")
            }
            Self::Svg(why) => write!(out, "the SVG cannot be read: {why}"),
            Self::ManyLayers(count) => write!(
                out,
                "the SVG has {count} lines and areas, more than {}: make a PNG of it",
                limits::PICTURE_LAYERS
            ),
        }
    }
}

impl Refusal {
    /// For a person.
    pub fn words(&self) -> Words {
        Words::new(self.to_string(), words::russian(self))
    }
}

impl std::error::Error for Refusal {}

/// Something in a picture that sensors see otherwise, or not at all.
#[derive(Clone, Copy, Debug, Eq, Ord, PartialEq, PartialOrd)]
pub enum Lack {
    /// A text.
    Text,
    /// A picture inside that is damaged.
    Damaged,
    /// A picture inside that is neither PNG nor JPEG.
    Other,
    /// A pattern.
    Pattern,
}

/// A picture, from (0, 0) to (1, 1).
#[derive(Clone, Debug, Default)]
pub struct Picture {
    /// From the bottom up.
    pub layers: Vec<Layer>,
    /// What is in the file and cannot be shown.
    pub lacks: Vec<Lack>,
}

/// What an area is painted with.
#[derive(Clone, Debug)]
pub enum Paint {
    /// One colour.
    Plain(Tint),
    /// Colours from place to place.
    Shade(Box<Gradient>),
}

/// A part of a picture.
#[derive(Clone, Debug)]
pub enum Layer {
    /// An inside, and what takes it to the picture's square.
    Filled(skia::Path, Rule, Paint, Affine),
    /// The same of a line, with the lengths of its dashes and gaps.
    Drawn(skia::Path, Box<(skia::Stroke, Vec<f32>)>, Paint, Affine),
    /// Pixels, and what takes the place of a pixel to the picture's square.
    Pixels(std::sync::Arc<Pixels>, Affine),
}

impl Layer {
    /// Its outline where the square of the picture is at `place`; nothing for pixels.
    pub fn outline(&self, place: &Affine) -> Option<(Outline, Paint)> {
        let (outline, paint) = match self {
            Self::Filled(path, rule, paint, to) => {
                (Outline::inside(path, &to.then(place), *rule)?, paint)
            }
            Self::Drawn(path, pen, paint, to) => {
                let (stroke, dashes) = &**pen;
                let outline = Outline::along(path, &to.then(place), stroke, dashes)?;
                (outline, paint)
            }
            Self::Pixels(..) => return None,
        };
        let paint = match paint {
            Paint::Plain(tint) => Paint::Plain(*tint),
            Paint::Shade(gradient) => Paint::Shade(gradient.at(place)?.into()),
        };
        Some((outline, paint))
    }
}

impl Picture {
    /// A picture out of a project: the text of an SVG, or a PNG or JPEG in Base64.
    ///
    /// # Errors
    /// What is wrong with it, for people.
    pub fn read(path: &str, text: &str) -> Result<Self, Refusal> {
        let trimmed = text.trim_start();
        let is_svg = path.to_ascii_lowercase().ends_with("svg") || trimmed.starts_with('<');
        if is_svg {
            return Self::svg(trimmed);
        }
        let file = base64(text)?;
        let pixels = screen::picture::decode(&file).map_err(Refusal::Fault)?;
        let mut picture = Self::default();
        picture.add_pixels(pixels, &Affine::SAME);
        Ok(picture)
    }

    fn svg(text: &str) -> Result<Self, Refusal> {
        if text.len() > limits::SVG_BYTES {
            return Err(Refusal::LongSvg(text.len()));
        }
        let options = usvg::Options {
            image_href_resolver: usvg::ImageHrefResolver {
                resolve_string: Box::new(|_, _| None),
                ..usvg::ImageHrefResolver::default()
            },
            ..usvg::Options::default()
        };
        // usvg panics at some pictures inside that have strange sizes.
        let read = std::panic::AssertUnwindSafe(|| usvg::Tree::from_str(text, &options));
        let tree = std::panic::catch_unwind(read)
            .map_err(|_| Refusal::StrangeSvg)?
            .map_err(|error| Refusal::Svg(error.to_string()))?;
        let size = tree.size();
        let square = Affine([
            1.0 / f64::from(size.width()),
            0.0,
            0.0,
            1.0 / f64::from(size.height()),
            0.0,
            0.0,
        ]);
        let mut picture = Self::default();
        picture.add_group(tree.root(), &square, 1.0, 0);
        if picture.layers.len() > limits::PICTURE_LAYERS {
            return Err(Refusal::ManyLayers(picture.layers.len()));
        }
        picture.lacks.sort_unstable();
        picture.lacks.dedup();
        Ok(picture)
    }

    fn add_group(&mut self, group: &usvg::Group, square: &Affine, opacity: f32, depth: u32) {
        let opacity = opacity * group.opacity().get();
        for node in group.children() {
            if self.layers.len() > limits::PICTURE_LAYERS || depth > limits::PICTURE_DEPTH {
                return;
            }
            match node {
                usvg::Node::Group(group) => self.add_group(group, square, opacity, depth + 1),
                usvg::Node::Path(path) if path.is_visible() => {
                    self.add_path(path, square, opacity);
                }
                usvg::Node::Image(image) if image.is_visible() => {
                    self.add_image(image, square, opacity, depth);
                }
                usvg::Node::Text(_) => self.lacks.push(Lack::Text),
                usvg::Node::Path(_) | usvg::Node::Image(_) => {}
            }
        }
    }

    fn add_path(&mut self, path: &usvg::Path, square: &Affine, opacity: f32) {
        let to = affine(path.abs_transform()).then(square);
        if let Some(fill) = path.fill()
            && let Some(paint) = self.paint(fill.paint(), fill.opacity().get() * opacity, &to)
        {
            let rule = match fill.rule() {
                usvg::FillRule::NonZero => Rule::NonZero,
                usvg::FillRule::EvenOdd => Rule::EvenOdd,
            };
            self.layers
                .push(Layer::Filled(path.data().clone(), rule, paint, to));
        }
        if let Some(stroke) = path.stroke()
            && let Some(paint) = self.paint(stroke.paint(), stroke.opacity().get() * opacity, &to)
        {
            let dashes = stroke.dasharray().unwrap_or_default().to_vec();
            let stroke = Box::new((stroke.to_tiny_skia(), dashes));
            self.layers
                .push(Layer::Drawn(path.data().clone(), stroke, paint, to));
        }
    }

    fn add_image(&mut self, image: &usvg::Image, square: &Affine, opacity: f32, depth: u32) {
        let place = affine(image.abs_transform()).then(square);
        match image.kind() {
            usvg::ImageKind::PNG(file) | usvg::ImageKind::JPEG(file) => {
                match screen::picture::decode(file) {
                    Ok(pixels) => {
                        let (width, height) = (image.size().width(), image.size().height());
                        let size = [f64::from(width), 0.0, 0.0, f64::from(height), 0.0, 0.0];
                        self.add_pixels(pixels, &Affine(size).then(&place));
                    }
                    Err(_) => self.lacks.push(Lack::Damaged),
                }
            }
            usvg::ImageKind::SVG(tree) => self.add_group(tree.root(), &place, opacity, depth + 1),
            usvg::ImageKind::GIF(_) | usvg::ImageKind::WEBP(_) => {
                self.lacks.push(Lack::Other);
            }
        }
    }

    /// Pixels whose own square lies at `place`.
    fn add_pixels(&mut self, pixels: Pixels, place: &Affine) {
        let (width, height) = (f64::from(pixels.width()), f64::from(pixels.height()));
        if width > 0.0 && height > 0.0 {
            let own = Affine([1.0 / width, 0.0, 0.0, 1.0 / height, 0.0, 0.0]);
            self.layers
                .push(Layer::Pixels(pixels.into(), own.then(place)));
        }
    }

    /// What a paint of a path is, whose path goes to the picture's square by `to`.
    fn paint(&mut self, paint: &usvg::Paint, opacity: f32, to: &Affine) -> Option<Paint> {
        match paint {
            usvg::Paint::Color(colour) => Some(Paint::Plain(Tint {
                rgb: [colour.red, colour.green, colour.blue],
                opacity: byte(opacity * 255.0),
            })),
            usvg::Paint::LinearGradient(_) | usvg::Paint::RadialGradient(_) => {
                let gradient = Gradient::of(paint, opacity, to);
                gradient.map(|gradient| Paint::Shade(gradient.into()))
            }
            usvg::Paint::Pattern(_) => {
                self.lacks.push(Lack::Pattern);
                None
            }
        }
    }
}

fn byte(value: f32) -> u8 {
    value.round().clamp(0.0, 255.0) as u8
}

fn affine(from: skia::Transform) -> Affine {
    Affine([from.sx, from.ky, from.kx, from.sy, from.tx, from.ty].map(f64::from))
}

/// The bytes that Base64 stands for; white space is left out.
///
/// # Errors
/// It is too long, empty or none.
pub fn base64(text: &str) -> Result<Vec<u8>, Refusal> {
    if text.len() > limits::PICTURE_BYTES / 3 * 4 {
        return Err(Refusal::TooLong);
    }
    let mut bytes = Vec::with_capacity(text.len() / 4 * 3);
    let (mut bits, mut count) = (0u32, 0);
    for (at, letter) in text.bytes().enumerate() {
        let value = match letter {
            b'A'..=b'Z' => letter - b'A',
            b'a'..=b'z' => letter - b'a' + 26,
            b'0'..=b'9' => letter - b'0' + 52,
            b'+' => 62,
            b'/' => 63,
            b'=' => break,
            _ if letter.is_ascii_whitespace() => continue,
            _ => return Err(Refusal::NotBase64(at)),
        };
        bits = bits << 6 | u32::from(value);
        count += 6;
        if count >= 8 {
            count -= 8;
            bytes.push((bits >> count & 0xff) as u8);
        }
    }
    if bytes.is_empty() {
        return Err(Refusal::Empty);
    }
    Ok(bytes)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn base64_is_read() {
        assert_eq!(base64("aGVs\n bG8=").unwrap(), b"hello");
        assert_eq!(base64("aGVsbG8h").unwrap(), b"hello!");
        assert!(base64("  ").is_err());
        assert_eq!(base64("aG$s"), Err(Refusal::NotBase64(2)));
    }

    #[test]
    fn an_svg_becomes_layers() {
        let text = "<svg xmlns='http://www.w3.org/2000/svg' viewBox='0 0 10 20'>\
            <rect width='5' height='5' fill='red'/><path d='M0 0 L 3 3' stroke='#00f' fill='none'/>\
            <image href='/etc/passwd' width='9' height='9'/></svg>";
        let picture = Picture::read("a.svg", text).unwrap();
        assert_eq!(picture.layers.len(), 2);
        let (outline, paint) = picture.layers[0].outline(&Affine::SAME).unwrap();
        assert!(matches!(paint, Paint::Plain(tint) if tint == Tint::solid([255, 0, 0])));
        let [left, top, right, bottom] = outline.bounds().0;
        assert_eq!((left, top), (0.0, 0.0));
        assert!((right - 0.5).abs() < 1e-6 && (bottom - 0.25).abs() < 1e-6);
    }

    #[test]
    fn what_is_no_picture_is_told() {
        for (path, text) in [
            ("a.svg", "no"),
            ("a.png", "aGVsbG8="),
            ("a.png", ""),
            ("", "<svg"),
        ] {
            assert!(Picture::read(path, text).is_err(), "{path} {text}");
        }
    }
}
