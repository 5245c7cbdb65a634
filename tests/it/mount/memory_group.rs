//! Memory that a control group limits: what the daemon may hold follows from it, and the kernel's kill is survived.

use super::limits::GREEDY;
use crate::program;
use harness::wait::eventually;
use harness::{Board, Mount, Setting, processes};
use std::fs;
use std::path::{Path, PathBuf};
use std::sync::atomic::{AtomicUsize, Ordering};

/// A control group of our own. It goes with the test, after the mount that is in it.
struct Group {
    folder: PathBuf,
}

impl Group {
    /// None: this machine lets us make none, which has been said by name.
    fn new(mib: u64) -> Option<Self> {
        // cgroups(7): the first version has a tree for each controller, the second one for all.
        let kinds = [
            ("/sys/fs/cgroup/memory", "memory.limit_in_bytes"),
            ("/sys/fs/cgroup", "memory.max"),
        ];
        // Tests beside this one make groups of the same size.
        static COUNT: AtomicUsize = AtomicUsize::new(0);
        let number = COUNT.fetch_add(1, Ordering::Relaxed);
        let name = format!("trikfs-it-{}-{number}", std::process::id());
        for (tree, limit) in kinds {
            // Where the first version is, the other place is a plain folder, in which anything can be written.
            let folder = Path::new(tree).join(&name);
            if !Path::new(tree).join("cgroup.procs").exists() || fs::create_dir(&folder).is_err() {
                continue;
            }
            let group = Self { folder };
            if fs::write(group.folder.join(limit), (mib << 20).to_string()).is_ok() {
                return Some(group);
            }
        }
        harness::wait::note_skip("no control group with a limit of memory can be made here");
        None
    }

    /// The mounted configuration, whose processes are all in the group.
    fn mount(&self, board: Board, config: &str) -> Option<Mount> {
        let enter = format!(
            "echo $$ > {}/cgroup.procs && exec \"$0\" \"$@\"",
            self.folder.display()
        );
        Mount::new(Setting {
            program: program(),
            board,
            config,
            options: &["--allow-other"],
            launcher: &["sh", "-c", &enter],
        })
    }
}

impl Drop for Group {
    fn drop(&mut self) {
        // The kernel keeps it until the last process has been waited for.
        let gone = || fs::remove_dir(&self.folder).is_ok();
        if std::thread::panicking() {
            let _ = gone();
        } else {
            eventually("the end of the control group", gone);
        }
    }
}

#[test]
fn a_daemon_that_the_kernel_kills_for_its_memory_leaves_motors_at_rest_and_comes_back() {
    let Some(group) = Group::new(192) else { return };
    let board = Board::new();
    board.file("motor", "..");
    // What native code allocates is charged to nobody, so this comes to the limit whatever open files may hold.
    let config = "trikfs = {
      motor = { src = '$DIR/motor', input_tuple_size = 2, rest = { 0, 7 } },
      greedy = { src = '/dev/zero', input_tuple_size = 1, output_tuple_size = 1, converter = { code = [[
#include <stdlib.h>
#include <string.h>
static char *volatile kept;
int converter(int in_s, char *in, int out_s, char *out)
{ kept = malloc(8 << 20); if (kept) memset(kept, 1, 8 << 20); out[0] = kept != 0; return 0; }
]] } },
    }";
    let Some(m) = group.mount(board, config) else {
        return;
    };
    m.sh("printf dd > motor/device");
    assert_eq!(m.board().content("motor"), b"dd");
    let daemon = m.daemon();
    let mut reads = 0;
    while m.errno("greedy/bin_data") == 0 {
        reads += 1;
        assert!(reads < 1000, "more than the group allows");
    }
    eventually("rest", || m.board().content("motor") == [0, 7]);
    eventually("another daemon", || {
        processes::children(m.guardian())
            .iter()
            .any(|&pid| pid != daemon)
    });
    eventually("the tree", || m.read("motor/units").is_ok());
    m.sh("printf ee > motor/device");
    assert_eq!(m.board().content("motor"), b"ee");
    let said = m.complaints();
    assert!(
        said.contains("killed by SIGKILL; starting it again"),
        "{said}"
    );
}

