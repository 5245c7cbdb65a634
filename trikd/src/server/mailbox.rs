//! Port 8889: messages between robots. Every robot is a server and a client of the others.
//!
//! Owns the list of known robots, the open links to them, our hull number, and what is remembered of these. A robot is
//! known by the address of its server; hull numbers need not be unique.

use super::Guest;
use crate::clients::Clients;
use crate::connection::{self, Handler, Held, VERSION};
use crate::outbox::Outbox;
use crate::program::{Command, Programs};
use crate::protocol::mail::{Message, NOWHERE, plain};
use crate::protocol::program::mailbox::Question;
use crate::scripts;
use crate::{limits, log};
use page::seats::{Seat, Seats};
use std::cell::{Cell, RefCell};
use std::collections::VecDeque;
use std::fmt::Write;
use std::net::{IpAddr, SocketAddr, UdpSocket};
use std::path::{Path, PathBuf};
use std::rc::Rc;
use std::sync::Arc;
use std::time::Duration;
use tokio::net::{TcpSocket, TcpStream};
use tokio::time::{Instant, sleep, timeout};

/// Hull number of a robot that has not said its own.
const UNKNOWN_HULL: i32 = -1;

/// An open connection to a robot, or one on its way.
#[derive(Debug)]
struct Link {
    outbox: Rc<Outbox>,
    /// Our address as the other side sees it.
    local: Cell<IpAddr>,
}

#[derive(Debug)]
struct Robot {
    /// Address of its server.
    ip: IpAddr,
    port: u16,
    hull: i32,
    link: Option<Rc<Link>>,
}

/// What the mailbox works with.
#[derive(Debug)]
pub struct Surroundings {
    /// The register of connections, and who hears of messages.
    pub clients: Rc<Clients>,
    /// Bytes of half frames.
    pub held: Rc<Held>,
    /// Connections on all ports.
    pub seats: Arc<Seats>,
    /// The part that runs programs, to which messages go.
    pub programs: Rc<Programs>,
    /// Addresses that this robot serves at; none: all.
    pub addresses: Vec<IpAddr>,
}

/// The mailbox of this robot.
#[derive(Debug)]
pub struct Mailbox {
    around: Surroundings,
    file: PathBuf,
    /// Of its server; None: this robot has none, sends nothing and remembers nothing.
    port: Cell<Option<u16>>,
    hull: Cell<i32>,
    /// The robot that was joined.
    server: Cell<Option<SocketAddr>>,
    robots: RefCell<Vec<Robot>>,
    /// What the file has, or soon will have.
    saved: RefCell<String>,
    /// Whether a task writes it.
    is_saving: Cell<bool>,
    /// Messages for the next program.
    kept: RefCell<VecDeque<(i32, String)>>,
}

/// Our address on the way to another one.
pub fn local_ip(towards: IpAddr) -> Option<IpAddr> {
    let any: IpAddr = if towards.is_ipv4() {
        NOWHERE
    } else {
        std::net::Ipv6Addr::UNSPECIFIED.into()
    };
    let socket = UdpSocket::bind((any, 0)).ok()?;
    // Sends nothing.
    socket.connect((towards, 9)).ok()?;
    Some(plain(socket.local_addr().ok()?.ip()))
}

/// Our address where other robots probably are: the network of the robot's own access point, else the way outside.
fn own_ip() -> IpAddr {
    let guesses = [[192, 168, 77, 254], [192, 0, 2, 1]];
    let found = guesses
        .into_iter()
        .find_map(|guess| local_ip(IpAddr::from(guess)));
    found.unwrap_or(IpAddr::from([127, 0, 0, 1]))
}

/// What stands in the file: hull number and the robot that was joined.
fn read(file: &Path) -> (i32, Option<SocketAddr>) {
    let text = std::fs::read_to_string(file).unwrap_or_default();
    let field = |name: &str| {
        text.lines()
            .find_map(|line| line.strip_prefix(name)?.strip_prefix('='))
    };
    let server = field("server").and_then(|server| server.parse().ok());
    (
        field("hullNumber")
            .and_then(|hull| hull.parse().ok())
            .unwrap_or(0),
        server,
    )
}

