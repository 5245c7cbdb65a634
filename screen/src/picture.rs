//! Pictures of files and of the camera: PNG and JPEG to pixels, and raw pixels of programs.
//!
//! Owns the limits of a picture; the formats themselves are known to the crates that read them.

use crate::colour::Colour;
use crate::fault::Fault;
use crate::limits;
use crate::pixels::Pixels;
use zune_jpeg::JpegDecoder;
use zune_jpeg::zune_core::bytestream::ZCursor;
use zune_jpeg::zune_core::colorspace::ColorSpace;
use zune_jpeg::zune_core::options::DecoderOptions;

/// Pixels of a PNG or JPEG file.
///
/// # Errors
/// It is neither, is damaged, or has more than [`limits::PICTURE_PIXELS`].
pub fn decode(file: &[u8]) -> Result<Pixels, Fault> {
    if file.starts_with(&[0xff, 0xd8]) {
        jpeg(file)
    } else if file.starts_with(b"\x89PNG") {
        png(file)
    } else {
        Err(Fault::NoPicture)
    }
}

/// Width and height, if they are within the limits.
fn sides(width: usize, height: usize) -> Result<(u16, u16), Fault> {
    let side = |size: usize| {
        u16::try_from(size)
            .ok()
            .filter(|side| *side <= limits::SIDE_MAX)
    };
    match (side(width), side(height)) {
        (Some(wide), Some(high)) if width * height <= limits::PICTURE_PIXELS => Ok((wide, high)),
        _ => Err(Fault::Pixels(width, height)),
    }
}

fn jpeg(file: &[u8]) -> Result<Pixels, Fault> {
    let options = DecoderOptions::default()
        .jpeg_set_out_colorspace(ColorSpace::RGB)
        .set_max_width(limits::SIDE_MAX.into())
        .set_max_height(limits::SIDE_MAX.into());
    let damaged = |error: zune_jpeg::errors::DecodeErrors| Fault::Jpeg(error.to_string());
    let mut decoder = JpegDecoder::new_with_options(ZCursor::new(file), options);
    decoder.decode_headers().map_err(damaged)?;
    let (width, height) = decoder.dimensions().unwrap_or_default();
    let (width, height) = sides(width, height)?;
    let bytes = decoder.decode().map_err(damaged)?;
    Ok(Pixels::from_rgb(width, height, &bytes))
}

fn png(file: &[u8]) -> Result<Pixels, Fault> {
    let damaged = |error: png::DecodingError| Fault::Png(error.to_string());
    let bounds = png::Limits {
        bytes: 4 * limits::PICTURE_PIXELS,
    };
    let mut decoder = png::Decoder::new_with_limits(std::io::Cursor::new(file), bounds);
    decoder.set_transformations(png::Transformations::normalize_to_color8());
    let mut reader = decoder.read_info().map_err(damaged)?;
    let (width, height) = (reader.info().width as usize, reader.info().height as usize);
    let (width, height) = sides(width, height)?;
    let size = reader.output_buffer_size().ok_or(Fault::PngSize)?;
    let mut bytes = vec![0; size];
    let info = reader.next_frame(&mut bytes).map_err(damaged)?;
    let mut pixels = Pixels::new(width, height, None);
    let samples = info.color_type.samples();
    for (index, pixel) in bytes[..info.buffer_size()]
        .chunks_exact(samples)
        .enumerate()
    {
        let (x, y) = (index % usize::from(width), index / usize::from(width));
        let (seen, opacity) = match *pixel {
            [grey] => ([grey; 3], u8::MAX),
            [grey, opacity] => ([grey; 3], opacity),
            [red, green, blue] => ([red, green, blue], u8::MAX),
            [red, green, blue, opacity] => ([red, green, blue], opacity),
            _ => continue,
        };
        // There are no half pixels: the background is not known yet.
        if opacity >= 128 {
            let [red, green, blue] = seen;
            let place = |at: usize| i32::try_from(at).unwrap_or(i32::MAX);
            pixels.set(place(x), place(y), Colour { red, green, blue });
        }
    }
    Ok(pixels)
}

/// How the numbers of a program are to be understood.
#[derive(Clone, Copy, Debug, Eq, PartialEq)]
pub enum RawFormat {
    /// One number for each pixel, 0xRRGGBB.
    Rgb32,
    /// Three numbers for each pixel.
    Rgb888,
    /// One number from black to white.
    Grayscale8,
}

impl RawFormat {
    /// By the words of programs.
    ///
    /// # Errors
    /// There is no such format.
    pub fn named(name: &str) -> Result<Self, Fault> {
        match name {
            "rgb32" => Ok(Self::Rgb32),
            "rgb888" => Ok(Self::Rgb888),
            "grayscale8" => Ok(Self::Grayscale8),
            _ => Err(Fault::Format(name.to_owned())),
        }
    }

    /// Numbers for each pixel.
    pub fn numbers(self) -> usize {
        match self {
            Self::Rgb888 => 3,
            Self::Rgb32 | Self::Grayscale8 => 1,
        }
    }
}

/// A picture from the numbers of a program, row by row.
///
/// # Errors
/// There are fewer numbers than pixels need, or too many pixels.
pub fn raw(numbers: &[i32], width: i32, height: i32, format: RawFormat) -> Result<Pixels, Fault> {
    let side = |size: i32| usize::try_from(size).map_err(|_| Fault::Side(size));
    let (columns, rows) = (side(width)?, side(height)?);
    let (width, height) = sides(columns, rows)?;
    let needed = columns * rows * format.numbers();
    if numbers.len() < needed {
        return Err(Fault::FewNumbers(width, height, needed, numbers.len()));
    }
    // Numbers may be signed bytes: the lowest eight bits count.
    let byte = |number: i32| number.to_le_bytes()[0];
    let bytes: Vec<u8> = match format {
        RawFormat::Rgb888 => numbers[..needed]
            .iter()
            .map(|&number| byte(number))
            .collect(),
        RawFormat::Grayscale8 => numbers[..needed]
            .iter()
            .flat_map(|&number| [byte(number); 3])
            .collect(),
        RawFormat::Rgb32 => numbers[..needed]
            .iter()
            .flat_map(|number| {
                let [blue, green, red, _] = number.to_le_bytes();
                [red, green, blue]
            })
            .collect(),
    };
    Ok(Pixels::from_rgb(width, height, &bytes))
}
