//! What clients are told: channels, the newest of each one, failures, and who listens to what.
//!
//! Owns the queue of each client. A queue is bounded: a client that does not read loses the oldest samples and never delays
//! anybody; one that does not even read what it has asked for is given up. Knows no sockets: code that has one takes from its
//! queue.

use super::protocol::{self, About, Graph, Weight};
use crate::limits::{CHANNELS_MAX, CONTROL_BYTES_MAX, DATA_BYTES_MAX, SUBSCRIPTIONS_MAX};
use journal::records::Record;
use recorder::entry::Entry;
use serde_json::Value;
use std::collections::{BTreeMap, BTreeSet, HashMap, VecDeque};
use std::io::Write;
use std::os::unix::net::UnixStream;
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};

/// The name under which all is published.
const PUBLISHER: &str = "trikfs";

/// A client, by a number of its own.
pub type ClientId = u64;

/// What goes to one client next.
#[derive(Debug)]
pub enum Next {
    /// A text.
    Text(String),
    /// Bytes.
    Bytes(Vec<u8>),
}

/// A message of a channel.
#[derive(Clone)]
struct Sample {
    at_ns: u64,
    bytes: Arc<[u8]>,
}

struct Channel {
    about: About,
    newest: Option<Sample>,
}

/// What waits for one client.
struct Queue {
    name: String,
    control: VecDeque<Next>,
    control_bytes: usize,
    data: VecDeque<(u32, Sample)>,
    data_bytes: usize,
    time: Option<u64>,
    /// The numbers that a client has for a channel.
    listens: HashMap<u32, Vec<u32>>,
    subscriptions: HashMap<u32, u32>,
    watches_graph: bool,
    /// Names of parameters; all if there are none.
    watches: Option<BTreeSet<String>>,
    lost: u64,
    is_given_up: bool,
    wake: UnixStream,
}

impl Queue {
    fn say(&mut self, what: Next) {
        self.control_bytes += match &what {
            Next::Text(text) => text.len(),
            Next::Bytes(bytes) => bytes.len(),
        };
        self.is_given_up |= self.control_bytes > CONTROL_BYTES_MAX;
        if self.is_given_up {
            self.control.clear();
            self.data.clear();
        } else {
            self.control.push_back(what);
        }
        self.wake();
    }

    /// Adds a sample, instead of the oldest ones if there is no room.
    fn sample(&mut self, channel: u32, sample: &Sample) {
        let Some(subscriptions) = self.listens.get(&channel) else {
            return;
        };
        for &subscription in subscriptions {
            self.data_bytes += sample.bytes.len();
            self.data.push_back((subscription, sample.clone()));
        }
        while self.data_bytes > DATA_BYTES_MAX && self.data.len() > 1 {
            if let Some((_, old)) = self.data.pop_front() {
                self.data_bytes -= old.bytes.len();
                self.lost += 1;
            }
        }
        self.wake();
    }

    fn wake(&mut self) {
        // A full pipe wakes as well.
        let _ = self.wake.write(&[0]);
    }

    fn forget(&mut self, channel: u32) {
        for subscription in self.listens.remove(&channel).unwrap_or_default() {
            self.subscriptions.remove(&subscription);
        }
    }
}

#[derive(Default)]
struct State {
    channels: BTreeMap<u32, Channel>,
    /// Types of the tree that is there.
    schemas: HashMap<u16, (String, String)>,
    /// What the first channel of this tree has for a number.
    base: u32,
    statuses: BTreeMap<String, String>,
    clients: HashMap<ClientId, Queue>,
    services: BTreeSet<String>,
    graph: Graph,
    next_client: ClientId,
    parameters: BTreeMap<String, Value>,
}

/// What is told to all clients.
#[derive(Default)]
pub struct Hub(Mutex<State>);

