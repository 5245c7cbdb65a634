//! The display of the robot, as one program has it: what it draws goes into the tree as whole pictures.
//!
//! Owns the file of the tree and when it is written. What orders mean and how things look is in the crate `screen`.

mod words;

use crate::blame::{Blame, Os};
use crate::limits;
use crate::pictures::{self, NoPicture};
use lang_text::problem::Words;
use screen::Fault;
use screen::order::Effect;
use screen::picture::{self, RawFormat};
use screen::{Drawing, Pixels};
use std::fmt;
use std::fs::{File, OpenOptions};
use std::io::{self, BufRead, Read, Seek, Write};
use std::path::{Path, PathBuf};

/// Where the tree takes pictures: 320 x 240 pixels, RGB565, the low byte first.
pub const DISPLAY: &str = "display/device";

/// Why something is not shown, or an order is not done.
#[derive(Clone, Debug, Eq, PartialEq)]
pub enum Unshown {
    /// An order or a picture makes no sense.
    Fault(Fault),
    /// A file that is to be shown cannot be read.
    File(PathBuf, Os),
    /// It has more bytes than [`screen::limits::FILE_BYTES`].
    LongFile(PathBuf),
    /// It is no picture.
    NotPicture(PathBuf, Fault),
    /// The tree has no display at this path.
    NoDisplay(PathBuf),
    /// The tree does not take a picture: its file, and what it says of the fault, if anything.
    Tree(PathBuf, Os, String),
    /// Orders in a simulator, in its own words.
    Simulated(String),
    /// A photo.
    NoPhoto(NoPicture),
    /// An order in no UTF-8.
    NoText,
    /// A word where an order has a whole number: the order, the word.
    NotWhole(String, String),
    /// `show` with other words.
    ShowWords,
    /// `photo` with other words.
    PhotoWords,
    /// A width or height that no photo has.
    PhotoSide(String),
    /// More numbers than [`limits::SHOWN_NUMBERS`], or fewer than none.
    ManyNumbers,
    /// The input ends within numbers.
    FewNumbers,
    /// Numbers cannot be read.
    Numbers(Os),
    /// Orders cannot be read.
    Orders(Os),
    /// Answers cannot be written.
    Answers(Os),
    /// So many orders have failed, and each was told.
    Failed(u32),
}

impl Unshown {
    /// For a person.
    pub fn words(&self) -> Words {
        Words::new(self.to_string(), words::russian(self))
    }

    /// Who can change something about it.
    pub fn blame(&self) -> Blame {
        match self {
            Self::Fault(_)
            | Self::File(..)
            | Self::LongFile(_)
            | Self::NotPicture(..)
            | Self::Simulated(_)
            | Self::NoText
            | Self::NotWhole(..)
            | Self::ShowWords
            | Self::PhotoWords
            | Self::PhotoSide(_)
            | Self::ManyNumbers
            | Self::FewNumbers
            | Self::Failed(_) => Blame::Client,
            Self::NoDisplay(_) | Self::Tree(..) => Blame::Tree,
            Self::NoPhoto(why) => why.blame(),
            Self::Numbers(_) | Self::Orders(_) | Self::Answers(_) => Blame::System,
        }
    }
}

impl fmt::Display for Unshown {
    fn fmt(&self, out: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Fault(why) => write!(out, "{why}"),
            Self::File(path, os) => write!(out, "{}: {os}", path.display()),
            Self::LongFile(path) => {
                let most = screen::limits::FILE_BYTES >> 20;
                write!(out, "{}: is larger than {most} MiB", path.display())
            }
            Self::NotPicture(path, why) => write!(out, "{}: {why}", path.display()),
            Self::NoDisplay(path) => {
                let path = path.display();
                write!(out, "the tree has no display ({path}); nothing is shown")
            }
            Self::Tree(path, os, fault) => {
                write!(out, "{}: {os}", path.display())?;
                if !fault.is_empty() {
                    write!(out, " ({fault})")?;
                }
                out.write_str("; nothing is shown")
            }
            Self::Simulated(why) => out.write_str(why),
            Self::NoPhoto(why) => write!(out, "{why}"),
            Self::NoText => out.write_str("the order is no UTF-8"),
            Self::NotWhole(verb, word) => {
                write!(out, "{verb} takes whole numbers, not '{word}'")
            }
            Self::ShowWords => {
                out.write_str("show takes width, height, format and the count of numbers")
            }
            Self::PhotoWords => out.write_str("photo takes width and height"),
            Self::PhotoSide(word) => write!(out, "{word} is no width or height of a photo"),
            Self::ManyNumbers => {
                write!(out, "show takes at most {} numbers", limits::SHOWN_NUMBERS)
            }
            Self::FewNumbers => out.write_str("the numbers end before their count"),
            Self::Numbers(os) => write!(out, "{os}"),
            Self::Orders(os) => write!(out, "orders cannot be read: {os}"),
            Self::Answers(os) => write!(out, "answers cannot be written: {os}"),
            Self::Failed(count) => write!(out, "{count} orders failed"),
        }
    }
}

