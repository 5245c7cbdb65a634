//! Port 8080: pictures of the camera, if the tree has any.
//!
//! Pictures are JPEG in the file [`PICTURES`], each read of which gives the newest one. A tree without it is answered
//! with a reason.

use super::Guest;
use super::variables::head;
use crate::daemon::Daemon;
use crate::limits;
use crate::protocol::http::{Head, answer};
use std::io;
use std::path::PathBuf;
use std::rc::Rc;
use std::time::Duration;
use tokio::io::AsyncWriteExt;
use tokio::net::TcpStream;
use tokio::time::{Instant, sleep_until, timeout};

/// Where the tree has the newest picture.
pub const PICTURES: &str = "camera/picture/bin_data";

/// The newest picture; a slow camera delays only who asks.
async fn picture(path: PathBuf) -> io::Result<Vec<u8>> {
    let read = move || {
        let file = std::fs::File::open(path)?;
        let mut bytes = Vec::new();
        io::Read::read_to_end(&mut io::Read::take(file, limits::PICTURE_BYTES), &mut bytes)?;
        Ok(bytes)
    };
    tokio::task::spawn_blocking(read)
        .await
        .map_err(io::Error::other)?
}

/// Sends pictures until the client leaves: one after the other, at most so many in a second.
async fn stream_pictures(stream: &mut TcpStream, path: PathBuf, first: Vec<u8>) -> io::Result<()> {
    let start = "HTTP/1.0 200 OK\r\nConnection: close\r\nCache-Control: no-cache\r\n\
                 Content-Type: multipart/x-mixed-replace;boundary=picture\r\n\r\n";
    stream.write_all(start.as_bytes()).await?;
    let mut next = first;
    loop {
        let due = Instant::now() + Duration::from_millis(limits::PICTURE_MS);
        let part = format!(
            "--picture\r\nContent-Type: image/jpeg\r\nContent-Length: {}\r\n\r\n",
            next.len()
        );
        let send = async {
            stream.write_all(part.as_bytes()).await?;
            stream.write_all(&next).await?;
            stream.write_all(b"\r\n").await
        };
        timeout(Duration::from_millis(limits::SILENCE_MS), send).await??;
        sleep_until(due).await;
        next = picture(path.clone()).await?;
    }
}

/// Serves one client.
pub async fn serve(daemon: Rc<Daemon>, guest: Guest) {
    let Guest {
        mut stream,
        peer,
        seat,
    } = guest;
    let text = |status: &str, body: &str| answer(status, "text/plain; charset=utf-8", body);
    let path = daemon.settings.tree.join(PICTURES);
    let reply = match head(&mut stream).await {
        Head::Get { path: asked, query } if asked == "/" => match picture(path.clone()).await {
            Err(error) => {
                let body = format!("there are no pictures: {}: {error}\n", path.display());
                text("503 Service Unavailable", &body)
            }
            Ok(first) if query.split('&').any(|word| word == "action=snapshot") => {
                let mut reply = format!(
                    "HTTP/1.0 200 OK\r\nContent-Type: image/jpeg\r\nContent-Length: {}\r\n\r\n",
                    first.len()
                )
                .into_bytes();
                reply.extend(first);
                reply
            }
            Ok(first) => {
                let _client =
                    daemon
                        .clients
                        .add("video", peer, Rc::new(crate::outbox::Outbox::new(0)));
                let _ = stream_pictures(&mut stream, path, first).await;
                return drop(seat);
            }
        },
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
