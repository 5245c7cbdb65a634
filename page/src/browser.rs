//! One browser that looks: what it says is carried out or refused, and it is told what happens.
//!
//! Owns the two halves of its connection. Only what comes from the robot may wait for a slow browser; orders of the browser,
//! a stop first of all, wait for nothing that is sent to it.

use crate::configuration;
use crate::control::Browser;
use crate::drive::{self, Moves};
use crate::error::{Busy, Error};
use crate::inside::{self, Stages};
use crate::limits;
use crate::relay::{self, Came, Outgoing, Request};
use crate::shared::Shared;
use crate::store;
use crate::word::{News, Order, looks_back, only_looks};
use axum::body::Bytes;
use axum::extract::ws::{Message, WebSocket};
use futures_util::stream::{SplitSink, SplitStream};
use futures_util::{SinkExt, StreamExt};
use lang_text::problem::Locale;
use std::path::Path;
use std::sync::Arc;
use tokio::sync::{Notify, OwnedSemaphorePermit, mpsc, watch};
use tokio::time::{Instant, MissedTickBehavior, interval, timeout, timeout_at};

/// Serves one browser until it is gone.
pub async fn serve(shared: Arc<Shared>, socket: WebSocket, who: Browser, locale: Locale) {
    let (sink, stream) = socket.split();
    let (news, told) = mpsc::channel(limits::NEWS);
    let moves = Arc::<Moves>::default();
    let (requests, to_send) = mpsc::channel(limits::ORDERS);
    // What the robot says waits in the robot, which leaves out what is old.
    let (came, from_robot) = mpsc::channel(1);
    let (looks, is_looked_at) = watch::channel(false);
    let (inspects, inspected) = watch::channel(None);
    let (tells_stages, stages) = watch::channel(None);
    let stop = Arc::<Notify>::default();
    let outgoing = Outgoing {
        requests: to_send,
        stop: stop.clone(),
    };
    let relay = tokio::spawn(relay::run(
        (shared.robot.subscribe(), locale),
        outgoing,
        came,
    ));
    // It goes on when all else has ended: it has to bring actuators to rest.
    tokio::spawn(drive::run(
        shared.settings.tree.clone(),
        moves.clone(),
        news.clone(),
        shared.control.watch(),
        who,
    ));
    // It ends when the listener is gone.
    let (tree, turns) = (shared.settings.tree.clone(), shared.looks.clone());
    tokio::spawn(inside::run(tree, inspected, tells_stages, turns));
    let ending = moves.clone();
    let listener = Listener {
        shared: shared.clone(),
        who,
        news,
        moves,
        requests,
        stop,
        looks,
        inspects,
    };
    let teller = Teller {
        shared: shared.clone(),
        who,
        sink,
        told,
        from_robot,
        is_looked_at,
        stages,
        locale,
    };
    tokio::select! {
        () = listener.run(stream) => {}
        () = teller.run() => {}
    }
    relay.abort();
    shared.control.leave(who);
    ending.end();
}

/// What the browser says.
struct Listener {
    shared: Arc<Shared>,
    who: Browser,
    news: mpsc::Sender<News>,
    moves: Arc<Moves>,
    requests: mpsc::Sender<Request>,
    stop: Arc<Notify>,
    looks: watch::Sender<bool>,
    /// The node whose inside it wants to see.
    inspects: watch::Sender<Option<String>>,
}

impl Listener {
    async fn run(self, mut stream: SplitStream<WebSocket>) {
        let mut heard = Instant::now();
        let mut is_silent = false;
        loop {
            let patience = if is_silent {
                limits::SEND_TIME
            } else {
                limits::SILENCE_TIME
            };
            let message = match timeout_at(heard + patience, stream.next()).await {
                Ok(Some(Ok(message))) => message,
                Ok(None | Some(Err(_))) => return,
                // A network that has broken off says nothing: what was driven must not go on.
                Err(_) if !is_silent => {
                    is_silent = true;
                    self.moves.rest();
                    continue;
                }
                Err(_) => return,
            };
            (heard, is_silent) = (Instant::now(), false);
            let refused = match message {
                Message::Text(text) => Order::parse(&text).and_then(|order| self.obey(order)),
                Message::Binary(request) => self.ask(request),
                Message::Ping(_) | Message::Pong(_) => Ok(()),
                Message::Close(_) => return,
            };
            // A browser that says nothing but rubbish leaves room for what came of its values.
            if let Err(error) = refused
                && self.news.capacity() > limits::NEWS / 2
            {
                let _ = self.news.try_send(News::Refused(error.words()));
            }
        }
    }

    /// This computer may do something.
    fn may(&self) -> Result<(), Error> {
        let (guests, ip) = (&self.shared.settings.guests, self.who.address.ip());
        if guests.may_drive(ip) {
            return Ok(());
        }
        guests.asks(ip);
        Err(Error::Unpaired)
    }

