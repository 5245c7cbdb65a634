//! The display of the robot, as one program has it: what it draws goes into the tree as whole pictures.
//!
//! Owns the file of the tree and when it is written. What orders mean and how things look is in the crate `screen`.

use crate::{limits, pictures};
use screen::order::Effect;
use screen::picture::{self, RawFormat};
use screen::{Drawing, Pixels};
use std::fs::{File, OpenOptions};
use std::io::{self, BufRead, Read, Seek, Write};
use std::path::{Path, PathBuf};

/// Where the tree takes pictures: 320 x 240 pixels, RGB565, the low byte first.
pub const DISPLAY: &str = "display/device";

/// A drawing and the display that it is shown on. Each failure is a text for a person.
#[derive(Debug)]
pub struct Display {
    drawing: Drawing,
    path: PathBuf,
    file: Option<File>,
}

impl Display {
    /// The display of the tree that is mounted at `root`. Opens nothing yet.
    pub fn new(root: &Path) -> Self {
        Self {
            drawing: Drawing::default(),
            path: root.join(DISPLAY),
            file: None,
        }
    }

    /// Does what one line says; see [`screen::order`].
    ///
    /// # Errors
    /// The line makes no sense, or the tree does not take the picture.
    pub fn order(&mut self, line: &str) -> Result<(), String> {
        match self.drawing.order(line)? {
            Effect::Later => Ok(()),
            Effect::Show => self.put(&self.drawing.paint()),
            Effect::Hide => {
                let (width, height) = self.drawing.size();
                self.put(&Pixels::new(width, height, None))
            }
        }
    }

    /// Shows the picture of a file, PNG or JPEG, at the bottom.
    ///
    /// # Errors
    /// It cannot be read, is no such picture, or the tree does not take it.
    pub fn show_file(&mut self, file: &Path) -> Result<(), String> {
        let told = |error: io::Error| format!("{}: {error}", file.display());
        let mut bytes = Vec::new();
        let limit = screen::limits::FILE_BYTES as u64;
        let opened = File::open(file).map_err(told)?;
        let read = opened.take(limit + 1).read_to_end(&mut bytes);
        read.map_err(told)?;
        if bytes.len() as u64 > limit {
            return Err(format!(
                "{}: is larger than {} MiB",
                file.display(),
                limit >> 20
            ));
        }
        let picture = picture::decode(&bytes);
        let picture = picture.map_err(|reason| format!("{}: {reason}", file.display()))?;
        self.show(&picture)
    }

    /// Shows pixels that a program has computed.
    ///
    /// # Errors
    /// There are too few, the format is not known, or the tree does not take them.
    pub fn show_numbers(
        &mut self,
        numbers: &[i32],
        width: i32,
        height: i32,
        format: &str,
    ) -> Result<(), String> {
        let format = RawFormat::named(format)?;
        let picture = picture::raw(numbers, width, height, format)?;
        self.show(&picture)
    }

    fn show(&mut self, picture: &Pixels) -> Result<(), String> {
        self.drawing.show(picture);
        self.put(&self.drawing.paint())
    }

    /// Writes one picture. The file stays open, and is opened anew after a failure: the tree may have been mounted again.
    fn put(&mut self, pixels: &Pixels) -> Result<(), String> {
        let bytes = pixels.to_rgb565();
        let had_one = self.file.is_some();
        let mut result = self.write(&bytes);
        if result.is_err() {
            self.file = None;
            if had_one {
                result = self.write(&bytes);
            }
        }
        result.map_err(|error| {
            self.file = None;
            let fault = self.path.with_file_name("fault");
            let fault = std::fs::read_to_string(fault).unwrap_or_default();
            let fault = fault.trim();
            let path = self.path.display();
            match (error.kind(), fault) {
                (io::ErrorKind::NotFound, "") => {
                    format!("the tree has no display ({path}); nothing is shown")
                }
                (_, "") => format!("{path}: {error}; nothing is shown"),
                _ => format!("{path}: {error} ({fault}); nothing is shown"),
            }
        })
    }

