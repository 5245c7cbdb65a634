//! The virtual display: everything that a program has drawn, in order, and the picture that it makes.
//!
//! Owns the list as the original's checker and its records have it: an ellipse by its centre and half axes, an arc by the
//! rectangle around it, a text replaced by the next one at its place. Knows no robot; pixels are those of crate `screen`.

// A command or figure that is forgotten must not compile.
#![deny(clippy::wildcard_enum_match_arm)]

use lang_diagram::brick::{Command, Figure};
use screen::colour::{BLACK, Colour, WHITE, colour};
use screen::drawing::{Drawing, Outline};

use crate::limits;

/// Width of the picture in pixels.
pub const WIDTH: u16 = 240;
/// Its height.
pub const HEIGHT: u16 = 280;
/// What the original calls gray.
pub const GRAY: Colour = colour(0xa0, 0xa0, 0xa4);

/// What a thing on the display is. Coordinates and lengths are pixels, angles degrees.
#[derive(Clone, Debug, Eq, PartialEq)]
pub enum Form {
    /// x and y.
    Point([i32; 2]),
    /// x and y of both ends.
    Line([i32; 4]),
    /// Corner, width, height, and whether it is filled.
    Rectangle([i32; 4], bool),
    /// Centre, half axes, and whether it is filled.
    Ellipse([i32; 4], bool),
    /// Corner, width and height of the rectangle around the ellipse, start and span.
    Arc([i32; 6]),
    /// Upper left corner, text, and height of its letters.
    Text([i32; 2], String, i32),
}

/// One thing on the display.
#[derive(Clone, Debug, Eq, PartialEq)]
pub struct Object {
    /// What it is.
    pub form: Form,
    /// Colour of the pen it was drawn with.
    pub colour: Colour,
    /// Width of that pen.
    pub thickness: i32,
}

/// What a command has changed on the display.
#[derive(Clone, Copy, Debug, Default, Eq, PartialEq)]
pub struct Change {
    /// The colour behind everything.
    pub background: bool,
    /// Whether there is a face.
    pub smiles: bool,
    /// The list of objects.
    pub objects: bool,
}

/// A display.
#[derive(Clone, Debug, Eq, PartialEq)]
pub struct Screen {
    background: Colour,
    objects: Vec<Object>,
    /// A happy face, or a sad one.
    face: Option<bool>,
    pen: Colour,
    pen_width: i32,
}

impl Default for Screen {
    /// As a program finds it.
    fn default() -> Self {
        Self {
            background: GRAY,
            objects: Vec::new(),
            face: None,
            pen: BLACK,
            pen_width: 1,
        }
    }
}

/// A colour by its name in a program; what is none is black, as in the original.
pub fn named(name: &str) -> Colour {
    match name.trim() {
        "gray" | "grey" => colour(0x80, 0x80, 0x80),
        name => Colour::named(name).unwrap_or(BLACK),
    }
}

/// `#rrggbb`.
pub fn hex(colour: Colour) -> String {
    format!("#{:06x}", colour.number())
}

impl Screen {
    /// Does what a command says, if it is one for the display.
    pub fn command(&mut self, command: &Command<'_>) -> Change {
        let mut change = Change::default();
        match *command {
            Command::PenColor { color } => self.pen = named(color),
            Command::PenWidth { width } => self.pen_width = width,
            Command::Background { color } => {
                self.background = named(color);
                change.background = true;
            }
            Command::Smile { sad } => {
                self.face = Some(!sad);
                change.smiles = true;
            }
            Command::ClearScreen => {
                *self = Self {
                    background: self.background,
                    ..Self::default()
                };
                change.smiles = true;
                change.objects = true;
            }
            Command::Label { x, y, size, text } => {
                self.label([x, y], size, text);
                change.objects = true;
            }
            Command::Draw(figure) => {
                self.push(match figure {
                    Figure::Pixel(at) => Form::Point(at),
                    Figure::Line(ends) => Form::Line(ends),
                    Figure::Rectangle(sides, filled) => Form::Rectangle(sides, filled),
                    Figure::Ellipse(sides, filled) => Form::Ellipse(sides, filled),
                    Figure::Arc(numbers) => Form::Arc(numbers),
                });
                change.objects = true;
            }
            Command::Power { .. }
            | Command::Off { .. }
            | Command::Servo { .. }
            | Command::ResetEncoder { .. }
            | Command::Sound { .. }
            | Command::Tone { .. }
            | Command::Say { .. }
            | Command::Led { .. }
            | Command::System { .. }
            | Command::Append { .. }
            | Command::Remove { .. }
            | Command::StartCamera { .. }
            | Command::StopCamera { .. }
            | Command::StartVideo { .. }
            | Command::StopVideo
            | Command::Detect { .. }
            | Command::Send { .. }
            | Command::Join { .. }
            | Command::CalibrateGyroscope
            | Command::Console { .. }
            | Command::Redraw
            | Command::MarkerDown { .. }
            | Command::MarkerUp
            | Command::Rest => {}
        }
        change
    }

