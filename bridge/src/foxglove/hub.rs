//! What clients are told: channels, the newest of each one, failures, and who listens to what.
//!
//! Owns which client hears what; `queue` has what waits for each one, within its bounds. Knows no sockets: code that has one
//! takes from its queue.

mod queue;

pub use queue::{GivenUp, Next};

use super::protocol::{self, About, Graph, Weight};
use super::robot;
use crate::limits::CHANNELS_MAX;
use journal::records::Record;
use queue::{Queue, Sample, Watches};
use recorder::entry::Entry;
use recorder::errno::LEFT;
use serde_json::Value;
use std::collections::{BTreeMap, BTreeSet, HashMap};
use std::os::unix::net::UnixStream;
use std::sync::{Mutex, MutexGuard, PoisonError};

/// The name under which all is published.
const PUBLISHER: &str = "trikfs";
/// The id of the status of a robot that is gone.
const ROBOT: &str = "robot";
/// That of what the bridge itself could not pass on.
const BRIDGE: &str = "bridge";

/// A client, by a number of its own.
pub type ClientId = u64;

struct Channel {
    about: About,
    newest: Option<Sample>,
}

#[derive(Default)]
struct State {
    channels: BTreeMap<u32, Channel>,
    /// Types of the tree that is there.
    schemas: HashMap<u16, (String, String)>,
    /// What the first channel of this tree has for a number.
    base: u32,
    /// What is wrong, by the id of its status.
    statuses: BTreeMap<String, (Weight, String)>,
    clients: HashMap<ClientId, Queue>,
    services: BTreeSet<String>,
    /// What those who watch it know.
    graph: Graph,
    /// It may be another one by now.
    is_dirty: bool,
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
        state.is_dirty = true;
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
                // It was taken out of the configuration.
                Entry::Fault(known, _, LEFT, _) => state.recover(&id_of(&known.node.path)),
                Entry::Fault(known, _, errno, reason) => {
                    let text = format!("{}: {reason} (errno {errno})", known.node.path);
                    state.fault(&id_of(&known.node.path), Weight::Warning, text);
                }
                Entry::Sample(known, ..) => state.recover(&id_of(&known.node.path)),
                Entry::Node(_) | Entry::Line(..) | Entry::Attachment(..) | Entry::Facts(..) => {}
            }
        }
    }

    /// Something of the tree cannot be told; of a tree the first one is.
    pub fn failed(&self, why: &str) {
        let mut state = self.lock();
        if !state.statuses.contains_key(BRIDGE) {
            state.fault(BRIDGE, Weight::Error, why.to_owned());
        }
    }

    /// The tree is gone: so is all that was told of it.
    pub fn gone(&self) {
        let mut state = self.lock();
        state.clear();
        let ids: Vec<String> = state.statuses.keys().cloned().collect();
        ids.iter().for_each(|id| state.recover(id));
        state.fault(ROBOT, Weight::Error, "the robot is gone".to_owned());
    }

    /// It is there again.
    pub fn back(&self) {
        self.lock().recover(ROBOT);
    }

    /// What time it is, for all. With it comes what has become of the graph.
    pub fn beat(&self, now_ns: u64) {
        let mut state = self.lock();
        for queue in state.clients.values_mut() {
            queue.time(now_ns);
        }
        if state.clients.values().any(|queue| queue.watches_graph) {
            state.redraw();
        }
    }

    /// A client that has come; it is told what there is. What is written to `wake` wakes it.
    pub fn enter(&self, name: &str, info: String, may_act: bool, wake: UnixStream) -> ClientId {
        let mut state = self.lock();
        let id = state.next_client;
        state.next_client += 1;
        let mut queue = Queue::new(name, wake);
        queue.say(Next::Text(info));
        let channels = state.channels.iter().map(|(id, one)| (*id, &one.about));
        queue.say(Next::Text(protocol::advertise(channels)));
        let services = robot::services(may_act);
        queue.say(Next::Text(protocol::advertise_services(services)));
        for (id, (weight, text)) in &state.statuses {
            queue.say(Next::Text(protocol::status(*weight, text, Some(id))));
        }
        state.clients.insert(id, queue);
        id
    }

    /// It has gone.
    pub fn leave(&self, id: ClientId) {
        let mut state = self.lock();
        state.is_dirty |= state.clients.remove(&id).is_some();
    }

    /// What goes to it next; None if there is nothing, and an error if it was given up.
    ///
    /// # Errors
    /// It has not read what it has asked for.
    pub fn next(&self, id: ClientId) -> Result<Option<Next>, GivenUp> {
        match self.lock().clients.get_mut(&id) {
            Some(queue) => queue.next(),
            None => Err(GivenUp),
        }
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
            let done = match channels.get(&channel) {
                Some(one) => queue.subscribe(subscription, channel, one.newest.as_ref()),
                None => Err("there is no channel with this number"),
            };
            if let Err(why) = done {
                let text = format!("subscription {subscription} to channel {channel}: {why}");
                queue.warn(&text);
            }
        }
        state.is_dirty = true;
    }

    /// It does not any more.
    pub fn unsubscribe(&self, id: ClientId, subscriptions: &[u32]) {
        let mut state = self.lock();
        if let Some(queue) = state.clients.get_mut(&id) {
            queue.unsubscribe(subscriptions);
            state.is_dirty = true;
        }
    }

    /// A client is told of the graph, or not any more.
    pub fn watch_graph(&self, id: ClientId, wants: bool) {
        let mut state = self.lock();
        // One who asks again is told all again, and nothing twice.
        if let Some(queue) = state.clients.get_mut(&id) {
            queue.watches_graph = false;
        }
        if !wants {
            return;
        }
        state.redraw();
        let State { clients, graph, .. } = &mut *state;
        if let Some(queue) = clients.get_mut(&id) {
            queue.watches_graph = true;
            if let Some(text) = protocol::graph_update(&Graph::default(), graph, PUBLISHER) {
                queue.say(Next::Text(text));
            }
        }
    }

    /// A client is told of changes of parameters, of all if none is named, or not any more.
    pub fn watch_parameters(&self, id: ClientId, names: Vec<String>, wants: bool) {
        if let Some(queue) = self.lock().clients.get_mut(&id) {
            queue.watch(names, wants);
        }
    }

    /// Whether anybody wants to hear of parameters.
    pub fn has_watchers(&self) -> bool {
        let state = self.lock();
        let mut clients = state.clients.values();
        clients.any(|queue| queue.watches != Watches::None)
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
        let names: BTreeSet<&str> = all.iter().map(|(name, _)| name.as_str()).collect();
        let left = parameters.keys();
        let left = left.filter(|name| !names.contains(name.as_str()));
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
            let wanted = changed.iter().filter(|(name, _)| queue.watches.has(name));
            let wanted: Vec<_> = wanted.cloned().collect();
            if !wanted.is_empty() {
                queue.say(Next::Text(protocol::parameter_values(&wanted, None)));
            }
        }
    }
}

