//! Numbers for names on the command line: `L=0.5,r=0.1`.
//!
//! Owns their form and what is said of names that are missing, strange or there twice.

use crate::diagrams::Refusal;

/// The numbers of an option, in the order of these names; names may be missing.
pub(crate) fn values(
    option: &str,
    text: &str,
    names: &[&str],
) -> Result<Vec<Option<f64>>, Refusal> {
    let refused = |why: String| Refusal::new(format!("{option}: {why}"));
    let mut values = vec![None; names.len()];
    for part in text.split(',').map(str::trim).filter(|one| !one.is_empty()) {
        let Some((name, number)) = part.split_once('=') else {
            return Err(refused(format!("{part:?} is not NAME=NUMBER")));
        };
        let (name, number) = (name.trim(), number.trim());
        let Some(at) = names.iter().position(|one| *one == name) else {
            let all = match names {
                [] => "there are none".to_owned(),
                _ => format!("there are {}", names.join(", ")),
            };
            return Err(refused(format!("there is no {name:?}; {all}")));
        };
        let value: f64 = match number.parse() {
            Ok(value) if f64::is_finite(value) => value,
            _ => {
                return Err(refused(format!(
                    "{name} cannot be {number:?}: give a number"
                )));
            }
        };
        if values[at].replace(value).is_some() {
            return Err(refused(format!("{name} is there twice")));
        }
    }
    Ok(values)
}

/// The same where no name may be missing.
pub(crate) fn all_values(option: &str, text: &str, names: &[&str]) -> Result<Vec<f64>, Refusal> {
    let given = values(option, text, names)?;
    let missing = names.iter().zip(&given).filter(|(_, one)| one.is_none());
    let missing: Vec<&str> = missing.map(|(name, _)| *name).collect();
    if !missing.is_empty() {
        let each: Vec<String> = missing
            .iter()
            .map(|name| format!("{name}=NUMBER"))
            .collect();
        let why = format!(
            "give numbers for {}: {}",
            missing.join(", "),
            each.join(",")
        );
        return Err(Refusal::new(format!("{option}: {why}")));
    }
    Ok(given.into_iter().flatten().collect())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_have_their_numbers() {
        let found = all_values("--params", "r = 1e-1, L=-2", &["L", "r"]);
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
            ("L=1", "trik: --params: give numbers for r: r=NUMBER"),
        ] {
            let told = all_values("--params", text, &["L", "r"]).map_err(|one| one.lines);
            assert_eq!(told, Err(vec![expected.to_owned()]));
        }
    }
}
