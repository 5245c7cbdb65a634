//! Values of attributes that a world can hold and nobody means: colours, styles, units, truths, sizes, halves of pairs.
//!
//! Owns which form the text of an attribute has to have. Reading takes another text for a default without a word, as the
//! original does; here it is told. Knows no field: a tag with its attributes is enough.

use super::{warn, words};
use crate::arena::floor::colour::Tint;
use crate::field::Kind;
use lang_text::near::nearest;
use lang_text::problem::Problem;
use lang_text::xml::Element;

/// What the text of an attribute has to be.
#[derive(Clone, Copy, Debug, Eq, PartialEq)]
enum Form {
    Colour,
    /// One of a few words; another one counts as the last part says.
    Word(&'static [&'static str], &'static str),
    /// A number that is not below 0.
    NotNegative,
    /// A number above 0.
    Positive,
    /// A whole number that is not below 0.
    Whole,
}

const LINES: Form = Form::Word(
    &["solid", "dot", "dash", "dashdot", "dashdotdot", "none"],
    "solid",
);
const FILLS: Form = Form::Word(&["none", "solid"], "none");
const UNITS: Form = Form::Word(&["px", "cm", "mm", "m"], "px");
const TRUTHS: Form = Form::Word(&["true", "false"], "false");

/// Attributes that are meant together; the truth says whether one alone means nothing, or the other one is 0 then.
const PAIRS: [(&str, [&str; 2], bool); 9] = [
    ("regions/region", ["x", "y"], true),
    ("regions/region", ["width", "height"], true),
    ("regions/region", ["textX", "textY"], true),
    ("skittles/skittle", ["x", "y"], false),
    ("skittles/skittle", ["markerX", "markerY"], false),
    ("balls/ball", ["x", "y"], false),
    ("balls/ball", ["markerX", "markerY"], false),
    ("cubes/cube", ["x", "y"], false),
    ("cubes/cube", ["markerX", "markerY"], false),
];

fn form(path: &str, name: &str) -> Option<Form> {
    Some(match (path, name) {
        ("root/settings", "sizeUnit") => UNITS,
        ("root/settings", "realisticPhysics" | "realisticSensors" | "realisticMotors") => TRUTHS,
        ("regions/region", "filled" | "visible") => TRUTHS,
        ("images/image" | "world/background", "isBackground" | "external") => TRUTHS,
        ("regions/region", "stroke") => Form::Whole,
        (_, "stroke" | "fill" | "color" | "backgroundColor") => Form::Colour,
        (_, "stroke-style") => LINES,
        (_, "fill-style") => FILLS,
        (_, "mass" | "friction" | "restitution" | "angularDamping" | "linearDamping") => {
            Form::NotNegative
        }
        (_, "stroke-width") | ("trace/segment", "width") => Form::NotNegative,
        (_, "diameter" | "edgeSize") => Form::Positive,
        ("robots/robot" | "world/robot", "width" | "height") => Form::Positive,
        _ => return None,
    })
}

/// Tells what is strange in the attributes of a tag.
pub(super) fn check(element: &Element<'_>, kind: &Kind, problems: &mut Vec<Problem>) {
    for (name, text) in &element.attributes {
        if let Some(form) = form(kind.path, name)
            && let Some(words) = wrong(form, name, text)
        {
            warn(element.start, words, problems);
        }
    }
    for (path, [one, other], is_void) in PAIRS {
        if path != kind.path {
            continue;
        }
        let [has_one, has_other] = [one, other].map(|name| element.attribute(name).is_some());
        if has_one != has_other {
            let (there, missing) = if has_one { (one, other) } else { (other, one) };
            warn(
                element.start,
                words::half(there, missing, is_void),
                problems,
            );
        }
    }
}

/// What is wrong with a text; an empty one is the default.
fn wrong(form: Form, name: &str, text: &str) -> Option<lang_text::problem::Words> {
    if text.is_empty() {
        return None;
    }
    // What is no number at all has been told by the reader of numbers.
    let number: Option<f64> = text.trim().parse().ok();
    match form {
        Form::Colour => Tint::named(text)
            .is_none()
            .then(|| words::no_colour(name, text)),
        Form::Word(known, other) => (!known.contains(&text)).then(|| {
            let near = nearest(text, known.iter().copied());
            words::no_word(name, text, known, other, near)
        }),
        Form::NotNegative => number
            .filter(|number| *number < 0.0)
            .map(|_| words::negative(name, text)),
        Form::Positive => number
            .filter(|number| *number <= 0.0)
            .map(|_| words::not_positive(name, text)),
        Form::Whole => {
            let whole: Option<i32> = text.trim().parse().ok();
            whole
                .is_none_or(|whole| whole < 0)
                .then(|| words::not_whole(name, text))
        }
    }
}