    fn label(&mut self, at: [i32; 2], size: i32, text: &str) {
        let text: String = text.chars().take(limits::SCREEN_TEXT).collect();
        let old = self
            .objects
            .iter_mut()
            .find_map(|object| match &mut object.form {
                Form::Text(place, text, size) => (*place == at).then_some((text, size)),
                Form::Point(_)
                | Form::Line(_)
                | Form::Rectangle(..)
                | Form::Ellipse(..)
                | Form::Arc(_) => None,
            });
        match old {
            Some((old, old_size)) => {
                *old = text;
                *old_size = size;
            }
            None => self.push(Form::Text(at, text, size)),
        }
    }

    fn push(&mut self, form: Form) {
        // Who draws for ever without clearing loses the newest.
        if self.objects.len() < limits::SCREEN_OBJECTS {
            self.objects.push(Object {
                form,
                colour: self.pen,
                thickness: self.pen_width,
            });
        }
    }

    /// The colour behind everything.
    pub fn background(&self) -> Colour {
        self.background
    }

    /// Whether there is a happy face.
    pub fn smiles(&self) -> bool {
        self.face == Some(true)
    }

    /// Whether there is a sad face.
    pub fn sad_smiles(&self) -> bool {
        self.face == Some(false)
    }

    /// Another colour behind everything.
    pub fn set_background(&mut self, colour: Colour) {
        self.background = colour;
    }

    /// Everything, to be changed.
    pub fn objects_mut(&mut self) -> &mut [Object] {
        &mut self.objects
    }

    /// Everything, in the order in which it was drawn.
    pub fn objects(&self) -> &[Object] {
        &self.objects
    }

    /// What is seen, [`WIDTH`] x [`HEIGHT`].
    pub fn paint(&self) -> screen::Pixels {
        let mut drawing = Drawing::new(WIDTH, HEIGHT);
        if let Some(is_happy) = self.face {
            let face = if is_happy { "smile" } else { "sadsmile" };
            // A word of ours, which is always understood.
            let _ = drawing.order(face);
        }
        drawing.set_background(self.background);
        for object in &self.objects {
            drawing.set_pen(object.colour);
            drawing.set_pen_width(object.thickness);
            match &object.form {
                Form::Point(at) => drawing.draw(Outline::Point(*at), false),
                Form::Line(ends) => drawing.draw(Outline::Line(*ends), false),
                Form::Rectangle(sides, filled) => drawing.draw(Outline::Rectangle(*sides), *filled),
                Form::Ellipse([x, y, a, b], filled) => {
                    let corner = [x.saturating_sub(*a), y.saturating_sub(*b)];
                    let size = [a.saturating_mul(2), b.saturating_mul(2)];
                    let around = [corner[0], corner[1], size[0], size[1]];
                    drawing.draw(Outline::Ellipse(around), *filled);
                }
                Form::Arc([x, y, width, height, start, span]) => {
                    drawing.draw(
                        Outline::Arc([*x, *y, *width, *height], *start, *span),
                        false,
                    );
                }
                Form::Text([x, y], text, size) => {
                    let height = u16::try_from((*size).clamp(1, 240)).unwrap_or(20);
                    // Too many labels: the rest is not seen, but it is in the list.
                    let _ = drawing.add_label(text, *x, *y, Some(height));
                }
            }
        }
        drawing.paint()
    }

    /// The same as a PNG file.
    pub fn png(&self) -> Vec<u8> {
        self.paint().to_png()
    }
}

/// What a robot shows and says beside its display.
#[derive(Clone, Debug, Eq, PartialEq)]
pub struct Shown {
    /// The display.
    pub screen: Screen,
    /// What it said last, if it said anything.
    pub last_phrase: Option<String>,
    /// The first [`limits::PRINTED_LINES`] texts that it printed.
    pub printed: Vec<String>,
    /// Colour of its light.
    pub led: Colour,
    /// How much of what is behind that colour is hidden, which only a rule changes; 255 is all.
    pub led_alpha: u8,
    /// Milliseconds for which it still sounds.
    pub beep_ms: u32,
}

impl Default for Shown {
    fn default() -> Self {
        Self {
            screen: Screen::default(),
            last_phrase: None,
            printed: Vec::new(),
            led: WHITE,
            led_alpha: u8::MAX,
            beep_ms: 0,
        }
    }
}

/// What is kept of a text.
fn cut(text: &str) -> String {
    text.chars().take(limits::SCREEN_TEXT).collect()
}