impl Hub {
    fn lock(&self) -> MutexGuard<'_, State> {
        // What is in it is whole, whatever failed elsewhere.
        self.0.lock().unwrap_or_else(PoisonError::into_inner)
    }

    /// There are these services.
    pub fn offer(&self, services: &[&str]) {
        let mut state = self.lock();
        state.services = services.iter().map(|name| (*name).to_owned()).collect();
        state.redraw();
    }

    /// Takes what a recording would have of one look at the tree.
    pub fn take(&self, records: Vec<Record>) {
        let mut state = self.lock();
        let mut new = Vec::new();
        for record in records {
            match record {
                Record::Schema(id, name, text) => {
                    state.schemas.insert(id, (name, text));
                }
                Record::Channel {
                    id,
                    schema,
                    topic,
                    metadata,
                } => new.extend(state.meet(id, schema, topic, metadata)),
                Record::Message(id, at_ns, bytes) => {
                    state.tell_new(&mut new);
                    state.message(id, at_ns, bytes);
                }
            }
        }
        state.tell_new(&mut new);
    }

    /// Takes failures and recoveries of nodes, as sentences that stay until they are taken back.
    pub fn take_faults(&self, entries: &[Entry]) {
        let mut state = self.lock();
        for entry in entries {
            match entry {
                Entry::Fault(known, _, errno, reason) => {
                    let text = format!("{}: {reason} (errno {errno})", known.node.path);
                    state.fault(&known.node.path, text);
                }
                Entry::Sample(known, ..) => state.recover(&known.node.path),
                Entry::Node(_) | Entry::Line(..) | Entry::Attachment(..) | Entry::Facts(..) => {}
            }
        }
    }

    /// The tree is gone: so is all that was told of it.
    pub fn gone(&self) {
        let mut state = self.lock();
        let old: Vec<u32> = state.channels.keys().copied().collect();
        state.base = state.base.wrapping_add(1 << 16);
        state.channels.clear();
        state.schemas.clear();
        state.parameters.clear();
        let nodes: Vec<String> = state.statuses.keys().cloned().collect();
        nodes.iter().for_each(|node| state.recover(node));
        for queue in state.clients.values_mut() {
            old.iter().for_each(|channel| queue.forget(*channel));
            if !old.is_empty() {
                queue.say(Next::Text(protocol::unadvertise(&old)));
            }
            let text = protocol::status(Weight::Error, "the robot is gone", Some("robot"));
            queue.say(Next::Text(text));
        }
        state.redraw();
    }

    /// It is there again.
    pub fn back(&self) {
        for queue in self.lock().clients.values_mut() {
            queue.say(Next::Text(protocol::remove_status(&["robot"])));
        }
    }

    /// What time it is, for all.
    pub fn beat(&self, now_ns: u64) {
        for queue in self.lock().clients.values_mut() {
            queue.time = Some(now_ns);
            queue.wake();
        }
    }

    /// A client that has come; it is told what there is. What is written to `wake` wakes it.
    pub fn enter(&self, name: &str, info: String, may_act: bool, wake: UnixStream) -> ClientId {
        let mut state = self.lock();
        let id = state.next_client;
        state.next_client += 1;
        let mut queue = Queue {
            name: name.to_owned(),
            control: VecDeque::new(),
            control_bytes: 0,
            data: VecDeque::new(),
            data_bytes: 0,
            time: None,
            listens: HashMap::new(),
            subscriptions: HashMap::new(),
            watches_graph: false,
            watches: None,
            lost: 0,
            is_given_up: false,
            wake,
        };
        queue.say(Next::Text(info));
        let channels = state.channels.iter().map(|(id, one)| (*id, &one.about));
        queue.say(Next::Text(protocol::advertise(channels)));
        if may_act {
            queue.say(Next::Text(protocol::advertise_services(
                &super::robot::SERVICES,
            )));
        }
        for (node, text) in &state.statuses {
            let text = protocol::status(Weight::Warning, text, Some(node));
            queue.say(Next::Text(text));
        }
        state.clients.insert(id, queue);
        id
    }

    /// It has gone.
    pub fn leave(&self, id: ClientId) {
        let mut state = self.lock();
        state.clients.remove(&id);
        state.redraw();
    }

    /// What goes to it next; None if there is nothing, and an error if it was given up.
    ///
    /// # Errors
    /// It has not read what it has asked for.
    pub fn next(&self, id: ClientId) -> Result<Option<Next>, GivenUp> {
        let mut state = self.lock();
        let Some(queue) = state.clients.get_mut(&id) else {
            return Err(GivenUp);
        };
        if queue.is_given_up {
            return Err(GivenUp);
        }
        if let Some(next) = queue.control.pop_front() {
            queue.control_bytes -= match &next {
                Next::Text(text) => text.len(),
                Next::Bytes(bytes) => bytes.len(),
            };
            return Ok(Some(next));
        }
        if let Some(now_ns) = queue.time.take() {
            return Ok(Some(Next::Bytes(protocol::time(now_ns))));
        }
        if queue.lost > 0 {
            let text = format!("this client is slow: {} samples are lost", queue.lost);
            queue.lost = 0;
            let text = protocol::status(Weight::Warning, &text, Some("slow"));
            return Ok(Some(Next::Text(text)));
        }
        Ok(queue.data.pop_front().map(|(subscription, sample)| {
            queue.data_bytes -= sample.bytes.len();
            Next::Bytes(protocol::message(subscription, sample.at_ns, &sample.bytes))
        }))
    }

    /// An answer for one client.
    pub fn say(&self, id: ClientId, what: Next) {
        if let Some(queue) = self.lock().clients.get_mut(&id) {
            queue.say(what);
        }
    }

    /// A client listens to channels from now on; the newest of each comes at once. What is wrong is told to it.
    pub fn subscribe(&self, id: ClientId, pairs: &[(u32, u32)]) {
        let mut state = self.lock();
        let State {
            clients, channels, ..
        } = &mut *state;
        let Some(queue) = clients.get_mut(&id) else {
            return;
        };
        for &(subscription, channel) in pairs {
            let why = match channels.get(&channel) {
                _ if queue.subscriptions.len() >= SUBSCRIPTIONS_MAX => "too many subscriptions",
                _ if queue.subscriptions.contains_key(&subscription) => {
                    "a subscription with this number is there"
                }
                None => "there is no channel with this number",
                Some(one) => {
                    queue.subscriptions.insert(subscription, channel);
                    queue.listens.entry(channel).or_default().push(subscription);
                    if let Some(newest) = &one.newest {
                        queue.data_bytes += newest.bytes.len();
                        queue.data.push_back((subscription, newest.clone()));
                        queue.wake();
                    }
                    continue;
                }
            };
            let text = format!("subscription {subscription} to channel {channel}: {why}");
            queue.say(Next::Text(protocol::status(Weight::Warning, &text, None)));
        }
        state.redraw();
    }

    /// It does not any more.
    pub fn unsubscribe(&self, id: ClientId, subscriptions: &[u32]) {
        let mut state = self.lock();
        let Some(queue) = state.clients.get_mut(&id) else {
            return;
        };
        for subscription in subscriptions {
            let Some(channel) = queue.subscriptions.remove(subscription) else {
                continue;
            };
            if let Some(all) = queue.listens.get_mut(&channel) {
                all.retain(|one| one != subscription);
                if all.is_empty() {
                    queue.listens.remove(&channel);
                }
            }
        }
        state.redraw();
    }

    /// A client is told of the graph, or not any more.
    pub fn watch_graph(&self, id: ClientId, wants: bool) {
        let mut state = self.lock();
        let State { clients, graph, .. } = &mut *state;
        let Some(queue) = clients.get_mut(&id) else {
            return;
        };
        queue.watches_graph = wants;
        if wants && let Some(text) = protocol::graph_update(&Graph::default(), graph, PUBLISHER) {
            queue.say(Next::Text(text));
        }
    }

    /// A client is told of changes of parameters, of all if none is named, or not any more.
    pub fn watch_parameters(&self, id: ClientId, names: Vec<String>, wants: bool) {
        if let Some(queue) = self.lock().clients.get_mut(&id) {
            let names: BTreeSet<String> = names.into_iter().collect();
            match (wants, &mut queue.watches) {
                (true, Some(known)) if !known.is_empty() && !names.is_empty() => {
                    known.extend(names)
                }
                (true, watches) => *watches = Some(names),
                (false, Some(known)) if !names.is_empty() && !known.is_empty() => {
                    known.retain(|name| !names.contains(name));
                }
                (false, watches) => *watches = None,
            }
        }
    }

    /// Whether anybody wants to hear of parameters.
    pub fn has_watchers(&self) -> bool {
        let state = self.lock();
        state.clients.values().any(|queue| queue.watches.is_some())
    }

    /// The parameters as they are: who wants to hear of a change does.
    pub fn parameters(&self, all: &[(String, Option<Value>)]) {
        let mut state = self.lock();
        let State {
            clients,
            parameters,
            ..
        } = &mut *state;
        let is_new =
            |(name, value): &&(String, Option<Value>)| parameters.get(name) != value.as_ref();
        let mut changed: Vec<(String, Option<Value>)> =
            all.iter().filter(is_new).cloned().collect();
        let left = parameters.keys();
        let left = left.filter(|name| !all.iter().any(|(one, _)| one == *name));
        changed.extend(left.map(|name| (name.clone(), None)));
        if changed.is_empty() {
            return;
        }
        for (name, value) in &changed {
            match value {
                Some(value) => parameters.insert(name.clone(), value.clone()),
                None => parameters.remove(name),
            };
        }
        for queue in clients.values_mut() {
            let Some(names) = &queue.watches else {
                continue;
            };
            let wanted = changed.iter();
            let wanted = wanted.filter(|(name, _)| names.is_empty() || names.contains(name));
            let wanted: Vec<_> = wanted.cloned().collect();
            if !wanted.is_empty() {
                queue.say(Next::Text(protocol::parameter_values(&wanted, None)));
            }
        }
    }
}

