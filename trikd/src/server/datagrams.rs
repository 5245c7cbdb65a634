//! Telemetry as datagrams: one JSON object after the other to one address, for plotting programs.
//!
//! Owns two kinds of them: what answers `data` on port 9000, and the newest of every node. Knows no node by its name.

use crate::limits;
use crate::sampler::Sampler;
use journal::layout::{Layout, Number};
use lang_text::json::quoted;
use recorder::desk::Listener;
use recorder::entry::Entry;
use recorder::watch::{Wants, Wish};
use std::collections::BTreeMap;
use std::io;
use std::net::{IpAddr, Ipv4Addr, Ipv6Addr, SocketAddr};
use std::rc::Rc;
use std::time::{Duration, SystemTime, UNIX_EPOCH};
use tokio::net::UdpSocket;

/// An address of this machine from which such another one is reached.
fn any(to: SocketAddr) -> SocketAddr {
    let any: IpAddr = if to.is_ipv4() {
        Ipv4Addr::UNSPECIFIED.into()
    } else {
        Ipv6Addr::UNSPECIFIED.into()
    };
    (any, 0).into()
}

/// Sends for ever, every `period_ms`.
///
/// # Errors
/// There is no socket.
pub async fn send(sampler: Rc<Sampler>, to: SocketAddr, period_ms: u64) -> io::Result<()> {
    let socket = UdpSocket::bind(any(to)).await?;
    let mut tick = tokio::time::interval(Duration::from_millis(period_ms));
    tick.set_missed_tick_behavior(tokio::time::MissedTickBehavior::Delay);
    loop {
        tick.tick().await;
        let snapshot = sampler.snapshot().await;
        let time_s = SystemTime::now()
            .duration_since(UNIX_EPOCH)
            .map_or(0.0, |time| time.as_secs_f64());
        // Nobody may be listening, or the network may be away.
        let _ = socket.send_to(snapshot.json(time_s).as_bytes(), to).await;
    }
}

/// The newest of every node, as objects `{"timestamp":1.5,"nodes":{"sensors/A1":{"value":27}}}`; a node without a value has
/// null.
pub struct Datagrams {
    socket: std::net::UdpSocket,
    to: SocketAddr,
    period_ns: u64,
    due_ns: u64,
    /// What is shown of each node, by its path.
    shown: BTreeMap<String, String>,
    /// How a tuple of a node is read, by the number of the node.
    layouts: BTreeMap<u32, Option<Layout>>,
}

impl Datagrams {
    /// To this address, every `period_ms`.
    ///
    /// # Errors
    /// There is no socket.
    pub fn to(to: SocketAddr, period_ms: u64) -> io::Result<Self> {
        let socket = std::net::UdpSocket::bind(any(to))?;
        socket.set_nonblocking(true)?;
        Ok(Self {
            socket,
            to,
            period_ns: period_ms * 1_000_000,
            due_ns: 0,
            shown: BTreeMap::new(),
            layouts: BTreeMap::new(),
        })
    }

    fn hear(&mut self, entry: &Entry) {
        match entry {
            Entry::Sample(known, _, tuple) => {
                let layout = self.layouts.entry(known.number);
                let layout = layout.or_insert_with(|| Layout::parse(&known.node.format).ok());
                if let Some(shown) = layout.as_ref().and_then(|layout| shown(layout, tuple)) {
                    self.shown.insert(known.node.path.clone(), shown);
                }
            }
            Entry::Fault(known, ..) => {
                if let Some(shown) = self.shown.get_mut(&known.node.path) {
                    *shown = "null".to_owned();
                }
            }
            Entry::Node(_) | Entry::Line(..) | Entry::Attachment(..) | Entry::Facts(..) => {}
        }
    }

    /// All nodes, in as many datagrams as it takes.
    fn send(&self, now_ns: u64) {
        let time = Duration::from_nanos(now_ns).as_secs_f64();
        let begin = format!("{{\"timestamp\":{time:.6},\"nodes\":{{");
        let mut text = begin.clone();
        let send = |text: &str| {
            // Nobody may be listening, or the network may be away.
            let _ = (self.socket).send_to(format!("{text}}}}}").as_bytes(), self.to);
        };
        for (path, shown) in &self.shown {
            if text.len() + path.len() + shown.len() > limits::DATAGRAM_BYTES && text != begin {
                send(&text);
                text.clone_from(&begin);
            }
            if text != begin {
                text.push(',');
            }
            text.push_str(&format!(
                "{}:{shown}",
                quoted(path, limits::NODE_PATH_BYTES)
            ));
        }
        if text != begin {
            send(&text);
        }
    }
}

