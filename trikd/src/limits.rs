//! Every limit of the daemon and every default that is a number.
//!
//! Owns the numbers only; the code that enforces each one names it from here.

/// Bytes of the name of a port.
pub const PORT_NAME_BYTES: usize = 32;
/// Bytes of one value of the tree: 360 distances of a lidar fit.
pub const VALUE_BYTES: usize = 4096;
/// How often processes outside of the program's group are looked for before the motors rest: they may start others.
pub const FREEZE_ROUNDS: usize = 4;
/// Bytes of a name in a message of multicast DNS: twice what the protocol allows.
pub const DNS_NAME_BYTES_MAX: usize = 512;
/// Questions of one message of multicast DNS that are looked at.
pub const DNS_QUESTIONS_MAX: u16 = 32;
/// Pointers in one name of multicast DNS.
pub const DNS_POINTERS_MAX: usize = 8;
/// Characters of the secret that a program in Python says to its debugger.
pub const DEBUG_SECRET_BYTES: usize = 64;
/// Characters of a text in what the daemon itself tells clients that debug.
pub const DEBUG_CHARACTERS_MAX: usize = 1000;
/// Bytes of one transfer on a bus: as many as i2c-dev takes.
pub const TRANSFER_BYTES: usize = 8192;
/// Memory of one engine of JavaScript; each thread of a program has one.
pub const JS_MEMORY_BYTES: usize = 64 << 20;
/// Depth of calls in JavaScript, as bytes of the stack.
pub const JS_STACK_BYTES: usize = 1 << 20;
/// What an engine's thread has beyond that, for the functions of the host and for the depth between two checks.
pub const JS_STACK_SPARE_BYTES: usize = 1 << 20;
/// Threads of one JavaScript program at once.
pub const JS_THREADS: usize = 16;
/// Timers of one engine.
pub const JS_TIMERS: usize = 256;
/// Messages, of robots or between threads, that wait for a program; the oldest go first.
pub const JS_MESSAGES: usize = 256;
/// Events that wait for one engine; further ones are lost.
pub const JS_EVENTS: usize = 1024;
/// Bytes of a program, and of a file that it includes or reads.
pub const JS_FILE_BYTES: u64 = 16 << 20;
/// Frames of a backtrace that are shown.
pub const JS_FRAMES: usize = 16;
/// Characters of the text of an error.
pub const JS_ERROR_CHARACTERS: usize = 2000;
/// Milliseconds that threads have to end when the program is over.
pub const JS_END_MS: u64 = 100;
/// Milliseconds that threads may take to stand still for a debugger before that says that the program is stopped.
pub const JS_STILL_MS: u64 = 500;
/// How often it looks meanwhile, and brings motors to rest.
pub const JS_LOOK_MS: u64 = 10;
/// Bytes of one frame on the telemetry and mailbox ports.
pub const SMALL_FRAME_BYTES: usize = 64 << 10;
/// Bytes of one frame between the daemon and a program.
pub const CHANNEL_FRAME_BYTES: usize = 16 << 20;
/// Lines of the log about one matter that may come at once.
pub const LOG_BURST: f32 = 100.0;
/// Lines about one matter in a minute in the long run: some 3 MB a day, whatever a client does.
pub const LOG_LINES_PER_MINUTE: f32 = 20.0;
/// Lines in a second of what is told only to who asks for `debug` or `trace`.
pub const LOG_VERBOSE_LINES_PER_SECOND: f32 = 50.0;
/// Characters of one line of the log.
pub const LOG_LINE_CHARACTERS: usize = 400;
/// Bytes of the name of a file in which a program is stopped.
pub const PLACE_BYTES: usize = 120;
/// Bytes of a request that the log shows to who asks for `debug`.
pub const LOG_REQUEST_BYTES: usize = 80;
/// Beeps and lights that may wait.
pub const FEEDBACK_WAITS: usize = 8;
/// Priority of the threads that stop motors (nice(2): -20 goes first, 19 last).
pub const NICE_REST: i32 = -20;
/// Priority of the thread that serves. Not much before the tree: who floods it would starve that.
pub const NICE_SERVING: i32 = -5;
/// Priority of programs.
pub const NICE_PROGRAM: i32 = 5;
/// Milliseconds over which turns of the serving thread are counted.
pub const PACE_WINDOW_MS: u64 = 100;
/// Turns in a second from which it pauses between them.
pub const PACE_MANY: u32 = 2000;
/// Turns in a second, with pauses, below which it no longer does.
pub const PACE_FEW: u32 = 500;
/// Microseconds of a pause: so much later a stop is heard while thousands of requests come in a second.
pub const PACE_PAUSE_US: u64 = 1000;
/// Milliseconds within which a key pairs the computer that asked last.
pub const PAIRING_MS: u64 = 30_000;
/// Milliseconds for which a pairing code counts.
pub const CODE_MS: u64 = 600_000;
/// Digits of a pairing code.
pub const CODE_DIGITS: u32 = 6;
/// Wrong codes of a computer after which a code counts no longer for it.
pub const CODES_WRONG_MAX: u32 = 5;
/// Computers of which wrong codes are heard: with all their codes a guess is right in one of 6000 cases.
pub const CODE_GUESSERS_MAX: usize = 32;
/// Paired computers.
pub const PAIRED: usize = 64;
/// Bytes of the name of a program.
pub const NAME_BYTES: usize = 200;
/// Folders in the name of a program.
pub const NAME_DEPTH: usize = 8;
/// Memory of one program in MiB, as its address space: Python alone takes some 30.
pub const PROGRAM_MEMORY_MIB: u64 = 256;
/// Processes of one program.
pub const PROGRAM_PROCESSES: u64 = 64;
/// Connections at once on all ports together.
pub const CONNECTIONS: u16 = 256;
/// One part in so many of these is out of reach for each single computer.
pub const CONNECTIONS_OF_OTHERS: usize = 4;
/// Places beside these for this machine, whose page is one client for many browsers, and as many more for the computer in control:
/// a person who has set the robot going comes back to it, however many others have come meanwhile.
pub const CONNECTIONS_KEPT: usize = 8;
/// Milliseconds that a connection keeps its place in the midst of a message while others wait for one: a network that loses a
/// packet takes less, and a client that sends a byte now and then takes more.
pub const STUCK_MS: u64 = 1_000;
/// Connections to the control port beyond all places, which may say `stop` and ask what runs: so many that one which speaks at
/// once is heard before thousands that come in the same second have pushed it out.
pub const LOBBY: usize = 256;
/// Connections to a port that are accepted in one turn of the serving thread: everything else, a stop first of all, waits so long.
pub const ACCEPTS: usize = 4;
/// The same for the control port, at which a stop may stand behind many.
pub const CONTROL_ACCEPTS: usize = 32;
/// Bytes in which one of them must have said so.
pub const LOBBY_BYTES: usize = 64;
/// Milliseconds that one of them may take for that.
pub const LOBBY_MS: u64 = 1_000;
/// Connections that the kernel keeps until they are accepted: one for which there is no room comes again after a second, and
/// that would be a second until a stop. The kernel takes less if it has to (listen(2)).
pub const BACKLOG: i32 = 1024;
/// Questions of multicast DNS that are looked at in a second; what comes beyond that is lost, as in a network that is full.
pub const QUESTIONS_PER_SECOND: u32 = 200;
/// Milliseconds of the pieces in which these are counted: so long a question may wait behind a flood.
pub const QUESTIONS_WINDOW_MS: u64 = 100;
/// Milliseconds between a panic of a thread or task and its next beginning: one that fails at once must not take the processor.
pub const PANIC_MS: u64 = 100;
/// Bytes that are read from a connection at once.
pub const READ_BYTES: usize = 8 << 10;
/// Milliseconds without a sent byte after which a keepalive is sent.
pub const KEEPALIVE_MS: u64 = 3_000;
/// Milliseconds without a received byte after which a connection is closed.
pub const SILENCE_MS: u64 = 5_000;
/// Milliseconds within which a frame must be whole.
pub const FRAME_MS: u64 = 60_000;
/// Bytes of half frames that all connections may hold together.
pub const HELD_BYTES: usize = 32 << 20;
/// Bytes of a half frame that a connection may hold in any case.
pub const HELD_FREE_BYTES: usize = 16 << 10;
/// Milliseconds that a connection that ends is kept for its last words.
pub const FAREWELL_MS: u64 = 500;
/// Bytes that are read and thrown away in that time.
pub const FAREWELL_BYTES: usize = 1 << 20;
/// Bytes that wait for one client.
pub const OUTBOX_BYTES: usize = 256 << 10;
/// Milliseconds for which all clients share one snapshot of the sensors.
pub const SNAPSHOT_MS: u64 = 15;
/// Milliseconds that an answer waits for the tree.
pub const SNAPSHOT_WAIT_MS: u64 = 250;
/// Milliseconds without a question after which the files of the sensors are closed: the tree samples what is open.
pub const SENSORS_LINGER_MS: u64 = 5_000;
/// Milliseconds between two looks at raw readings, which cost transfers on the bus.
pub const RAW_MS: u64 = 100;
/// Milliseconds that a program may live on while the motors are brought to rest.
pub const REST_WAIT_MS: u64 = 50;
/// Milliseconds after which a tree that has not brought the motors to rest is told of.
pub const REST_LAST_MS: u64 = 2_000;
/// Wishes for rest that may wait.
pub const REST_ASKS: usize = 16;
/// Bytes of one line of output; longer ones come in pieces.
pub const LINE_BYTES: usize = 4096;
/// Messages of one program in a second, and how many may come at once.
pub const OUTPUT_MESSAGES_PER_SECOND: f64 = 1000.0;
/// Messages beyond that which wait, of which the newest are shown when there is room, or at the end of the program.
pub const OUTPUT_HELD_MESSAGES: usize = 200;
/// Bytes of these.
pub const OUTPUT_HELD_BYTES: usize = 64 << 10;
/// Bytes of messages in a second.
pub const OUTPUT_BYTES_PER_SECOND: f64 = 262_144.0;
/// Commands that wait for the one who runs programs.
pub const COMMANDS: usize = 32;
/// Milliseconds between two counts of the processes of a program.
pub const PROCESSES_MS: u64 = 250;
/// Milliseconds until the processes of a program must be gone.
pub const KILL_MS: u64 = 2_000;
/// Rounds of killing after which the user of programs is ended as a whole.
pub const KILL_ROUNDS: u32 = 3;
/// Milliseconds that are waited for output of a program that has ended.
pub const DRAIN_MS: u64 = 50;
/// Bytes of one message of a program.
pub const MESSAGE_BYTES: usize = 64 << 10;
/// Messages of the mailbox that wait for the next program.
pub const KEPT_MESSAGES: usize = 256;
/// Robots that the mailbox knows.
pub const ROBOTS: usize = 256;
/// Milliseconds for one attempt to reach another robot.
pub const CONNECT_MS: u64 = 1_000;
/// Attempts to reach a robot that somebody wants to talk to.
pub const JOIN_TRIES: u32 = 3;
/// Attempts to reach the robot that was joined before the start: it may start later.
pub const REJOIN_TRIES: u32 = 120;
/// Bytes of one line of a gamepad.
pub const GAMEPAD_LINE_BYTES: usize = 256;
/// Lines of one gamepad in a second.
pub const GAMEPAD_LINES_PER_SECOND: u32 = 500;
/// Milliseconds after which a pressed button is released: applications send no release.
pub const BUTTON_MS: u64 = 500;
/// Bytes of the head of a request over HTTP.
pub const HTTP_HEAD_BYTES: usize = 8 << 10;
/// Milliseconds that a program has to show its variables.
pub const WEB_MS: u64 = 1_000;
/// Bytes of one picture.
pub const PICTURE_BYTES: usize = 1 << 20;
/// Milliseconds after which a picture that is still the same is sent again: somebody may think that nobody sends.
pub const PICTURE_AGAIN_MS: u64 = 1_000;
/// Milliseconds that a viewer waits for the first picture: the camera may have to be started.
pub const PICTURE_WAIT_MS: u64 = 30_000;
/// Milliseconds between two pictures.
pub const PICTURE_MS: u64 = 66;
/// Milliseconds after the start at which a program runs by itself.
pub const AUTORUN_MS: u64 = 1_000;
/// Milliseconds after which a start with such a program counts as good.
pub const AUTORUN_PROOF_MS: u64 = 10_000;
/// Starts that may fail before such a program is no longer run.
pub const AUTORUN_TRIES: u32 = 3;
/// Milliseconds that the end of the daemon waits for the file of the mailbox.
pub const SAVE_MS: u64 = 1_000;
/// Further ports that the mailbox tries.
pub const MAILBOX_PORTS: u16 = 4;
/// Threads for files that may be slow.
pub const BLOCKING_THREADS: usize = 4;
/// Milliseconds that one of them waits for more work before it ends.
pub const BLOCKING_IDLE_MS: u64 = 2_000;
/// Milliseconds that the guardian waits for the motors to rest.
pub const GUARDIAN_REST_MS: u64 = 1_000;
/// Milliseconds within which crashes are counted.
pub const CRASHES_MS: u64 = 60_000;
/// Crashes in that time after which the guardian gives up.
pub const CRASHES: usize = 5;
/// Bytes that the kernel keeps for one client.
pub const SEND_BUFFER_BYTES: usize = 64 << 10;
/// Milliseconds that the serving process has for its end.
pub const GUARDIAN_END_MS: u64 = 8_000;
/// Milliseconds between two beats of the serving thread.
pub const BEAT_MS: u64 = 500;
/// Milliseconds between two looks whether the socket of the status has been removed.
pub const SOCKET_LOOK_MS: u64 = 1_000;
/// Milliseconds between two looks whether the guardian stands still.
pub const GUARDIAN_LOOK_MS: u64 = 500;
/// Looks in a row at which a process of a program stood still before the program is ended: one look may see a process that goes
/// on at once.
pub const STILL_LOOKS: u32 = 2;
/// Beats that may be missing before it counts as hung.
pub const BEATS_MISSING: u32 = 20;
/// Rests of which the status tells how long they took.
pub const RESTS_SHOWN: usize = 256;
/// Bytes that wait for one client of a stream, besides those in its outbox.
pub const STREAM_BYTES: usize = 1 << 20;
/// Bytes of one piece of a recording.
pub const STREAM_PIECE_BYTES: usize = 16 << 10;
/// Bytes of the path of a node that is asked for by its name.
pub const NODE_PATH_BYTES: usize = 1024;
/// Bytes of one datagram with values of nodes; more come in further ones.
pub const DATAGRAM_BYTES: usize = 8 << 10;
/// Numbers of a node with more are in no datagram.
pub const DATAGRAM_NUMBERS: usize = 512;
/// Numbers of one picture that a program shows, three for each pixel at most.
pub const SHOWN_NUMBERS: usize = 3 << 20;

