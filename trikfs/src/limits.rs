//! Every limit of the running filesystem. Those of a configuration are in `config::limits`.
//!
//! Owns the numbers only; the code that enforces each one names it from here.

use std::time::Duration;

/// Threads that may serve one role (the kernel, events, the schedule) while others of that role are late.
pub const MAX_THREADS: usize = 64;
/// Transfers that wait for one bus at once.
pub const BUS_WAITERS_MAX: usize = 24;
/// Transfers that may join those that wait for a bus that is stuck. With [`LATE_PER_NODE_MAX`] operations on each of
/// their nodes, those of two dead buses leave threads for everything else.
pub const BUS_WAITERS_STUCK_MAX: usize = 6;
/// Milliseconds that one transfer may take before a bus counts as stuck.
pub const BUS_STUCK_MS: u64 = 50;
/// Microseconds from which a transfer counts as slow: others must not wait for it.
pub const BUS_SLOW_US: u64 = 500;
/// Fast transfers after a slow one until a bus counts as fast again.
pub const BUS_SLOW_TRANSFERS: u32 = 64;
/// How often it is looked whether a bus in use is still there, at most.
pub const BUS_LOOK_MS: u64 = 250;
/// Bytes of data that a bus of 100 kHz moves within [`BUS_SLOW_US`], about.
pub const BUS_SHORT_BYTES: usize = 8;
/// Buses whose nodes are sampled by a thread of their own.
pub const BUS_THREADS_MAX: usize = 16;
/// Registers of one bus that are remembered, in each of two ways.
pub const BUS_MEMORY_MAX: usize = 4_096;
/// Milliseconds that the actions of `setup` may keep a configuration from coming into force.
pub const SETUP_WAIT_MS: u64 = 3_000;
/// Milliseconds beyond its time limit after which an action that hangs in a device is given up.
pub const SETUP_GRACE_MS: u64 = 100;
/// Actions that may hang in a device before no further ones are tried.
pub const SETUP_STUCK_MAX: usize = 8;
/// Bytes of the output of a program of `setup` that are told.
pub const SETUP_OUTPUT_BYTES: usize = 512;
/// Open files at once; the next open gets EMFILE. See `admission` for how many of them may be whose.
pub const OPEN_FILES_MAX: usize = 65_536;
/// The open files of everybody may hold this part of the machine's memory: an eighth leaves the rest of a small board to the
/// programs that drive it.
pub const OPEN_MEMORY_PART: u64 = 8;
/// ... but so many bytes in any case: a few hundred converters in Lua.
pub const OPEN_BYTES_LEAST: usize = 16 << 20;
/// ... and no more than this on any machine.
pub const OPEN_BYTES_MOST: usize = 512 << 20;
/// All users but the owner and root may hold this part of it together, and of the open files.
pub const OPEN_PART_OF_OTHERS: usize = 2;
/// One of them may hold this part.
pub const OPEN_PART_OF_ONE: usize = 4;
/// Bytes that an open file takes without what is behind it.
pub const OPEN_FILE_BYTES: usize = 1024;
/// Bytes of the text of one number of a tuple, which an open `valueN` keeps.
pub const NUMBER_TEXT_BYTES: usize = 32;
/// Bytes that `status` has for each node, about, which its open file keeps.
pub const STATUS_LINE_BYTES: usize = 64;
/// Bytes of a tuple that `stages` shows.
pub const STAGE_BYTES_MAX: usize = 1024;
/// Bytes of memory of the smallest board.
pub const MACHINE_BYTES_LEAST: u64 = 192 << 20;
/// Tuples that a slow reader of a shared source may be behind before the oldest are dropped.
pub const QUEUE_TUPLES: usize = 256;
/// Bytes of such tuples, if fewer than [`QUEUE_TUPLES`] take them.
pub const QUEUE_BYTES: usize = 1 << 20;
/// Bytes read from a source at once.
pub const READ_BYTES: usize = 128 << 10;
/// Tuples that one request converts without getting any output before it gives way.
pub const CONSUMED_TUPLES_MAX: usize = 4_096;
/// Rounds of reading one shared source before other events get their turn.
pub const PUMP_ROUNDS: usize = 64;
/// Bytes of shared memory that the sample bus of one mount takes.
pub const SAMPLE_BUS_BYTES_MAX: usize = 64 << 20;
/// ... and no more than this part of the memory that there is.
pub const SAMPLE_BUS_PART: u64 = 8;
/// Bytes of the log that are kept.
pub const LOG_BYTES: usize = 64 << 10;
/// Bytes of one recording.
pub const RECORDING_BYTES_MAX: usize = 16 << 20;
/// Milliseconds between two looks whether an open source is still at its path.
pub const PRESENCE_MS: u64 = 500;
/// Time from which a background sample lasts: the next one of its node is taken while another thread watches the clock.
pub const SAMPLE_SOON: Duration = Duration::from_millis(1);
/// Milliseconds after which a source whose turn it is not, and that has given nothing since it was opened, counts as silent:
/// its readers are told so within 50 ms.
pub const SILENCE_MS: u64 = 40;
/// Milliseconds that a write to a sampled node waits for the next sample.
pub const RENEWAL_MS: u64 = 100;
/// Milliseconds that the clock goes on sampling after the last one who needed it: a program that opens, reads and closes
/// again and again finds the node at work.
pub const SAMPLING_LINGER_MS: u64 = 1_000;
/// Milliseconds between attempts to open a lost device again.
pub const REOPEN_MS: u64 = 250;
/// Milliseconds without an opening or closing after which the stock of Lua states is small again.
pub const LUA_STATES_QUIET_MS: u64 = 200;
/// Milliseconds that the making and closing of Lua states is put off, to do more of it at once.
pub const LUA_STATES_BATCH_MS: u64 = 2;
/// Nice value of the thread that makes and closes Lua states.
pub const LUA_STATES_NICE: i32 = 10;
/// Prepared Lua states after many openings in a row.
pub const LUA_STATES_READY: usize = 32;
/// Largest errno of Linux (`MAX_ERRNO` of linux/err.h).
pub const ERRNO_MAX: i32 = 4095;
/// Bytes of a reason that a player gives for a recorded failure; the rest is cut.
pub const REASON_BYTES_MAX: usize = 512;
/// Bytes of the text of one number that is written.
pub const TEXT_BYTES_MAX: usize = 64 << 10;
/// Milliseconds until an event that found too many operations inside its node is looked at again.
pub const RETRY_MS: u64 = 20;
/// Milliseconds beyond its budget after which an operation inside a node counts as stuck for good.
pub const STUCK_MS: u32 = 2_000;
/// Operations inside one node that may be late at the same time before others are refused.
pub const LATE_PER_NODE_MAX: usize = 4;
/// Milliseconds that another one waits for a place, if one of those inside began no longer ago than that.
pub const CROWDED_PATIENCE_MS: u32 = 20;
/// How often it looks, beside being woken.
pub const CROWDED_LOOK: Duration = Duration::from_millis(1);
/// Operations that may wait so for one node: each holds a thread.
pub const CROWDED_PER_NODE_MAX: u32 = 6;
/// Milliseconds of one `stop` before it goes on to the next actuator is bounded by each node's `timeout_ms`;
/// this bounds the number of actuators brought to rest at once.
pub const REST_THREADS_MAX: usize = 8;
/// Milliseconds that a write waits for an actuator that is coming to rest after a lease.
pub const REST_WAIT_MS: u64 = 1_000;
/// Highest priority that a lease can be asked for with.
pub const LEASE_PRIORITY_MAX: u32 = 100;
/// Longest time in milliseconds that a dead-man's clock can be set to.
pub const DEADMAN_MS_MAX: u32 = 60_000;
/// How long a call on the kernel's device that fails for a reason that may pass is tried again. Callers wait meanwhile, and a
/// kernel that is short of memory frees some in less.
pub const KERNEL_PATIENCE: Duration = Duration::from_secs(2);
/// Longest pause between two of these tries.
pub const KERNEL_PAUSE_MAX: Duration = Duration::from_millis(32);
/// Bytes of data in one read or write request of the kernel; a larger one is served in part.
pub const TRANSFER_BYTES_MAX: usize = 128 << 10;
/// Requests without a waiting caller (releases, read-ahead) that the kernel may have under way.
pub const BACKGROUND_MAX: u16 = 64;

