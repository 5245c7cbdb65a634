//! Names: which are found, which are not, and how long the kernel may believe it.

use crate::mount;
use std::ffi::OsStr;
use std::os::unix::ffi::OsStrExt;

const TREE: &str = "trikfs = {
  zero = { src = '/dev/zero', input_tuple_size = 4 },
  motors = { M1 = { src = '/dev/zero', input_tuple_size = 1 }, deep = { er = { src = '/dev/zero', input_tuple_size = 2 } } },
}";

fn errno(path: std::path::PathBuf) -> i32 {
    std::fs::metadata(path)
        .err()
        .and_then(|error| error.raw_os_error())
        .unwrap_or(0)
}

#[test]
fn nodes_groups_and_reserved_files_are_found() {
    let Some(m) = mount(TREE) else { return };
    for name in [
        "config",
        "status",
        "log",
        "stop",
        "zero/device",
        "zero/value",
        "motors/M1/device",
        "motors/deep/er/stats",
    ] {
        assert!(m.path(name).is_file(), "{name}");
    }
    for name in [
        "zero",
        "motors",
        "motors/M1",
        "motors/deep",
        "motors/deep/er",
    ] {
        assert!(m.path(name).is_dir(), "{name}");
    }
}

/// A file that is added to the tree takes its name from configurations: the list of `config` has it, or a description could
/// take the place of that file.
#[test]
fn names_of_files_are_refused_as_names_of_nodes_and_attributes() {
    let text = "trikfs = {
      motor = { src = '/dev/null', input_tuple_size = 4, output_tuple_size = 4, format = 'i32 percent', rest = { 0 } },
    }";
    let Some(m) = mount(text) else { return };
    let names = |path: &str| -> Vec<String> {
        let entries = std::fs::read_dir(m.path(path)).unwrap();
        entries
            .map(|entry| entry.unwrap().file_name().into_string().unwrap())
            .collect()
    };
    let source = "src = '/dev/zero', input_tuple_size = 1";
    let refusal = |text: String| {
        let loaded = config::load::Loader::default().load("robot.lua", None, text.as_bytes());
        loaded.err().map(|problem| problem.to_string())
    };
    let of_nodes = names("");
    let of_attributes = names("motor");
    assert!(of_attributes.len() >= 9, "{of_attributes:?}");
    for name in of_nodes.iter().filter(|name| *name != "motor") {
        let text = format!("trikfs = {{ {name} = {{ {source} }} }}");
        assert!(refusal(text).is_some(), "a node can be called {name}");
    }
    for name in &of_attributes {
        let text = format!(
            "trikfs = {{ x = {{ {source}, attributes = {{ {name} = {{ {source} }} }} }} }}"
        );
        assert!(refusal(text).is_some(), "an attribute can be called {name}");
    }
    let text =
        format!("trikfs = {{ x = {{ {source}, attributes = {{ motor = {{ {source} }} }} }} }}");
    assert_eq!(refusal(text), None);
}

#[test]
fn other_names_are_enoent_and_files_are_no_directories() {
    let Some(m) = mount(TREE) else { return };
    for name in [
        "zero0",
        "Zero",
        "zero/devic",
        "zero/value0",
        "motors/M2",
        "motors/M1/M1",
        "zero/ device",
    ] {
        assert_eq!(errno(m.path(name)), libc::ENOENT, "{name}");
    }
    assert_eq!(errno(m.path("config/device")), libc::ENOTDIR);
    assert_eq!(errno(m.path("zero/device/value")), libc::ENOTDIR);
}

#[test]
fn odd_names_do_no_harm() {
    let Some(m) = mount(TREE) else { return };
    assert_eq!(errno(m.path(&"a".repeat(255))), libc::ENOENT);
    assert_ne!(errno(m.path(&"a".repeat(256))), 0);
    assert_eq!(errno(m.path(&"a".repeat(5000))), libc::ENAMETOOLONG);
    for odd in [
        &b"\xff\xfe"[..],
        b"zero\n",
        b"\x01",
        b"zero\x80",
        "n\u{e9}".as_bytes(),
    ] {
        assert_eq!(
            errno(m.root().join(OsStr::from_bytes(odd))),
            libc::ENOENT,
            "{odd:?}"
        );
    }
}

#[test]
fn a_reload_shows_new_names_and_hides_old_ones_although_the_kernel_had_looked() {
    let Some(m) = mount(TREE) else { return };
    assert_eq!(errno(m.path("one/device")), libc::ENOENT);
    assert_eq!(errno(m.path("zero/device")), 0);
    m.apply("trikfs = { one = { src = '/dev/zero', input_tuple_size = 4 } }")
        .unwrap();
    harness::eventually("the new name", || errno(m.path("one/device")) == 0);
    harness::eventually("the end of the old name", || {
        errno(m.path("zero/device")) == libc::ENOENT
    });
    assert_eq!(errno(m.path("motors/M1")), libc::ENOENT);
    assert_eq!(m.sh("ls"), "config\nlog\none\nstatus\nstop\n");
}