    /// It may do something, and is in control.
    fn need(&self) -> Result<(), Error> {
        self.may()?;
        self.shared.control.need(self.who)
    }

    /// What would hold others up waits for its turn, and is refused later if it is.
    fn order_world(&self, words: String) -> Result<(), Error> {
        self.need()?;
        let world = self.shared.settings.world.clone().ok_or(Error::NoWorld)?;
        if words.len() <= limits::WORLD_QUICK_BYTES {
            return world.order(&words).map_err(|why| Error::World(why.0));
        }
        let busy = |_| Error::Busy(Busy::Worlds);
        let turn = self
            .shared
            .large
            .clone()
            .try_acquire_owned()
            .map_err(busy)?;
        let news = self.news.clone();
        tokio::task::spawn_blocking(move || {
            let _turn = turn;
            if let Err(why) = world.order(&words) {
                let _ = news.try_send(News::Refused(Error::World(why.0).words()));
            }
        });
        Ok(())
    }

    fn obey(&self, order: Order) -> Result<(), Error> {
        match order {
            Order::Write(target, value) => {
                self.need()?;
                self.moves.write(target, value)
            }
            Order::Inspect(path) => {
                self.inspects.send_replace(path);
                Ok(())
            }
            Order::World(words) => self.order_world(words),
            Order::Configure(text) => {
                if let Err(why) = self.configure(text) {
                    // Not among other refusals: the page waits for this answer.
                    let _ = (self.news).try_send(News::Configured(Some(why.words())));
                }
                Ok(())
            }
            Order::Playback(words) => {
                self.need()?;
                let playback = self.shared.settings.playback.as_ref();
                let playback = playback.ok_or(Error::NoPlayback)?;
                playback.order(&words).map_err(|why| Error::World(why.0))
            }
            Order::Remove(name) => {
                let done = News::Programs(name.clone(), None);
                self.change(done, move |programs| store::remove(programs, &name))
            }
            Order::Rename(name, to) => {
                let done = News::Programs(name.clone(), Some(to.clone()));
                self.change(done, move |programs| store::rename(programs, &name, &to))
            }
            Order::Look(looks) => {
                let changed = |now: &mut bool| std::mem::replace(now, looks) != looks;
                self.looks.send_if_modified(changed);
                Ok(())
            }
            Order::Take => {
                self.may()?;
                self.shared.control.take(self.who);
                Ok(())
            }
            Order::Leave => {
                self.shared.control.leave(self.who);
                self.moves.rest();
                Ok(())
            }
            Order::Pair(code) => {
                let done = self
                    .shared
                    .settings
                    .guests
                    .pair(self.who.address.ip(), &code);
                let why = done.err().map(|why| Error::Pairing(why).words());
                // Not among other refusals: the page waits for this answer.
                let _ = self.news.try_send(News::Paired(why));
                Ok(())
            }
            Order::Stop => {
                // The programs by the robot itself, what moves by the tree, should the robot's daemon not be there.
                self.stop.notify_one();
                self.moves.stop();
                Ok(())
            }
        }
    }

    /// Another configuration of the tree. What comes of it is told later: its converters are compiled meanwhile.
    fn configure(&self, text: String) -> Result<(), Error> {
        if !self.shared.settings.configures {
            return Err(Error::Fixed);
        }
        self.need()?;
        let busy = |_| Error::Busy(Busy::Configuration);
        let turn = (self.shared.large.clone().try_acquire_owned()).map_err(busy)?;
        let (news, shared) = (self.news.clone(), self.shared.clone());
        tokio::task::spawn_blocking(move || {
            let _turn = turn;
            let done = configuration::replace(&shared.settings.tree, &text);
            let _ = news.try_send(News::Configured(done.err().map(|why| why.words())));
        });
        Ok(())
    }

    /// Something about the folder of programs, which may be on a slow card; `done` is told when it is.
    fn change(
        &self,
        done: News,
        change: impl FnOnce(&Path) -> Result<(), Error> + Send + 'static,
    ) -> Result<(), Error> {
        self.need()?;
        let busy = |_| Error::Busy(Busy::Files);
        let turn = (self.shared.large.clone().try_acquire_owned()).map_err(busy)?;
        let (news, shared) = (self.news.clone(), self.shared.clone());
        tokio::task::spawn_blocking(move || {
            let _turn = turn;
            let folder = shared.settings.programs.as_deref();
            let outcome = folder.ok_or(Error::NoFolder).and_then(change);
            let told = outcome.map_or_else(|why| News::Refused(why.words()), |()| done);
            // A browser that does not read is told nothing.
            let _ = news.try_send(told);
        });
        Ok(())
    }

    /// A request of the control port.
    fn ask(&self, request: Bytes) -> Result<(), Error> {
        if looks_back(&request) {
            self.may()?;
        } else if !only_looks(&request) {
            self.need()?;
        }
        let room = self.room(&request)?;
        let full = |_| Error::Busy(Busy::Requests);
        let request = Request {
            bytes: request,
            room,
        };
        self.requests.try_send(request).map_err(full)
    }