/// Bytes that a port of lines, packets or samples reads at once.
pub const PORT_READ_BYTES: usize = 4096;
/// Bytes that such a port looks at without finding anything before others get their turn.
pub const CUT_BYTES_MAX: usize = 64 << 10;
/// Entries of the folder of IIO devices that are looked at.
pub const IIO_DEVICES_MAX: usize = 256;
/// Files of one IIO device's scan elements that are looked at.
pub const IIO_FILES_MAX: usize = 1024;
/// Samples that the kernel keeps of an IIO device while nobody reads.
pub const IIO_BUFFER_SAMPLES: u32 = 128;
/// Milliseconds that the start of a sensor's program may take.
pub const PROGRAM_START_MS_MAX: u32 = 30_000;
/// Milliseconds that its stop may take.
pub const PROGRAM_STOP_MS_MAX: u32 = 10_000;
/// Milliseconds that a program goes on after its last user: one that comes back at once finds it running.
pub const PROGRAM_LINGER_MS: u64 = 1_000;
/// Milliseconds until a start that has failed is tried again.
pub const PROGRAM_RETRY_MS: u64 = 5_000;
/// Milliseconds that the end of a mount waits for programs to stop.
pub const PROGRAM_END_MS: u64 = 1_500;
/// Bytes of output of a start or stop that go to the log.
pub const PROGRAM_OUTPUT_BYTES_MAX: usize = 4096;
/// How long actuators that hang may keep a new tree from being ready.
pub const START_REST_MS_MAX: u32 = 2_000;
/// Texts that wait for a program that is run for each.
pub const PROGRAM_TEXTS_MAX: usize = 8;
/// How long one run of it may take.
pub const PROGRAM_TEXT_MS_MAX: u32 = 60_000;
/// Milliseconds that a sensor's pipe may take to appear once its program has been started.
pub const LINES_APPEAR_MS: u64 = 20_000;
/// Milliseconds between two looks for it.
pub const LINES_LOOK_MS: u64 = 50;

