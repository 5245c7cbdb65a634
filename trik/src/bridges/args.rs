//! The options of `trik bridge`.
//!
//! Owns the options. Knows nothing of what they do.

use crate::remote::target::{Target, target};
use clap::{Args, Subcommand};
use std::net::IpAddr;
use std::path::PathBuf;

/// What a tree is served for.
#[derive(Subcommand, Clone, Debug, PartialEq, Eq)]
pub(crate) enum Bridge {
    /// Serve health and values of a tree as the text that Prometheus reads, at /metrics.
    ///
    /// A node that fails has no value, and its errno as a series of its own. A tree that is unmounted is waited for; trikfs_up
    /// is 0 meanwhile.
    ///
    /// Exit status: 0 somebody has ended it; 1 there is no tree, or the address cannot be had; 2 the command line was not
    /// understood.
    Prometheus(PrometheusArgs),
    /// Serve a tree live over Foxglove's WebSocket, for Foxglove, Lichtblick, PlotJuggler and others.
    ///
    /// Every node is a channel with the messages that a recording has; parameters are sampling periods, parameters of filters
    /// and variables of the diagram that runs; services stop the robot and run a program that it has. A tree that is unmounted
    /// is waited for.
    ///
    /// Exit status: 0 somebody has ended it; 1 there is no tree, or the address cannot be had; 2 the command line was not
    /// understood.
    Foxglove(FoxgloveArgs),
    /// Tell an MQTT broker the newest values of a tree, and take commands by way of it.
    ///
    /// Topics are trik/CLASS/NAME/life (online or offline, by the last will too), .../tel/NODE (the newest of a node, as JSON),
    /// .../cmd/stop, .../cmd/run, .../cmd/set/NODE, .../cmd/parameter/NAME, .../cmd/alive, and .../answer. An actuator that is
    /// set rests when no command has come for --deadman ms. A broker or a tree that is gone is waited for.
    ///
    /// Exit status: 0 somebody has ended it; 1 there is no tree, the broker does not let it in, or another robot has its name;
    /// 2 the command line was not understood.
    Mqtt(MqttArgs),
}

/// The options of `trik bridge mqtt`.
#[derive(Args, Clone, Debug, PartialEq, Eq)]
pub(crate) struct MqttArgs {
    /// The broker: a name or an address, with its port if that is not 1883; mqtts://HOST is one behind TLS, at port 8883.
    #[arg(long, value_name = "BROKER", default_value = "127.0.0.1", value_parser = broker)]
    pub broker: Broker,
    /// The class that the robot is in, a part of its topics.
    #[arg(long, default_value = "class")]
    pub class: String,
    /// The name of the robot, a part of its topics [default: that of this computer].
    #[arg(long)]
    pub name: Option<String>,
    /// Who it is for the broker; needs --password-file.
    #[arg(long, requires = "password_file")]
    pub user: Option<String>,
    /// A file with the password in its first line. On the command line everybody could read it.
    #[arg(long, value_name = "FILE", requires = "user")]
    pub password_file: Option<PathBuf>,
    /// Certificates of those who vouch for a broker behind TLS, as PEM [default: whom this computer trusts].
    #[arg(long, value_name = "FILE")]
    pub ca: Option<PathBuf>,
    /// A certificate by which a broker behind TLS knows this robot, as PEM, version 3; needs --ca and --key.
    #[arg(long, value_name = "FILE", requires_all = ["ca", "key"])]
    pub cert: Option<PathBuf>,
    /// The key of that certificate, as PEM.
    #[arg(long, value_name = "FILE", requires = "cert")]
    pub key: Option<PathBuf>,
    /// Take all commands, and not only stop. Who may send them is for the broker to say.
    #[arg(long)]
    pub control: bool,
    /// Until an actuator rests that nobody sets any more, in ms.
    #[arg(long, value_name = "MS", default_value_t = 500, value_parser = clap::value_parser!(u32).range(100..=60_000))]
    pub deadman: u32,
    /// Messages of one node in a second at most.
    #[arg(long, value_name = "HZ", default_value_t = 5, value_parser = clap::value_parser!(u32).range(1..=50))]
    pub rate: u32,
    /// Let Home Assistant find the robot by itself; PREFIX is that of its discovery.
    #[arg(long, value_name = "PREFIX", num_args = 0..=1, default_missing_value = "homeassistant", require_equals = true)]
    pub home_assistant: Option<String>,
    /// Where the robot takes programs: its name or address, with its port if that is not 8888 [default: that of the virtual
    /// robot with this tree].
    #[arg(long, value_name = "ADDRESS", value_parser = target)]
    pub programs: Option<Target>,
    /// The robot: where its tree is mounted, or the address of a virtual one.
    #[arg(long, value_name = "ROBOT", conflicts_with = "mountpoint")]
    pub robot: Option<PathBuf>,
    /// The mounted tree [default: the virtual robot that runs, or else /trikfs].
    pub mountpoint: Option<PathBuf>,
}

