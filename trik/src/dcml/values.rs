//! Numbers for names on the command line: `L=0.5,r=0.1`.
//!
//! Owns their form and what is said of names that are missing, strange or there twice.

use crate::refusal::Refusal;
use lang_text::near::did_you_mean;
use lang_text::problem::Locale;

/// The numbers of an option, in the order of these names; names may be missing.
pub(crate) fn values(
    option: &str,
    text: &str,
    names: &[&str],
) -> Result<Vec<Option<f64>>, Refusal> {
    let refused = |why: String| Refusal::new(format!("{option}: {why}"));
    let mut given = Vec::new();
    for part in text.split(',').map(str::trim).filter(|one| !one.is_empty()) {
        let Some((name, number)) = part.split_once('=') else {
            return Err(refused(format!("{part:?} is not NAME=NUMBER")));
        };
        let (name, number) = (name.trim(), number.trim());
        match number.parse() {
            Ok(value) if f64::is_finite(value) => given.push((name, value)),
            _ => {
                let why = format!("{name} cannot be {number:?}: give a number");
                return Err(refused(why));
            }
        }
    }
    in_order(option, names, given)
}

/// Numbers in the order of these names; names may be missing.
pub(crate) fn in_order<'a>(
    option: &str,
    names: &[&str],
    given: impl IntoIterator<Item = (&'a str, f64)>,
) -> Result<Vec<Option<f64>>, Refusal> {
    let refused = |why: String| Refusal::new(format!("{option}: {why}"));
    let mut values = vec![None; names.len()];
    for (name, value) in given {
        let Some(at) = names.iter().position(|one| *one == name) else {
            let all = match names {
                [] => "there are none".to_owned(),
                _ => format!("there are {}", names.join(", ")),
            };
            let meant = did_you_mean(name, names.iter().copied());
            return Err(refused(format!(
                "there is no {name:?}; {all}{}",
                meant.in_locale(Locale::English)
            )));
        };
        if values[at].replace(value).is_some() {
            return Err(refused(format!("{name} is there twice")));
        }
    }
    Ok(values)
}

/// The numbers of all these names, none of which may be missing.
pub(crate) fn complete(
    option: &str,
    names: &[&str],
    values: Vec<Option<f64>>,
) -> Result<Vec<f64>, Refusal> {
    let missing = names.iter().zip(&values).filter(|(_, one)| one.is_none());
    let missing: Vec<String> = missing.map(|(name, _)| format!("{name}=...")).collect();
    if missing.is_empty() {
        return Ok(values.into_iter().flatten().collect());
    }
    let missing = missing.join(",");
    Err(Refusal::new(format!(
        "the model needs numbers: {option} {missing}"
    )))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn all(text: &str) -> Result<Vec<f64>, Refusal> {
        let names = ["L", "r"];
        complete("--params", &names, values("--params", text, &names)?)
    }

    #[test]
    fn names_have_their_numbers() {
        let found = all("r = 1e-1, L=-2");
        assert_eq!(found, Ok(vec![-2.0, 0.1]));
        assert_eq!(values("--start", "", &["x"]), Ok(vec![None]));
    }

    #[test]
    fn what_is_wrong_is_said() {
        for (text, expected) in [
            ("L", "trik: --params: \"L\" is not NAME=NUMBER"),
            ("q=1", "trik: --params: there is no \"q\"; there are L, r"),
            (
                "L=one",
                "trik: --params: L cannot be \"one\": give a number",
            ),
            (
                "L=inf",
                "trik: --params: L cannot be \"inf\": give a number",
            ),
            ("L=1,L=1", "trik: --params: L is there twice"),
            ("L=1", "trik: the model needs numbers: --params r=..."),
        ] {
            let told = all(text).map_err(|one| one.lines);
            assert_eq!(told, Err(vec![expected.to_owned()]));
        }
    }
}
