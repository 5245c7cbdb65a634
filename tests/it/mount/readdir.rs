//! Directories: complete, in order, whatever their size.

use crate::mount;

#[test]
fn a_node_lists_its_files_and_the_root_its_nodes() {
    let Some(m) = mount(
        "trikfs = {
          plain = { src = '/dev/zero', input_tuple_size = 2 },
          motors = { M1 = { src = '/dev/zero', input_tuple_size = 3, format = 'i8 x, u16 y' } },
        }",
    ) else {
        return;
    };
    assert_eq!(
        m.sh("ls -a"),
        ".\n..\nconfig\nlog\nmotors\nplain\nstatus\nstop\n"
    );
    let files = "bin_data device fault format poll_ms stats units value";
    assert_eq!(m.sh("echo $(ls plain)"), format!("{files}\n"));
    assert_eq!(
        m.sh("echo $(ls motors/M1)"),
        format!("{files} value0 value1\n")
    );
    assert_eq!(
        m.sh("find . -type d | sort"),
        ".\n./motors\n./motors/M1\n./plain\n"
    );
}

#[test]
fn a_thousand_nodes_are_listed_once_each() {
    let Some(m) = mount(
        "trikfs = {}
        for i = 1, 1000 do trikfs['node' .. i] = { src = '/dev/zero', input_tuple_size = 1 } end",
    ) else {
        return;
    };
    let entries: Vec<_> = std::fs::read_dir(m.root())
        .unwrap()
        .map(|entry| entry.unwrap().file_name())
        .collect();
    assert_eq!(entries.len(), 1004);
    let different: std::collections::BTreeSet<_> = entries.iter().collect();
    assert_eq!(different.len(), 1004);
    assert!(
        m.ready_line().contains("(1000 nodes)"),
        "{}",
        m.ready_line()
    );
}

#[test]
fn inode_numbers_in_a_listing_are_those_of_stat() {
    let Some(m) = mount("trikfs = { n = { src = '/dev/zero', input_tuple_size = 1 } }") else {
        return;
    };
    m.python(
        "for top in (M, M + '/n'):
    for entry in os.scandir(top):
        assert entry.inode() == os.stat(entry.path).st_ino, entry.path
        assert entry.is_dir() == os.path.isdir(entry.path)
",
    );
}
