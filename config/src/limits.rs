//! Every limit of a configuration and of what it may ask for, with the defaults.
//!
//! Owns the numbers only; the code that enforces each one names it from here.

/// Bytes of one configuration file, and of everything written to the `config` node at once.
pub const CONFIG_BYTES_MAX: usize = 1 << 20;
/// Bytes of one tuple, before or after a converter; a camera's picture is the largest.
pub const TUPLE_BYTES_MAX: usize = 4 << 20;
/// Bytes of the name of one channel of a player.
pub const CHANNEL_BYTES_MAX: usize = 512;
/// Bytes of one tuple that a player gives: one message of a Unix socket, whose buffer the kernel limits to 208 KiB
/// (`net.core.wmem_max`) with its own overhead.
pub const PLAYED_BYTES_MAX: usize = 128 << 10;
/// Nodes and attributes in one configuration.
pub const NODES_MAX: usize = 4096;
/// Depth of nested groups.
pub const GROUP_DEPTH_MAX: usize = 16;
/// Bytes of one file or group name, as in the kernel.
pub const NAME_BYTES_MAX: usize = 255;
/// Fields in one `format`.
pub const FIELDS_MAX: usize = 1024;
/// Stages in one chain of converters.
pub const CHAIN_MAX: usize = 16;
/// Sources of one node.
pub const SOURCES_MAX: usize = 64;
/// Actions in one `setup`.
pub const SETUP_ACTIONS_MAX: usize = 256;
/// Bytes that one action of `setup` writes, and of all words of a program that it runs.
pub const SETUP_BYTES_MAX: usize = 4_096;
/// `timeout_ms` of an action of `setup` when it has none.
pub const SETUP_TIMEOUT_MS: u32 = 1_000;
/// Largest `timeout_ms` of an action of `setup`.
pub const SETUP_TIMEOUT_MS_MAX: u32 = 60_000;
/// Smallest 7-bit address of a device; the I2C specification reserves those below.
pub const I2C_ADDRESS_MIN: u32 = 0x03;
/// Largest 7-bit address of a device; the I2C specification reserves those above.
pub const I2C_ADDRESS_MAX: u32 = 0x77;
/// Bytes of one SMBus block (`I2C_SMBUS_BLOCK_MAX` of linux/i2c.h).
pub const I2C_BLOCK_BYTES_MAX: usize = 32;
/// Bytes of one plain I2C message (8192 in the kernel's i2c-dev.c).
pub const I2C_RAW_BYTES_MAX: usize = 8_192;
/// Numbers in the `params` of one description.
pub const PARAMS_MAX: usize = 256;
/// Files that one configuration may `include`, each at most [`CONFIG_BYTES_MAX`].
pub const INCLUDES_MAX: usize = 64;
/// Milliseconds that running the configuration program may take.
pub const LOAD_TIME_MS: u32 = 5_000;
/// Bytes of Lua memory while the configuration program runs for the first time.
pub const LOAD_MEMORY_BYTES: usize = 64 << 20;
/// Bytes that a program may hold for its state to be kept as the one that others are copied from.
pub const ORIGINAL_BYTES_MAX: usize = 16 << 20;
/// Bytes of what the converters of one node may reach to be copied; beyond it every open file runs the program anew.
pub const IMAGE_BYTES_MAX: usize = 4 << 20;
/// Bytes of such copies that are kept for later openings.
pub const IMAGES_BYTES_MAX: usize = 1 << 20;
/// Nodes with converters in Lua up to which a program is settled: what each reaches is made ready, whether or not it is
/// wanted.
pub const SETTLED_NODES_MAX: usize = 512;
/// Entries that the copy of a table has room for before the first is there.
pub const ENTRIES_AHEAD_MAX: i32 = 1 << 16;
/// Bytes of Lua memory that a state without any program stays below.
pub const BLANK_BYTES: usize = 48 << 10;
/// Nodes whose state is made when a configuration is loaded, to see whether `memory_kb` has room for it.
pub const NODES_TRIED_MAX: usize = 64;
/// Bytes of one `trikfs_log` line; the rest is cut.
pub const LOG_LINE_BYTES_MAX: usize = 1024;
/// Steps of one pattern match before it is refused.
pub const PATTERN_STEPS_MAX: u32 = 1_000_000;

