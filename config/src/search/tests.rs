//! Tests of the search path: what is found, and that nothing outside is.

use super::*;
use std::fs;
use std::os::unix::fs::symlink;
use tempfile::TempDir;

/// A folder of this test, removed with the value.
struct Folder(TempDir);

impl Folder {
    fn new() -> Self {
        let folder = tempfile::tempdir().unwrap();
        fs::create_dir(folder.path().join("inside")).unwrap();
        Self(folder)
    }

    fn search(&self) -> Search {
        Search {
            base_dir: Some(self.0.path().join("base")),
            include_dirs: vec![self.0.path().join("nowhere"), self.0.path().join("inside")],
            library_dirs: vec![self.0.path().join("inside")],
        }
    }
}

#[test]
fn a_file_is_found_with_or_without_its_ending() {
    let folder = Folder::new();
    fs::write(folder.0.path().join("inside/board.lua"), "x = 1").unwrap();
    assert_eq!(
        folder.search().include(b"board"),
        Ok(("board.lua".to_owned(), b"x = 1".to_vec()))
    );
    assert_eq!(
        folder.search().include(b"board.lua"),
        Ok(("board.lua".to_owned(), b"x = 1".to_vec()))
    );
    let error = folder.search().include(b"bord").unwrap_err().to_string();
    assert!(
        error.starts_with("'bord' was not found in ") && error.ends_with("/inside"),
        "{error}"
    );
}

#[test]
fn nothing_outside_the_search_path_is_included() {
    let folder = Folder::new();
    fs::write(folder.0.path().join("secret.lua"), "x = 1").unwrap();
    symlink(
        folder.0.path().join("secret.lua"),
        folder.0.path().join("inside/link.lua"),
    )
    .unwrap();
    fs::write(folder.0.path().join("inside/own.lua"), "x = 2").unwrap();
    symlink("own.lua", folder.0.path().join("inside/alias.lua")).unwrap();
    let refused = |name: &str| {
        let error = folder.search().include(name.as_bytes()).unwrap_err();
        error.to_string()
    };
    assert_eq!(
        refused("../secret.lua"),
        "'../secret.lua' leads outside the search path"
    );
    assert_eq!(
        refused("x/../../secret"),
        "'x/../../secret' leads outside the search path"
    );
    assert_eq!(
        refused("/etc/passwd"),
        "'/etc/passwd' leads outside the search path"
    );
    assert_eq!(refused("a\0b"), "'a\0b' leads outside the search path");
    assert_eq!(refused(""), "'' leads outside the search path");
    assert_eq!(refused("."), "'.' leads outside the search path");
    assert_eq!(
        refused("link"),
        "'link' is a link that leads outside the search path"
    );
    assert_eq!(
        folder.search().include(b"alias"),
        Ok(("alias.lua".to_owned(), b"x = 2".to_vec()))
    );
    assert_eq!(
        folder.search().recording(b"/tmp/run.rec"),
        Ok("/tmp/run.rec".into())
    );
}

#[test]
fn what_is_no_file_or_too_large_is_refused() {
    let folder = Folder::new();
    fs::create_dir(folder.0.path().join("inside/folder.lua")).unwrap();
    nix::unistd::mkfifo(
        &folder.0.path().join("inside/pipe.lua"),
        nix::sys::stat::Mode::S_IRWXU,
    )
    .unwrap();
    fs::write(
        folder.0.path().join("inside/large.lua"),
        vec![b' '; CONFIG_BYTES_MAX + 1],
    )
    .unwrap();
    assert!(
        folder
            .search()
            .include(b"folder")
            .unwrap_err()
            .to_string()
            .starts_with("'folder' was not found in ")
    );
    assert!(
        folder
            .search()
            .include(b"pipe")
            .unwrap_err()
            .to_string()
            .starts_with("'pipe' was not found in ")
    );
    assert_eq!(
        folder.search().include(b"large").unwrap_err().to_string(),
        "'large' has more than 1048576 bytes"
    );
}

#[test]
fn a_library_is_found_beside_the_file_and_then_in_the_library_folder() {
    let folder = Folder::new();
    fs::create_dir_all(folder.0.path().join("base")).unwrap();
    fs::write(folder.0.path().join("inside/x.so"), "1").unwrap();
    assert_eq!(
        folder.search().library(b"x.so"),
        Ok(folder.0.path().join("inside/x.so"))
    );
    fs::write(folder.0.path().join("base/x.so"), "2").unwrap();
    assert_eq!(
        folder.search().library(b"x.so"),
        Ok(folder.0.path().join("base/x.so"))
    );
    assert_eq!(
        folder.search().library(b"/nowhere/x.so"),
        Err(Error::Named(
            "library '/nowhere/x.so' does not exist".into()
        ))
    );
    assert!(
        folder
            .search()
            .library(b"y.so")
            .unwrap_err()
            .to_string()
            .starts_with("library 'y.so' was not found in ")
    );
}