/// Libraries that the cache directory keeps.
pub const CACHE_FILES_MAX: usize = 256;
/// Bytes of libraries that the cache directory keeps.
pub const CACHE_BYTES_MAX: u64 = 256 << 20;
/// Bytes of one shared library.
pub const LIBRARY_BYTES_MAX: u64 = 64 << 20;
/// Seconds that a compiler may take for one piece of inline C.
pub const COMPILE_SECONDS_MAX: u32 = 30;
/// Bytes of compiler output that are kept.
pub const COMPILE_OUTPUT_BYTES_MAX: usize = 64 << 10;
/// KiB of memory that each process of a compiler may take.
pub const COMPILE_MEMORY_KB_MAX: u32 = 512 << 10;
/// How long an isolated converter may take for one tuple, beside the node's `budget_us`. Less than the usual `timeout_ms` and
/// than what makes a node count as stuck ([`STUCK_MS`]): its callers get its own error before.
pub const ISOLATED_PATIENCE: Duration = Duration::from_millis(800);
/// How often that time may pass during a batch that goes on.
pub const ISOLATED_BATCH_WAITS: u32 = 10;
/// How long its process may take to load a library.
pub const ISOLATED_LOAD_PATIENCE: Duration = Duration::from_secs(5);
/// How often it is looked whether a process that has not answered yet is dead.
pub const ISOLATED_LOOK: Duration = Duration::from_millis(5);
/// How long it may take to close the states of files that are closed.
pub const ISOLATED_CLOSE_PATIENCE: Duration = Duration::from_millis(200);
/// Time without a word after which it is asked first whether the process still lives: one that somebody has ended costs nobody
/// a tuple then.
pub const ISOLATED_IDLE: Duration = Duration::from_millis(20);
/// How often a process that nobody asks looks whether its daemon lives, beside what the kernel does.
pub const ISOLATED_ORPHAN_LOOK: Duration = Duration::from_secs(10);
/// Bytes of tuples in the memory that it shares with the daemon, in each direction.
pub const ISOLATED_BYTES: usize = 128 << 10;
/// Tuples of one batch: how many of them are done is half a word.
pub const ISOLATED_TUPLES: usize = 0xffff;
/// Bytes up to which a single tuple travels in a message.
pub const ISOLATED_TUPLE_BYTES: usize = 4 << 10;
/// Bytes of one message: 256 params with their names, and lines of the log, are the longest.
pub const ISOLATED_MESSAGE_BYTES: usize = 32 << 10;
/// Lines that a converter may log while it is opened.
pub const ISOLATED_LOG_LINES: usize = 16;
/// Bytes of these lines together.
pub const ISOLATED_LOG_BYTES: usize = ISOLATED_MESSAGE_BYTES / 2;
/// Isolated nodes of one configuration: as many as could take [`ISOLATED_DATA_BYTES`] each of all the memory that there is,
/// which hardly any does, but so many on the smallest board,
pub const ISOLATED_NODES_LEAST: usize = 8;
/// ... and no more than these on any computer: a user has a number of processes, and a start takes milliseconds.
pub const ISOLATED_NODES_MOST: usize = 256;
/// Nodes that the line names which tells that the kernel cannot confine isolated converters.
pub const ISOLATED_NODES_NAMED: usize = 8;
/// MiB of memory that all its states may take together.
pub const ISOLATED_DATA_MIB: u32 = 64;
/// Bytes of addresses beside those of the program and that memory: libraries, and what no limit of data counts.
pub const ISOLATED_LIBRARY_BYTES: libc::rlim_t = 64 << 20;
/// Pause before another process is started after a second death; it doubles with each,
pub const ISOLATED_PAUSE: Duration = Duration::from_millis(100);
/// ... up to this.
pub const ISOLATED_PAUSE_MAX: Duration = Duration::from_secs(2);
/// A process that has lived so long is replaced at once.
pub const ISOLATED_CALM: Duration = Duration::from_secs(10);
/// Crashes within [`CRASH_WINDOW_SECONDS`] after which the filesystem is not started again.
pub const CRASHES_MAX: usize = 5;
/// Seconds that a crash is remembered.
pub const CRASH_WINDOW_SECONDS: u32 = 60;
/// Milliseconds from asking the daemon to end to ending it.
pub const GRACE_MS: u32 = 2_000;
/// Milliseconds that a daemon may be stopped before it is taken for dead.
pub const STOPPED_MS: u32 = 1_000;
/// Panics that `status` tells in words.
pub const PANICS_KEPT: usize = 8;
/// Characters of each.
pub const PANIC_WORDS_MAX: usize = 240;
/// Milliseconds between two looks of the daemon whether its guardian is stopped, while an actuator is driven.
pub const GUARDIAN_LOOK_MS: u64 = 400;
/// Time from the end of a daemon's lifeline to its end, which takes a moment; callers wait meanwhile.
pub const REAP_PATIENCE: Duration = Duration::from_millis(5);
/// Time that a dead daemon may still hang once its connection is cut off. Actuators are at rest by then. All that a guardian
/// waits for at the end is less than what a service manager gives it ([`GRACE_MS`], this, [`FIRST_REST`], [`REST_MS_MAX`]).
pub const CUT_OFF_PATIENCE: Duration = Duration::from_secs(2);
/// Time for the actuators before the last thread of a dead daemon has ended: one that hangs has more the second time.
pub const FIRST_REST: Duration = Duration::from_secs(1);
/// Bytes that the guardian gives back when the daemon has died: for the threads that bring actuators to rest and what they open.
pub const RESERVE_BYTES: usize = 256 << 10;
/// Pause between two looks whether it has ended.
pub const REAP_PAUSE: Duration = Duration::from_millis(1);
/// Milliseconds that bringing all actuators to rest may take.
pub const REST_MS_MAX: u32 = 3_000;
/// Rest actions in one ledger.
pub const REST_ACTIONS_MAX: usize = 4096;
/// Bytes of all rest actions in one ledger.
pub const REST_BYTES_MAX: usize = 4 << 20;
/// Bytes of the list of loaded libraries in one ledger.
pub const COPIES_BYTES_MAX: usize = 1 << 20;
/// Node ids with cached values in one ledger.
pub const CACHED_MAX: usize = 4096;
/// A mistake that a caller repeats within so many ms is not told again.
pub const MISTAKE_MS: u32 = 1000;
/// Bytes that `trikfs convert` reads at a time.
pub const CONVERT_CHUNK_BYTES: usize = 64 << 10;
/// Reasons of refusals that `trikfs convert` tells apart.
pub const FAULT_REASONS_MAX: usize = 16;

