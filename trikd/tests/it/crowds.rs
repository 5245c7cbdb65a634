//! Crowds: thousands of connections that say next to nothing, bursts of them, floods of datagrams. A stop is heard among them.
//!
//! `TRIKD_CROWD_TRIES` stops so often for figures; other addresses of this machine stand for other computers.

use crate::rig::{Client, Robot, frame, robot};
use harness::wait::SOON;
use harness::{eventually, processes};
use nix::libc;
use nix::sys::resource::{Resource, getrlimit, setrlimit};
use socket2::{Domain, Socket, Type};
use std::collections::VecDeque;
use std::io::{ErrorKind, Read, Write};
use std::net::{Ipv4Addr, SocketAddr, TcpStream, UdpSocket};
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use std::thread::JoinHandle;
use std::time::{Duration, Instant};

/// Connections that trickle.
const CROWD: usize = 3_000;
/// So long each of them is silent.
const TRICKLE: Duration = Duration::from_millis(700);

/// Room for so many connections in this process.
fn allow_files() {
    let (_, most) = getrlimit(Resource::RLIMIT_NOFILE).expect("a limit");
    setrlimit(Resource::RLIMIT_NOFILE, most, most).expect("more files");
}

/// A connection on its way from an address of this machine; nothing is waited for.
fn begin(from: Ipv4Addr, port: u16) -> std::io::Result<TcpStream> {
    let socket = Socket::new(Domain::IPV4, Type::STREAM, None)?;
    // No number of a port is kept for one that has ended.
    socket.set_linger(Some(Duration::ZERO))?;
    socket.bind(&SocketAddr::from((from, 0)).into())?;
    socket.set_nonblocking(true)?;
    let to = SocketAddr::from((Ipv4Addr::LOCALHOST, port));
    match socket.connect(&to.into()) {
        Err(error) if error.raw_os_error() != Some(libc::EINPROGRESS) => Err(error),
        _ => Ok(socket.into()),
    }
}

/// A client at an address of this machine.
fn client_at(from: Ipv4Addr, port: u16) -> Client {
    let socket = Socket::new(Domain::IPV4, Type::STREAM, None).expect("a socket");
    socket
        .bind(&SocketAddr::from((from, 0)).into())
        .expect("an address");
    let to = SocketAddr::from((Ipv4Addr::LOCALHOST, port));
    socket.connect(&to.into()).expect("a connection");
    Client::over(socket.into())
}

/// Connections that send a byte now and then and come back when they are closed. Ends when it is dropped.
struct Crowd {
    is_over: Arc<AtomicBool>,
    thread: Option<JoinHandle<()>>,
}

impl Crowd {
    /// At these ports, from these addresses.
    fn gather(ports: Vec<u16>, from: Vec<Ipv4Addr>) -> Self {
        allow_files();
        let is_over = Arc::<AtomicBool>::default();
        let ends = is_over.clone();
        let (tell, told) = std::sync::mpsc::channel();
        let work = move || {
            let mut all: Vec<Option<TcpStream>> = (0..CROWD).map(|_| None).collect();
            while !ends.load(Ordering::Relaxed) {
                let round = Instant::now();
                for (index, one) in all.iter_mut().enumerate() {
                    let port = ports[index % ports.len()];
                    let address = from[index / ports.len() % from.len()];
                    match one {
                        None => *one = begin(address, port).ok(),
                        Some(stream) => {
                            let is_there = match stream.write(b"7") {
                                Ok(_) => true,
                                Err(error) => error.kind() == ErrorKind::WouldBlock,
                            };
                            if !is_there {
                                *one = begin(address, port).ok();
                            }
                        }
                    }
                }
                let _ = tell.send(());
                std::thread::sleep(TRICKLE.saturating_sub(round.elapsed()));
            }
        };
        let thread = std::thread::spawn(work);
        for _ in 0..3 {
            told.recv_timeout(SOON).expect("a crowd");
        }
        Self {
            is_over,
            thread: Some(thread),
        }
    }
}

impl Drop for Crowd {
    fn drop(&mut self) {
        self.is_over.store(true, Ordering::Relaxed);
        if let Some(thread) = self.thread.take() {
            let _ = thread.join();
        }
    }
}

