//! Every limit of the tool, and nothing else.

/// How long a FIFO or a device that is read may say nothing.
pub const INPUT_SILENCE_MS: u16 = 3_000;
/// How long reading a FIFO or a device may take in all.
pub const INPUT_MS: u32 = 60_000;
/// Robots of one user that run side by side.
pub const ROBOTS_MAX: usize = 32;
/// Slowest and fastest course of simulated time: far below nothing moves, far above the threads cannot follow.
pub const SPEED_MIN: f64 = 0.1;
/// See [`SPEED_MIN`].
pub const SPEED_MAX: f64 = 20.0;
/// Bytes of a file with a world: more than any save may have.
pub const WORLD_FILE_BYTES_MAX: u64 = 64 << 20;
/// How often the view is drawn anew, or what was said is told.
pub const VIEW_MS: u16 = 100;
/// Characters of what the loudspeaker gave that a line tells: they fit into a pipe that has any room.
pub const SOUND_CHARS_MAX: usize = 500;
/// Names of diagrams that a message lists.
pub const DIAGRAM_NAMES_MAX: usize = 20;
/// Characters of a diagram's name that a message repeats.
pub const DIAGRAM_NAME_SHOWN_MAX: usize = 80;
/// How far a judged run may be ahead of the first one that is not done.
pub const RUNS_AHEAD_MAX: usize = 2_000;
/// Bytes of one path of a job of judged runs.
pub const JOB_BYTES_MAX: u64 = 64 << 10;
/// Characters of a name or a message that a terminal is shown.
pub const SHOWN_CHARS_MAX: usize = 400;
/// Seconds of a moment that a replay is sent to: far enough for any recording.
pub const SEEK_S_MAX: f64 = 1e9;
/// Time for the tree to be there.
pub const START_MS: u32 = 60_000;
/// Time for the tree to end after it was asked to, before it is forced.
pub const STOP_MS: u32 = 8_000;
/// Time for a process that stands on the tree to end before it is forced: its guardian forces the serving one after 8 s.
pub const COMPANION_STOP_MS: u32 = 10_000;
/// Time for a daemon that has lost its guardian to clean up, before the board goes.
pub const ORPHAN_MS: u32 = 8_000;
/// Longest line that is passed on from the processes of the tree.
pub const LINE_BYTES_MAX: usize = 16 << 10;
/// Bytes of a record of a running robot.
pub const RECORD_BYTES_MAX: u64 = 16 << 10;
/// Longest path of a directory for robots: names of sockets below it end at 107 bytes.
pub const BASE_BYTES_MAX: usize = 64;
/// How often a tree is started again whose guardian was killed.
pub const RESTARTS_MAX: usize = 5;
/// Bytes of the name of a robot (RFC 1035: names in the network have at most 253).
pub const HOST_BYTES_MAX: usize = 253;
/// Bytes of the name of a network interface, as Linux has it.
pub const ZONE_BYTES_MAX: usize = 15;
/// Addresses of one name that are tried.
pub const ADDRESSES_MAX: usize = 8;
/// Robots that are talked to at once.
pub const FLEET_MAX: usize = 64;
/// Answers that are looked at for that: who answers again and again is no reason to look for ever.
pub const FOUND_EVENTS_MAX: usize = 10_000;
/// Bytes of the name of a robot that is found, a multiple of three; a number behind it fits into the name of a class.
pub const FOUND_NAME_BYTES_MAX: usize = 57;
/// Bytes of a file that names the robots of a class.
pub const CLASS_BYTES_MAX: u64 = 64 << 10;
/// Bytes of the name of one of them, and of a group.
pub const CLASS_NAME_BYTES_MAX: usize = 64;
/// Time for a connection to a robot.
pub const CONNECT_MS: u32 = 5_000;
/// Time for the answer to a request; a stop waits for processes that die slowly.
pub const ANSWER_MS: u32 = 20_000;
/// Greatest program that is sent; a robot takes at most 256 MiB, and usually 16.
pub const UPLOAD_BYTES_MAX: u64 = 256 << 20;
/// The same for programs of blocks: what every robot takes, less the words of the request. One that refuses a message ends
/// the connection, and with it the changes of a program that goes on.
pub const BLOCKS_UPLOAD_BYTES_MAX: u64 = frame::limits::CONTROL_BYTES as u64 - 1024;
/// Programs from here on show how far they are on their way.
pub const PROGRESS_BYTES: usize = 256 << 10;
/// Greatest message of a robot.
pub const MESSAGE_BYTES_MAX: usize = 1 << 20;
/// Time without a sent byte after which a robot is told that somebody is there; it gives up after 5 s.
pub const KEEPALIVE_MS: u32 = 2_000;
/// Silence after which a robot counts as lost; it says something every 3 s.
pub const SILENCE_MS: u32 = 10_000;
/// How often a file that is watched is looked at.
pub const SAVE_LOOK_MS: u32 = 200;
/// Longest wait before clocks are looked at again.
pub const TURN_MS: u32 = 250;
/// Wait while the reader of the output has no room.
pub const ROOM_MS: u32 = 20;
/// Pieces of output that wait for the reader.
pub const OUTPUT_PIECES: usize = 64;
/// Bytes that a judged program prints between two calls; those beyond that are lost.
pub const SCRIPT_PRINT_BYTES: usize = 1 << 20;
/// Processes and threads of a judged program: the threads that it may have, and some more.
pub const SCRIPT_PROCESSES: u64 = 80;
/// The greatest number of a process of one that Linux counts none for: more than the numbers that it keeps for itself.
pub const SCRIPT_PID_MAX: u32 = 381;
/// Those of its control group, in which the process is that waits for it.
pub const GROUP_PROCESSES: u64 = 96;
/// Open files of each of them.
pub const SCRIPT_OPEN_FILES: u64 = 128;
/// Bytes of one file that it writes.
pub const SCRIPT_FILE_BYTES: u64 = 64 << 20;
/// Size of its scratch folder in memory, in MiB.
pub const SCRIPT_SCRATCH_MIB: u32 = 64;
/// Files in it.
pub const SCRIPT_SCRATCH_FILES: u32 = 4096;
/// What a process of it may compute beyond the real time of the run.
pub const SCRIPT_CPU_GRACE_S: u64 = 2;
/// Folders of solutions for which is asked in advance whether nobody could read them.
pub const SANDBOX_FOLDERS: usize = 500;
/// Folders that Python names as those that it reads.
pub const PYTHON_PATHS: usize = 64;
/// Bytes of what it says of that.
pub const PYTHON_PATHS_BYTES: u64 = 64 << 10;
/// How long Python may take to say that, and the steps of its sandbox to say what is missing.
pub const PYTHON_ANSWER_MS: u32 = 10_000;
/// Longest run that is judged, in seconds of model time.
pub const MODEL_SECONDS_MAX: f64 = 3600.0;
/// Longest run that is judged, in seconds of real time.
pub const WALL_SECONDS_MAX: f64 = 3600.0;
/// What a worker gets beyond the time of a run, for reading files, and again for writing pictures, in milliseconds.
pub const WORKER_GRACE_MS: u32 = 5_000;
/// What a run gets beyond its real time to end by itself before its worker is killed, in milliseconds: its processes are
/// killed in it, however many there are, and on a busy machine.
pub const RUN_GRACE_MS: u32 = 10_000;
/// Solutions of one command.
pub const SOLUTIONS_MAX: usize = 100_000;
/// Fields of one command.
pub const FIELDS_MAX: usize = 1_000;
/// Cells of the table of a class.
pub const CELLS_MAX: usize = 1_000_000;
/// How deep directories of solutions may nest.
pub const FOLDERS_DEEP: usize = 8;
/// Files and folders that are named when a class is judged without them; more are only counted.
pub const PASSED_MAX: usize = 1000;
/// Bytes of a world, a program or a file of inputs.
pub const WORLD_BYTES_MAX: u64 = 32 << 20;
/// Bytes of a recorded trajectory.
pub const LOG_BYTES_MAX: u64 = 256 << 20;
/// How late in a run a node may speak first: what it says then counts from the beginning.
pub(crate) const FIRST_SAMPLE_MS: u64 = 1_000;
/// Programs of a recording that a person is told of, so that one of them can be chosen.
pub(crate) const RUNS_TOLD: usize = 12;
/// Cells and runs of a table that is shown while it is judged.
pub const MARKS_MAX: usize = 10_000;
/// Bytes of what a worker says of one run.
pub const ROW_BYTES_MAX: usize = 4 << 20;
/// How often what a judged program has left behind is looked for and killed.
pub const SWEEPS: usize = 100;
/// Warnings of one world that are told.
pub const ROW_WARNINGS_MAX: usize = 20;
/// Bytes of the report of a run that a result of a queue has.
#[cfg(feature = "nats")]
pub const REPORT_BYTES_MAX: u64 = 256 << 10;
/// Messages of one run that a line of results has.
pub const ROW_MESSAGES_MAX: usize = 200;
/// Characters of one of them.
pub const ROW_MESSAGE_CHARS_MAX: usize = 2_000;
/// Bytes of one header of a message of an editor.
pub const LSP_HEADER_BYTES: usize = 4 << 10;
/// Bytes of a message of an editor: the longest document, with each of its letters written as six.
pub const LSP_MESSAGE_BYTES: u64 = 192 << 20;
/// Values of a message of an editor: numbers, texts, lists. Ten thousand changes at once have less than two hundred thousand.
pub const LSP_VALUES: usize = 1_000_000;
/// Bytes of the name of a request.
pub const LSP_ID_BYTES: usize = 256;
/// Messages of an editor that wait.
pub const LSP_WAITING: usize = 1000;
/// Bytes of messages that wait before no more are read.
pub const LSP_WAITING_BYTES: usize = 32 << 20;
/// Bytes of an open document.
pub const LSP_DOCUMENT_BYTES: usize = lang_dcml::limits::DCML_TEXT_MAX;
/// Bytes of all open documents.
pub const LSP_TEXT_BYTES: usize = 128 << 20;
/// Documents that are open at once.
pub const LSP_DOCUMENTS: usize = 1000;
/// Bytes of the name of a document.
pub const LSP_URI_BYTES: usize = 8 << 10;
/// Bytes of places of a document in one answer, roughly.
pub const LSP_ANSWER_BYTES: usize = 32 << 20;
/// Bytes of documents of which all is kept that is known, beside the one that is edited.
pub const LSP_READ_BYTES: usize = 4 << 20;
/// How often the server looks whether the editor is still there, while that says nothing.
pub const LSP_PARENT_MS: u64 = 10_000;
/// Lines of a table of actions, and of one that a simulation writes.
pub(crate) const DCML_ROWS_MAX: usize = 1_000_000;
/// Bytes of a table of actions.
pub(crate) const DCML_ACTIONS_BYTES_MAX: u64 = 64 << 20;
/// Panels of the picture of a simulation.
pub(crate) const DCML_PANELS_MAX: usize = 40;

