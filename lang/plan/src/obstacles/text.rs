//! Obstacles as text: a line for each, a word and numbers.
//!
//! Owns the form. Knows no file: the caller has read it.
//!
//! ```text
//! # comment
//! bounds 0 0 3 2              the workspace: lowest x and y, highest x and y
//! rectangle 1.3 0.85 1.6 1.15 two opposite corners
//! polygon 0 0  1 0  1 1       three corners or more
//! wall 0 1  2 1  0.02         from, to, thickness
//! circle 1 1  0.1             centre, radius
//! ```

use super::{Fault, Obstacles, Shape};
use crate::limits::{PLAN_CORNERS_MAX, PLAN_OBSTACLES_MAX, PLAN_OBSTACLES_TEXT_MAX};

const KINDS: [&str; 5] = ["bounds", "rectangle", "polygon", "wall", "circle"];
/// Which numbers stand after each word.
const FORMS: [(&str, &str); 5] = [
    ("bounds", "4 numbers: x, y of two opposite corners"),
    ("rectangle", "4 numbers: x, y of two opposite corners"),
    ("polygon", "two numbers for each corner"),
    ("wall", "5 numbers: x, y of both ends and the thickness"),
    ("circle", "3 numbers: x, y of its centre and the radius"),
];

/// Reads obstacles.
///
/// # Errors
/// The first line that is none, with its number, and why.
pub fn read(text: &str) -> Result<Obstacles, Fault> {
    if text.len() > PLAN_OBSTACLES_TEXT_MAX {
        return Err(Fault::TextBytes(text.len(), PLAN_OBSTACLES_TEXT_MAX));
    }
    let mut shapes = Vec::new();
    let mut workspace = None;
    for (at, line) in text.lines().enumerate() {
        let line = line.split('#').next().unwrap_or_default();
        let told = |fault: Fault| Fault::Line(at + 1, Box::new(fault));
        let Some((word, numbers)) = words(line).map_err(told)? else {
            continue;
        };
        let shape = match (word, numbers.as_slice()) {
            ("bounds", &[a, b, c, d]) => {
                if workspace
                    .replace([a.min(c), b.min(d), a.max(c), b.max(d)])
                    .is_some()
                {
                    return Err(told(Fault::SecondWorkspace));
                }
                continue;
            }
            ("rectangle", &[a, b, c, d]) => Shape::Rectangle([a, b], [c, d]),
            ("wall", &[a, b, c, d, thickness]) => Shape::Wall([a, b], [c, d], thickness),
            ("circle", &[x, y, radius]) => Shape::Circle([x, y], radius),
            ("polygon", all) if all.len() % 2 == 0 => {
                Shape::Polygon(all.chunks_exact(2).map(|one| [one[0], one[1]]).collect())
            }
            _ => return Err(told(wanted(word, numbers.len()))),
        };
        shape.check().map_err(told)?;
        if shapes.len() >= PLAN_OBSTACLES_MAX {
            return Err(told(Fault::TooManyObstacles));
        }
        shapes.push(shape);
    }
    Obstacles::new(shapes, workspace)
}

fn words(line: &str) -> Result<Option<(&str, Vec<f64>)>, Fault> {
    let mut words = line
        .split(|sign: char| sign.is_whitespace() || sign == ',')
        .filter(|word| !word.is_empty());
    let Some(first) = words.next() else {
        return Ok(None);
    };
    if !KINDS.contains(&first) {
        return Err(wanted(first, 0));
    }
    let mut numbers = Vec::new();
    for word in words {
        let number = word.parse::<f64>();
        let number = number.map_err(|_| Fault::Number(word.to_owned()))?;
        if numbers.len() >= 2 * PLAN_CORNERS_MAX {
            return Err(Fault::TooManyCorners);
        }
        numbers.push(number);
    }
    Ok(Some((first, numbers)))
}

/// The fault of a line whose word or count of numbers is none of [`KINDS`].
fn wanted(word: &str, got: usize) -> Fault {
    match FORMS.iter().find(|(kind, _)| *kind == word) {
        Some((kind, form)) => Fault::Numbers(kind, form, got),
        None => Fault::Kind(word.to_owned(), &KINDS),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn each_kind_is_read() {
        let read = read(
            "# a room\nbounds 0 0 3 2\n\n rectangle 1,1 2,2 # box\npolygon 0 0 1 0 1 1\nwall 0 1 2 1 0.02\n\
             circle 1 1 0.1\r\n",
        )
        .unwrap();
        assert_eq!(read.workspace(), Some([0.0, 0.0, 3.0, 2.0]));
        assert_eq!(
            read.shapes(),
            [
                Shape::Rectangle([1.0, 1.0], [2.0, 2.0]),
                Shape::Polygon(vec![[0.0, 0.0], [1.0, 0.0], [1.0, 1.0]]),
                Shape::Wall([0.0, 1.0], [2.0, 1.0], 0.02),
                Shape::Circle([1.0, 1.0], 0.1),
            ]
        );
        assert_eq!(super::read("").unwrap().shapes(), []);
    }

    #[test]
    fn what_is_wrong_is_told_with_its_line() {
        let refused = |text: &str| read(text).unwrap_err().to_string();
        assert_eq!(
            refused("\ncube 1 2"),
            "line 2: \"cube\" is no kind of obstacle: bounds, rectangle, polygon, wall, circle"
        );
        assert_eq!(
            refused("wall 1 2 3 4"),
            "line 1: `wall` needs 5 numbers: x, y of both ends and the thickness; here are 4"
        );
        assert_eq!(
            refused("polygon 1 2 3"),
            "line 1: `polygon` needs two numbers for each corner; here are 3"
        );
        assert_eq!(
            refused("polygon 1 2 3 4"),
            "line 1: a polygon needs three corners or more, not 2"
        );
        assert_eq!(refused("circle 1 x 3"), "line 1: \"x\" is no number");
        assert_eq!(
            refused("circle 1 1 -3"),
            "line 1: -3 is no thickness or radius"
        );
        for number in ["NaN", "inf", "1e308", "-1e308"] {
            let told = refused(&format!("circle {number} 1 3"));
            assert!(
                told.ends_with("is no coordinate: they go from -1e9 to 1e9"),
                "{told}"
            );
        }
        assert_eq!(
            refused("bounds 0 0 1 0"),
            "the bounds of the workspace have no area"
        );
        assert_eq!(
            refused("bounds 0 0 1 1\nbounds 0 0 1 1"),
            "line 2: a second `bounds`"
        );
    }
}