/// The id of the status of a node, which is that of no other status.
fn id_of(node: &str) -> String {
    format!("node:{node}")
}

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
                queue.forget(&[former]);
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
        self.is_dirty = true;
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

    /// Channels and parameters are gone, and later ones have other numbers.
    fn clear(&mut self) {
        let old: Vec<u32> = self.channels.keys().copied().collect();
        self.base = self.base.wrapping_add(1 << 16);
        self.channels.clear();
        self.schemas.clear();
        self.parameters.clear();
        for queue in self.clients.values_mut() {
            queue.forget(&old);
            if !old.is_empty() {
                queue.say(Next::Text(protocol::unadvertise(&old)));
            }
        }
        self.is_dirty = true;
    }

    fn fault(&mut self, id: &str, weight: Weight, text: String) {
        if self.statuses.get(id).is_some_and(|(_, old)| *old == text) {
            return;
        }
        for queue in self.clients.values_mut() {
            queue.say(Next::Text(protocol::status(weight, &text, Some(id))));
        }
        self.statuses.insert(id.to_owned(), (weight, text));
    }

    fn recover(&mut self, id: &str) {
        if self.statuses.remove(id).is_some() {
            for queue in self.clients.values_mut() {
                queue.say(Next::Text(protocol::remove_status(&[id])));
            }
        }
    }

    /// Tells those who want to know who publishes and who listens.
    fn redraw(&mut self) {
        if !std::mem::take(&mut self.is_dirty) {
            return;
        }
        let topics = self.channels.values();
        let mut graph = Graph {
            topics: topics.map(|one| one.about.topic.clone()).collect(),
            services: self.services.clone(),
            ..Graph::default()
        };
        for queue in self.clients.values() {
            for channel in queue.listens() {
                if let Some(one) = self.channels.get(&channel) {
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
mod tests;