    fn write(&mut self, bytes: &[u8]) -> io::Result<()> {
        let file = match &mut self.file {
            Some(file) => file,
            closed => closed.insert(OpenOptions::new().write(true).open(&self.path)?),
        };
        // A file of the tree has no position; a plain file in its place has one.
        let _ = file.rewind();
        file.write_all(bytes)
    }
}

/// Orders of programs in other languages, and of people at a shell: one on each line of `input`.
///
/// Beside those of [`screen::order`] there are `image PATH` and `show WIDTH HEIGHT FORMAT COUNT`, behind whose line
/// stand COUNT numbers of four bytes, the lowest first. `photo WIDTH HEIGHT` is a question to the camera. With `answers`
/// each order is answered by a line `ok COUNT` and COUNT bytes (those of a photo, three for each point, else none), or
/// `error: TEXT`; otherwise failures alone are told, on standard error.
///
/// # Errors
/// The input or output fails, or an order has failed and nobody wants answers.
pub fn serve(root: &Path, input: &mut impl BufRead, answers: bool) -> Result<(), String> {
    let mut display = Display::new(root);
    let mut failures = 0;
    let mut output = io::stdout();
    loop {
        let mut line = Vec::new();
        let limit = screen::limits::ORDER_BYTES as u64 + 2;
        let told = |error: io::Error| format!("orders cannot be read: {error}");
        input
            .take(limit)
            .read_until(b'\n', &mut line)
            .map_err(told)?;
        if line.is_empty() {
            break;
        }
        let done = match std::str::from_utf8(&line) {
            Ok(text) => perform(&mut display, root, text.trim_end_matches('\n'), input),
            Err(_) => Err("the order is no UTF-8".to_owned()),
        };
        failures += u32::from(done.is_err());
        if answers {
            let answer = match done {
                Ok(bytes) => [format!("ok {}\n", bytes.len()).into_bytes(), bytes].concat(),
                Err(reason) => format!("error: {reason}\n").into_bytes(),
            };
            let said = output.write_all(&answer).and_then(|()| output.flush());
            said.map_err(|error| format!("answers cannot be written: {error}"))?;
        } else if let Err(reason) = done {
            crate::log::report(reason);
        }
    }
    if failures > 0 && !answers {
        return Err(format!("{failures} orders failed"));
    }
    Ok(())
}

/// Does one order; the bytes are the answer.
fn perform(
    display: &mut Display,
    root: &Path,
    line: &str,
    input: &mut impl Read,
) -> Result<Vec<u8>, String> {
    let (verb, rest) = line.split_once(' ').unwrap_or((line, ""));
    let words: Vec<&str> = rest.split(' ').collect();
    let whole = |word: &str| {
        let number = word.parse::<i32>();
        number.map_err(|_| format!("{verb} takes whole numbers, not '{word}'"))
    };
    match (verb, &words[..]) {
        ("image", _) => display.show_file(Path::new(rest))?,
        ("show", [width, height, format, count]) => {
            let (width, height, count) = (whole(width)?, whole(height)?, whole(count)?);
            let numbers = numbers(input, count)?;
            display.show_numbers(&numbers, width, height, format)?;
        }
        ("show", _) => {
            return Err("show takes width, height, format and the count of numbers".to_owned());
        }
        ("photo", [width, height]) => {
            let side = |word: &str| {
                let side = u16::try_from(whole(word)?).ok();
                let side = side.filter(|side| (1..=screen::limits::SIDE_MAX).contains(side));
                side.ok_or_else(|| format!("{word} is no width or height of a photo"))
            };
            let (width, height) = (side(width)?, side(height)?);
            return Ok(pictures::photo(root)?.scaled(width, height).to_rgb());
        }
        ("photo", _) => return Err("photo takes width and height".to_owned()),
        _ => display.order(line)?,
    }
    Ok(Vec::new())
}

