//! Versions of saves: numbers, perhaps with a stage before the release, as `3.0.0-rc1`.

use std::fmt;

/// How far a version was from its release.
#[derive(Clone, Copy, Debug, Eq, Ord, PartialEq, PartialOrd)]
enum Stage {
    Alpha,
    Beta,
    Candidate,
    Release,
}

/// A version of the language; versions are ordered by time.
#[derive(Clone, Copy, Debug, Eq, Ord, PartialEq, PartialOrd)]
pub struct Version {
    numbers: [u32; 3],
    stage: Stage,
    /// Which alpha, beta or candidate it was.
    build: u32,
}

impl Version {
    /// Reads `2024.1.0`, `2020.4`, `3.0.0-a4`, `3.1.1-alpha3`, `3.0.0-b2` or `3.0.0-rc1`; `None` for anything else.
    pub fn parse(text: &str) -> Option<Self> {
        let (numbers, stage) = match text.split_once('-') {
            Some((numbers, stage)) => (numbers, Some(stage)),
            None => (text, None),
        };
        let mut version = Self::release(0, 0, 0);
        let mut parts = numbers.split('.');
        for (at, number) in version.numbers.iter_mut().enumerate() {
            match parts.next() {
                Some(part) => *number = digits(part)?,
                None if at == 0 => return None,
                None => break,
            }
        }
        if parts.next().is_some() {
            return None;
        }
        let Some(stage) = stage else {
            return Some(version);
        };
        let letters = stage.trim_end_matches(|c: char| c.is_ascii_digit());
        version.stage = match letters {
            "a" | "alpha" => Stage::Alpha,
            "b" | "beta" => Stage::Beta,
            "rc" => Stage::Candidate,
            _ => return None,
        };
        let number = &stage[letters.len()..];
        version.build = if number.is_empty() {
            0
        } else {
            digits(number)?
        };
        Some(version)
    }

    /// A version without a stage.
    pub const fn release(major: u32, minor: u32, patch: u32) -> Self {
        Self {
            numbers: [major, minor, patch],
            stage: Stage::Release,
            build: 0,
        }
    }

    /// The same version as its alpha with a number.
    pub(super) const fn alpha(mut self, build: u32) -> Self {
        self.stage = Stage::Alpha;
        self.build = build;
        self
    }

    /// The same version as its beta with a number.
    pub(super) const fn beta(mut self, build: u32) -> Self {
        self.stage = Stage::Beta;
        self.build = build;
        self
    }
}

fn digits(text: &str) -> Option<u32> {
    let is_number = !text.is_empty() && text.bytes().all(|byte| byte.is_ascii_digit());
    is_number.then(|| text.parse().ok())?
}

impl fmt::Display for Version {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let [major, minor, patch] = self.numbers;
        write!(f, "{major}.{minor}.{patch}")?;
        match self.stage {
            Stage::Alpha => write!(f, "-a{}", self.build),
            Stage::Beta => write!(f, "-b{}", self.build),
            Stage::Candidate => write!(f, "-rc{}", self.build),
            Stage::Release => Ok(()),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn versions_are_ordered_by_time() {
        let order = [
            "2.9",
            "3.0.0-a1",
            "3.0.0-alpha4",
            "3.0.0-a5",
            "3.0.0-b2",
            "3.0.0-rc1",
            "3.0.0",
            "3.0.1",
            "3.1.1-alpha3",
            "3.1.1",
            "3.10",
            "2020.4",
            "2020.4.1",
            "2024.1.0",
        ];
        let versions = order.map(|text| Version::parse(text).unwrap());
        for pair in versions.windows(2) {
            assert!(pair[0] < pair[1], "{} {}", pair[0], pair[1]);
        }
        assert_eq!(Version::parse("2024.1"), Version::parse("2024.1.0"));
    }

    #[test]
    fn what_is_no_version_is_none() {
        for text in [
            "",
            ".",
            "3.",
            "x",
            "3.0.0.1",
            "3.0-",
            "3.0-z1",
            "-1",
            "+1",
            "99999999999",
        ] {
            assert_eq!(Version::parse(text), None, "{text}");
        }
    }
}