impl Mailbox {
    /// Remembers in `file`. Nothing is sent before [`Mailbox::open`].
    pub fn new(file: &Path, around: Surroundings) -> Self {
        let (hull, server) = read(file);
        Self {
            around,
            file: file.to_owned(),
            port: Cell::new(None),
            hull: Cell::new(hull),
            server: Cell::new(server),
            robots: RefCell::default(),
            saved: RefCell::default(),
            is_saving: Cell::default(),
            kept: RefCell::default(),
        }
    }

    /// Begins to work, and joins again whom it had joined.
    pub fn open(self: &Rc<Self>, port: u16) {
        self.port.set(Some(port));
        if let Some(server) = self.server.get() {
            self.join(server, limits::REJOIN_TRIES);
        }
    }

    /// Remembers the hull number and the robot that was joined, if they are others than before. A disk may be slow and a
    /// program may change them all the time, so a task writes what is newest then, and nobody waits for it.
    fn save(self: &Rc<Self>) {
        let mut text = format!("hullNumber={}\n", self.hull.get());
        if let Some(server) = self.server.get() {
            let _ = writeln!(text, "server={server}");
        }
        if *self.saved.borrow() == text {
            return;
        }
        self.saved.replace(text);
        if self.port.get().is_some() && !self.is_saving.replace(true) {
            let mailbox = self.clone();
            tokio::task::spawn_local(async move { mailbox.write().await });
        }
    }

    /// Writes until the file has what is newest.
    async fn write(&self) {
        loop {
            let (file, text) = (self.file.clone(), self.saved.borrow().clone());
            let work = move || {
                let done = scripts::replace(&file, text.as_bytes(), 0o600);
                (text, done)
            };
            let Ok((text, done)) = tokio::task::spawn_blocking(work).await else {
                break;
            };
            if let Err(error) = done {
                tracing::warn!(
                    target: log::DAEMON,
                    "{}: {error}: the mailbox will not be remembered",
                    self.file.display()
                );
            }
            if *self.saved.borrow() == text {
                break;
            }
        }
        self.is_saving.set(false);
    }

    /// Waits until everything is written, a while at most.
    pub async fn rest(&self) {
        let deadline = Instant::now() + Duration::from_millis(limits::SAVE_MS);
        while self.is_saving.get() && Instant::now() < deadline {
            sleep(Duration::from_millis(2)).await;
        }
    }

    /// Keeps a message for the next program; the oldest goes when there are too many.
    pub fn keep(&self, hull: i32, text: String) {
        let mut kept = self.kept.borrow_mut();
        if kept.len() >= limits::KEPT_MESSAGES {
            kept.pop_front();
        }
        kept.push_back((hull, text));
    }

    /// The messages that came while no program ran.
    pub fn take_kept(&self) -> VecDeque<(i32, String)> {
        self.kept.take()
    }

    /// A program has ended, and its messages with it.
    pub fn forget_kept(&self) {
        self.kept.borrow_mut().clear();
    }

    /// The answer to a question of a program; empty if there is nothing to say.
    pub fn answer(self: &Rc<Self>, words: &str) -> String {
        let flag = |holds: bool| u8::from(holds).to_string();
        let Some(question) = Question::parse(words) else {
            return String::new();
        };
        match question {
            Question::Send { hull, text } => self.send(hull.unwrap_or(UNKNOWN_HULL), text),
            Question::Connect { address, port } => self.join_new(address, port),
            Question::Join {
                address,
                port,
                hull,
            } => {
                if hull >= 0 {
                    self.set_hull(hull);
                }
                self.join_new(address, u16::try_from(port).ok());
            }
            Question::SetHull(hull) => self.set_hull(hull),
            Question::Hull => return self.hull.get().to_string(),
            Question::Server => {
                let server = self.server.get();
                return server.map_or_else(String::new, |server| server.ip().to_string());
            }
            Question::Ip => {
                let named = self.port.get().and(self.around.addresses.first().copied());
                let named = named.filter(|ip| !ip.is_unspecified());
                return named.unwrap_or_else(own_ip).to_string();
            }
            Question::Connected => {
                // Before a robot has said its hull number, nothing that is sent to that would reach it.
                let is_heard = |robot: &Robot| robot.link.is_some() && robot.hull != UNKNOWN_HULL;
                return flag(self.robots.borrow().iter().any(is_heard));
            }
            Question::Enabled => return flag(self.port.get().is_some()),
            // Our own address is looked for whenever somebody asks.
            Question::Renew => {}
        }
        String::new()
    }