/// Texts of a version that is prepared beside a running program: what is made of them takes up to 300 times as much memory, of
/// which a program may have 256 MiB.
pub const VERSION_BYTES: usize = 640 << 10;
/// What a block without a text counts there.
pub const VERSION_BLOCK_BYTES: usize = 12;

/// How long a diagram whose next step is late hears what is asked for, in milliseconds: a change that takes longer is the
/// only one before that step.
pub const HEARING_MS: u64 = 5;
/// How often it is looked whether a new version of a diagram is ready, in milliseconds.
pub const VERSION_LOOK_MS: u64 = 1;
/// How often a part of the robot that was not there is looked for by a diagram that uses it, in milliseconds.
pub const PART_LOOK_MS: u64 = 200;
/// How often a diagram tells where it is, in milliseconds.
pub const WATCH_MS: u32 = 50;
/// Bytes of the line that tells it to people.
pub const WATCH_LINE_BYTES: usize = 1024;
/// Bytes after which no more variables are told.
pub const WATCH_JSON_BYTES: usize = 32 << 10;
/// Bytes of variables of a data-flow program beside which what happens at its blocks has room in one line of a recording, which
/// has 8 KiB.
pub const WATCH_BESIDE_BYTES: usize = 2 << 10;
/// Characters of a text that is told.
pub const WATCH_TEXT_CHARACTERS: usize = 1024;
/// Bytes that the past of a diagram takes while it is debugged on the robot.
pub const DEBUG_HISTORY_BYTES: usize = 2 << 20;
/// Orders to a debugger that the diagram has not answered yet.
pub const DEBUG_ORDERS: usize = 256;
/// Warnings about a diagram that are told.
pub const DIAGRAM_WARNINGS: usize = 20;
/// Milliseconds within which a sensor of the camera must hear a diagram after its start.
pub const DETECT_MS: u64 = 20_000;
/// Commands of the system that a diagram has at once.
pub const DIAGRAM_COMMANDS: usize = 16;
/// Messages of other robots that a diagram has not fetched.
pub const DIAGRAM_MAIL: usize = 256;
/// Bytes of a file that a block of a data-flow program reads.
pub const DIAGRAM_FILE_BYTES: u64 = 1 << 20;
/// Seconds that a diagram waits for the answer of a person, unless another time is named.
pub const ANSWER_S: u64 = 120;
/// The most that can be named: a day.
pub const ANSWER_S_MAX: u64 = 86_400;
/// Characters of a question, its variable and its default.
pub const QUESTION_CHARACTERS: usize = 1000;
/// Milliseconds between a question without an answer and the next one.
pub const QUESTION_REST_MS: u64 = 10_000;
/// Bytes of the file of a program that goes with recordings.
pub const RECORDED_PROGRAM_BYTES: u64 = 256 << 10;
