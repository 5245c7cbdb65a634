//! Clients without sockets: what they are told.

use super::*;
use crate::limits::{CONTROL_BYTES_MAX, DATA_BYTES_MAX};
use journal::node::Node;
use recorder::entry::Known;
use std::sync::Arc;

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
    named(hub, "c")
}

fn named(hub: &Hub, name: &str) -> (ClientId, UnixStream) {
    let (wake, woken) = UnixStream::pair().unwrap();
    wake.set_nonblocking(true).unwrap();
    (hub.enter(name, "{}".to_owned(), true, wake), woken)
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
    assert!(told.iter().any(|one| one.contains("7 samples are lost")));
    let last = told.iter().rfind(|one| one.starts_with('[')).unwrap();
    assert!(
        last.starts_with("[1, 1, 0, 0, 0, 9, 0,"),
        "the newest is there"
    );
    assert!(
        told.last().unwrap().contains(r#""statusIds":["slow"]"#),
        "it has caught up"
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
    hub.beat(1);
    let told = all(&hub, id).concat();
    assert!(told.contains(r#""subscriberIds":["c"]"#), "{told}");
    hub.beat(2);
    assert!(!all(&hub, id).concat().contains("connectionGraphUpdate"));
    let (late, _woken) = named(&hub, "d");
    hub.subscribe(late, &[(1, 1)]);
    // The first question is answered with all, each later one with what is new.
    hub.watch_graph(late, true);
    let told = all(&hub, late).concat();
    assert!(
        told.contains(r#""publishedTopics":[{"name":"/a""#),
        "{told}"
    );
    let told = all(&hub, id).concat();
    assert!(
        told.contains(r#""publishedTopics":[]"#) && told.contains("subscriberIds"),
        "{told}"
    );
    hub.leave(late);
    hub.gone();
    hub.beat(3);
    let told = all(&hub, id).concat();
    assert!(told.contains(r#""channelIds":[1]"#) && told.contains(r#""removedTopics":["/a"]"#));
    let (late, _woken) = enter(&hub);
    let told = all(&hub, late).concat();
    assert!(told.contains("the robot is gone"), "{told}");
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

#[test]
fn failures_of_nodes_stay_until_they_are_taken_back() {
    let hub = Hub::default();
    let (id, _woken) = enter(&hub);
    all(&hub, id);
    // A node may have the name of another status.
    let known = Arc::new(Known {
        number: 1,
        node: Node::sensor("robot", "u8 x"),
    });
    let fault = Entry::Fault(known.clone(), 1, 5, "broken".into());
    hub.take_faults(&[fault.clone(), fault]);
    let told = all(&hub, id);
    assert!(
        told.len() == 1 && told[0].contains(r#""id":"node:robot""#),
        "{told:?}"
    );
    hub.back();
    assert!(all(&hub, id).is_empty());
    hub.take_faults(&[Entry::Sample(known, 1, vec![1].into())]);
    let told = all(&hub, id).concat();
    assert!(told.contains(r#""statusIds":["node:robot"]"#), "{told}");
}
