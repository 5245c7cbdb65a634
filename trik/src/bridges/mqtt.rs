//! `trik bridge mqtt`: the run, from its beginning to Ctrl-C.
//!
//! Owns which robot is told of, the files that a person names, and what a person is told. What a broker gets is known to the
//! crate `bridge`.

use super::args::MqttArgs;
use super::{PROGRAM, refused, root, say};
use crate::error::Error;
use crate::input::secret::{bytes, password};
use crate::refusal::Refusal;
use crate::remote::bridged::Programs;
use crate::remote::target::target;
use crate::terminal::harmless;
use crate::up::session::signals;
use ::bridge::follow::{Change, Follow};
use ::bridge::foxglove::robot::{self, Robot};
use ::bridge::mqtt::Message;
use ::bridge::mqtt::client::{Client, Gone, News, Settings, Tls, Voice};
use ::bridge::mqtt::discovery;
use ::bridge::mqtt::hands::Hands;
use ::bridge::mqtt::inbox::Inbox;
use ::bridge::mqtt::topics::Topics;
use ::bridge::mqtt::values::Values;
use nix::poll::{PollFd, PollFlags, PollTimeout, poll};
use std::fs;
use std::os::fd::AsFd;
use std::path::PathBuf;
use std::sync::Arc;
use std::thread::{self, JoinHandle};
use std::time::{Duration, Instant};

/// How often the hands look for leases that nobody uses any more.
const LOOK_TIME: Duration = Duration::from_millis(50);
/// For the last command.
const END_TIME: Duration = Duration::from_secs(1);

/// Serves until somebody stops it.
///
/// # Errors
/// There is no tree, a file cannot be read, the broker does not let us in, or another one has our name.
pub(super) fn serve(args: &MqttArgs) -> Result<u8, Refusal> {
    let root = root(args.robot.as_deref(), args.mountpoint.as_deref())?;
    let topics = topics(args)?;
    let settings = settings(args)?;
    // Threads inherit what is blocked.
    let signals = signals().map_err(|error| Error::system("signals", error))?;
    let follow = Follow::begin(&root, PROGRAM).map_err(refused)?;
    let shown = root.display().to_string();
    let programs = args
        .programs
        .clone()
        .or_else(|| target(&format!("{shown}/")).ok());
    let programs = programs.map(|at| Box::new(Programs::new(at)) as Box<dyn robot::Programs>);
    let deadman = Duration::from_millis(args.deadman.into());
    let inbox = Arc::new(Inbox::new(args.control));
    let hands = Hands::new(root.clone(), Robot::new(&root, programs), &topics, deadman);
    let mut values = Values::new(&topics, Duration::from_secs(1) / args.rate);
    values.take(&follow.beginning());
    let client = Client::begin(settings, &topics, inbox.clone()).map_err(refused)?;
    let hands = carry_out(hands, inbox.clone(), client.voice())?;
    brake(root, inbox.clone())?;
    let at = format!("{}:{}", args.broker.host, args.broker.port);
    say(&format!(
        "{shown}: {} at {at}; Ctrl-C ends it\n",
        topics.life().trim_end_matches("/life")
    ))?;
    let mut run = Run {
        args,
        at,
        topics,
        voice: client.voice(),
        client,
        follow,
        values,
        found: Vec::new(),
        is_there: false,
    };
    let over = loop {
        run.look()?;
        if let Some(gone) = run.hear()? {
            break Some(gone);
        }
        run.tell();
        if let Ok(Some(_)) = signals.read_signal() {
            break None;
        }
        let mut fds = [PollFd::new(signals.as_fd(), PollFlags::POLLIN)];
        let _ = poll(&mut fds, PollTimeout::from(recorder::limits::LOOK_MS));
    };
    // Those who drive rest before anybody hears that the robot is gone.
    inbox.end();
    let until = Instant::now() + END_TIME;
    // Hands that wait for a program of the robot give their leases back when this process ends.
    while !hands.is_finished() && Instant::now() < until {
        thread::sleep(LOOK_TIME);
    }
    match over {
        Some(gone) => Err(Error::Refused(format!("{}: {gone}", run.at)).into()),
        None => {
            run.client.end();
            Ok(0)
        }
    }
}

/// What is between the tree and the broker.
struct Run<'a> {
    args: &'a MqttArgs,
    /// Where the broker is, for a person.
    at: String,
    topics: Topics,
    voice: Voice,
    client: Client,
    follow: Follow,
    values: Values,
    /// What Home Assistant is still to be told.
    found: Vec<Message>,
    /// The broker is there.
    is_there: bool,
}

