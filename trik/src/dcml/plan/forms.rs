//! Names with numbers on a command line: `x=1,y=2`, `u=-1..1`, `circle:0.1`.
//!
//! Owns the forms. What the names mean is known to the caller.

use crate::error::Error;
use lang_plan::obstacles::Footprint;

/// A name and what it was given.
pub(crate) type Named<T> = (String, T);

/// Names with numbers.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Assignments(pub Vec<Named<f64>>);

/// Names with ranges.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Ranges(pub Vec<Named<(f64, f64)>>);

/// A footprint.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Footing(pub Footprint);

/// One more body: X, Y and perhaps HEADING, and what it covers.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Bodied(pub Vec<String>, pub Footprint);

/// A rigid link: X, Y of both of its ends, and its tolerance.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Linked(pub Vec<String>, pub f64);

/// Numbers beyond this are no place, angle or speed.
const MOST: f64 = 1e9;

fn number(text: &str) -> Result<f64, Error> {
    let number = text.trim().parse::<f64>();
    let number = number.map_err(|_| Error::Refused(format!("{text:?} is no number")))?;
    if number.abs() <= MOST {
        Ok(number)
    } else {
        Err(Error::Refused(format!(
            "{text} is not from -{MOST:e} to {MOST:e}"
        )))
    }
}

/// A number above 0.
pub(crate) fn positive(text: &str) -> Result<f64, Error> {
    let number = number(text)?;
    if number > 0.0 {
        Ok(number)
    } else {
        Err(Error::Refused(format!("{text} is not above 0")))
    }
}

/// `LOW..HIGH`
pub(crate) fn range(text: &str) -> Result<(f64, f64), Error> {
    let (low, high) = text
        .split_once("..")
        .ok_or_else(|| Error::Refused(format!("{text:?} is no range: write LOW..HIGH")))?;
    let (low, high) = (number(low)?, number(high)?);
    if low <= high {
        Ok((low, high))
    } else {
        Err(Error::Refused(format!("{low} is above {high}")))
    }
}

fn named<T>(
    text: &str,
    value: impl Fn(&str) -> Result<T, Error>,
    form: &str,
) -> Result<Vec<Named<T>>, Error> {
    let one = |part: &str| {
        let (name, rest) = part
            .split_once('=')
            .ok_or_else(|| Error::Refused(format!("{part:?}: write NAME={form}")))?;
        Ok((name.trim().to_owned(), value(rest)?))
    };
    text.split(',')
        .filter(|part| !part.trim().is_empty())
        .map(one)
        .collect()
}

/// `NAME=NUMBER,...`
pub(crate) fn given(text: &str) -> Result<Assignments, Error> {
    named(text, number, "NUMBER").map(Assignments)
}

/// `NAME=LOW..HIGH,...`
pub(crate) fn ranges(text: &str) -> Result<Ranges, Error> {
    named(text, range, "LOW..HIGH").map(Ranges)
}

/// `circle:RADIUS` or `polygon:X,Y,X,Y,...`
pub(crate) fn footing(text: &str) -> Result<Footing, Error> {
    let (kind, rest) = text.split_once(':').unwrap_or((text, ""));
    let numbers = rest
        .split([',', ' ', ';'])
        .filter(|part| !part.is_empty())
        .map(number)
        .collect::<Result<Vec<f64>, Error>>();
    let footprint = match (kind, numbers?.as_slice()) {
        ("circle", &[radius]) => Footprint::circle(radius),
        ("polygon", all) if all.len() >= 6 && all.len() % 2 == 0 => {
            Footprint::polygon(all.chunks_exact(2).map(|one| [one[0], one[1]]).collect())
        }
        _ => {
            let why = "write circle:RADIUS, or polygon: and x, y of three corners or more";
            return Err(Error::Refused(why.to_owned()));
        }
    };
    footprint
        .map(Footing)
        .map_err(|why| Error::Refused(why.to_string()))
}

fn names_of(text: &str) -> Vec<String> {
    text.split(',').map(|name| name.trim().to_owned()).collect()
}

/// `X,Y[,HEADING]=SHAPE`
pub(crate) fn body(text: &str) -> Result<Bodied, Error> {
    let split = text
        .split_once('=')
        .map(|(names, shape)| (names_of(names), shape));
    match split {
        Some((names, shape)) if matches!(names.len(), 2 | 3) => {
            Ok(Bodied(names, footing(shape)?.0))
        }
        _ => Err(Error::Refused(format!(
            "{text:?} is no body: write X,Y,HEADING=SHAPE with names of states or outputs"
        ))),
    }
}

/// `X,Y,X,Y=TOLERANCE`
pub(crate) fn link(text: &str) -> Result<Linked, Error> {
    let split = text
        .split_once('=')
        .map(|(names, rest)| (names_of(names), rest));
    match split {
        Some((names, tolerance)) if names.len() == 4 => Ok(Linked(names, positive(tolerance)?)),
        _ => Err(Error::Refused(format!(
            "{text:?} is no link: write X,Y,X,Y=TOLERANCE with names of states or outputs"
        ))),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn lists_of_names_are_read() {
        assert_eq!(
            given("x=1, y=-2.5").unwrap().0,
            [("x".to_owned(), 1.0), ("y".to_owned(), -2.5)]
        );
        assert_eq!(
            ranges("u=-1..1").unwrap().0,
            [("u".to_owned(), (-1.0, 1.0))]
        );
        assert_eq!(
            given("x").unwrap_err().to_string(),
            "\"x\": write NAME=NUMBER"
        );
        assert_eq!(given("x=y").unwrap_err().to_string(), "\"y\" is no number");
        for bad in ["NaN", "inf", "1e308"] {
            let told = given(&format!("x={bad}")).unwrap_err().to_string();
            assert_eq!(told, format!("{bad} is not from -1e9 to 1e9"));
        }
        assert_eq!(ranges("u=1..-1").unwrap_err().to_string(), "1 is above -1");
        assert_eq!(
            ranges("u=1").unwrap_err().to_string(),
            "\"1\" is no range: write LOW..HIGH"
        );
        assert_eq!(positive("0").unwrap_err().to_string(), "0 is not above 0");
    }

    #[test]
    fn footprints_are_read() {
        assert_eq!(footing("circle:0.1").unwrap().0.reach(), 0.1);
        assert_eq!(footing("polygon:0,0 3,0 3,4").unwrap().0.reach(), 5.0);
        for bad in ["circle", "circle:1,2", "polygon:0,0,1,1", "box:1"] {
            assert!(
                footing(bad)
                    .unwrap_err()
                    .to_string()
                    .starts_with("write circle:")
            );
        }
        assert_eq!(
            footing("circle:-1").unwrap_err().to_string(),
            "-1 is no radius"
        );
    }
}