/// How long a stop takes from the first packet to the answer; None: it was not heard.
fn stop(port: u16) -> Option<Duration> {
    let begin = Instant::now();
    let mut stream = TcpStream::connect((Ipv4Addr::LOCALHOST, port)).ok()?;
    stream.set_nodelay(true).ok()?;
    stream.set_read_timeout(Some(SOON)).ok()?;
    let words = [frame("stop"), frame("status")].concat();
    stream.write_all(&words).ok()?;
    let mut heard = Vec::new();
    let mut piece = [0; 4096];
    while !heard.windows(8).any(|part| part == b"status: ") {
        match stream.read(&mut piece) {
            Ok(size) if size > 0 => heard.extend_from_slice(&piece[..size]),
            _ => return None,
        }
    }
    Some(begin.elapsed())
}

/// Stops again and again; all are heard, and most of them at once.
fn all_stops_are_heard(robot: &Robot, what: &str) {
    let tries = std::env::var("TRIKD_CROWD_TRIES").ok();
    let tries = tries.and_then(|text| text.parse().ok()).unwrap_or(20);
    let port = robot.port("control");
    let mut times = Vec::new();
    for _ in 0..tries {
        robot.forget_rest();
        times.extend(stop(port).filter(|_| robot.has_rested()));
    }
    times.sort();
    let (median, worst) = (times.get(times.len() / 2), times.last());
    println!(
        "{what}: {} of {tries} heard, median {median:?}, worst {worst:?}",
        times.len()
    );
    assert_eq!(times.len(), tries, "{what}: stops that nobody has heard");
    // A limit for machines on which other tests run; alone it is a few milliseconds.
    assert!(
        median < Some(&Duration::from_millis(500)),
        "{what}: {median:?}"
    );
}

fn addresses(numbers: std::ops::RangeInclusive<u8>) -> Vec<Ipv4Addr> {
    numbers.map(|last| Ipv4Addr::new(127, 0, 0, last)).collect()
}

const PORTS: [&str; 5] = ["control", "gamepad", "mailbox", "telemetry", "page"];

#[test]
fn a_stop_is_heard_among_thousands_of_slow_connections_from_its_own_address() {
    let robot = robot(&["--page-port", "0"]);
    let ports = PORTS.map(|name| robot.port(name)).to_vec();
    let _crowd = Crowd::gather(ports, addresses(1..=1));
    all_stops_are_heard(&robot, "one address");
}

#[test]
fn slow_connections_from_many_addresses_keep_neither_a_stop_nor_good_clients_out() {
    let robot = robot(&["--page-port", "0"]);
    let mut idle = robot.client("telemetry");
    idle.keep_alive();
    idle.sync();
    let ports = PORTS.map(|name| robot.port(name)).to_vec();
    let _crowd = Crowd::gather(ports, addresses(2..=9));
    all_stops_are_heard(&robot, "several addresses");
    for name in ["control", "telemetry", "mailbox"] {
        let mut client = client_at(Ipv4Addr::new(127, 0, 0, 99), robot.port(name));
        client.raw(frame("version"));
        assert_eq!(client.next().as_deref(), Some("version: 3.1.4"), "{name}");
    }
    let mut page = client_at(Ipv4Addr::new(127, 0, 0, 99), robot.port("page"));
    page.raw(format!(
        "GET /plain HTTP/1.1\r\nHost: 127.0.0.1:{}\r\n\r\n",
        robot.port("page")
    ));
    assert_eq!(page.exactly(12), b"HTTP/1.1 200");
    // One that is merely idle has kept its place.
    idle.sync();
}

#[test]
fn a_client_that_is_stuck_in_a_message_gives_way_and_one_that_is_idle_does_not() {
    // One computer may have six of eight.
    let robot = robot(&["--connections", "8"]);
    let mut stuck: Vec<Client> = (0..3).map(|_| robot.client("control")).collect();
    let mut idle: Vec<Client> = (0..3).map(|_| robot.client("telemetry")).collect();
    for client in stuck.iter_mut().chain(&mut idle) {
        client.keep_alive();
        client.sync();
    }
    // It is longer than what comes of it.
    stuck.iter_mut().for_each(|client| client.raw("60000:file"));
    let begin = Instant::now();
    let mut late = Vec::new();
    eventually("three places", || {
        let mut client = robot.client("telemetry");
        let _ = client.stream.write_all(&frame("version"));
        if client.next().is_some() {
            client.keep_alive();
            late.push(client);
        }
        late.len() == 3
    });
    // Time alone would have ended them as well, after a minute.
    assert!(begin.elapsed() < Duration::from_secs(30));
    idle.iter_mut().for_each(Client::sync);
    late.iter_mut().for_each(Client::sync);
}

