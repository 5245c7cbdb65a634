//! The tree as a table without scripts and styles, for browsers and builds that have no page.
//!
//! Owns the table. It is read anew every two seconds by the browser itself.

use crate::{limits, tree};
use lang_text::escape::escaped;
use std::fmt::Write;
use std::fs;
use std::path::Path;

/// The table; `why_not` says why there is nothing better, if there is a reason.
pub fn table(name: &str, tree: &Path, why_not: &str) -> String {
    let mut rows = Vec::new();
    visit(tree, "", 0, &mut rows);
    rows.sort();
    let name = escaped(name);
    let mut page = format!(
        "<!doctype html><html lang=\"en\"><head><meta charset=\"utf-8\"><title>{name}</title>\
         <meta http-equiv=\"refresh\" content=\"2\"></head><body><main><h1>{name}</h1>"
    );
    if !why_not.is_empty() {
        let _ = write!(page, "<p>{}</p>", escaped(why_not));
    }
    page += "<table><thead><tr><th>node</th><th>value</th><th>unit</th></tr></thead><tbody>";
    for (path, value, unit) in rows {
        let cells = [path, value, unit].map(|cell| format!("<td>{}</td>", escaped(&cell)));
        let _ = write!(page, "<tr>{}</tr>", cells.concat());
    }
    page + "</tbody></table></main></body></html>\n"
}

/// A file of a node, shortened; a failure in words.
fn text(path: &Path) -> String {
    match tree::read(path) {
        Ok(text) => text.trim_end().chars().take(limits::CELL_LETTERS).collect(),
        // Nobody has asked for it yet, or it has nothing to say.
        Err(error) if error.kind() == std::io::ErrorKind::WouldBlock => "no value yet".to_owned(),
        Err(error) => {
            let text = error.to_string();
            text.split(" (os error")
                .next()
                .unwrap_or_default()
                .to_owned()
        }
    }
}

fn visit(at: &Path, path: &str, depth: usize, rows: &mut Vec<(String, String, String)>) {
    for entry in fs::read_dir(at).into_iter().flatten().flatten() {
        let is_folder = entry.file_type().is_ok_and(|kind| kind.is_dir());
        if !is_folder || depth >= limits::FOLDERS_MAX || rows.len() >= limits::ROWS_MAX {
            continue;
        }
        let name = entry.file_name().to_string_lossy().into_owned();
        let path = if path.is_empty() {
            name
        } else {
            format!("{path}/{name}")
        };
        let directory = entry.path();
        if directory.join("format").is_file() {
            // A camera is not started for a table.
            let is_small = fs::metadata(directory.join("bin_data"))
                .is_ok_and(|file| file.len() <= limits::CELL_BYTES_MAX);
            let value = if is_small {
                text(&directory.join("value"))
            } else {
                String::new()
            };
            rows.push((path, value, text(&directory.join("units"))));
        } else {
            visit(&directory, &path, depth + 1, rows);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_table_has_every_node_and_no_markup_of_others() {
        let tree = tempfile::tempdir().unwrap();
        let node = tree.path().join("sensors/A1");
        fs::create_dir_all(&node).unwrap();
        for (name, text) in [
            ("format", "u16"),
            ("bin_data", "ab"),
            ("value", "<b>\n"),
            ("units", "cm"),
        ] {
            fs::write(node.join(name), text).unwrap();
        }
        let page = table("<i>", tree.path(), "no npm");
        assert!(
            page.contains("<td>sensors/A1</td><td>&lt;b&gt;</td><td>cm</td>"),
            "{page}"
        );
        assert!(page.contains("<h1>&lt;i&gt;</h1><p>no npm</p>"), "{page}");
    }
}