/// `timeout_ms` when a description has none.
pub const TIMEOUT_MS: u32 = 1_000;
/// Largest `timeout_ms` and `poll_ms`: one hour.
pub const PERIOD_MS_MAX: u32 = 3_600_000;
/// `budget_us` when a description has none.
/// Compiling a loop takes LuaJIT some milliseconds of a small 32-bit processor, and belongs to the call in which it happens.
pub const BUDGET_US: u32 = if cfg!(target_pointer_width = "32") {
    50_000
} else {
    10_000
};
/// Largest `budget_us`: ten seconds.
pub const BUDGET_US_MAX: u32 = 10_000_000;
/// `memory_kb` when a description has none.
pub const MEMORY_KB: u32 = 1_024;
/// Largest `memory_kb`: 64 MiB.
pub const MEMORY_KB_MAX: u32 = 64 << 10;

/// Codes of one `evdev` tuple.
pub const EVDEV_CODES_MAX: usize = 256;
/// Bytes of the reason of an absent source.
pub const ABSENT_REASON_BYTES_MAX: usize = 200;
/// Names that one `iio` source may look for.
pub const IIO_NAMES_MAX: usize = 16;
/// Channels of one `iio` source.
pub const IIO_CHANNELS_MAX: usize = 64;
/// Bytes of the name of a device or channel of `iio`.
pub const IIO_NAME_BYTES_MAX: usize = 64;
/// Largest `sampling_frequency` of `iio`, in Hz.
pub const IIO_FREQUENCY_MAX: f64 = 1e9;
/// Largest `channel` of `pwm`.
pub const PWM_CHANNEL_MAX: u32 = 255;
/// Largest `number` of `gpio`.
pub const GPIO_NUMBER_MAX: u32 = 65_535;
/// Words of a command: the program and its arguments.
pub const COMMAND_WORDS_MAX: usize = 32;
/// Bytes of one argument of a command.
pub const COMMAND_WORD_BYTES_MAX: usize = 1024;
/// Bytes of `question` and of `answer` of `lines{...}`.
pub const ANSWER_BYTES_MAX: usize = 64;
/// Bytes of the `start` of packets.
pub const PACKET_START_BYTES_MAX: usize = 16;
/// Speeds of a serial line in bits per second, as Linux names them (asm-generic/termbits.h).
pub const BAUD_RATES: [u32; 19] = [
    1_200, 2_400, 4_800, 9_600, 19_200, 38_400, 57_600, 115_200, 230_400, 460_800, 500_000,
    576_000, 921_600, 1_000_000, 1_152_000, 1_500_000, 2_000_000, 2_500_000, 3_000_000,
];

/// Problems of one model or program that are reported.
pub const MODEL_PROBLEMS_MAX: usize = 8;
/// Milliseconds that a fuzz target gives one configuration.
pub const FUZZ_TIME_MS: u32 = 50;
/// Bytes of Lua memory that it gives.
pub const FUZZ_MEMORY_BYTES: usize = 4 << 20;
/// Longest chunk name that Lua does not shorten in messages (LUA_IDSIZE less the terminator).
pub const CHUNK_NAME_BYTES_MAX: usize = 59;
/// Keys whose lines are remembered; a text with more was not written by hand.
pub const KEYS_MAX: usize = 1 << 16;
/// Nesting of keys whose lines are remembered.
pub const KEY_DEPTH_MAX: usize = 64;
/// Captures of one pattern, as in the reference implementation.
pub const CAPTURES_MAX: usize = 32;
/// Nested attempts of one pattern match, as in the reference implementation; keeps the machine stack small.
pub const PATTERN_DEPTH_MAX: u32 = 200;
/// Nested tables of a program: groups, and inside a node its attributes, their fields, and lists in these.
pub const TABLE_DEPTH_MAX: usize = GROUP_DEPTH_MAX + 8;
/// Values in all tables that a program leaves.
pub const VALUES_MAX: usize = 1 << 18;
/// Bytes of all strings in these tables together.
pub const TEXT_BYTES_MAX: usize = 8 * CONFIG_BYTES_MAX;
/// Names of undefined globals that are remembered for a warning.
pub const UNDEFINED_MAX: usize = 16;
/// Log lines of one load that are kept.
pub const LOG_LINES_MAX: usize = 1000;
/// Smallest `memory_kb`: a state with the program takes about 50 KiB, and with less than this no converter would ever run.
pub const MEMORY_KB_MIN: u32 = 128;
/// Bytes of `units`.
pub const UNITS_BYTES_MAX: usize = 64;
/// Bytes of `about`.
pub const ABOUT_BYTES_MAX: usize = 200;
/// Nodes that read each other in a row; bounds the recursion of the checks.
pub const LINKS_MAX: usize = SOURCES_MAX;