    /// Joins a robot and remembers that; without a port, that of our own server, as on the original robots.
    fn join_new(self: &Rc<Self>, address: &str, port: Option<u16>) {
        let ip = address.parse().ok();
        if let (Some(ip), Some(port)) = (ip, port.or(self.port.get())) {
            let server = SocketAddr::new(plain(ip), port);
            self.server.set(Some(server));
            self.save();
            self.join(server, limits::JOIN_TRIES);
        }
    }

    fn set_hull(self: &Rc<Self>, hull: i32) {
        self.hull.set(hull);
        self.save();
        let Some(port) = self.port.get() else { return };
        for robot in self.robots.borrow().iter() {
            if let Some(link) = &robot.link {
                let message = Message::Connection {
                    ip: link.local.get(),
                    port,
                    hull,
                };
                link.outbox.send(message.to_string().as_bytes());
            }
        }
    }

    /// Sends to all robots with this hull number, or to all.
    fn send(self: &Rc<Self>, hull: i32, text: &str) {
        let fits = |robot: &Robot| hull == UNKNOWN_HULL || robot.hull == hull;
        let all: Vec<_> = self
            .robots
            .borrow()
            .iter()
            .filter(|robot| fits(robot))
            .map(|robot| SocketAddr::new(robot.ip, robot.port))
            .collect();
        for server in all {
            self.say(server, &Message::Data(text.to_owned()));
        }
    }

    /// Says something to one robot, over a new connection if there is none.
    fn say(self: &Rc<Self>, server: SocketAddr, message: &Message) {
        if let Some(outbox) = self.link(server, limits::JOIN_TRIES) {
            outbox.send(message.to_string().as_bytes());
        }
    }

    fn join(self: &Rc<Self>, server: SocketAddr, tries: u32) {
        let _ = self.link(server, tries);
    }

    /// What waits for one robot: of the open link, or of one that is made now and begins with `register`.
    fn link(self: &Rc<Self>, server: SocketAddr, tries: u32) -> Option<Rc<Outbox>> {
        let port = self.port.get()?;
        let index = self.meet(server, None)?;
        let mut robots = self.robots.borrow_mut();
        if let Some(link) = &robots[index].link {
            return Some(link.outbox.clone());
        }
        let outbox = Rc::new(Outbox::new(limits::OUTBOX_BYTES));
        outbox.send(
            Message::Register {
                port,
                hull: self.hull.get(),
            }
            .to_string()
            .as_bytes(),
        );
        let link = Rc::new(Link {
            outbox: outbox.clone(),
            local: Cell::new(NOWHERE),
        });
        robots[index].link = Some(link.clone());
        tokio::task::spawn_local(connect(self.clone(), server, link, tries));
        Some(outbox)
    }

    /// The place of a robot in the list; adds it, and corrects its hull number. When the list is full, it takes the place
    /// of one that is not linked: who tells of robots that do not exist keeps nobody out. None: all are linked.
    fn meet(&self, server: SocketAddr, hull: Option<i32>) -> Option<usize> {
        let mut robots = self.robots.borrow_mut();
        let known = robots
            .iter()
            .position(|robot| (robot.ip, robot.port) == (server.ip(), server.port()));
        let index = match known {
            Some(index) => index,
            None => {
                let robot = Robot {
                    ip: server.ip(),
                    port: server.port(),
                    hull: UNKNOWN_HULL,
                    link: None,
                };
                if robots.len() < limits::ROBOTS {
                    robots.push(robot);
                    robots.len() - 1
                } else {
                    let away = robots.iter().position(|robot| robot.link.is_none())?;
                    robots[away] = robot;
                    away
                }
            }
        };
        if let Some(hull) = hull {
            robots[index].hull = hull;
        }
        Some(index)
    }

