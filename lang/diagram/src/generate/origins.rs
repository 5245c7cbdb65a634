//! The blocks that a line says, carried at its end while a program is put together.
//!
//! Owns the mark. Its letter is a control character, which XML cannot have, so that no text of a save ends like one.

use crate::program::Node;

const MARK: char = '\u{1}';

/// Puts a mark at the end of a line; one that says no block gets none.
pub(super) fn mark(line: &mut String, nodes: &[Node]) {
    for (at, node) in nodes.iter().enumerate() {
        line.push(if at == 0 { MARK } else { ',' });
        line.push_str(&node.to_string());
    }
}

/// A line without its mark, and what that says.
pub(super) fn read(line: &str) -> (&str, Vec<Node>) {
    let Some((text, mark)) = line.rsplit_once(MARK) else {
        return (line, Vec::new());
    };
    match mark.split(',').map(str::parse).collect() {
        Ok(nodes) => (text, nodes),
        Err(_) => (line, Vec::new()),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn marks_are_read_as_they_were_put_and_other_lines_stay() {
        for nodes in [vec![], vec![0], vec![7, 70_000]] {
            let mut line = "    x = 1, 2".to_owned();
            mark(&mut line, &nodes);
            assert_eq!(read(&line), ("    x = 1, 2", nodes));
        }
        for line in ["", "a\u{1}", "a\u{1}b", "a\u{1}1,"] {
            assert_eq!(read(line), (line, vec![]));
        }
    }
}
