//! Colours of drawn things, by the names and numbers of world models and of the web.

use std::str::FromStr;

/// A colour that may let through what is below.
#[derive(Clone, Copy, Debug, Eq, PartialEq)]
pub struct Tint {
    /// Red, green, blue.
    pub rgb: [u8; 3],
    /// 0 is glass, 255 is paint.
    pub opacity: u8,
}

impl Tint {
    /// What lets nothing through.
    pub const fn solid(rgb: [u8; 3]) -> Self {
        Self {
            rgb,
            opacity: u8::MAX,
        }
    }

    /// By its name in any case, `#rgb`, `#rrggbb` or `#aarrggbb`; nothing if there is no such colour.
    pub fn named(text: &str) -> Option<Self> {
        let text = text.trim();
        if let Some(digits) = text.strip_prefix('#') {
            let number = u32::from_str_radix(digits, 16).ok()?;
            let [opacity, red, green, blue] = number.to_be_bytes();
            let rgb = [red, green, blue];
            return match digits.len() {
                3 => svg(text),
                6 => Some(Self::solid(rgb)),
                8 => Some(Self { rgb, opacity }),
                _ => None,
            };
        }
        svg(&text.to_ascii_lowercase())
    }
}

fn svg(text: &str) -> Option<Tint> {
    if !text
        .bytes()
        .all(|byte| byte.is_ascii_alphanumeric() || byte == b'#')
    {
        return None;
    }
    let colour = svgtypes::Color::from_str(text).ok()?;
    Some(Tint {
        rgb: [colour.red, colour.green, colour.blue],
        opacity: colour.alpha,
    })
}

/// A part of 255, rounded as the original's painter does it.
fn part(value: u8, of: u8) -> u32 {
    let product = u32::from(value) * u32::from(of);
    (product + (product >> 8) + 0x80) >> 8
}

/// Lays a colour with some coverage over another one.
pub fn lay(under: &mut [u8; 3], over: Tint, coverage: u8) {
    let seen = u8::try_from(part(over.opacity, coverage)).unwrap_or(u8::MAX);
    if seen == u8::MAX {
        *under = over.rgb;
        return;
    }
    for (under, over) in under.iter_mut().zip(over.rgb) {
        let sum = part(over, seen) + part(*under, u8::MAX - seen);
        *under = u8::try_from(sum).unwrap_or(u8::MAX);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn colours_have_names_and_numbers() {
        let cases = [
            ("#ff000000", Tint::solid([0, 0, 0])),
            (
                "#80ff0001",
                Tint {
                    rgb: [255, 0, 1],
                    opacity: 128,
                },
            ),
            ("#0a141e", Tint::solid([10, 20, 30])),
            ("#f0a", Tint::solid([255, 0, 170])),
            (" LightSkyBlue ", Tint::solid([135, 206, 250])),
            ("green", Tint::solid([0, 128, 0])),
        ];
        for (text, tint) in cases {
            assert_eq!(Tint::named(text), Some(tint), "{text}");
        }
        for text in [
            "",
            "#",
            "#12",
            "#12345",
            "no colour",
            "#+12",
            "rgb(1,2,3)",
            "#ff00zz",
        ] {
            assert_eq!(Tint::named(text), None, "{text}");
        }
        assert_eq!(Tint::named("transparent").map(|tint| tint.opacity), Some(0));
    }

    #[test]
    fn coverage_mixes() {
        let mut under = [255, 255, 255];
        lay(&mut under, Tint::solid([0, 0, 0]), 100);
        assert_eq!(under, [155; 3]);
        lay(&mut under, Tint::solid([9, 8, 7]), 255);
        assert_eq!(under, [9, 8, 7]);
        lay(
            &mut under,
            Tint {
                rgb: [255; 3],
                opacity: 0,
            },
            255,
        );
        assert_eq!(under, [9, 8, 7]);
    }
}
