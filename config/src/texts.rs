//! The texts of a configuration (its file and what it included) and the places in them that messages name.
//!
//! Owns the translation between Lua's chunk names and the names that users gave. Opens nothing.

use crate::limits::CHUNK_NAME_BYTES_MAX;
use crate::lines::{Lines, line_of};
use crate::place::Place;
use crate::problem::Problem;

/// One file of a configuration.
#[derive(Debug)]
struct Text {
    /// As Lua's messages name it.
    chunk: String,
    /// As the user named it.
    name: String,
    source: Vec<u8>,
    lines: Lines,
}

/// All files of a configuration; the first is the configuration itself.
#[derive(Debug, Default)]
pub(crate) struct Texts(Vec<Text>);

impl Texts {
    /// Adds a file and gives its chunk name for Lua, with the leading `@`.
    pub(crate) fn add(&mut self, name: &str, source: &[u8]) -> String {
        let clean: String = name
            .chars()
            .map(|c| if c.is_control() { '?' } else { c })
            .collect();
        let mut chunk = clean.clone();
        if chunk.len() > CHUNK_NAME_BYTES_MAX {
            // The end of a path says more than its beginning.
            let from = chunk.len() - CHUNK_NAME_BYTES_MAX + 3;
            let from = (from..chunk.len())
                .find(|i| chunk.is_char_boundary(*i))
                .unwrap_or(0);
            chunk = format!("...{}", &chunk[from..]);
        }
        let at = format!("@{chunk}");
        self.0.push(Text {
            chunk,
            name: clean,
            source: source.to_vec(),
            lines: Lines::read(source),
        });
        at
    }

    /// The name of the configuration itself.
    pub(crate) fn main(&self) -> &str {
        self.0.first().map_or("", |text| text.name.as_str())
    }

    /// Place of a key, given the keys that lead to it; of the nearest enclosing one that stands in a text, or line 1.
    pub(crate) fn place(&self, path: &[&str]) -> Place {
        for length in (1..=path.len()).rev() {
            let part = path.get(..length).unwrap_or_default();
            let mut best: Option<(usize, Place)> = None;
            for text in &self.0 {
                let Some((line, fits)) = text.lines.find(part) else {
                    continue;
                };
                // One name alone may stand anywhere, unless the path has no more.
                let enough = fits >= length.min(2);
                if enough && best.as_ref().is_none_or(|(most, _)| fits > *most) {
                    let file = text.name.clone();
                    best = Some((fits, Place { file, line }));
                }
            }
            if let Some((_, place)) = best {
                return place;
            }
        }
        Place {
            file: self.main().to_owned(),
            line: 1,
        }
    }

    /// The place of a function that Lua knows by chunk name and line; None if it is not of these texts.
    pub(crate) fn of_chunk(&self, place: &Place) -> Option<Place> {
        let text = self.0.iter().find(|text| text.chunk == place.file)?;
        Some(Place {
            file: text.name.clone(),
            line: place.line,
        })
    }

    /// The place of the first line of a piece of text that stands in a file as it is.
    pub(crate) fn of_text(&self, piece: &[u8]) -> Option<Place> {
        self.0.iter().find_map(|text| {
            let line = line_of(&text.source, piece)?;
            Some(Place {
                file: text.name.clone(),
                line,
            })
        })
    }

    /// The warning that a global was read which nobody has defined, at the first place where its name stands.
    pub(crate) fn undefined(&self, name: &str) -> Problem {
        let place = self.of_text(name.as_bytes()).unwrap_or_default();
        let file = if place.file.is_empty() {
            self.main().to_owned()
        } else {
            place.file
        };
        Problem::new(
            file,
            place.line,
            format!("there is no global '{name}', so it is nil here"),
        )
    }

    /// Turns a message of Lua, `CHUNK:LINE: REASON`, into a problem. A reason that begins with a place of its own comes
    /// from an included file, and that place is the one to mend. Without a place it is a problem of the whole file.
    pub(crate) fn problem(&self, message: &str) -> Problem {
        let (mut place, mut reason) = ((self.main(), 1), message);
        let mut outer: Option<(&str, u32)> = None;
        while let Some((inner, rest)) = self.place_in(reason) {
            if rest.is_empty() {
                break;
            }
            outer = outer.or((reason != message).then_some(place));
            (place, reason) = (inner, rest);
        }
        match outer {
            Some((file, line)) => Problem::new(
                place.0,
                place.1,
                format!("{reason} (included at {file}:{line})"),
            ),
            None => Problem::new(place.0, place.1, reason),
        }
    }

    /// Splits a place of these texts off a message.
    fn place_in<'m>(&self, message: &'m str) -> Option<((&str, u32), &'m str)> {
        self.0.iter().find_map(|text| {
            let rest = message
                .strip_prefix(text.chunk.as_str())?
                .strip_prefix(':')?;
            let (line, reason) = rest.split_once(": ")?;
            Some(((text.name.as_str(), line.parse().ok()?), reason))
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_message_of_lua_finds_its_file() {
        let mut texts = Texts::default();
        assert_eq!(texts.add("robot.lua", b""), "@robot.lua");
        texts.add("board.lua", b"");
        assert_eq!(
            texts.problem("board.lua:7: no port"),
            Problem::new("board.lua", 7, "no port")
        );
        assert_eq!(
            texts.problem("robot.lua:2: board.lua:7: no port"),
            Problem::new("board.lua", 7, "no port (included at robot.lua:2)")
        );
        assert_eq!(
            texts.problem("not enough memory"),
            Problem::new("robot.lua", 1, "not enough memory")
        );
        assert_eq!(
            texts.problem("robot.lua:x: y"),
            Problem::new("robot.lua", 1, "robot.lua:x: y")
        );
    }

    #[test]
    fn a_long_name_is_cut_for_lua_and_whole_for_the_user() {
        let mut texts = Texts::default();
        let name = format!(
            "/home/{}/\u{e9}{}/robot.lua",
            "a".repeat(100),
            "b".repeat(40)
        );
        let chunk = texts.add(&name, b"");
        assert!(
            chunk.len() <= CHUNK_NAME_BYTES_MAX + 1 && chunk.ends_with("/robot.lua"),
            "{chunk}"
        );
        assert_eq!(
            texts.problem(&format!("{}:3: x", &chunk[1..])),
            Problem::new(name, 3, "x")
        );
    }

    #[test]
    fn a_place_is_that_of_the_nearest_key_in_any_file() {
        let mut texts = Texts::default();
        texts.add(
            "robot.lua",
            b"include 'm'\ntrikfs = {\n  motors = motors(4),\n}",
        );
        texts.add(
            "m.lua",
            b"\n\nfunction motors(n)\n return { left = { src = '/dev/x' } } end",
        );
        let place = |path: &[&str]| texts.place(path).to_string();
        assert_eq!(place(&["trikfs", "motors"]), "robot.lua:3");
        assert_eq!(place(&["trikfs", "motors", "left", "src"]), "m.lua:4");
        assert_eq!(place(&["trikfs", "motors", "right"]), "robot.lua:3");
        assert_eq!(place(&["trikfs", "nowhere"]), "robot.lua:2");
    }
}