/// How long a sound file is, whatever is in it.
const SOUND_MS: u32 = 1000;

impl Shown {
    /// Does what a command says, if it is one for display, light, loudspeaker or speech.
    pub fn command(&mut self, command: &Command<'_>) {
        match *command {
            Command::Say { text } => self.last_phrase = text.map(cut),
            Command::Console { text } => {
                if self.printed.len() < limits::PRINTED_LINES {
                    self.printed.push(cut(text));
                }
            }
            Command::Led { color } => {
                self.led = match color {
                    "off" => GRAY,
                    color => named(color),
                };
                self.led_alpha = u8::MAX;
            }
            Command::Tone { ms, .. } => self.beep_ms = u32::try_from(ms).unwrap_or(0),
            Command::Sound { .. } => self.beep_ms = SOUND_MS,
            Command::Rest => self.beep_ms = 0,
            Command::PenColor { .. }
            | Command::PenWidth { .. }
            | Command::Background { .. }
            | Command::Draw(_)
            | Command::Label { .. }
            | Command::Smile { .. }
            | Command::ClearScreen => {
                self.screen.command(command);
            }
            Command::Power { .. }
            | Command::Off { .. }
            | Command::Servo { .. }
            | Command::ResetEncoder { .. }
            | Command::System { .. }
            | Command::Append { .. }
            | Command::Remove { .. }
            | Command::StartCamera { .. }
            | Command::StopCamera { .. }
            | Command::StartVideo { .. }
            | Command::StopVideo
            | Command::Detect { .. }
            | Command::Send { .. }
            | Command::Join { .. }
            | Command::CalibrateGyroscope
            | Command::Redraw
            | Command::MarkerDown { .. }
            | Command::MarkerUp => {}
        }
    }

    /// One tick of some milliseconds.
    pub fn tick(&mut self, ms: u32) {
        self.beep_ms = self.beep_ms.saturating_sub(ms);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_is_drawn_is_listed_in_order() {
        let mut screen = Screen::default();
        assert_eq!(hex(screen.background()), "#a0a0a4");
        screen.command(&Command::PenColor { color: "yellow" });
        screen.command(&Command::PenWidth { width: 10 });
        let change = screen.command(&Command::Draw(Figure::Ellipse([60, 100, 20, 20], false)));
        assert!(change.objects && !change.smiles && !change.background);
        let label = |text| Command::Label {
            x: 1,
            y: 2,
            size: 20,
            text,
        };
        screen.command(&label("one"));
        screen.command(&label("two"));
        let objects = screen.objects();
        assert_eq!(objects.len(), 2);
        assert_eq!(objects[0].form, Form::Ellipse([60, 100, 20, 20], false));
        assert_eq!(
            (hex(objects[0].colour), objects[0].thickness),
            ("#ffff00".to_owned(), 10)
        );
        assert_eq!(objects[1].form, Form::Text([1, 2], "two".to_owned(), 20));
        screen.command(&Command::Smile { sad: true });
        assert!(screen.sad_smiles() && !screen.smiles());
        screen.command(&Command::Background { color: "red" });
        screen.command(&Command::ClearScreen);
        assert!(screen.objects().is_empty() && !screen.sad_smiles());
        assert_eq!(hex(screen.background()), "#ff0000");
    }

    #[test]
    fn the_picture_shows_it() {
        let mut screen = Screen::default();
        screen.command(&Command::Background { color: "white" });
        screen.command(&Command::Draw(Figure::Ellipse([100, 100, 30, 20], true)));
        let pixels = screen.paint();
        assert_eq!((pixels.width(), pixels.height()), (WIDTH, HEIGHT));
        assert_eq!(pixels.at(100, 100), Some(BLACK));
        assert_eq!(pixels.at(75, 100), Some(BLACK));
        assert_eq!(pixels.at(100, 125), Some(WHITE));
        let again = screen::picture::decode(&screen.png()).unwrap();
        assert_eq!(again, pixels);
        let huge = Figure::Ellipse([i32::MIN, i32::MAX, i32::MAX, i32::MIN], true);
        screen.command(&Command::Draw(huge));
        screen.paint();
    }

    #[test]
    fn sounds_end() {
        let mut shown = Shown::default();
        shown.command(&Command::Tone { hertz: 440, ms: 25 });
        shown.tick(10);
        assert_eq!(shown.beep_ms, 15);
        shown.tick(20);
        assert_eq!(shown.beep_ms, 0);
        shown.command(&Command::Say { text: Some("hi") });
        shown.command(&Command::Led { color: "green" });
        assert_eq!(
            (shown.last_phrase.as_deref(), hex(shown.led)),
            (Some("hi"), "#008000".to_owned())
        );
    }
}
