//! Where texts stand in a picture of a diagram, so that none of them covers another one or a block.
//!
//! Owns the estimate of how wide a text is, the room under each block, and the search for a free place. Knows no SVG.

use crate::limits;

/// Half of the side of a block, in px.
pub(super) const HALF: f64 = 25.0;
/// Between two lines of text, in px.
pub(super) const LINE: f64 = 11.0;
/// From the middle of a block to the foot of its first line.
pub(super) const FIRST_LINE: f64 = 36.0;
/// From the middle of a block to the top of its label.
const LABEL: f64 = HALF + 2.0;
/// Half of the widest label, and its most lines.
const WIDEST: f64 = 80.0;
const LINES: usize = 5;
/// Half of the narrowest label: one that is as wide as its block.
const NARROWEST: f64 = HALF;
/// What stays free between two texts.
const GAP: f64 = 3.0;

/// A part of the picture.
#[derive(Clone, Copy, Debug)]
pub(super) struct Area {
    pub low: (f64, f64),
    pub high: (f64, f64),
}

impl Area {
    /// Around a place.
    pub fn around((x, y): (f64, f64), half_width: f64, half_height: f64) -> Self {
        Self {
            low: (x - half_width, y - half_height),
            high: (x + half_width, y + half_height),
        }
    }

    /// Under the middle of a block, for a label.
    pub fn under((x, y): (f64, f64), lines: &[String]) -> Self {
        let half = lines.iter().map(|line| width(line)).fold(0.0, f64::max) / 2.0;
        let top = y + LABEL;
        Self {
            low: (x - half, top),
            high: (x + half, top + LINE * lines.len() as f64),
        }
    }

    /// With another one.
    pub fn with(self, other: Self) -> Self {
        Self {
            low: (self.low.0.min(other.low.0), self.low.1.min(other.low.1)),
            high: (self.high.0.max(other.high.0), self.high.1.max(other.high.1)),
        }
    }

    /// Whether two share some place.
    pub fn meets(&self, other: &Self) -> bool {
        self.low.0 < other.high.0
            && other.low.0 < self.high.0
            && self.low.1 < other.high.1
            && other.low.1 < self.high.1
    }
}

/// How wide a text of 10 px is, about.
pub(super) fn width(text: &str) -> f64 {
    let letter = |letter: char| match letter {
        'i' | 'j' | 'l' | 'I' | '.' | ',' | ':' | ';' | '\'' | '|' | '!' | ' ' => 3.2,
        'm' | 'w' | 'M' | 'W' => 8.6,
        letter if letter.is_ascii_uppercase() => 6.9,
        letter if letter.is_ascii() => 5.7,
        letter if letter.is_uppercase() => 7.4,
        _ => 6.4,
    };
    text.chars().map(letter).sum()
}

/// What a label under a block may take.
#[derive(Clone, Copy, Debug)]
pub(super) struct Room {
    /// In px.
    pub width: f64,
    pub lines: usize,
}

/// The room under a block among others, by their middles: up to half of the way to the label beside it, and down to the
/// block beneath it.
pub(super) fn room(own: usize, middles: &[(f64, f64)]) -> Room {
    let tallest = LABEL + LINE * LINES as f64;
    let (mut half, mut lines) = (WIDEST, LINES);
    let others = middles.iter().enumerate().filter(|&(at, _)| at != own);
    for (_, &(x, y)) in others {
        let (beside, beneath) = ((x - middles[own].0).abs(), y - middles[own].1);
        if beside >= 2.0 * HALF {
            if beneath.abs() < tallest - LABEL {
                half = half.min(beside / 2.0 - GAP);
            }
            if beneath > 0.0 && beneath - HALF < tallest {
                half = half.min(beside - HALF - GAP);
            }
        } else if beneath > 2.0 * HALF {
            lines = lines.min(((beneath - HALF - LABEL - GAP) / LINE) as usize);
        }
    }
    Room {
        width: 2.0 * half.max(NARROWEST),
        lines: lines.max(1),
    }
}

/// A text in lines that are not too wide; what is left over is cut.
pub(super) fn wrapped(text: &str, widest: f64, lines: usize) -> Vec<String> {
    let mut all: Vec<String> = Vec::new();
    for word in text.split_whitespace() {
        let joined = all.last().map(|last| format!("{last} {word}"));
        match (all.last_mut(), joined) {
            (Some(last), Some(joined)) if width(&joined) <= widest => *last = joined,
            _ => all.push(word.to_owned()),
        }
    }
    let is_cut = all.len() > lines;
    all.truncate(lines);
    let count = all.len();
    for (at, line) in all.iter_mut().enumerate() {
        let more = is_cut && at + 1 == count;
        if more || width(line) > widest {
            while width(line) + width("...") > widest && line.pop().is_some() {}
            line.push_str("...");
        }
    }
    all
}

/// The first of some places that is free, else the first of all; it is taken then.
pub(super) fn free(places: &[Area], taken: &mut Vec<Area>) -> Option<Area> {
    let is_free = |place: &&Area| !taken.iter().any(|area| area.meets(place));
    let found = match taken.len() <= limits::PICTURE_AREAS_MAX {
        true => places.iter().find(is_free),
        false => None,
    };
    let found = found.or(places.first()).copied()?;
    taken.push(found);
    Some(found)
}
