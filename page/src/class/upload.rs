//! A file on its way to one robot, over a connection of its own.
//!
//! Owns what goes over it, and what the robot says of the file. The program is started over the robot's other connection, so
//! that a stop comes before or after that and never between.

use super::board::{Board, Stage};
use super::robot::open;
use super::words::Why;
use crate::error::plain;
use crate::limits;
use axum::body::Bytes;
use frame::{Decoder, encode};
use std::net::SocketAddr;
use std::sync::Arc;
use tokio::io::{AsyncReadExt, AsyncWriteExt};
use tokio::net::tcp::{OwnedReadHalf, OwnedWriteHalf};
use tokio::sync::OwnedSemaphorePermit;
use tokio::time::timeout;

/// How errors about a file begin, or about its sender; others are those of a program.
pub const REFUSALS: [&str; 2] = ["the upload failed: ", "this computer is not paired "];

/// A file for several robots.
#[derive(Debug)]
pub struct Parcel {
    pub name: String,
    pub content: Bytes,
    /// It shall run.
    pub runs: bool,
    /// Its share of the room for all files; given back when the last robot has it.
    pub _room: OwnedSemaphorePermit,
}

/// Sends it to the robot that takes programs there.
pub async fn run(board: Arc<Board>, id: usize, at: SocketAddr, parcel: Arc<Parcel>) {
    let sent = timeout(limits::CLASS_UPLOAD_TIME, send(&board, id, at, &parcel)).await;
    match sent.unwrap_or(Err(Why::Slow)) {
        Ok(()) if parcel.runs => board.run(id, &parcel.name),
        Ok(()) => board.stage(id, &parcel.name, Stage::Sent),
        Err(why) => board.stage(id, &parcel.name, Stage::Failed(why)),
    }
}

async fn send(board: &Board, id: usize, at: SocketAddr, parcel: &Parcel) -> Result<(), Why> {
    let (mut read, mut write) = open(at).await?.into_split();
    tokio::select! {
        answer = answer(&mut read, &parcel.name) => answer,
        // It ends only by a failure, and why the robot takes no more it may have said before.
        why = write_all(board, id, parcel, &mut write) => {
            match timeout(limits::RETURN_TIME, answer(&mut read, &parcel.name)).await {
                Ok(Err(said @ Why::Said(_))) => Err(said),
                Ok(_) | Err(_) => Err(why),
            }
        }
    }
}

/// Writes the file, and then what keeps the connection.
async fn write_all(board: &Board, id: usize, parcel: &Parcel, write: &mut OwnedWriteHalf) -> Why {
    let head = format!("file:{}:", parcel.name);
    let size = head.len() + parcel.content.len();
    if let Err(error) = write.write_all(format!("{size}:{head}").as_bytes()).await {
        return Why::System(plain(&error));
    }
    let mut done = 0;
    for piece in parcel.content.chunks(limits::CLASS_PIECE_BYTES) {
        if let Err(error) = write.write_all(piece).await {
            return Why::System(plain(&error));
        }
        done += piece.len();
        board.stage(id, &parcel.name, Stage::Sending(done));
    }
    let mut next = encode(b"version");
    loop {
        if let Err(error) = write.write_all(&next).await {
            return Why::System(plain(&error));
        }
        tokio::time::sleep(limits::KEEPALIVE_TIME).await;
        next = encode(b"keepalive");
    }
}

/// Waits until the robot has kept the file.
async fn answer(read: &mut OwnedReadHalf, name: &str) -> Result<(), Why> {
    let mut decoder = Decoder::new(limits::CLASS_MESSAGE_BYTES_MAX);
    let mut buffer = vec![0; limits::READ_BYTES];
    let own = format!("'{name}'");
    loop {
        let size = match timeout(limits::CLASS_SILENCE_TIME, read.read(&mut buffer)).await {
            Ok(Ok(0)) => return Err(Why::Closed),
            Ok(Ok(size)) => size,
            Ok(Err(error)) => return Err(Why::System(plain(&error))),
            Err(_) => return Err(Why::Silent),
        };
        decoder.feed(&buffer[..size]);
        loop {
            let frame = match decoder.next() {
                Ok(Some(frame)) => frame,
                Ok(None) => break,
                Err(violation) => return Err(Why::NoRobot(violation.to_string())),
            };
            if frame.starts_with(b"version: ") {
                return Ok(());
            }
            let Some(text) = frame.strip_prefix(b"error: ") else {
                continue;
            };
            let text = String::from_utf8_lossy(text);
            if text.starts_with(&own) || REFUSALS.iter().any(|start| text.starts_with(start)) {
                return Err(Why::Said(
                    text.chars().take(limits::CLASS_LETTERS_MAX).collect(),
                ));
            }
        }
    }
}