/// A client does not read what it has asked for.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct GivenUp;

impl State {
    /// A channel that is new: its number.
    fn meet(
        &mut self,
        id: u16,
        schema: u16,
        topic: String,
        metadata: BTreeMap<String, String>,
    ) -> Option<u32> {
        let (schema_name, schema) = self.schemas.get(&schema).cloned().unwrap_or_default();
        let number = self.base | u32::from(id);
        // A node whose format has changed comes again under its topic: the former channel has nothing more to say.
        let former = self
            .channels
            .iter()
            .find(|(_, one)| one.about.topic == topic);
        let former = former.map(|(number, _)| *number);
        if let Some(former) = former.filter(|former| *former != number) {
            self.channels.remove(&former);
            for queue in self.clients.values_mut() {
                queue.forget(former);
                queue.say(Next::Text(protocol::unadvertise(&[former])));
            }
        }
        if self.channels.len() >= CHANNELS_MAX {
            return None;
        }
        let about = About {
            topic,
            schema_name,
            schema,
            metadata,
        };
        let channel = Channel {
            about,
            newest: None,
        };
        self.channels
            .insert(number, channel)
            .is_none()
            .then_some(number)
    }

    /// Tells of channels that are new.
    fn tell_new(&mut self, new: &mut Vec<u32>) {
        if new.is_empty() {
            return;
        }
        let of = |id: &u32| Some((*id, &self.channels.get(id)?.about));
        let text = protocol::advertise(new.iter().filter_map(of));
        for queue in self.clients.values_mut() {
            queue.say(Next::Text(text.clone()));
        }
        new.clear();
        self.redraw();
    }

