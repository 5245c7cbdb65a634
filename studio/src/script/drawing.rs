//! Orders for the display, as commands of the simulated robot.
//!
//! Pure: one line in, at most one command out. What orders there are is in `screen::order`.

use lang_diagram::brick::{Command, Figure};
use std::fmt;

/// Why nothing is shown: the program draws something else.
#[derive(Clone, Debug, Eq, PartialEq)]
pub enum Undrawn {
    /// A word where a number has to be.
    NoNumber(String),
    /// Labels alone cannot be taken away.
    LabelsStay,
    /// An order that there is not.
    Unknown(String),
}

impl fmt::Display for Undrawn {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::NoNumber(word) => write!(f, "{word:?} is no number"),
            Self::LabelsStay => {
                f.write_str("the simulated display forgets labels only with clear()")
            }
            Self::Unknown(verb) => write!(f, "nobody knows the order {verb:?}"),
        }
    }
}

impl std::error::Error for Undrawn {}

/// Height of letters that nobody has chosen.
const LETTERS: i32 = 20;

fn numbers<const N: usize>(words: &[&str]) -> Result<[i32; N], Undrawn> {
    let mut found = [0; N];
    for (index, number) in found.iter_mut().enumerate() {
        let word = words.get(index).copied().unwrap_or("");
        let parsed = word.parse::<f64>().ok().filter(|number| number.is_finite());
        let parsed = parsed.ok_or_else(|| Undrawn::NoNumber(word.to_owned()))?;
        *number = parsed as i32;
    }
    Ok(found)
}

/// Does with the command what `tell` does; a line without one is left out.
///
/// # Errors
/// The line makes no sense.
pub fn order(line: &str, mut tell: impl FnMut(Command<'_>)) -> Result<(), Undrawn> {
    let (verb, rest) = line.split_once(' ').unwrap_or((line, ""));
    let words: Vec<&str> = rest.split_ascii_whitespace().collect();
    let is_filled = |at: usize| words.get(at).is_some_and(|word| *word == "1");
    if verb == "label" {
        let mut parts = rest.splitn(4, ' ');
        let mut part = || parts.next().unwrap_or("");
        let [x, y, size] = numbers(&[part(), part(), part()])?;
        let text = &part().replace("\\n", "\n");
        let size = if size > 0 { size } else { LETTERS };
        tell(Command::Label { x, y, size, text });
        return Ok(());
    }
    tell(match verb {
        "point" => Command::Draw(Figure::Pixel(numbers(&words)?)),
        "line" => Command::Draw(Figure::Line(numbers(&words)?)),
        "rect" => Command::Draw(Figure::Rectangle(numbers(&words)?, is_filled(4))),
        "ellipse" => Command::Draw(Figure::Ellipse(numbers(&words)?, is_filled(4))),
        "arc" => Command::Draw(Figure::Arc(numbers(&words)?)),
        "color" => Command::PenColor { color: rest },
        "width" => {
            let [width] = numbers(&words)?;
            Command::PenWidth { width }
        }
        "background" => Command::Background { color: rest },
        // What the controller's own faces are called: its Python has no other words for them.
        "image" if rest.ends_with("trik_smile_normal.png") => Command::Smile { sad: false },
        "image" if rest.ends_with("trik_smile_sad.png") => Command::Smile { sad: true },
        "smile" => Command::Smile { sad: false },
        "sadsmile" => Command::Smile { sad: true },
        "clear" => Command::ClearScreen,
        "redraw" => Command::Redraw,
        "hide" => return Ok(()),
        "removelabels" => return Err(Undrawn::LabelsStay),
        _ => return Err(Undrawn::Unknown(verb.to_owned())),
    });
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn orders_become_the_commands_of_blocks() {
        for (line, command) in [
            ("label 1 2 -1 two  words", "label 1 2 20 \"two  words\""),
            ("label 1 2 30 a\\nb", "label 1 2 30 \"a\\nb\""),
            ("rect 1 2 3 4 1", "rectangle 1 2 3 4 filled"),
            ("ellipse 1 2.9 3 4 0", "ellipse 1 2 3 4"),
            ("color red", "pen red"),
            ("sadsmile", "smile sad"),
            ("image media/trik_smile_normal.png", "smile"),
            ("image /x/media/trik_smile_sad.png", "smile sad"),
            ("redraw", "redraw"),
        ] {
            let mut told = Vec::new();
            order(line, |command| told.push(command.to_string())).unwrap();
            assert_eq!(told, [command], "{line}");
        }
        for bad in ["", "jump", "line 1 2 3", "width NaN", "label 1"] {
            assert!(order(bad, |_| ()).is_err(), "{bad}");
        }
    }
}
