//! Every limit of the bridges.
//!
//! Owns the numbers only; the code that enforces each one names it from here.

use std::time::Duration;

/// Numbers of one node that become series: a picture or a cloud of points is none.
pub const FIELDS_MAX: usize = 64;
/// Kinds of failures of one node that are counted apart.
pub const ERRNOS_MAX: usize = 16;
/// Bytes of `status` that are read.
pub const STATUS_BYTES_MAX: u64 = 1 << 20;
/// Bytes of a request and its head.
pub const HEAD_BYTES_MAX: usize = 8 << 10;
/// Requests that are served at once; a further one is told to come later.
pub const CONNECTIONS_MAX: usize = 8;
/// From the first byte of a request to the last byte of its answer.
pub const REQUEST_TIME: Duration = Duration::from_secs(5);
/// Until a tree that has gone is looked for again.
pub const RETURN_TIME: Duration = Duration::from_secs(1);
/// Clients of Foxglove at once; a further one is told to come later.
pub const CLIENTS_MAX: usize = 16;
/// Until a client has said what it wants: the handshake.
pub const HANDSHAKE_TIME: Duration = Duration::from_secs(5);
/// Bytes of a message of a client.
pub const MESSAGE_BYTES_MAX: usize = 64 << 10;
/// Things that one message of a client names.
pub const NAMES_MAX: usize = 8192;
/// Bytes of a name that a client gives.
pub const NAME_BYTES_MAX: usize = 1024;
/// Mistakes of one client after which it is let go.
pub const MISTAKES_MAX: usize = 1000;
/// Channels that are told of: those of all nodes, and of messages of other people's types.
pub const CHANNELS_MAX: usize = 16_384;
/// Subscriptions of one client.
pub const SUBSCRIPTIONS_MAX: usize = 16_384;
/// Bytes of samples that wait for one client; of more the oldest are lost.
pub const DATA_BYTES_MAX: usize = 4 << 20;
/// What a sample that waits takes beside its bytes.
pub const SAMPLE_BYTES: usize = 64;
/// Bytes of all else that waits for one client; one that has more is given up. All types of a large tree fit.
pub const CONTROL_BYTES_MAX: usize = 32 << 20;
/// Messages that are handed to a socket at a time, before what comes from it is looked at.
pub const SENT_AT_ONCE: usize = 256;
/// Until a client that takes nothing at all is let go.
pub const STUCK_TIME: Duration = Duration::from_secs(30);
/// How often a silent client is asked whether it is there.
pub const PING_TIME: Duration = Duration::from_secs(10);
/// Until a client that has not answered is let go: three questions.
pub const DEAF_TIME: Duration = Duration::from_secs(30);
/// How often clients are told the time.
pub const BEAT_TIME: Duration = Duration::from_millis(100);
/// How often parameters are looked at while anybody wants to hear of changes.
pub const PARAMETERS_TIME: Duration = Duration::from_secs(1);
/// Parameters of one robot.
pub const PARAMETERS_MAX: usize = 4096;
/// How old values of parameters may be that several clients ask for.
pub const SNAPSHOT_TIME: Duration = Duration::from_millis(200);
/// Bytes of one parameter.
pub const PARAMETER_BYTES_MAX: u64 = 4096;
/// Bytes of one level of an MQTT topic.
pub const TOPIC_PART_BYTES_MAX: usize = 64;
/// Bytes of a text that is passed to a broker.
pub const TEXT_BYTES_MAX: usize = 4096;
/// Until what has not changed is said once more.
pub const REPEAT_TIME: Duration = Duration::from_secs(10);
/// Commands of one kind that wait to be carried out.
pub const ORDERS_MAX: usize = 64;
/// Bytes of one command.
pub const ORDER_BYTES_MAX: usize = 4096;
/// Actuators that are driven by way of a broker at once.
pub const LEASES_MAX: usize = 64;
/// Messages for Home Assistant.
pub const DISCOVERED_MAX: usize = 4096;
/// Messages that wait for the connection to a broker; what has no room is said later.
pub const QUEUE_MAX: usize = 512;
/// Bytes of a packet of a broker.
pub const PACKET_BYTES_MAX: u32 = 64 << 10;
/// Silence after which a broker counts as gone, and we for it.
pub const KEEP_ALIVE: Duration = Duration::from_secs(5);
/// For a connection to come about, and for the last word, in seconds.
pub const WORD_TIME_S: u64 = 5;
/// Until a broker that is gone is tried again, at first.
pub const AGAIN_TIME_MIN: Duration = Duration::from_millis(500);
/// And at last.
pub const AGAIN_TIME_MAX: Duration = Duration::from_secs(15);
