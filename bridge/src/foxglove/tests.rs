//! Clients as bytes: those that are refused, those that are hostile, and those that do not read.

use super::client::House;
use super::robot::Robot;
use super::{Server, serve};
use crate::limits::{CLIENTS_MAX, DATA_BYTES_MAX, HANDSHAKE_TIME, MESSAGE_BYTES_MAX, MISTAKES_MAX};
use journal::node::Node;
use recorder::entry::{Entry, Known};
use std::io::{ErrorKind, Read, Write};
use std::net::{SocketAddr, TcpStream};
use std::path::Path;
use std::sync::Arc;
use std::time::{Duration, Instant};
use tungstenite::handshake::client::generate_key;
use tungstenite::http::Request;
use tungstenite::{Error, Message, WebSocket, client};

/// Longer than anything here takes.
const LONG: Duration = Duration::from_secs(60);

fn server(root: &Path) -> Server {
    let house = House {
        name: "test".to_owned(),
        session: "1".to_owned(),
        origins: Vec::new(),
        lets_all_act: false,
    };
    let address = SocketAddr::from(([127, 0, 0, 1], 0));
    serve(address, house, Robot::new(root, None), "test 1").unwrap()
}

fn request(address: SocketAddr, more: &[(&str, &str)]) -> Request<()> {
    let mut request = Request::builder()
        .uri(format!("ws://{address}/"))
        .header("Host", address.to_string())
        .header("Connection", "Upgrade")
        .header("Upgrade", "websocket")
        .header("Sec-WebSocket-Version", "13")
        .header("Sec-WebSocket-Key", generate_key());
    for (name, value) in more {
        request = request.header(*name, *value);
    }
    request.body(()).unwrap()
}

type Socket = WebSocket<TcpStream>;

fn connect(address: SocketAddr, more: &[(&str, &str)]) -> Result<Socket, u16> {
    let stream = TcpStream::connect(address).unwrap();
    stream.set_read_timeout(Some(LONG)).unwrap();
    match client(request(address, more), stream) {
        Ok((socket, _)) => Ok(socket),
        Err(tungstenite::HandshakeError::Failure(Error::Http(answer))) => {
            Err(answer.status().as_u16())
        }
        Err(why) => panic!("{why}"),
    }
}

const SDK: [(&str, &str); 1] = [("Sec-WebSocket-Protocol", "x, foxglove.sdk.v1")];

/// The next text that has this in it.
fn until(socket: &mut Socket, part: &str) -> String {
    let begin = Instant::now();
    loop {
        assert!(begin.elapsed() < LONG, "{part} does not come");
        if let Message::Text(text) = socket.read().unwrap()
            && text.as_str().contains(part)
        {
            return text.as_str().to_owned();
        }
    }
}

/// The server ends this connection.
fn ends(socket: &mut Socket) {
    let begin = Instant::now();
    loop {
        assert!(begin.elapsed() < LONG, "a connection does not end");
        match socket.read() {
            Ok(_) => {}
            Err(Error::Io(why)) if why.kind() == ErrorKind::WouldBlock => {
                panic!("a connection is silent, and does not end")
            }
            Err(_) => return,
        }
    }
}

fn node(path: &str, format: &str) -> Arc<Known> {
    Arc::new(Known {
        number: 1,
        node: Node::sensor(path, format),
    })
}

