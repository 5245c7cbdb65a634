//! Integration tests: the program as people use it, mostly on real mounts.
//!
//! One binary, so that helpers are shared and linking happens once. Below is the table of contents.

/// Configurations that must be refused with a place and a reason.
mod config {
    /// What only somebody hostile would write.
    mod hostile;
    /// Mistakes, and the words that tell of them.
    mod problems;
}
/// The three languages of converters.
mod converters {
    /// Several stages, several sources, nodes that read nodes.
    mod chain;
    /// Programs of data flow, in Lua and in C.
    mod dataflow;
    /// Several nodes in one converter: pace, ages, one moment, numbers changed on the way.
    mod fusion;
    /// Loops, greed and nonsense cost their own file only.
    mod hostile;
    /// C source in the configuration.
    mod inline_c;
    /// Machine code in processes of their own.
    mod isolated;
    /// Projects for authors, from the first command to the mounted node.
    mod kit;
    /// Functions of the configuration, each open file with a state of its own.
    mod lua;
    /// Libraries: plain, versioned, replaced.
    mod shared;
    /// `trikfs convert`: forms, reports, times, vectors, random bytes.
    mod trial;
    /// The shipped filters in both languages against the golden vectors.
    mod vectors;
}
/// Devices that are more than a file, with files, pipes and sockets in their place.
mod devices {
    /// Single lines.
    mod gpio;
    /// Registers on a bus that is fine, slow, dead, gone and back.
    mod i2c;
    /// Sampled sensors.
    mod iio;
    /// Text of sensor programs.
    mod lines;
    /// Serial lines.
    mod packets;
    /// Channels of a player.
    mod played;
    /// Texts for programs.
    mod program;
    /// Pulses.
    mod pwm;
    /// A regulator whose motor is on a bus.
    mod regulated_bus;
    /// Actions that are done once, and the root of a virtual board.
    mod setup;
    /// A slow bus delays nobody who does not use it.
    mod slow_bus;
    /// A bus whose nodes nobody reads.
    mod unread_bus;
}
/// One module for each operation or file of a mounted tree.
mod mount {
    /// Second names of nodes, and nodes that are written through others.
    mod aliases;
    /// Further files in a node's directory.
    mod attributes;
    /// Writing and reading the configuration of a live tree.
    mod config_node;
    /// Decoded input events.
    mod evdev;
    /// What is told of failures, and by whom they are to be mended.
    mod fault;
    /// Named pipes: every reader sees every tuple, writers come and go.
    mod fifo;
    /// Modes, owners, sizes, times.
    mod getattr;
    /// Death of the daemon, of the guardian, of both.
    mod guardian;
    /// The example that ships, as the thesis describes it.
    mod hello;
    /// Who may write an actuator, and what becomes of it when that one ends.
    mod lease;
    /// Many open files, large tuples, many nodes.
    mod limits;
    /// What converters and the filesystem report.
    mod log;
    /// Names.
    mod lookup;
    /// A control group that allows less memory than the machine has.
    mod memory_group;
    /// Who may open what, and what opening may cost.
    mod open;
    /// Newest values without a round trip.
    mod page_cache;
    /// select, poll and epoll.
    mod poll;
    /// Terminals.
    mod pty;
    /// Streams, any read size, waiting and being killed while waiting.
    mod read;
    /// What was written, read again.
    mod read_back;
    /// Directories.
    mod readdir;
    /// A new configuration under open files.
    mod reload;
    /// What is taken away from under a tree that is used.
    mod removed;
    /// Recordings and made-up bytes.
    mod replay;
    /// Every kind of actuator comes to rest.
    mod rest;
    /// Samples in shared memory.
    mod sample_bus;
    /// Bytes on their way through converters.
    mod stages;
    /// The ready line, the background, the service manager, refusals.
    mod start;
    /// One line per node.
    mod status;
    /// Bringing actuators to rest.
    mod stop;
    /// Leaving, also while somebody waits.
    mod unmount;
    /// Newest values.
    mod value;
    /// Programs to devices.
    mod write;
    /// Extended attributes.
    mod xattr;
}
/// The shipped description of the controller, without hardware: bytes against numbers worked out by hand.
mod trik_lua {
    /// Speed that is held, heading, place.
    mod drive;
    /// Analog ports, battery, encoders.
    mod inputs;
    /// Motors and servos.
    mod outputs;
    /// Robot files, good and bad.
    mod robots;
    /// A robot whose converters are called one by one.
    pub mod run;
    /// Sensors that deliver by themselves: distance, keys, IIO, lines, packets.
    mod streams;
    /// The tables of docs/user/trik.md.
    mod tables;
    /// The program behind the tones.
    mod tone;
}
/// The documents: their examples run, their tables are complete.
mod docs;
/// Fuzz targets, briefly, with a printed seed.
mod fuzz;
/// Streams against a naive model.
mod model;

use harness::{Board, Mount, Setting};
use std::sync::OnceLock;

/// The program under test: the one built with the tests, or an installed one that `TRIKFS_UNDER_TEST` names.
fn program() -> &'static str {
    static PROGRAM: OnceLock<String> = OnceLock::new();
    PROGRAM.get_or_init(|| {
        std::env::var(UNDER_TEST)
            .unwrap_or_else(|_| env!("CARGO_BIN_EXE_trikfs-under-test").to_owned())
    })
}

/// Whether the program under test is the controller's, which is smaller than that of this PC.
fn is_of_the_controller() -> bool {
    const ARM: [u8; 2] = [40, 0];
    std::fs::read(program()).is_ok_and(|elf| elf.get(18..20) == Some(&ARM[..]))
}

const UNDER_TEST: &str = "TRIKFS_UNDER_TEST";

/// A mounted configuration on an empty board; None if nothing can be mounted here.
fn mount(config: &str) -> Option<Mount> {
    mount_on(Board::new(), config)
}

/// A mounted configuration on a prepared board.
fn mount_on(board: Board, config: &str) -> Option<Mount> {
    mount_with(board, config, &[])
}

/// The same with options of the command line.
fn mount_with(board: Board, config: &str, options: &[&str]) -> Option<Mount> {
    Mount::new(Setting {
        program: program(),
        board,
        config,
        options,
        launcher: &[],
    })
}

/// The program with arguments, run to its end on a board's folder.
fn trikfs(board: &Board, arguments: &[&str], input: &[u8]) -> harness::Output {
    let mut command = std::process::Command::new(program());
    harness::run(command.args(arguments).current_dir(board.dir()), input)
}

/// True if a thread that waits for a device is relieved of serving the kernel: the fuser crate has a few fixed threads.
fn late_threads_are_relieved() -> bool {
    let are = harness::mount::transport() == "native";
    if !are {
        harness::wait::note_skip("the fuser transport serves the kernel with four threads");
    }
    are
}

/// True if a reader that waits in the daemon can be killed: a limit of the fuser crate, which its file documents.
fn waiting_readers_can_be_killed() -> bool {
    let can = harness::mount::transport() == "native";
    if !can {
        harness::wait::note_skip("the fuser transport cannot interrupt a waiting request");
    }
    can
}