/// Where a broker is.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(crate) struct Broker {
    pub host: String,
    pub port: u16,
    pub is_secure: bool,
}

/// Reads where a broker is.
///
/// # Errors
/// It is no such address.
pub(crate) fn broker(text: &str) -> Result<Broker, &'static str> {
    let (is_secure, rest) = match text.split_once("://") {
        None => (false, text),
        Some(("mqtt", rest)) => (false, rest),
        Some(("mqtts", rest)) => (true, rest),
        Some(_) => return Err("a broker is HOST, HOST:PORT, mqtt://HOST or mqtts://HOST"),
    };
    let rest = rest.strip_suffix('/').unwrap_or(rest);
    let port = if is_secure { 8883 } else { 1883 };
    // An address of IPv6 has colons of its own, and stands in brackets if a port follows.
    let (host, port) = match rest.rsplit_once(':') {
        _ if rest.parse::<std::net::Ipv6Addr>().is_ok() => (rest, Some(port)),
        Some((host, digits)) if !rest.ends_with(']') => (host, digits.parse().ok()),
        Some(_) | None => (rest, Some(port)),
    };
    let host = host.trim_start_matches('[').trim_end_matches(']');
    let is_name = |c: char| c.is_ascii_alphanumeric() || matches!(c, '.' | '-' | '_' | ':' | '%');
    if host.is_empty() || !host.chars().all(is_name) {
        return Err("this is no name and no address of a broker");
    }
    match port {
        Some(port) if port > 0 => Ok(Broker {
            host: host.to_owned(),
            port,
            is_secure,
        }),
        Some(_) | None => Err("the port of a broker is a number from 1 to 65535"),
    }
}

/// The options of `trik bridge foxglove`.
#[derive(Args, Clone, Debug, PartialEq, Eq)]
pub(crate) struct FoxgloveArgs {
    /// The address to listen on; 0.0.0.0 or :: lets everybody in the network look.
    #[arg(long, default_value = "127.0.0.1")]
    pub address: IpAddr,
    /// The TCP port; 0 takes a free one.
    #[arg(long, default_value_t = 8765)]
    pub port: u16,
    /// Let clients of other computers set parameters and call services too, with your rights. There is no password.
    #[arg(long)]
    pub control: bool,
    /// A web page that may use the robot from a browser, such as https://lichtblick.example; may be given several times. Those
    /// of this computer and that of Foxglove may anyway.
    #[arg(long, value_name = "URL")]
    pub origin: Vec<String>,
    /// Where the robot takes programs: its name or address, with its port if that is not 8888 [default: that of the virtual
    /// robot with this tree].
    #[arg(long, value_name = "ADDRESS", value_parser = target)]
    pub programs: Option<Target>,
    /// The robot: where its tree is mounted, or the address of a virtual one.
    #[arg(long, value_name = "ROBOT", conflicts_with = "mountpoint")]
    pub robot: Option<PathBuf>,
    /// The mounted tree [default: the virtual robot that runs, or else /trikfs].
    pub mountpoint: Option<PathBuf>,
}

/// The options of `trik bridge prometheus`.
#[derive(Args, Clone, Debug, PartialEq, Eq)]
pub(crate) struct PrometheusArgs {
    /// The address to listen on; 0.0.0.0 or :: lets everybody in the network read.
    #[arg(long, default_value = "127.0.0.1")]
    pub address: IpAddr,
    /// The TCP port; 0 takes a free one.
    #[arg(long, default_value_t = 9464)]
    pub port: u16,
    /// The robot: where its tree is mounted, or the address of a virtual one.
    #[arg(long, value_name = "ROBOT", conflicts_with = "mountpoint")]
    pub robot: Option<PathBuf>,
    /// The mounted tree [default: the virtual robot that runs, or else /trikfs].
    pub mountpoint: Option<PathBuf>,
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_broker_is_a_name_or_an_address_with_or_without_a_port() {
        for (text, host, port, is_secure) in [
            ("broker", "broker", 1883, false),
            ("10.0.0.1:1884", "10.0.0.1", 1884, false),
            ("mqtt://broker.example/", "broker.example", 1883, false),
            ("mqtts://broker.example", "broker.example", 8883, true),
            ("mqtts://broker.example:1", "broker.example", 1, true),
            ("::1", "::1", 1883, false),
            ("[::1]", "::1", 1883, false),
            ("mqtt://[fe80::1]:99", "fe80::1", 99, false),
        ] {
            let expected = Broker {
                host: host.to_owned(),
                port,
                is_secure,
            };
            assert_eq!(broker(text), Ok(expected), "{text}");
        }
        for text in [
            "",
            ":1883",
            "mqtt://",
            "http://broker",
            "broker:0",
            "broker:x",
            "broker:65536",
            "bro ker",
            "user:secret@broker",
            "broker/topic",
        ] {
            assert!(broker(text).is_err(), "{text}");
        }
    }
}