impl Run<'_> {
    /// Takes what has happened in the tree.
    fn look(&mut self) -> Result<(), Refusal> {
        let mut entries = Vec::new();
        match self.follow.look(&mut entries) {
            Change::Same => self.values.take(&entries),
            Change::Gone => {
                self.client.life(false);
                say("the tree is gone; waiting for it\n")?;
            }
            Change::Back => {
                self.values.replace(&self.follow.beginning());
                self.client.life(true);
                say("the tree is there again\n")?;
            }
        }
        Ok(())
    }

    /// Hears what became of the connection; why it is given up, if it is.
    fn hear(&mut self) -> Result<Option<Gone>, Refusal> {
        let at = &self.at;
        match self.client.news() {
            None => {}
            Some(News::Connected) => {
                self.is_there = true;
                say(&format!("{at}: connected\n"))?;
                self.client.life(self.follow.is_there());
                self.values.begin_anew();
                self.found = discovered(self.args, &self.topics, &self.values);
            }
            Some(News::Lost(why)) => {
                self.is_there = false;
                let why = harmless(&why);
                say(&format!("{at}: {why}; it is tried again\n"))?;
            }
            Some(News::Forbidden(what)) => {
                say(&format!(
                    "{at}: the broker gives no right: {what}; its list of rights decides\n"
                ))?;
            }
            Some(News::Over(gone)) => return Ok(Some(gone)),
        }
        Ok(None)
    }

    /// Tells what is due, as far as there is room.
    fn tell(&mut self) {
        if self.values.is_other() {
            self.found = discovered(self.args, &self.topics, &self.values);
        }
        if !self.is_there {
            return;
        }
        while self
            .found
            .last()
            .is_some_and(|message| self.voice.say(message.clone()))
        {
            self.found.pop();
        }
        if self.follow.is_there() {
            let voice = &self.voice;
            self.values
                .due(Instant::now(), |message| voice.say(message));
        }
    }
}

/// The thread that carries commands out; its end gives back what it holds.
fn carry_out(mut hands: Hands, inbox: Arc<Inbox>, voice: Voice) -> Result<JoinHandle<()>, Error> {
    let work = move || {
        while !inbox.is_over() {
            if let Some(next) = inbox.next(LOOK_TIME) {
                voice.say(hands.take(next));
            }
            hands.let_go(Instant::now());
        }
    };
    let thread = thread::Builder::new().name("hands".to_owned()).spawn(work);
    thread.map_err(|why| Error::system("a thread", why))
}

/// The thread that brings everything to rest as soon as a stop comes, whatever the hands wait for.
fn brake(root: PathBuf, inbox: Arc<Inbox>) -> Result<(), Error> {
    let work = move || {
        while !inbox.is_over() {
            if inbox.brake(LOOK_TIME) {
                // The hands do it once more, and say what became of it.
                let _ = fs::write(root.join("stop"), "1\n");
            }
        }
    };
    let thread = thread::Builder::new().name("brake".to_owned()).spawn(work);
    thread
        .map(drop)
        .map_err(|why| Error::system("a thread", why))
}

/// What Home Assistant is told, if it is.
fn discovered(args: &MqttArgs, topics: &Topics, values: &Values) -> Vec<Message> {
    let prefix = args.home_assistant.as_deref();
    prefix.map_or_else(Vec::new, |prefix| {
        discovery::messages(prefix, topics, &args.class, values)
    })
}

fn topics(args: &MqttArgs) -> Result<Topics, Error> {
    let host = || {
        let name = fs::read_to_string("/proc/sys/kernel/hostname").unwrap_or_default();
        name.trim().to_owned()
    };
    let name = args.name.clone().unwrap_or_else(host);
    Topics::new(&args.class, &name).map_err(refused)
}

fn settings(args: &MqttArgs) -> Result<Settings, Error> {
    let tls = args.broker.is_secure.then(|| tls(args)).transpose()?;
    if tls.is_none() && args.ca.is_some() {
        let host = &args.broker.host;
        let why = format!("--ca is for a broker behind TLS: --broker mqtts://{host}");
        return Err(Error::Refused(why));
    }
    let login = match (&args.user, &args.password_file) {
        (Some(user), Some(file)) => Some((user.clone(), password(file)?)),
        (None, _) | (_, None) => None,
    };
    Ok(Settings {
        host: args.broker.host.clone(),
        port: args.broker.port,
        login,
        tls,
    })
}

fn tls(args: &MqttArgs) -> Result<Tls, Error> {
    let own = match (&args.cert, &args.key) {
        (Some(cert), Some(key)) => Some((bytes(cert)?, bytes(key)?)),
        (None, _) | (_, None) => None,
    };
    Ok(Tls {
        authority: args.ca.as_deref().map(bytes).transpose()?,
        own,
    })
}