impl std::error::Error for Unshown {}

impl From<Fault> for Unshown {
    fn from(why: Fault) -> Self {
        Self::Fault(why)
    }
}

/// A drawing and the display that it is shown on.
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
    pub fn order(&mut self, line: &str) -> Result<(), Unshown> {
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
    pub fn show_file(&mut self, file: &Path) -> Result<(), Unshown> {
        let told = |error: io::Error| Unshown::File(file.to_owned(), error.into());
        let mut bytes = Vec::new();
        let limit = screen::limits::FILE_BYTES as u64;
        let opened = File::open(file).map_err(told)?;
        let read = opened.take(limit + 1).read_to_end(&mut bytes);
        read.map_err(told)?;
        if bytes.len() as u64 > limit {
            return Err(Unshown::LongFile(file.to_owned()));
        }
        let picture = picture::decode(&bytes);
        let picture = picture.map_err(|why| Unshown::NotPicture(file.to_owned(), why))?;
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
    ) -> Result<(), Unshown> {
        let format = RawFormat::named(format)?;
        let picture = picture::raw(numbers, width, height, format)?;
        self.show(&picture)
    }

    fn show(&mut self, picture: &Pixels) -> Result<(), Unshown> {
        self.drawing.show(picture);
        self.put(&self.drawing.paint())
    }

    /// Writes one picture. The file stays open, and is opened anew after a failure: the tree may have been mounted again.
    fn put(&mut self, pixels: &Pixels) -> Result<(), Unshown> {
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
            let path = self.path.clone();
            match (error.kind(), fault) {
                (io::ErrorKind::NotFound, "") => Unshown::NoDisplay(path),
                _ => Unshown::Tree(path, error.into(), fault.to_owned()),
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
/// Beside those of [`screen::order`] there are `image PATH` and `show WIDTH HEIGHT FORMAT COUNT`, after whose line
/// stand COUNT numbers of four bytes, the lowest first. `photo WIDTH HEIGHT` is a question to the camera. With `answers`
/// each order is answered by a line `ok COUNT` and COUNT bytes (those of a photo, three for each point, else none), or
/// `error: TEXT`; otherwise failures alone are told, on standard error.
///
/// # Errors
/// The input or output fails, or an order has failed and nobody wants answers.
pub fn serve(root: &Path, input: &mut impl BufRead, answers: bool) -> Result<(), Unshown> {
    let mut display = Display::new(root);
    let mut failures = 0;
    let mut output = io::stdout();
    loop {
        let mut line = Vec::new();
        let limit = screen::limits::ORDER_BYTES as u64 + 2;
        let told = |error: io::Error| Unshown::Orders(error.into());
        input
            .take(limit)
            .read_until(b'\n', &mut line)
            .map_err(told)?;
        if line.is_empty() {
            break;
        }
        let done = match std::str::from_utf8(&line) {
            Ok(text) => perform(&mut display, root, text.trim_end_matches('\n'), input),
            Err(_) => Err(Unshown::NoText),
        };
        failures += u32::from(done.is_err());
        if answers {
            let answer = match done {
                Ok(bytes) => [format!("ok {}\n", bytes.len()).into_bytes(), bytes].concat(),
                Err(reason) => format!("error: {reason}\n").into_bytes(),
            };
            let said = output.write_all(&answer).and_then(|()| output.flush());
            said.map_err(|error| Unshown::Answers(error.into()))?;
        } else if let Err(reason) = done {
            crate::log::report(reason);
        }
    }
    if failures > 0 && !answers {
        return Err(Unshown::Failed(failures));
    }
    Ok(())
}

/// Does one order; the bytes are the answer.
fn perform(
    display: &mut Display,
    root: &Path,
    line: &str,
    input: &mut impl Read,
) -> Result<Vec<u8>, Unshown> {
    let (verb, rest) = line.split_once(' ').unwrap_or((line, ""));
    let words: Vec<&str> = rest.split(' ').collect();
    let whole = |word: &str| {
        let number = word.parse::<i32>();
        number.map_err(|_| Unshown::NotWhole(verb.to_owned(), word.to_owned()))
    };
    match (verb, &words[..]) {
        ("image", _) => display.show_file(Path::new(rest))?,
        ("show", [width, height, format, count]) => {
            let (width, height, count) = (whole(width)?, whole(height)?, whole(count)?);
            let numbers = numbers(input, count)?;
            display.show_numbers(&numbers, width, height, format)?;
        }
        ("show", _) => return Err(Unshown::ShowWords),
        ("photo", [width, height]) => {
            let side = |word: &str| {
                let side = u16::try_from(whole(word)?).ok();
                let side = side.filter(|side| (1..=screen::limits::SIDE_MAX).contains(side));
                side.ok_or_else(|| Unshown::PhotoSide(word.to_owned()))
            };
            let (width, height) = (side(width)?, side(height)?);
            let photo = pictures::photo(root).map_err(Unshown::NoPhoto)?;
            return Ok(photo.scaled(width, height).to_rgb());
        }
        ("photo", _) => return Err(Unshown::PhotoWords),
        _ => display.order(line)?,
    }
    Ok(Vec::new())
}

/// So many numbers of four bytes.
fn numbers(input: &mut impl Read, count: i32) -> Result<Vec<i32>, Unshown> {
    let count = usize::try_from(count).ok();
    let count = count.filter(|count| *count <= limits::SHOWN_NUMBERS);
    let Some(count) = count else {
        return Err(Unshown::ManyNumbers);
    };
    let mut bytes = Vec::new();
    let size = 4 * count as u64;
    let read = input.take(size).read_to_end(&mut bytes);
    if read.map_err(|error| Unshown::Numbers(error.into()))? < 4 * count {
        return Err(Unshown::FewNumbers);
    }
    let four = |four: &[u8]| i32::from_le_bytes([four[0], four[1], four[2], four[3]]);
    Ok(bytes.chunks_exact(4).map(four).collect())
}

#[cfg(test)]
mod tests {
    use super::*;
    use harness::put;
    use tempfile::{TempDir, tempdir};

    fn pixel(scratch: &TempDir, x: usize, y: usize) -> [u8; 2] {
        let bytes = std::fs::read(scratch.path().join(DISPLAY)).unwrap();
        assert_eq!(bytes.len(), 320 * 240 * 2);
        let at = 2 * (y * 320 + x);
        [bytes[at], bytes[at + 1]]
    }

    const RED: [u8; 2] = [0x00, 0xf8];
    const WHITE: [u8; 2] = [0xff, 0xff];

    #[test]
    fn what_is_drawn_is_seen_after_redraw_and_gone_after_hide() {
        let scratch = tempdir().unwrap();
        put(scratch.path(), DISPLAY, "");
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
        let scratch = tempdir().unwrap();
        let mut display = Display::new(scratch.path());
        let told = display.order("redraw").unwrap_err().to_string();
        assert!(told.starts_with("the tree has no display ("), "{told}");
        put(scratch.path(), DISPLAY, "");
        display.order("redraw").unwrap();
        assert_eq!(pixel(&scratch, 0, 0), WHITE);
    }

    #[test]
    fn orders_come_in_lines_with_numbers_and_files_between_them() {
        let scratch = tempdir().unwrap();
        put(scratch.path(), DISPLAY, "");
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
        assert_eq!(told.to_string(), "7 orders failed");
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
        let scratch = tempdir().unwrap();
        let file = put(scratch.path(), "text.png", "hello");
        let told = Display::new(scratch.path()).show_file(&file).unwrap_err();
        assert_eq!(told.blame(), Blame::Client);
        let told = told.to_string();
        assert!(
            told.contains("text.png: this is neither a PNG nor a JPEG"),
            "{told}"
        );
    }
}
