//! One browser that looks at marks: it is told what changes, and nothing that it says is listened to.
//!
//! Owns the two halves of its connection.

use super::board::Board;
use super::word;
use crate::limits;
use axum::body::Bytes;
use axum::extract::ws::{Message, WebSocket};
use futures_util::stream::{SplitSink, SplitStream};
use futures_util::{SinkExt, StreamExt};
use lang_text::problem::Locale;
use std::sync::Arc;
use tokio::time::{MissedTickBehavior, interval, sleep, timeout};

/// Serves one browser until it is gone.
pub async fn serve(board: Arc<Board>, socket: WebSocket, locale: Locale) {
    let (sink, stream) = socket.split();
    tokio::select! {
        () = listen(stream) => {}
        () = tell(&board, sink, locale) => {}
    }
}

/// A browser answers pings, so one that says nothing is gone.
async fn listen(mut stream: SplitStream<WebSocket>) {
    while let Ok(Some(Ok(message))) = timeout(limits::SEND_TIME, stream.next()).await {
        if matches!(message, Message::Close(_)) {
            return;
        }
    }
}

async fn tell(board: &Board, mut sink: SplitSink<WebSocket, Message>, locale: Locale) {
    let mut changes = board.watch();
    let mut texts = vec![word::hello(&board.title)];
    changes.mark_changed();
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
                let (rows, progress) = board.since(std::mem::replace(&mut seen, now));
                texts.extend(rows.iter().map(|(id, row)| word::row(*id, row, locale)));
                // Behind the rows: who reads that all is judged has all rows.
                texts.extend(progress.map(word::progress));
                // What changes meanwhile is shown together.
                sleep(limits::MARKS_TIME).await;
            }
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