    fn message(&mut self, id: u16, at_ns: u64, bytes: Vec<u8>) {
        let number = self.base | u32::from(id);
        let Some(channel) = self.channels.get_mut(&number) else {
            return;
        };
        let sample = Sample {
            at_ns,
            bytes: bytes.into(),
        };
        for queue in self.clients.values_mut() {
            queue.sample(number, &sample);
        }
        channel.newest = Some(sample);
    }

    fn fault(&mut self, node: &str, text: String) {
        if self.statuses.get(node) == Some(&text) {
            return;
        }
        for queue in self.clients.values_mut() {
            let text = protocol::status(Weight::Warning, &text, Some(node));
            queue.say(Next::Text(text));
        }
        self.statuses.insert(node.to_owned(), text);
    }

    fn recover(&mut self, node: &str) {
        if self.statuses.remove(node).is_some() {
            for queue in self.clients.values_mut() {
                queue.say(Next::Text(protocol::remove_status(&[node])));
            }
        }
    }

    /// Tells those who want to know who publishes and who listens.
    fn redraw(&mut self) {
        let topics = self.channels.values();
        let mut graph = Graph {
            topics: topics.map(|one| one.about.topic.clone()).collect(),
            services: self.services.clone(),
            ..Graph::default()
        };
        for queue in self.clients.values() {
            for channel in queue.listens.keys() {
                if let Some(one) = self.channels.get(channel) {
                    let listeners = graph.listened.entry(one.about.topic.clone());
                    listeners.or_default().insert(queue.name.clone());
                }
            }
        }
        let Some(text) = protocol::graph_update(&self.graph, &graph, PUBLISHER) else {
            return;
        };
        self.graph = graph;
        for queue in self.clients.values_mut().filter(|one| one.watches_graph) {
            queue.say(Next::Text(text.clone()));
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn channel(id: u16, topic: &str) -> [Record; 2] {
        [
            Record::Schema(id, format!("trik_msgs/msg/T{id}"), "int32 x\n".to_owned()),
            Record::Channel {
                id,
                schema: id,
                topic: topic.to_owned(),
                metadata: BTreeMap::new(),
            },
        ]
    }

    fn enter(hub: &Hub) -> (ClientId, UnixStream) {
        let (wake, woken) = UnixStream::pair().unwrap();
        wake.set_nonblocking(true).unwrap();
        (hub.enter("c", "{}".to_owned(), true, wake), woken)
    }

    fn all(hub: &Hub, id: ClientId) -> Vec<String> {
        std::iter::from_fn(|| hub.next(id).unwrap())
            .map(|next| match next {
                Next::Text(text) => text,
                Next::Bytes(bytes) => format!("{bytes:?}"),
            })
            .collect()
    }

    #[test]
    fn a_late_client_gets_the_newest_at_once_and_then_all() {
        let hub = Hub::default();
        hub.take(channel(1, "/a").into());
        hub.take(vec![
            Record::Message(1, 5, vec![1]),
            Record::Message(1, 6, vec![2]),
        ]);
        let (id, _woken) = enter(&hub);
        let told = all(&hub, id);
        assert!(told[1].contains(r#""topic":"/a""#), "{told:?}");
        hub.subscribe(id, &[(7, 1), (8, 99)]);
        let told = all(&hub, id);
        assert!(told[0].contains("no channel"), "{told:?}");
        assert_eq!(told[1], format!("{:?}", protocol::message(7, 6, &[2])));
        hub.take(vec![Record::Message(1, 9, vec![3])]);
        assert_eq!(
            all(&hub, id),
            [format!("{:?}", protocol::message(7, 9, &[3]))]
        );
        hub.unsubscribe(id, &[7, 8]);
        hub.take(vec![Record::Message(1, 10, vec![3])]);
        assert!(all(&hub, id).is_empty());
    }

    #[test]
    fn a_slow_client_loses_the_oldest_and_one_that_only_asks_is_given_up() {
        let hub = Hub::default();
        hub.take(channel(1, "/a").into());
        let (slow, _woken) = enter(&hub);
        let (other, _woken) = enter(&hub);
        hub.subscribe(slow, &[(1, 1)]);
        hub.subscribe(other, &[(1, 1)]);
        all(&hub, other);
        let size = DATA_BYTES_MAX / 4;
        for at in 0..10 {
            hub.take(vec![Record::Message(1, at, vec![0; size])]);
            assert_eq!(all(&hub, other).len(), 1);
        }
        let told = all(&hub, slow);
        assert!(told.iter().any(|one| one.contains("6 samples are lost")));
        let last = told.last().unwrap();
        assert!(
            last.starts_with("[1, 1, 0, 0, 0, 9, 0,"),
            "the newest is there"
        );
        for _ in 0..CONTROL_BYTES_MAX / 1000 + 1 {
            hub.say(slow, Next::Text("x".repeat(1000)));
        }
        assert!(hub.next(slow).is_err());
        assert!(hub.next(other).is_ok());
    }

    #[test]
    fn a_robot_that_is_gone_takes_its_channels_with_it() {
        let hub = Hub::default();
        hub.take(channel(1, "/a").into());
        let (id, _woken) = enter(&hub);
        hub.watch_graph(id, true);
        hub.subscribe(id, &[(1, 1)]);
        let told = all(&hub, id).concat();
        assert!(told.contains(r#""subscriberIds":["c"]"#), "{told}");
        hub.gone();
        let told = all(&hub, id).concat();
        assert!(told.contains(r#""channelIds":[1]"#) && told.contains(r#""removedTopics":["/a"]"#));
        hub.back();
        hub.take(channel(1, "/a").into());
        let told = all(&hub, id).concat();
        assert!(told.contains(r#""id":65537"#), "{told}");
        hub.take(vec![Record::Message(1, 5, vec![1])]);
        assert!(all(&hub, id).is_empty(), "nobody has subscribed to it");
    }

    #[test]
    fn changes_of_parameters_are_told_to_those_who_want_them() {
        let hub = Hub::default();
        let (id, _woken) = enter(&hub);
        all(&hub, id);
        let value = |number: i32| vec![("a".to_owned(), Some(Value::from(number)))];
        hub.parameters(&value(1));
        assert!(!hub.has_watchers() && all(&hub, id).is_empty());
        hub.watch_parameters(id, vec!["a".to_owned(), "b".to_owned()], true);
        hub.parameters(&value(1));
        assert!(all(&hub, id).is_empty(), "it is as it was");
        hub.parameters(&value(2));
        assert!(all(&hub, id)[0].contains(r#""value":2"#));
        hub.watch_parameters(id, Vec::new(), false);
        hub.parameters(&value(3));
        assert!(all(&hub, id).is_empty());
    }
}