/// So many numbers of four bytes.
fn numbers(input: &mut impl Read, count: i32) -> Result<Vec<i32>, String> {
    let count = usize::try_from(count).ok();
    let count = count.filter(|count| *count <= limits::SHOWN_NUMBERS);
    let Some(count) = count else {
        return Err(format!(
            "show takes at most {} numbers",
            limits::SHOWN_NUMBERS
        ));
    };
    let mut bytes = Vec::new();
    let size = 4 * count as u64;
    let read = input.take(size).read_to_end(&mut bytes);
    if read.map_err(|error| error.to_string())? < 4 * count {
        return Err("the numbers end before their count".to_owned());
    }
    let four = |four: &[u8]| i32::from_le_bytes([four[0], four[1], four[2], four[3]]);
    Ok(bytes.chunks_exact(4).map(four).collect())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scratch::Scratch;

    fn pixel(scratch: &Scratch, x: usize, y: usize) -> [u8; 2] {
        let bytes = std::fs::read(scratch.path().join(DISPLAY)).unwrap();
        assert_eq!(bytes.len(), 320 * 240 * 2);
        let at = 2 * (y * 320 + x);
        [bytes[at], bytes[at + 1]]
    }

    const RED: [u8; 2] = [0x00, 0xf8];
    const WHITE: [u8; 2] = [0xff, 0xff];

    #[test]
    fn what_is_drawn_is_seen_after_redraw_and_gone_after_hide() {
        let scratch = Scratch::new("display");
        scratch.file(DISPLAY, "");
        let mut display = Display::new(scratch.path());
        display.order("color red").unwrap();
        display.order("rect 10 10 20 20 1").unwrap();
        assert_eq!(std::fs::read(scratch.path().join(DISPLAY)).unwrap(), b"");
        display.order("redraw").unwrap();
        assert_eq!(
            (pixel(&scratch, 15, 15), pixel(&scratch, 5, 5)),
            (RED, WHITE)
        );
        display.order("hide").unwrap();
        assert_eq!(pixel(&scratch, 15, 15), [0, 0]);
        display.order("redraw").unwrap();
        assert_eq!(pixel(&scratch, 15, 15), RED);
    }

    #[test]
    fn a_tree_without_a_display_says_so_and_one_that_comes_later_is_found() {
        let scratch = Scratch::new("display");
        let mut display = Display::new(scratch.path());
        let told = display.order("redraw").unwrap_err();
        assert!(told.starts_with("the tree has no display ("), "{told}");
        scratch.file(DISPLAY, "");
        display.order("redraw").unwrap();
        assert_eq!(pixel(&scratch, 0, 0), WHITE);
    }

    #[test]
    fn orders_come_in_lines_with_numbers_and_files_between_them() {
        let scratch = Scratch::new("display");
        scratch.file(DISPLAY, "");
        let mut input = b"show 1 1 rgb32 1\n\x00\x00\xff\x00rect 0 0 10 10 1\nredraw\n".to_vec();
        serve(scratch.path(), &mut &input[..], false).unwrap();
        // The picture of one pixel is as high as the display.
        assert_eq!(
            (pixel(&scratch, 160, 120), pixel(&scratch, 5, 5)),
            (RED, [0, 0])
        );
        assert_eq!(pixel(&scratch, 20, 120), WHITE);
        input = b"show 2 2 rgb32 1\n\0\0\0\0nonsense\nimage /no/such/file\n\xff\xff\n".to_vec();
        input.extend([b'x'; 9000]);
        let told = serve(scratch.path(), &mut &input[..], false).unwrap_err();
        assert_eq!(told, "7 orders failed");
        for bad in [
            "show 1 1 rgb32 -1\n",
            "show 1 1\n",
            "show 1 1 rgb32 2000000000\n",
            "show 9 9 rgb32 81\nabc",
        ] {
            assert!(
                serve(scratch.path(), &mut bad.as_bytes(), false).is_err(),
                "{bad}"
            );
        }
    }

    #[test]
    fn a_file_that_is_no_picture_is_named() {
        let scratch = Scratch::new("display");
        let file = scratch.file("text.png", "hello");
        let told = Display::new(scratch.path()).show_file(&file).unwrap_err();
        assert!(
            told.contains("text.png: this is neither a PNG nor a JPEG"),
            "{told}"
        );
    }
}