#[test]
fn only_clients_that_speak_the_protocol_come_in_and_no_more_than_there_is_room_for() {
    let directory = tempfile::tempdir().unwrap();
    let server = server(directory.path());
    let at = server.address();
    assert_eq!(connect(at, &[]).err(), Some(400));
    let other = [("Sec-WebSocket-Protocol", "foxglove.sdk.v9")];
    assert_eq!(connect(at, &other).err(), Some(400));
    let page = [SDK[0], ("Origin", "http://evil.example")];
    assert_eq!(connect(at, &page).err(), Some(403));
    let former = [("Sec-WebSocket-Protocol", "foxglove.websocket.v1")];
    let mut all = vec![connect(at, &former).unwrap()];
    let told = until(&mut all[0], "serverInfo");
    assert!(
        told.contains(r#""sessionId":"1""#) && told.contains("services"),
        "{told}"
    );
    while all.len() < CLIENTS_MAX {
        match connect(at, &SDK) {
            Ok(socket) => all.push(socket),
            // Those that were refused may not have left yet.
            Err(status) => assert_eq!(status, 503),
        }
    }
    assert_eq!(connect(at, &SDK).err(), Some(503));
    drop(all);
    let begin = Instant::now();
    while connect(at, &SDK).is_err() {
        assert!(begin.elapsed() < LONG, "no place became free");
    }
}

#[test]
fn hostile_bytes_end_their_own_connection_alone() {
    let directory = tempfile::tempdir().unwrap();
    let mut server = server(directory.path());
    let at = server.address();
    let mut good = connect(at, &SDK).unwrap();
    until(&mut good, "serverInfo");
    // A handshake that never ends, rubbish instead of one, and rubbish behind one.
    let begin = Instant::now();
    let mut slow = TcpStream::connect(at).unwrap();
    slow.write_all(b"GET / HTTP/1.1\r\nHost:").unwrap();
    for bytes in [&[0xff_u8; 4096][..], b"\0", b"GET / HTTP/1.1\r\n\r\n"] {
        let mut rubbish = TcpStream::connect(at).unwrap();
        rubbish.set_read_timeout(Some(LONG)).unwrap();
        let _ = rubbish.write_all(bytes);
        let _ = rubbish.shutdown(std::net::Shutdown::Write);
        let _ = rubbish.read_to_end(&mut Vec::new());
    }
    let mut seed = 1_u32;
    for _ in 0..50 {
        let mut socket = connect(at, &SDK).unwrap();
        let bytes: Vec<u8> = (0..200)
            .map(|_| {
                seed = seed.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
                seed.to_be_bytes()[0]
            })
            .collect();
        let _ = socket.get_mut().write_all(&bytes);
    }
    // What is too long is not read.
    let mut long = connect(at, &SDK).unwrap();
    let _ = long.send(Message::Text("x".repeat(MESSAGE_BYTES_MAX + 1).into()));
    ends(&mut long);
    // One that says nothing but mistakes is told of them, and let go.
    let mut wrong = connect(at, &SDK).unwrap();
    for _ in 0..=MISTAKES_MAX {
        if wrong.send(Message::Text("{}".into())).is_err() {
            break;
        }
    }
    until(&mut wrong, "must be a JSON object");
    ends(&mut wrong);
    // Its time is over.
    slow.set_read_timeout(Some(LONG)).unwrap();
    let left = slow.read_to_end(&mut Vec::new());
    assert!(
        !matches!(&left, Err(why) if why.kind() == ErrorKind::WouldBlock),
        "a handshake that does not end is waited for"
    );
    assert!(begin.elapsed() >= HANDSHAKE_TIME);
    // Others have noticed nothing.
    let sample = Entry::Sample(node("a", "u8 x"), 5, vec![7].into());
    server.take(&[sample]);
    let told = until(&mut good, r#""topic":"/a""#);
    assert!(
        told.contains("trik_msgs/msg/A") && told.contains("uint8 x"),
        "{told}"
    );
}

#[test]
fn a_client_that_does_not_read_loses_samples_and_delays_nobody() {
    let directory = tempfile::tempdir().unwrap();
    let mut server = server(directory.path());
    let at = server.address();
    let known = node("picture", "u8 x 100000");
    server.take(&[Entry::Node(known.clone())]);
    let picture = |number: u8| {
        let bytes: Arc<[u8]> = vec![number; 100_000].into();
        Entry::Sample(known.clone(), u64::from(number), bytes)
    };
    server.take(&[picture(0)]);
    let mut clients = [connect(at, &SDK).unwrap(), connect(at, &SDK).unwrap()];
    for client in &mut clients {
        let told = until(client, r#""topic":"/picture""#);
        let all: serde_json::Value = serde_json::from_str(&told).unwrap();
        let all = all["channels"].as_array().unwrap();
        let channel = all.iter().find(|one| one["topic"] == "/picture").unwrap();
        let order = format!(
            r#"{{"op":"subscribe","subscriptions":[{{"id":3,"channelId":{}}}]}}"#,
            channel["id"]
        );
        client.send(Message::Text(order.into())).unwrap();
    }
    let [mut fast, mut slow] = clients;
    let next = |client: &mut Socket| loop {
        if let Message::Binary(bytes) = client.read().unwrap()
            && bytes[0] == 1
        {
            assert_eq!(bytes[1..5], [3, 0, 0, 0]);
            return *bytes.last().unwrap();
        }
    };
    assert_eq!(next(&mut fast), 0);
    // Far more than one queue and the buffers of a socket hold.
    const { assert!(200 * 100_000 > 4 * DATA_BYTES_MAX) };
    for number in 1..=200 {
        server.take(&[picture(number)]);
        assert_eq!(next(&mut fast), number);
    }
    // The slow one still gets the newest, and hears how much it has lost.
    let mut seen = Vec::new();
    let mut lost = String::new();
    let mut is_taken_back = false;
    let begin = Instant::now();
    while seen.last() != Some(&200) || !is_taken_back {
        assert!(begin.elapsed() < LONG, "{} came", seen.len());
        match slow.read().unwrap() {
            Message::Text(text) if text.as_str().contains("removeStatus") => is_taken_back = true,
            Message::Binary(bytes) if bytes[0] == 1 => seen.push(*bytes.last().unwrap()),
            Message::Text(text) if text.as_str().contains("slow") => {
                lost = text.as_str().to_owned()
            }
            Message::Text(_)
            | Message::Binary(_)
            | Message::Ping(_)
            | Message::Pong(_)
            | Message::Close(_)
            | Message::Frame(_) => {}
        }
    }
    assert!(seen.len() < 190, "{} came", seen.len());
    assert!(
        seen.is_sorted() && lost.contains("samples are lost"),
        "{lost}"
    );
}

#[test]
fn a_node_that_cannot_be_told_is_reported_and_hides_no_other() {
    let directory = tempfile::tempdir().unwrap();
    let mut server = server(directory.path());
    let mut client = connect(server.address(), &SDK).unwrap();
    let wrong = Arc::new(Known {
        number: 2,
        node: Node::sensor("wrong", "no format at all"),
    });
    let wrong = Entry::Sample(wrong, 5, vec![7].into());
    let good = Entry::Sample(node("good", "u8 x"), 5, vec![7].into());
    server.take(&[wrong, good]);
    until(&mut client, r#""topic":"/good""#);
    let told = until(&mut client, r#""id":"bridge""#);
    assert!(told.contains("cannot be passed on"), "{told}");
}
