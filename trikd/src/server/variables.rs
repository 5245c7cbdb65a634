//! Port 10000, for this machine only: variables that the program shows to web pages.

use super::Guest;
use crate::daemon::Daemon;
use crate::limits;
use crate::program::Command;
use crate::protocol::http::{Head, answer, parse};
use std::rc::Rc;
use std::time::Duration;
use tokio::io::{AsyncReadExt, AsyncWriteExt};
use tokio::net::TcpStream;
use tokio::sync::oneshot;
use tokio::time::timeout;

/// Reads the head of a request, as long as it comes in time and is short.
pub async fn head(stream: &mut TcpStream) -> Head {
    let mut bytes = Vec::new();
    let mut buffer = [0; 1024];
    let read = async {
        loop {
            match stream.read(&mut buffer).await {
                Ok(0) | Err(_) => return Head::Nonsense,
                Ok(size) => bytes.extend_from_slice(&buffer[..size]),
            }
            match parse(&bytes) {
                Head::Partial if bytes.len() < limits::HTTP_HEAD_BYTES => {}
                Head::Partial => return Head::Nonsense,
                head => return head,
            }
        }
    };
    timeout(Duration::from_millis(limits::SILENCE_MS), read)
        .await
        .unwrap_or(Head::Nonsense)
}

/// Serves one request.
pub async fn serve(daemon: Rc<Daemon>, guest: Guest) {
    let Guest {
        mut stream, seat, ..
    } = guest;
    let text = |status: &str, body: &str| answer(status, "text/plain; charset=utf-8", body);
    let reply = match head(&mut stream).await {
        Head::Get { path, .. } if path == "/web/" || path == "/web" => {
            if daemon.programs.runs() {
                let (ask, told) = oneshot::channel();
                daemon.programs.offer(Command::Web(ask));
                match timeout(Duration::from_millis(limits::WEB_MS), told).await {
                    Ok(Ok(json)) => answer("200 OK", "text/plain, charset=us-ascii", &json),
                    Ok(Err(_)) => text(
                        "503 Service Unavailable",
                        "the program has no variables to show\n",
                    ),
                    Err(_) => text(
                        "504 Gateway Timeout",
                        "the program is busy and does not answer\n",
                    ),
                }
            } else {
                text("503 Service Unavailable", "no program runs\n")
            }
        }
        Head::Get { .. } => text("404 Not Found", "there is only /web/\n"),
        Head::OtherMethod => text("405 Method Not Allowed", "only GET is understood\n"),
        Head::Nonsense | Head::Partial => text("400 Bad Request", "this is no HTTP request\n"),
    };
    let _ = timeout(
        Duration::from_millis(limits::FAREWELL_MS),
        stream.write_all(&reply),
    )
    .await;
    let _ = stream.shutdown().await;
    drop(seat);
}
