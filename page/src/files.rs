//! The page as it was built, in the program: compressed, as it is sent.
//!
//! Owns finding a file by its path. `build.rs` makes the list; without npm it is empty.

/// A file of the page.
#[derive(Debug)]
pub struct File {
    /// Its path below the root, as `assets/index.js`.
    pub path: &'static str,
    /// Its type.
    pub kind: &'static str,
    /// Its content, in gzip.
    pub bytes: &'static [u8],
}

include!(concat!(env!("OUT_DIR"), "/files.rs"));

/// The file of a path; the root is the page itself. Those of the pages of a class and of marks are found for these alone, so that a
/// program without them does not have them.
pub fn find_of_class(path: &str) -> Option<&'static File> {
    let name = path.trim_start_matches('/');
    find(path).or_else(|| OF_CLASS.iter().find(|file| file.path == name))
}

/// The file of a path; the root is the page itself.
pub fn find(path: &str) -> Option<&'static File> {
    let path = match path.trim_start_matches('/') {
        "" => "index.html",
        other => other,
    };
    FILES.iter().find(|file| file.path == path)
}

/// Whether names of these files change with their content, so that a browser may keep them.
pub fn is_kept(path: &str) -> bool {
    path.starts_with("assets/")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_page_is_here_where_it_must_be() {
        if std::env::var_os("TRIK_REQUIRE_TOOLS").is_some() {
            assert!(find("/").is_some(), "{WHY_NOT}");
        }
        for file in FILES.iter().chain(OF_CLASS) {
            assert!(file.bytes.starts_with(&[0x1f, 0x8b]), "{}", file.path);
        }
        // What is loaded first; an editor and others come when they are opened.
        let first =
            |file: &&File| file.path == "index.html" || file.path.starts_with("assets/index");
        let size: usize = FILES
            .iter()
            .filter(first)
            .map(|file| file.bytes.len())
            .sum();
        assert!(size <= 250 << 10, "{size} bytes");
        assert!(find("/none").is_none() && find_of_class("/none").is_none());
        assert_eq!(OF_CLASS.is_empty(), FILES.is_empty());
        for file in OF_CLASS {
            assert!(find(file.path).is_none() && find_of_class(file.path).is_some());
        }
    }
}