#[test]
fn who_only_reads_takes_a_part_of_what_the_group_allows() {
    let Some(group) = Group::new(128) else { return };
    let config = "local big = string.rep('x', 300000)
      trikfs = { n = { src = '/dev/zero', input_tuple_size = 1, output_tuple_size = 1,
        converter = function(a_s, a, b_s, b) ba.set(b, 0, #big == 300000 and 1 or 0) end } }";
    let Some(m) = group.mount(Board::new(), config) else {
        return;
    };
    let daemon = m.daemon();
    m.python(&format!(
        "{GREEDY}
number, count, end = greedy('n/device')
assert number == errno.ENOMEM, (number, count)
# A quarter of an eighth of 128 MiB.
assert 4 <= count <= 16, count
assert os.read(open_ro(M + '/n/device'), 1) == b'\\1'
end()
"
    ));
    assert_eq!(m.daemon(), daemon, "{}", m.complaints());
}

#[test]
fn a_configuration_has_as_many_isolated_nodes_as_the_group_has_room_for() {
    let Some(group) = Group::new(512) else { return };
    let board = Board::new();
    board.file("in", [0]);
    board.library(
        "plus.so",
        "int converter(int in_s, char *in, int out_s, char *out) { out[0] = in[0] + 1; return 0; }",
    );
    let config = |count: u32, name: &str| {
        format!(
            "trikfs = {{}} for i = 1, {count} do trikfs['{name}' .. i] = {{ src = '$DIR/in', input_tuple_size = 1, output_tuple_size = 1, isolate = true, converter = 'plus.so' }} end"
        )
    };
    let Some(m) = group.mount(board, &config(8, "n")) else {
        return;
    };
    let before = processes::children(m.daemon());
    assert_eq!(before.len(), 8);
    for node in 1..=8 {
        assert_eq!(m.read(&format!("n{node}/device")).unwrap()[0], 1);
    }
    let line = m.apply(&config(9, "n")).unwrap_err();
    assert_eq!(
        line,
        "config refused: config:1: node n9: isolate: the configuration has 9 isolated nodes, each with a process that may take 64 MiB, and 512 MiB of memory have room for 8 of them; leave isolate away where you trust the code, or convert several values in one node"
    );
    assert_eq!(processes::children(m.daemon()), before);
    assert_eq!(m.read("n8/device").unwrap()[0], 1);
    // Nobody keeps processes of nodes that leave by an open file.
    let mut kept = Vec::new();
    for round in 0..4 {
        let name = if round % 2 == 0 { "m" } else { "n" };
        m.apply(&config(8, name)).unwrap();
        kept.push(m.open(&format!("{name}1/device")));
        eventually("eight processes", || {
            processes::children(m.daemon()).len() == 8
        });
    }
    assert_eq!(m.read("n8/device").unwrap()[0], 1);
}

#[test]
fn rings_in_shared_memory_take_a_part_of_what_the_group_allows() {
    let Some(group) = Group::new(128) else { return };
    // A ring of such tuples takes some MiB, and all of them more than an eighth of 128.
    let node = "{ src = '/dev/zero', input_tuple_size = 1, output_tuple_size = 65536, poll_ms = 1000, converter = function() end }";
    let nodes: String = (0..40).map(|n| format!("n{n} = {node}, ")).collect();
    let Some(m) = group.mount(Board::new(), &format!("trikfs = {{ {nodes} }}")) else {
        return;
    };
    let log = m.log();
    assert!(
        log.contains("the rings of this mount would take more than 16 MiB"),
        "{log}"
    );
    assert_eq!(m.read("n39/bin_data").unwrap().len(), 65536);
}
