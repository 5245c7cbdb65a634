//! One browser that looks at a class: its orders are carried out or refused, and it is told what changes.
//!
//! Owns the two halves of its connection. An order waits for nothing that is sent to it.

use super::board::Reach;
use super::shared::Class;
use super::upload::{self, Parcel};
use super::word::{self, Order, Send};
use super::words::Refused;
use crate::control::Browser;
use crate::limits;
use axum::body::Bytes;
use axum::extract::ws::{Message, WebSocket};
use futures_util::stream::{SplitSink, SplitStream};
use futures_util::{SinkExt, StreamExt};
use lang_text::problem::Locale;
use std::sync::Arc;
use tokio::sync::mpsc;
use tokio::time::{MissedTickBehavior, interval, sleep, timeout};

/// Serves one browser until it is gone.
pub async fn serve(class: Arc<Class>, socket: WebSocket, who: Browser, locale: Locale) {
    let (sink, stream) = socket.split();
    let (refusals, told) = mpsc::channel(limits::NEWS);
    tokio::select! {
        () = listen(&class, who, stream, &refusals) => {}
        () = tell(&class, who, sink, told, locale) => {}
    }
}

async fn listen(
    class: &Arc<Class>,
    who: Browser,
    mut stream: SplitStream<WebSocket>,
    refusals: &mpsc::Sender<Refused>,
) {
    // A browser answers pings, so one that says nothing is gone.
    while let Ok(Some(Ok(message))) = timeout(limits::SEND_TIME, stream.next()).await {
        let done = match message {
            Message::Text(text) => may(class, who).and_then(|()| obey(class, &text)),
            Message::Binary(bytes) => may(class, who).and_then(|()| send(class, &bytes)),
            Message::Ping(_) | Message::Pong(_) => Ok(()),
            Message::Close(_) => return,
        };
        if let Err(why) = done {
            // A browser that says nothing but rubbish is not told of each.
            let _ = refusals.try_send(why);
        }
    }
}

/// This computer may do something.
fn may(class: &Class, who: Browser) -> Result<(), Refused> {
    match class.guests.may_drive(who.address.ip()) {
        true => Ok(()),
        false => Err(Refused::Looks),
    }
}

fn obey(class: &Class, text: &str) -> Result<(), Refused> {
    let board = &class.board;
    match Order::parse(text, board.titles.len())? {
        Order::Stop(robots) => robots.into_iter().for_each(|id| board.stop(id)),
        Order::Run(robots, name) => {
            // The robot would run what it had before.
            if robots.iter().any(|id| board.is_sending(*id, &name)) {
                return Err(Refused::Busy);
            }
            for id in robots {
                board.begin(id, (&name, 0), true, None);
                board.run(id, &name);
            }
        }
    }
    Ok(())
}

/// Sends a file to robots, to all at once.
fn send(class: &Arc<Class>, message: &Bytes) -> Result<(), Refused> {
    let board = &class.board;
    let order = Send::parse(message, board.titles.len())?;
    let bytes = order.content.len();
    let share = u32::try_from(bytes).map_err(|_| Refused::Busy)?;
    let uploads = class.uploads.clone();
    let parcel = Arc::new(Parcel {
        name: order.name,
        content: order.content,
        runs: order.runs,
        _room: uploads
            .try_acquire_many_owned(share)
            .map_err(|_| Refused::Busy)?,
    });
    for id in order.robots {
        let at = board.with(id, |card| match card.reach {
            Reach::There(at) => Some(at),
            Reach::Unknown | Reach::Absent(_) => None,
        });
        let name = parcel.name.clone();
        let Some(at) = at.flatten() else {
            board.begin(id, (&name, bytes), parcel.runs, None);
            board.away(id, &name);
            continue;
        };
        // It begins when this thread has done with the order, and then its card is there.
        let task = tokio::spawn(upload::run(board.clone(), id, at, parcel.clone()));
        let upload = Some(task.abort_handle());
        board.begin(id, (&name, bytes), parcel.runs, upload);
    }
    Ok(())
}

async fn tell(
    class: &Class,
    who: Browser,
    mut sink: SplitSink<WebSocket, Message>,
    mut refusals: mpsc::Receiver<Refused>,
    locale: Locale,
) {
    let board = &class.board;
    let mut changes = board.watch();
    let may_drive = class.guests.may_drive(who.address.ip());
    let mut texts = vec![word::hello(class, may_drive)];
    changes.mark_changed();
    // Numbers of changes begin with 1, and the first cards have none: a page knows of itself that nothing is known.
    let mut seen = 0;
    let mut pings = interval(limits::PING_TIME);
    pings.set_missed_tick_behavior(MissedTickBehavior::Delay);
    loop {
        for text in texts.drain(..) {
            if !say(&mut sink, Message::Text(text.into())).await {
                return;
            }
        }
        tokio::select! {
            changed = changes.changed() => {
                if changed.is_err() {
                    return;
                }
                let now = *changes.borrow_and_update();
                let cards = board.since(std::mem::replace(&mut seen, now));
                texts.extend(cards.iter().map(|(id, card)| word::card(*id, card, locale)));
                // What changes meanwhile is shown together.
                sleep(limits::PICTURE_TIME).await;
            }
            Some(why) = refusals.recv() => texts.push(word::refused(why, locale)),
            _ = pings.tick() => {
                if !say(&mut sink, Message::Ping(Bytes::new())).await {
                    return;
                }
                texts.push(word::beat());
            }
        }
    }
}

async fn say(sink: &mut SplitSink<WebSocket, Message>, message: Message) -> bool {
    matches!(
        timeout(limits::SEND_TIME, sink.send(message)).await,
        Ok(Ok(()))
    )
}
