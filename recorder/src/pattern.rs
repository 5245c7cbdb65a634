//! Patterns for paths of nodes: `*` stands for anything, and a group for all below it.
//!
//! Owns what they match. Knows no tree and no recording.

/// `*` stands for anything; a pattern without an end at a name is a group.
pub fn matches(pattern: &str, path: &str) -> bool {
    let pattern = pattern.trim_matches('/');
    let whole = is_match(pattern.as_bytes(), path.as_bytes());
    let ends = path.match_indices('/').map(|(at, _)| at);
    let mut groups = ends.map(|at| &path[..at]);
    whole || groups.any(|group| is_match(pattern.as_bytes(), group.as_bytes()))
}

/// One star is remembered, so this takes at most the product of both lengths.
fn is_match(pattern: &[u8], text: &[u8]) -> bool {
    let (mut at, mut in_text) = (0, 0);
    let mut star: Option<(usize, usize)> = None;
    while in_text < text.len() {
        match pattern.get(at) {
            Some(b'*') => {
                star = Some((at, in_text));
                at += 1;
            }
            Some(byte) if *byte == text[in_text] => {
                at += 1;
                in_text += 1;
            }
            _ => {
                let Some((before, taken)) = star else {
                    return false;
                };
                star = Some((before, taken + 1));
                at = before + 1;
                in_text = taken + 1;
            }
        }
    }
    pattern[at..].iter().all(|byte| *byte == b'*')
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn patterns_match_nodes_and_groups() {
        for (pattern, path, is_wanted) in [
            ("sensors/A1", "sensors/A1", true),
            ("sensors", "sensors/A1", true),
            ("sensors/", "sensors/A1", true),
            ("sens", "sensors/A1", false),
            ("*A1", "sensors/A1", true),
            ("s*/A*", "sensors/A1", true),
            ("*/A2", "sensors/A1", false),
            ("*", "x", true),
            ("motors/M*", "motors/M3/speed", true),
            ("", "x", false),
        ] {
            assert_eq!(matches(pattern, path), is_wanted, "{pattern} {path}");
        }
        // No pattern takes long.
        assert!(!matches(&"*a".repeat(200), &"a".repeat(150)));
    }
}