impl Listener for Datagrams {
    fn wants(&self) -> Wants {
        Box::new(|_| Some(Wish::ByTheClock))
    }

    fn put(&mut self, entries: &[Entry], now_ns: u64) -> bool {
        for entry in entries {
            self.hear(entry);
        }
        // A clock that was set back does not end it.
        if now_ns >= self.due_ns || self.due_ns > now_ns + self.period_ns {
            self.due_ns = now_ns + self.period_ns;
            self.send(now_ns);
        }
        true
    }
}

/// A tuple as JSON; None for bytes without names, which no plot shows, and for too many numbers.
fn shown(layout: &Layout, tuple: &[u8]) -> Option<String> {
    match layout {
        Layout::Bytes(_) => None,
        Layout::Text(_) => Some(quoted(&layout.show(tuple), limits::VALUE_BYTES)),
        Layout::Fields(fields) if fields.len() > limits::DATAGRAM_NUMBERS => None,
        Layout::Fields(_) => {
            let numbers = layout.numbers(tuple).into_iter();
            let named = layout.names().into_iter().zip(numbers);
            let words: Vec<String> = named
                .map(|(name, number)| format!("{}:{}", quoted(&name, 64), json(number)))
                .collect();
            Some(format!("{{{}}}", words.join(",")))
        }
    }
}

/// JSON knows neither infinity nor what is no number.
fn json(number: Number) -> String {
    match number.to_f64().is_finite() {
        true => number.to_string(),
        false => "null".to_owned(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use journal::node::Node;
    use recorder::entry::Known;
    use std::sync::Arc;

    fn of(path: &str, format: &str, number: u32) -> Arc<Known> {
        let node = Node::sensor(path, format);
        Arc::new(Known { number, node })
    }

    #[test]
    fn every_node_is_in_a_datagram_and_a_failure_is_null() {
        let socket = std::net::UdpSocket::bind("127.0.0.1:0").unwrap();
        let mut all = Datagrams::to(socket.local_addr().unwrap(), 50).unwrap();
        let (a, b) = (of("a", "i16 x, f32 y", 1), of("g/b", "u8 x", 2));
        let bytes = of("raw", "u8 x 4", 3);
        let mut tuple = (-5_i16).to_ne_bytes().to_vec();
        tuple.extend(f32::NAN.to_ne_bytes());
        let second_ns = 1_000_000_000;
        assert!(all.put(
            &[
                Entry::Sample(a, second_ns, tuple.into()),
                Entry::Sample(b.clone(), second_ns, Arc::new([7])),
                Entry::Sample(bytes, second_ns, Arc::new([1, 2, 3, 4])),
            ],
            second_ns,
        ));
        // Nothing before its time.
        assert!(all.put(&[], second_ns + 1));
        let fault = Entry::Fault(b, second_ns, 5, "away".into());
        assert!(all.put(&[fault], second_ns + 50_000_000));
        let mut got = Vec::new();
        for _ in 0..2 {
            let mut buffer = [0; 9000];
            let size = socket.recv(&mut buffer).unwrap();
            got.push(String::from_utf8(buffer[..size].to_vec()).unwrap());
        }
        assert_eq!(
            got,
            [
                r#"{"timestamp":1.000000,"nodes":{"a":{"x":-5,"y":null},"g/b":{"x":7}}}"#,
                r#"{"timestamp":1.050000,"nodes":{"a":{"x":-5,"y":null},"g/b":null}}"#,
            ]
        );
    }

    #[test]
    fn many_nodes_come_in_several_datagrams_that_are_whole() {
        let socket = std::net::UdpSocket::bind("127.0.0.1:0").unwrap();
        let mut all = Datagrams::to(socket.local_addr().unwrap(), 50).unwrap();
        for number in 0..500 {
            let known = of(&format!("group/node{number}"), "u32 value", number);
            all.hear(&Entry::Sample(
                known,
                1,
                number.to_ne_bytes().to_vec().into(),
            ));
        }
        all.send(1);
        let mut seen = 0;
        while seen < 500 {
            let mut buffer = [0; 2 * limits::DATAGRAM_BYTES];
            let size = socket.recv(&mut buffer).unwrap();
            assert!(size <= limits::DATAGRAM_BYTES + 16, "{size}");
            let text = std::str::from_utf8(&buffer[..size]).unwrap();
            assert!(text.ends_with("}}}"), "{text}");
            seen += text.matches("group/node").count();
        }
        assert_eq!(seen, 500);
    }
}
