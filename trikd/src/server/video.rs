//! Port 8080: pictures of the camera, if the tree has any.
//!
//! Owns what stands around a picture on the wire. Where pictures come from, `pictures` knows.

use super::Guest;
use super::variables::head;
use crate::clients::Clients;
use crate::limits;
use crate::pictures::{Newest, NoPicture, Pictures};
use crate::protocol::http::{Head, answer};
use std::io;
use std::rc::Rc;
use std::sync::Arc;
use std::time::Duration;
use tokio::io::{AsyncReadExt, AsyncWriteExt};
use tokio::net::TcpStream;
use tokio::sync::watch::Receiver;
use tokio::time::timeout;

/// The next picture.
async fn next(watcher: &mut Receiver<Newest>) -> Result<Arc<[u8]>, NoPicture> {
    let wait = Duration::from_millis(limits::PICTURE_WAIT_MS);
    match timeout(wait, watcher.changed()).await {
        Ok(Ok(())) => {}
        Ok(Err(_)) => return Err(NoPicture::End),
        Err(_) => return Err(NoPicture::Silent(limits::PICTURE_WAIT_MS / 1000)),
    }
    let newest = watcher.borrow_and_update().clone();
    newest.unwrap_or(Err(NoPicture::NoneYet))
}

/// Ends when the client has broken the connection. One that only says nothing more may still want its answer.
async fn gone(stream: &mut (impl AsyncReadExt + Unpin)) {
    let mut ignored = [0; 64];
    loop {
        match stream.read(&mut ignored).await {
            Err(_) => return,
            Ok(0) => std::future::pending().await,
            Ok(_) => {}
        }
    }
}

/// Sends pictures until the client leaves or there are no more: one after the other, those that it is too slow for not.
async fn stream_pictures(
    stream: &mut TcpStream,
    mut watcher: Receiver<Newest>,
    first: Arc<[u8]>,
) -> io::Result<()> {
    let start = "HTTP/1.0 200 OK\r\nConnection: close\r\nCache-Control: no-cache\r\n\
                 Content-Type: multipart/x-mixed-replace;boundary=picture\r\n\r\n";
    stream.write_all(start.as_bytes()).await?;
    let mut picture = first;
    loop {
        let part = format!(
            "--picture\r\nContent-Type: image/jpeg\r\nContent-Length: {}\r\n\r\n",
            picture.len()
        );
        let send = async {
            stream.write_all(part.as_bytes()).await?;
            stream.write_all(&picture).await?;
            stream.write_all(b"\r\n").await
        };
        timeout(Duration::from_millis(limits::SILENCE_MS), send).await??;
        picture = next(&mut watcher).await.map_err(io::Error::other)?;
    }
}

/// What this port works with.
#[derive(Debug)]
pub struct Video {
    /// The register of connections.
    pub clients: Rc<Clients>,
    /// What the camera sees.
    pub pictures: Pictures,
}

/// Serves one client.
pub async fn serve(video: Rc<Video>, guest: Guest) {
    let Guest {
        mut stream,
        peer,
        mut seat,
        ..
    } = guest;
    let text = |status: &str, body: &str| answer(status, "text/plain; charset=utf-8", body);
    let reply = match head(&mut stream, &mut seat).await {
        Head::Get { path: asked, query } if asked == "/" => {
            let first = match video.pictures.watch() {
                Ok(mut watcher) => tokio::select! {
                    picture = next(&mut watcher) => picture.map(|picture| (picture, watcher)),
                    () = gone(&mut stream) => return drop(seat),
                },
                Err(error) => Err(NoPicture::NoReader(error.into())),
            };
            match first {
                Err(reason) => text(
                    "503 Service Unavailable",
                    &format!("there are no pictures: {reason}\n"),
                ),
                Ok((picture, _)) if query.split('&').any(|word| word == "action=snapshot") => {
                    let mut reply = format!(
                        "HTTP/1.0 200 OK\r\nContent-Type: image/jpeg\r\nContent-Length: {}\r\n\r\n",
                        picture.len()
                    )
                    .into_bytes();
                    reply.extend_from_slice(&picture);
                    reply
                }
                Ok((picture, watcher)) => {
                    let outbox = Rc::new(crate::outbox::Outbox::new(0));
                    let _client = video.clients.add("video", peer, outbox);
                    let _ = stream_pictures(&mut stream, watcher, picture).await;
                    return drop(seat);
                }
            }
        }
        Head::Get { .. } => text(
            "404 Not Found",
            "there is only /?action=stream and /?action=snapshot\n",
        ),
        Head::OtherMethod => text("405 Method Not Allowed", "only GET is understood\n"),
        Head::Nonsense | Head::Partial => text("400 Bad Request", "this is no HTTP request\n"),
    };
    let _ = timeout(
        Duration::from_millis(limits::SILENCE_MS),
        stream.write_all(&reply),
    )
    .await;
    let _ = stream.shutdown().await;
    drop(seat);
}