#[test]
fn without_a_place_only_a_stop_is_heard() {
    let robot = robot(&["--connections", "8"]);
    let mut crowd: Vec<Client> = (0..6).map(|_| robot.client("telemetry")).collect();
    for client in &mut crowd {
        client.keep_alive();
        client.sync();
    }
    let why = "error: there are 6 connections from there already: close some";
    for asked in ["run:x.py", ""] {
        let mut other = robot.client("control");
        other.send(asked);
        assert_eq!(other.next().as_deref(), Some(why));
        assert_eq!(other.next(), None);
    }
    assert!(
        robot.status().contains("\nprograms 0 started"),
        "{}",
        robot.status()
    );
    robot.forget_rest();
    assert!(stop(robot.port("control")).is_some() && robot.has_rested());
    crowd.iter_mut().for_each(Client::sync);
}

#[test]
fn the_computer_in_control_finds_a_place_when_there_are_none() {
    let robot = robot(&["--connections", "8"]);
    let driver = Ipv4Addr::new(127, 0, 0, 5);
    let mut first = client_at(driver, robot.port("control"));
    first.send("stop");
    first.sync();
    let mut crowd: Vec<Client> = (0..6)
        .map(|_| client_at(driver, robot.port("telemetry")))
        .collect();
    for client in crowd.iter_mut().take(5) {
        client.keep_alive();
        client.sync();
    }
    let mut again = client_at(driver, robot.port("control"));
    again.send("configVersion");
    again.until("configVersion: ");
    drop(crowd);
}

#[test]
fn a_burst_of_ten_thousand_connections_passes() {
    let robot = robot(&[]);
    let (daemon, port) = (robot.daemon(), robot.port("control"));
    allow_files();
    let mut open = VecDeque::new();
    for _ in 0..10_000 {
        open.extend(begin(Ipv4Addr::new(127, 0, 0, 3), port));
        if open.len() > 2_000 {
            open.pop_front();
        }
    }
    eventually("a stop", || stop(port).is_some());
    drop(open);
    eventually("all are gone", || {
        robot.status().contains("\nconnections 0 of ")
    });
    assert_eq!(robot.daemon(), daemon, "{}", robot.log());
    assert!(processes::is_alive(daemon));
}

/// A question for robots in the network.
fn question() -> Vec<u8> {
    let mut question = vec![0, 9, 0, 0, 0, 1, 0, 0, 0, 0, 0, 0];
    for label in ["_trik", "_tcp", "local"] {
        question.push(u8::try_from(label.len()).expect("a short one"));
        question.extend_from_slice(label.as_bytes());
    }
    question.extend_from_slice(&[0, 0, 12, 0, 1]);
    question
}

#[test]
fn a_flood_of_questions_costs_little_and_questions_after_it_are_answered() {
    let robot = robot(&["--name", "flooded"]);
    let (question, mut buffer) = (question(), [0; 2000]);
    let mut asks = || {
        let socket = UdpSocket::bind("127.0.0.1:0").expect("a socket");
        let wait = Duration::from_millis(500);
        socket.set_read_timeout(Some(wait)).expect("a timeout");
        socket
            .send_to(&question, "127.0.0.1:5353")
            .expect("to send");
        let size = socket.recv(&mut buffer).unwrap_or(0);
        let is_ours = buffer[..size].windows(8).any(|part| part == b"\x07flooded");
        (socket, is_ours)
    };
    // Others on this machine may share the port: the kernel chooses one of them by the port of the asker.
    let mut found = None;
    eventually("an answer of this robot", || {
        let (socket, is_ours) = asks();
        found = is_ours.then_some(socket);
        found.is_some()
    });
    let socket = found.expect("a socket");
    socket.set_nonblocking(true).expect("an option");
    let begin = Instant::now();
    let mut answers = 0;
    while begin.elapsed() < Duration::from_secs(2) {
        for _ in 0..50 {
            let _ = socket.send_to(&question, "127.0.0.1:5353");
        }
        while socket.recv(&mut [0; 2000]).is_ok() {
            answers += 1;
        }
    }
    let took = begin.elapsed();
    println!("{answers} answers in {took:?}");
    let most = 500.0 * took.as_secs_f64();
    assert!(
        answers > 0 && f64::from(answers) <= most,
        "{answers} answers in {took:?}"
    );
    robot.client("control").sync();
    eventually("an answer after the flood", || asks().1);
}