/// Seconds that a drive takes at most: an hour.
pub(crate) const DRIVE_LONGEST_S: f64 = 3600.0;
/// How often a drive looks at encoders and writes to motors.
pub(crate) const DRIVE_TICK_MS: u64 = 20;
/// Servos have so long before a drive begins, and wheels twice as long after its end.
pub(crate) const DRIVE_SETTLE_MS: u64 = 300;
/// Degrees per second of a motor of TRIK at full power and 12 V.
pub(crate) const DRIVE_TOP_DEG_S: f64 = 1200.0;
/// A wheel that is farther away from its path ends a drive.
pub(crate) const DRIVE_LAG_DEG: f64 = 180.0;
/// A wheel that is so near to the end of its path has arrived.
pub(crate) const DRIVE_NEAR_DEG: f64 = 2.0;
/// Percent of power for each degree that a wheel is behind.
pub(crate) const DRIVE_GAIN: f64 = 0.5;
/// Servos turn so far to each side.
pub(crate) const DRIVE_SERVO_DEG: f64 = 90.0;
/// The weight of a task in the sum of a class, to either side of 0.
pub(crate) const WEIGHT_MAX: f64 = 1e6;
/// Moments of which `trik debug` keeps where the robot was: an hour.
pub const DEBUG_POSES_MAX: usize = 360_000;
/// Calls of a thread that `trik debug` shows.
pub const DEBUG_CALLS_SHOWN: usize = 100;
/// Blocks of one name that are shown to who has to choose one.
pub const CHOICES_MAX: usize = 8;
/// Characters of the line of each.
pub const CHOICE_CHARS_MAX: usize = 40;
/// Bytes of a line that is typed at `trik debug`.
pub const DEBUG_LINE_BYTES: usize = 16_384;
/// Bytes of one that is edited in a terminal, which is drawn again with each letter once it is longer than the screen is wide.
pub const DEBUG_TYPED_BYTES: usize = 1000;
/// Lines that can be had back there.
pub const DEBUG_HISTORY_LINES: usize = 1000;
/// Requests of an editor that debugs which wait for their turn.
pub const DAP_WAITING: usize = 1000;
/// Bytes of a sentence about a robot that is looked for in another language; what programs say may be longer.
pub const TRANSLATED_BYTES_MAX: usize = 1000;
/// Files whose breakpoints are kept for a restart of a program in Python.
pub const DAP_SOURCES_MAX: usize = 1000;
/// Connections that are accepted in one turn where a program in Python is awaited: as many as the system lets wait.
pub const RELAY_COMERS: usize = 128;
/// Connections there that have not said yet what they are: more than come in one turn, so that a crowd does not turn out the
/// program before its secret has arrived.
pub const RELAY_UNKNOWN_MAX: usize = 2 * RELAY_COMERS;
/// Events of a robot that wait for the debugger; the oldest are lost.
pub const DEBUG_EVENTS_MAX: usize = 10_000;
/// Threads, and variables, that `trik watch` shows.
pub const WATCH_LINES_MAX: usize = 40;
/// Slowest replay: a second of the recording in more than a minute and a half.
pub const REPLAY_SPEED_MIN: f64 = 0.01;
/// Fastest replay: far above, a daemon cannot take all events.
pub const REPLAY_SPEED_MAX: f64 = 1000.0;
/// Events that a player gives out before it listens to anybody again.
pub const REPLAY_BATCH: usize = 1_000;
/// Connections to a player: each node that is read and each that is written has one, and a guardian may have more.
pub const REPLAY_PEERS_MAX: usize = 2 * 4096 + 64;
/// Time in which one of them says what it wants, before the clock goes on without it.
pub const REPLAY_HELLO_MS: u64 = 100;
/// How late an event may be given before the clock waits for it.
pub const REPLAY_LATE_MS: u64 = 20;
/// How long after its beginning a recording may have the first of what its recorder found when it began.
pub const REPLAY_BEGINNING_MS: u64 = 100;
/// Bytes of what one connection says at once: the greatest tuple of a `played` source.
pub const REPLAY_MESSAGE_BYTES: usize = 128 << 10;
/// Keys that wait for the player.
pub const REPLAY_ORDERS_MAX: usize = 64;
/// Lines of news that wait to be told, and differences that are shown.
pub const REPLAY_NEWS_MAX: usize = 64;
/// Changes of one actuator that are compared.
pub const REPLAY_CHANGES_MAX: usize = 100_000;
/// Bytes of one text about a recorded world: what stands still in it, as the recorder takes it.
pub const REPLAY_WORLD_BYTES_MAX: usize = 256 << 10;
/// A recorded world is read on until a moment that is so near; to one further on it is sought.
pub const REPLAY_WORLD_NEAR_NS: u64 = 10_000_000_000;
/// Seconds of a moment of a recording: 30 years.
pub(crate) const RECORDING_SECONDS_MAX: f64 = 1e9;
/// How often a long work says how far it is.
pub(crate) const PROGRESS: std::time::Duration = std::time::Duration::from_millis(250);
/// Columns of a table: as many as spreadsheet programs take.
pub(crate) const TABLE_COLUMNS_MAX: usize = 16_384;
/// Panels of the picture of a recording.
pub(crate) const PLOT_PANELS_MAX: usize = 40;
/// Steps of time in such a picture, each with its least and greatest number: more than it has px.
pub(crate) const PLOT_STEPS: usize = 1_120;
/// Failures that are marked in a panel.
pub(crate) const PLOT_FAULTS_MAX: usize = 1_000;
/// Gaps within one step of time of such a picture.
pub(crate) const PLOT_GAPS_MAX: usize = 4;
/// Size of the black box of a virtual robot, in MiB: ten minutes of its nodes and its world, at some 50 KB/s.
pub const BOX_MIB: u16 = 32;
/// How often the world around a virtual robot is told to those who record it.
pub(crate) const TOLD_MS: u64 = 100;
/// The same while nothing moves in it.
pub(crate) const TOLD_AGAIN_MS: u64 = 1_000;
/// Letters of a tuple in a line about a difference.
pub(crate) const DIFF_SHOWN_CHARS: usize = 60;
/// Panels of one node in a picture of differences: not each ray of a lidar.
pub(crate) const DIFF_PANELS_MAX: usize = 8;
/// Names of files that are told if another one was meant.
pub(crate) const FILES_TOLD: usize = 20;
/// Events that another configuration converts between two looks whether somebody wants an end.
pub(crate) const ANEW_STEPS: usize = 256;
/// Lines of programs that wait for a bridge.
pub(crate) const STORIES: usize = 1_024;
/// When a robot is asked again that did not tell of its programs.
pub(crate) const STORIES_AGAIN_MS: u64 = 2_000;
/// Bytes of texts and pictures after which rows of a table are written.
#[cfg(feature = "parquet")]
pub(crate) const TABLE_GROUP_BYTES: usize = 32 << 20;
/// Cells of a table in Parquet that are in memory, and rows.
#[cfg(feature = "parquet")]
pub(crate) const TABLE_CELLS: usize = 4 << 20;
#[cfg(feature = "parquet")]
pub(crate) const TABLE_ROWS: usize = 65_536;
/// Bytes of a file with a password or certificates.
pub const SECRET_BYTES_MAX: u64 = 256 << 10;
/// Bytes of a file of the studio.
pub(crate) const SITE_FILE_BYTES_MAX: u64 = 16 << 20;
/// Files of the studio.
pub(crate) const SITE_FILES_MAX: usize = 200;