    /// A robot has come and says who it is.
    fn register(self: &Rc<Self>, server: SocketAddr, hull: i32, link: &Rc<Link>) {
        // Behind one connection is one robot: a crowd of them would have everybody connect to everybody.
        if self.is_another(server, link) {
            return;
        }
        let before: Vec<(SocketAddr, i32)> = self
            .robots
            .borrow()
            .iter()
            .map(|robot| (SocketAddr::new(robot.ip, robot.port), robot.hull))
            .collect();
        let is_new = !before.contains(&(server, hull));
        let Some(index) = self.meet(server, Some(hull)) else {
            return;
        };
        self.robots.borrow_mut()[index].link = Some(link.clone());
        let others = before.into_iter().filter(|(other, _)| *other != server);
        for (other, other_hull) in others {
            if is_new {
                self.say(
                    other,
                    &Message::Connection {
                        ip: server.ip(),
                        port: server.port(),
                        hull,
                    },
                );
            }
            let message = Message::Connection {
                ip: other.ip(),
                port: other.port(),
                hull: other_hull,
            };
            link.outbox.send(message.to_string().as_bytes());
        }
        link.outbox
            .send(Message::Own(self.hull.get()).to_string().as_bytes());
    }

    /// Whether there is a robot at the other end of a link, and not this one.
    fn is_another(&self, server: SocketAddr, link: &Rc<Link>) -> bool {
        let robots = self.robots.borrow();
        let mut linked = robots.iter().filter(|robot| {
            let other = robot.link.as_ref();
            other.is_some_and(|other| Rc::ptr_eq(other, link))
        });
        linked.any(|robot| (robot.ip, robot.port) != (server.ip(), server.port()))
    }

    /// Hull number of the robot at the other end of a link.
    fn hull_of(&self, link: &Rc<Link>) -> i32 {
        let robots = self.robots.borrow();
        let of_link = |robot: &&Robot| {
            robot
                .link
                .as_ref()
                .is_some_and(|other| Rc::ptr_eq(other, link))
        };
        robots
            .iter()
            .find(of_link)
            .map_or(UNKNOWN_HULL, |robot| robot.hull)
    }

    fn learn_hull(&self, link: &Rc<Link>, hull: i32) {
        for robot in self.robots.borrow_mut().iter_mut() {
            if robot
                .link
                .as_ref()
                .is_some_and(|other| Rc::ptr_eq(other, link))
            {
                robot.hull = hull;
            }
        }
    }

    /// A link has ended.
    fn forget(&self, link: &Rc<Link>) {
        for robot in self.robots.borrow_mut().iter_mut() {
            if robot
                .link
                .as_ref()
                .is_some_and(|other| Rc::ptr_eq(other, link))
            {
                robot.link = None;
            }
        }
    }

    /// Lines for the status.
    pub fn describe(&self) -> String {
        let mut text = format!("mailbox hull {}\n", self.hull.get());
        for robot in self.robots.borrow().iter() {
            let state = if robot.link.is_some() {
                "linked"
            } else {
                "known"
            };
            let _ = writeln!(
                text,
                "robot {}:{} hull {} {state}",
                robot.ip, robot.port, robot.hull
            );
        }
        text
    }
}

struct Mails {
    mailbox: Rc<Mailbox>,
    link: Rc<Link>,
    /// The other end of the connection.
    peer: SocketAddr,
}