    /// The share of an upload in the room for all of them; others are small.
    fn room(&self, request: &Bytes) -> Result<Option<OwnedSemaphorePermit>, Error> {
        if request.len() <= limits::REQUEST_BYTES_MAX {
            return Ok(None);
        }
        if !request.starts_with(b"file:") {
            return Err(Error::Long(request.len(), limits::REQUEST_BYTES_MAX));
        }
        let full = || Error::Busy(Busy::Uploads);
        let bytes = u32::try_from(request.len()).map_err(|_| full())?;
        let uploads = self.shared.uploads.clone();
        let room = uploads.try_acquire_many_owned(bytes);
        room.map(Some).map_err(|_| full())
    }
}

/// What the browser is told.
struct Teller {
    shared: Arc<Shared>,
    who: Browser,
    sink: SplitSink<WebSocket, Message>,
    told: mpsc::Receiver<News>,
    from_robot: mpsc::Receiver<Came>,
    is_looked_at: watch::Receiver<bool>,
    stages: watch::Receiver<Option<Stages>>,
    /// Sentences are in this language.
    locale: Locale,
}

impl Teller {
    async fn run(mut self) {
        let mut holder = self.shared.control.watch();
        let playback = self.shared.settings.playback.clone();
        let control = News::control(*holder.borrow_and_update(), self.who);
        if !self.say(self.hello()).await || !self.say(control).await {
            return;
        }
        let mut pings = interval(limits::PING_TIME);
        pings.set_missed_tick_behavior(MissedTickBehavior::Delay);
        let mut pictures = interval(limits::PICTURE_TIME);
        pictures.set_missed_tick_behavior(MissedTickBehavior::Delay);
        let mut places = interval(limits::PLAYBACK_TIME);
        places.set_missed_tick_behavior(MissedTickBehavior::Delay);
        let mut place = None;
        let mut shown = Shown::default();
        loop {
            let looks = *self.is_looked_at.borrow();
            let is_sent = tokio::select! {
                Some(news) = self.told.recv() => self.say(news).await,
                came = self.from_robot.recv() => match came {
                    Some(Came::There) => self.say(News::Robot(None)).await,
                    Some(Came::Gone(why)) => self.say(News::Robot(Some(why))).await,
                    Some(Came::Frame(frame)) => self.send(Message::Binary(frame.into())).await,
                    None => false,
                },
                Ok(()) = self.stages.changed() => {
                    let now = self.stages.borrow_and_update().clone();
                    match now {
                        Some(stages) => self.say(News::Stages(stages)).await,
                        None => true,
                    }
                }
                Ok(()) = holder.changed() => {
                    let now = *holder.borrow_and_update();
                    self.say(News::control(now, self.who)).await
                }
                Ok(()) = self.is_looked_at.changed() => {
                    // What a marker drew meanwhile was not seen here: the scene has it.
                    shown = Shown::default();
                    true
                }
                _ = pings.tick() => {
                    self.say(News::Beat).await && self.send(Message::Ping(Bytes::new())).await
                }
                _ = places.tick(), if playback.is_some() => {
                    let now = playback.as_ref().map(|playback| playback.state());
                    let has_changed = now != place;
                    place = now;
                    match now.filter(|_| has_changed) {
                        Some(state) => self.say(News::Playback(state.json())).await,
                        None => true,
                    }
                }
                _ = pictures.tick(), if looks => self.show(&mut shown).await,
            };
            if !is_sent {
                return;
            }
        }
    }

    fn hello(&self) -> News {
        let settings = &self.shared.settings;
        News::Hello {
            name: settings.name.clone(),
            version: env!("CARGO_PKG_VERSION").to_owned(),
            has_world: settings.world.is_some(),
            orders_world: (settings.world.as_ref()).is_some_and(|world| world.takes_orders()),
            has_studio: settings.studio.is_some(),
            configures: settings.configures,
            may_drive: settings.guests.may_drive(self.who.address.ip()),
        }
    }

    async fn say(&mut self, news: News) -> bool {
        self.send(Message::Text(news.text(self.locale).into()))
            .await
    }

    async fn send(&mut self, message: Message) -> bool {
        matches!(
            timeout(limits::SEND_TIME, self.sink.send(message)).await,
            Ok(Ok(()))
        )
    }

    /// The world, as far as it has changed.
    async fn show(&mut self, shown: &mut Shown) -> bool {
        let Some(world) = self.shared.settings.world.clone() else {
            return true;
        };
        if shown.version != Some(world.version()) {
            let (version, scene) = world.scene();
            shown.version = Some(version);
            if !self.say(News::Scene(scene)).await {
                return false;
            }
        }
        let state = world.state();
        if state == shown.state {
            return true;
        }
        shown.state.clone_from(&state);
        self.say(News::World(state)).await
    }
}

/// What this browser was shown last of the world.
#[derive(Default)]
struct Shown {
    version: Option<u64>,
    state: String,
}
