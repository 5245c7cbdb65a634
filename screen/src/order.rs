//! Orders of programs as lines of words: `line 0 0 100 50`, `label 10 20 -1 Hello`.
//!
//! Owns the grammar, which is the same for all languages of programs and for a person at a shell.
//!
//! | order | does |
//! | --- | --- |
//! | `line X1 Y1 X2 Y2`, `point X Y` | draws |
//! | `rect X Y W H FILLED`, `ellipse X Y W H FILLED` | draws; FILLED is 1 or 0 |
//! | `arc X Y W H FROM SPAN` | a part of an ellipse, in degrees counter-clockwise from the right |
//! | `label X Y HEIGHT TEXT` | a text, to the end of the line; a HEIGHT of -1 is the usual one; `\n` begins a new line |
//! | `color NAME`, `width PIXELS` | of the pen, for what comes after |
//! | `background NAME`, `removelabels` | at once |
//! | `smile`, `sadsmile` | a face, at once |
//! | `redraw` | shows what was drawn |
//! | `clear`, `hide` | the display is empty |

use crate::colour::{BLACK, Colour, WHITE, colour};
use crate::drawing::{Drawing, Outline};
use crate::fault::Fault;
use crate::limits;

/// What is to be done with the display after an order.
#[derive(Clone, Copy, Debug, Eq, PartialEq)]
pub enum Effect {
    /// Nothing: it is seen with the next `redraw`.
    Later,
    /// The drawing is shown.
    Show,
    /// The display becomes dark.
    Hide,
}

const ORDERS: &str = "line, point, rect, ellipse, arc, label, color, width, background, removelabels, smile, sadsmile, \
                      redraw, clear and hide";

/// `N` whole numbers at the beginning of the words, and what follows the space after them.
fn numbers<'a, const N: usize>(verb: &str, words: &'a str) -> Result<([i32; N], &'a str), Fault> {
    let mut rest = words;
    let mut numbers = [0; N];
    for number in &mut numbers {
        let (word, behind) = rest.split_once(' ').unwrap_or((rest, ""));
        let parsed = word.parse::<f64>().ok().filter(|parsed| parsed.is_finite());
        let Some(parsed) = parsed else {
            return Err(Fault::Number(verb.to_owned(), N, word.to_owned()));
        };
        // What is too large is cut.
        *number = parsed.trunc() as i32;
        rest = behind;
    }
    Ok((numbers, rest))
}

fn all<const N: usize>(verb: &str, words: &str) -> Result<[i32; N], Fault> {
    match numbers(verb, words)? {
        (numbers, "") => Ok(numbers),
        (_, more) => Err(Fault::MoreWords(verb.to_owned(), N, more.to_owned())),
    }
}

fn is_transparent(name: &str) -> bool {
    name.trim().eq_ignore_ascii_case("transparent")
}

impl Drawing {
    /// Does what one line says.
    ///
    /// # Errors
    /// The line makes no sense; nothing has changed then.
    pub fn order(&mut self, line: &str) -> Result<Effect, Fault> {
        if line.len() > limits::ORDER_BYTES {
            return Err(Fault::LongOrder);
        }
        let (verb, words) = line.split_once(' ').unwrap_or((line, ""));
        match verb {
            "line" => self.draw(Outline::Line(all(verb, words)?), false),
            "point" => self.draw(Outline::Point(all(verb, words)?), false),
            "rect" | "ellipse" => {
                let [x, y, width, height, filled] = all(verb, words)?;
                let place = [x, y, width, height];
                let outline = match verb {
                    "rect" => Outline::Rectangle(place),
                    _ => Outline::Ellipse(place),
                };
                self.draw(outline, filled != 0);
            }
            "arc" => {
                let [x, y, width, height, from, span] = all(verb, words)?;
                self.draw(Outline::Arc([x, y, width, height], from, span), false);
            }
            "label" => {
                let ([x, y, height], text) = numbers(verb, words)?;
                let height = u16::try_from(height).ok().filter(|height| *height > 0);
                self.add_label(&text.replace("\\n", "\n"), x, y, height)?;
            }
            // A drawing lies on its background alone, so that is what is seen through it.
            "color" if is_transparent(words) => self.set_pen(self.background()),
            "color" => self.set_pen(Colour::named(words)?),
            "width" => {
                let [width] = all(verb, words)?;
                self.set_pen_width(width);
            }
            "background" => {
                let colour = if is_transparent(words) {
                    WHITE
                } else {
                    Colour::named(words)?
                };
                self.set_background(colour);
                return Ok(Effect::Show);
            }
            "removelabels" => {
                self.remove_labels();
                return Ok(Effect::Show);
            }
            "smile" | "sadsmile" => {
                self.smile(verb == "smile");
                return Ok(Effect::Show);
            }
            "redraw" => return Ok(Effect::Show),
            "clear" => {
                self.clear();
                return Ok(Effect::Hide);
            }
            "hide" => return Ok(Effect::Hide),
            _ => {
                return Err(Fault::Order(verb.to_owned(), ORDERS));
            }
        }
        Ok(Effect::Later)
    }

    /// A round face instead of everything else, happy or not.
    fn smile(&mut self, is_happy: bool) {
        let (width, height) = self.size();
        let (width, height) = (i32::from(width), i32::from(height));
        let side = width.min(height) - 20;
        let (left, top) = ((width - side) / 2, (height - side) / 2);
        let part = |share: i32| side * share / 100;
        self.clear();
        self.set_pen(colour(255, 210, 40));
        self.draw(Outline::Ellipse([left, top, side, side]), true);
        self.set_pen(BLACK);
        self.set_pen_width(part(3));
        self.draw(Outline::Ellipse([left, top, side, side]), false);
        for x in [28, 60] {
            let eye = [left + part(x), top + part(30), part(12), part(16)];
            self.draw(Outline::Ellipse(eye), true);
        }
        let mouth = |from: i32| [left + part(25), top + part(from), part(50), part(40)];
        self.draw(
            if is_happy {
                Outline::Arc(mouth(42), 200, 140)
            } else {
                Outline::Arc(mouth(62), 20, 140)
            },
            false,
        );
        // The next program's pen is not that of the face.
        self.set_pen_width(1);
    }
}