/// Time that one rest action may take before the next one is begun beside it.
pub const REST_PATIENCE: Duration = Duration::from_millis(50);
/// Longest line that a daemon has to say to its guardian; a longer one is nonsense and is dropped.
pub const LIFE_LINE_BYTES_MAX: usize = 64;
/// Milliseconds between two looks whether a process that holds its output open has ended.
pub const COMMAND_LOOK_MS: u16 = 50;
/// Time between two looks whether a process that has closed its output has ended; it usually has.
pub const COMMAND_SETTLE: Duration = Duration::from_millis(1);
/// Bytes of the complaint of the mounting helper that are passed on.
pub const HELPER_COMPLAINT_BYTES_MAX: u64 = 4096;
/// How often a list of mounts that changes while it is read is read again before it is taken as it is.
pub const MOUNT_TABLE_READS_MAX: usize = 16;
/// Bytes of the list of mounts that are read; a longer one is not believed.
pub const MOUNT_TABLE_BYTES_MAX: u64 = 16 << 20;
/// Age from which an abandoned temporary file is removed from the cache; far above the time limit of a compiler.
pub const CACHE_TEMPORARY_AGE: Duration = Duration::from_secs(3600);
/// Generations of processes that are looked at for an ancestor; a longer line does not lead to one.
pub const GENERATIONS_MAX: usize = 64;
/// Bytes of the name of a new converter.
pub const PROJECT_NAME_BYTES_MAX: usize = 32;
/// Bytes of `status` that are looked at for the reason of a refusal.
pub const STATUS_BYTES_MAX: u64 = 64 << 10;
/// Longest line that the guardian in the background prints.
pub const READY_LINE_BYTES_MAX: u64 = 16 << 10;
/// Bytes of an attribute of sysfs: one page.
pub const ATTRIBUTE_BYTES_MAX: u64 = 4096;
/// Time between two attempts to bring an actuator to rest whose device is busy.
pub const REST_PAUSE: Duration = Duration::from_millis(1);
/// Prepared Lua states at rest.
pub const LUA_STATES_FIRST: usize = 4;
/// Threads with which the crate fuser serves the mount. More cost every request some 15 %, fewer let a single late
/// operation stop it.
pub const FUSER_THREADS: usize = 4;
/// How long the kernel may keep what does not change by itself; a reload invalidates it.
pub const KEPT_LONG: Duration = Duration::from_secs(86_400);
/// How long `stat` of a value may be old.
pub const KEPT_SHORT: Duration = Duration::from_secs(1);
/// Bytes of a refused tuple that a message shows.
pub const FAULT_SHOWN_BYTES: usize = 16;