impl Handler for Mails {
    async fn frame(&mut self, frame: &[u8]) {
        if frame == b"version" {
            return self.link.outbox.send(VERSION);
        }
        let mailbox = &self.mailbox;
        let port = mailbox.port.get().unwrap_or_default();
        let is_self = |ip: IpAddr, other: u16| ip == self.link.local.get() && other == port;
        match Message::parse(frame) {
            Message::Register { port, hull } => {
                if !is_self(self.peer.ip(), port) {
                    mailbox.register(SocketAddr::new(self.peer.ip(), port), hull, &self.link);
                }
            }
            Message::Connection { ip, port, hull } => {
                if !is_self(ip, port) {
                    mailbox.meet(SocketAddr::new(plain(ip), port), Some(hull));
                }
            }
            Message::Own(hull) => mailbox.learn_hull(&self.link, hull),
            Message::Data(text) => {
                let hull = mailbox.hull_of(&self.link);
                let around = &mailbox.around;
                around
                    .clients
                    .broadcast(format!("mail: sender: {hull} contents: {text}").as_bytes());
                around.programs.try_send(Command::Mail(hull, text));
            }
            Message::Unknown => {}
        }
    }
}

async fn converse(
    mailbox: &Rc<Mailbox>,
    stream: TcpStream,
    seat: &mut Seat,
    peer: SocketAddr,
    link: &Rc<Link>,
) {
    if let Ok(local) = stream.local_addr() {
        link.local.set(plain(local.ip()));
    }
    let around = &mailbox.around;
    let client = around.clients.add("mailbox", peer, link.outbox.clone());
    tracing::info!(target: log::CLIENTS, "mailbox: {peer} is connected");
    let mut handler = Mails {
        mailbox: mailbox.clone(),
        link: link.clone(),
        peer,
    };
    let why = connection::serve(
        stream,
        &[],
        seat,
        limits::SMALL_FRAME_BYTES,
        &around.held,
        &link.outbox,
        &mut handler,
    )
    .await;
    tracing::info!(target: log::CLIENTS, "mailbox: {peer} has left: {why}");
    mailbox.forget(link);
    drop(client);
}

/// A connection from the address at which this robot serves, if it has one: others know it by where it comes from.
async fn reach(own: &[IpAddr], server: SocketAddr) -> std::io::Result<TcpStream> {
    let fits = |ip: &&IpAddr| {
        ip.is_ipv4() == server.is_ipv4()
            && ip.is_loopback() == server.ip().is_loopback()
            && !ip.is_unspecified()
    };
    let socket = match server {
        SocketAddr::V4(_) => TcpSocket::new_v4(),
        SocketAddr::V6(_) => TcpSocket::new_v6(),
    }?;
    if let Some(ip) = own.iter().find(fits) {
        socket.bind((*ip, 0).into())?;
    }
    socket.connect(server).await
}

/// Connects to a robot; what waits for it is lost when it does not answer for so many tries.
async fn connect(mailbox: Rc<Mailbox>, server: SocketAddr, link: Rc<Link>, tries: u32) {
    let wait = Duration::from_millis(limits::CONNECT_MS);
    for _ in 0..tries {
        match timeout(wait, reach(&mailbox.around.addresses, server)).await {
            Ok(Ok(stream)) => {
                let _ = stream.set_nodelay(true);
                let around = &mailbox.around;
                let whom = around.clients.whom(server.ip());
                let Ok(mut seat) = around.seats.take(server.ip(), whom) else {
                    break;
                };
                return converse(&mailbox, stream, &mut seat, server, &link).await;
            }
            Ok(Err(_)) => sleep(wait).await,
            Err(_) => {}
        }
    }
    tracing::warn!(
        target: log::CLIENTS,
        "mailbox: {server} does not answer: messages for it are lost"
    );
    mailbox.forget(&link);
}

/// Serves a robot that has come.
pub async fn serve(mailbox: Rc<Mailbox>, mut guest: Guest) {
    let outbox = Rc::new(Outbox::new(limits::OUTBOX_BYTES));
    let link = Rc::new(Link {
        outbox,
        local: Cell::new(NOWHERE),
    });
    converse(&mailbox, guest.stream, &mut guest.seat, guest.peer, &link).await;
}
