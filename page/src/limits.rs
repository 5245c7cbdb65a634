//! Every limit of the page's server.
//!
//! Owns the numbers only; the code that enforces each one names it from here.

use std::time::Duration;

/// Browsers that look at once.
pub const BROWSERS_MAX: usize = 40;
/// Connections at once, with those that only fetch a file.
pub const CONNECTIONS_MAX: usize = 128;
/// Those of them that one computer may have.
pub const CONNECTIONS_OF_ONE_MAX: usize = 96;
/// Places beside these for browsers of this machine.
pub const CONNECTIONS_KEPT: usize = 8;
/// A connection that is not answered keeps its place so long while others wait for it: its request is not whole. A browser that
/// looks is told something in every [`PING_TIME`].
pub const STUCK_TIME: Duration = Duration::from_secs(3);
/// One that has asked for nothing keeps it so long: browsers connect before they know what to ask for.
pub const MUTE_TIME: Duration = Duration::from_secs(5);
/// A computer that has so many places more than another one gives some up for that at once, if nothing whole has come on them.
pub const FAIR_LEAD: usize = 8;
/// Bytes of one message that count as progress: so many in the time after which a connection is stuck are an upload over a
/// bad network, and fewer are none.
pub const PROGRESS_BYTES: usize = 1 << 10;
/// A connection to which nothing could be sent for so long is closed; a browser that looks is told something every second.
pub const IDLE_TIME: Duration = Duration::from_secs(30);
/// Bytes of one message of a browser: the greatest upload, as the control port takes it.
pub const MESSAGE_BYTES_MAX: usize = frame::limits::CONTROL_BYTES;
/// Characters of what a browser has sent that an error repeats.
pub const REPEATED_MAX: usize = 80;
/// Bytes of a request that is no upload.
pub const REQUEST_BYTES_MAX: usize = 64 << 10;
/// Bytes of uploads that wait for the robot, of all browsers together.
pub const UPLOADS_BYTES_MAX: usize = 2 * MESSAGE_BYTES_MAX;
/// Bytes that wait for one browser, answers to its pings too: a little more than one message.
pub const UNSENT_BYTES_MAX: usize = MESSAGE_BYTES_MAX + (1 << 20);
/// Bytes that are read from a browser at once; a browser holds a buffer of this size while it is connected.
pub const READ_BYTES: usize = 16 << 10;
/// How long a thread for files waits for more work before it ends.
pub const FILE_THREAD_IDLE_TIME: Duration = Duration::from_secs(2);
/// Bytes of an order in words: a value for an actuator.
pub const WORDS_BYTES_MAX: usize = 64 << 10;
/// Bytes of an order to the world: a world that a person drops on the page comes in it.
pub const WORLD_BYTES_MAX: usize = 6 << 20;
/// An order to the world that is longer takes time, so a thread of its own carries it out.
pub const WORLD_QUICK_BYTES: usize = 4 << 10;
/// Bytes of a path of the tree.
pub const PATH_BYTES_MAX: usize = 1024;
/// Orders to actuators that wait; of each actuator only the newest is carried out.
pub const ORDERS: usize = 64;
/// Messages that wait for one browser, beside what comes from the robot.
pub const NEWS: usize = 256;
/// How long one message may take to a browser. A robot closes a connection that says nothing for five seconds, so keepalives do
/// not wait for this.
pub const SEND_TIME: Duration = Duration::from_secs(20);
/// How often a browser is asked whether it is there.
pub const PING_TIME: Duration = Duration::from_secs(1);
/// A browser that has not answered for so long is gone: what it drives comes to rest.
pub const SILENCE_TIME: Duration = Duration::from_secs(4);
/// The control port of a robot is told so often that somebody is there.
pub const KEEPALIVE_TIME: Duration = Duration::from_secs(2);
/// Between a panic of the thread that serves and its next beginning: one that fails at once must not take the processor.
pub const AGAIN_TIME: Duration = Duration::from_millis(100);
/// Until a robot that is not there is looked for again.
pub const RETURN_TIME: Duration = Duration::from_secs(1);
/// How often the world is shown, in the best case.
pub const PICTURE_TIME: Duration = Duration::from_millis(16);
/// How often it is looked where a recording is.
pub const PLAYBACK_TIME: Duration = Duration::from_millis(100);
/// Threads for files of the tree, which may make them wait.
pub const FILE_THREADS: usize = 4;
/// Of these, for programs, diagrams and worlds at once.
pub const LARGE_MAX: usize = FILE_THREADS / 2;
/// Programs that are listed.
pub const PROGRAMS_MAX: usize = 1000;
/// Bytes of the name of a program, folders with it.
pub const NAME_BYTES_MAX: usize = 400;
/// Depth of folders of programs that are listed.
pub const FOLDERS_MAX: usize = 4;
/// Bytes of a program that is shown.
pub const PROGRAM_BYTES_MAX: usize = 16 << 20;
/// Bytes of the page of a studio.
pub const STUDIO_PAGE_BYTES_MAX: u64 = 1 << 20;
/// Bytes of a file of the studio that are in memory at once.
pub const STUDIO_PIECE_BYTES: usize = 64 << 10;
/// Bytes of a program that is edited: a connection that reads nothing holds so many.
pub const EDITED_BYTES_MAX: usize = 128 << 10;
/// Bytes of a property of a block.
pub const PROPERTY_BYTES_MAX: usize = 4 << 10;
/// Blocks of a data-flow program that is drawn, of all its diagrams together.
pub const FLOW_BLOCKS_MAX: usize = 5000;
/// The same of its edges: as many as one picture has.
pub const FLOW_EDGES_MAX: usize = 10_000;
/// Mistakes of a diagram that are told.
pub const MISTAKES_MAX: usize = 5;
/// Bytes of a configuration, as the filesystem takes them.
pub const CONFIGURATION_BYTES_MAX: usize = 1 << 20;
/// Bytes of the `status` of a tree: a line about its configuration and one for each node.
pub const STATUS_BYTES_MAX: usize = 1 << 20;
/// Bytes of the `stages` of a node: as many tuples as a chain may have converters, and one more, as the filesystem cuts them.
pub const STAGES_BYTES_MAX: usize = 64 << 10;
/// Params of a node that are shown, as many as it can have with its attributes.
pub const PARAMS_MAX: usize = 256;
/// Threads for files that look into nodes at once.
pub const LOOKS_MAX: usize = 1;
/// Rows of the plain table.
pub const ROWS_MAX: usize = 500;
/// Letters of one of its cells.
pub const CELL_LETTERS: usize = 200;
/// Bytes of a tuple that it shows.
pub const CELL_BYTES_MAX: u64 = 1024;
/// Robots of the page of a class.
pub const CLASS_ROBOTS_MAX: usize = 64;
/// Programs that wait to be started on one of them.
pub const CLASS_RUNS: usize = 8;
/// How long a connection to one may take.
pub const CLASS_CONNECT_TIME: Duration = Duration::from_secs(3);
/// Until one that was lost is looked for again; then twice as long, and so on.
pub const CLASS_SOONEST_TIME: Duration = Duration::from_millis(500);
/// Until one is looked for again, at most.
pub const CLASS_LATEST_TIME: Duration = Duration::from_secs(8);
/// One that has said nothing for so long is lost; it says something every 3 s.
pub const CLASS_SILENCE_TIME: Duration = Duration::from_secs(8);
/// How often one is asked what runs, beside when it has told that something has changed.
pub const CLASS_LOOK_TIME: Duration = Duration::from_secs(6);
/// Until one that was just reached is asked the second time.
pub const CLASS_AGAIN_TIME: Duration = Duration::from_secs(1);
/// An order to stop is given to a robot that comes back within this time.
pub const CLASS_STOP_TIME: Duration = Duration::from_secs(60);
/// How long a file may take to one robot.
pub const CLASS_UPLOAD_TIME: Duration = Duration::from_secs(300);
/// Bytes of a file after which it is said how far it is.
pub const CLASS_PIECE_BYTES: usize = 64 << 10;
/// Bytes of one message of a robot.
pub const CLASS_MESSAGE_BYTES_MAX: usize = 1 << 20;
/// Letters of what a robot says that a card shows.
pub const CLASS_LETTERS_MAX: usize = 300;
/// Bytes of the name of a program.
pub const CLASS_NAME_BYTES_MAX: usize = 200;
/// How often a viewer of marks is told of new ones, in the best case.
pub const MARKS_TIME: Duration = Duration::from_millis(50);
/// Bytes of the page of a replay.
pub const REPLAY_BYTES_MAX: u64 = 32 << 20;
/// Replays that are read at once.
pub const REPLAYS_AT_ONCE: usize = 4;
