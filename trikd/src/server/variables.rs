//! Port 10000, for this machine only: variables that the program shows to web pages, and where a diagram is.

use super::Guest;
use crate::clients::{Clients, Watching};
use crate::limits;
use crate::outbox::Outbox;
use crate::program::{Command, Programs};
use crate::protocol::http::{Head, answer, parse};
use page::seats::Seat;
use std::io;
use std::net::SocketAddr;
use std::rc::Rc;
use std::time::Duration;
use tokio::io::{AsyncReadExt, AsyncWriteExt};
use tokio::net::TcpStream;
use tokio::sync::oneshot;
use tokio::time::timeout;

/// Reads the head of a request, as long as it comes in time and is short, and nobody else needs the place.
pub async fn head(stream: &mut TcpStream, seat: &mut Seat) -> Head {
    let place = seat.place();
    let mut bytes = Vec::new();
    let mut buffer = [0; 1024];
    let read = async {
        loop {
            match stream.read(&mut buffer).await {
                Ok(0) | Err(_) => return Head::Nonsense,
                Ok(size) => {
                    bytes.extend_from_slice(&buffer[..size]);
                    place.hears(size, false, true);
                }
            }
            match parse(&bytes) {
                Head::Partial if bytes.len() < limits::HTTP_HEAD_BYTES => {}
                Head::Partial => return Head::Nonsense,
                head @ (Head::Get { .. } | Head::OtherMethod | Head::Nonsense) => {
                    place.is_good();
                    return head;
                }
            }
        }
    };
    tokio::select! {
        head = timeout(Duration::from_millis(limits::SILENCE_MS), read) => head.unwrap_or(Head::Nonsense),
        () = seat.lost() => Head::Nonsense,
    }
}

/// Tells where the running diagram is, one JSON object on each line, until the client leaves.
async fn diagram(clients: &Clients, stream: &mut TcpStream, peer: SocketAddr) -> io::Result<()> {
    stream
        .write_all(
            b"HTTP/1.0 200 OK\r\nContent-Type: application/x-ndjson\r\nConnection: close\r\n\r\n",
        )
        .await?;
    let outbox = Rc::new(Outbox::new(limits::OUTBOX_BYTES));
    let client = clients.add("diagram", peer, outbox.clone());
    client.watch(Watching::Objects);
    let mut rest = [0; 64];
    loop {
        tokio::select! {
            line = outbox.next() => match line {
                Some(line) => {
                    let sent = stream.write_all(&line);
                    timeout(Duration::from_millis(limits::SILENCE_MS), sent).await??;
                }
                None => return Ok(()),
            },
            read = stream.read(&mut rest) => {
                if read? == 0 {
                    return Ok(());
                }
            }
        }
    }
}

/// What this port works with.
#[derive(Debug)]
pub struct Variables {
    /// The register of connections.
    pub clients: Rc<Clients>,
    /// The part that runs programs.
    pub programs: Rc<Programs>,
}

/// Serves one request.
pub async fn serve(variables: Rc<Variables>, guest: Guest) {
    let Guest {
        mut stream,
        peer,
        mut seat,
        ..
    } = guest;
    let text = |status: &str, body: &str| answer(status, "text/plain; charset=utf-8", body);
    let reply = match head(&mut stream, &mut seat).await {
        Head::Get { path, .. } if path == "/web/" || path == "/web" => {
            if variables.programs.runs() {
                let (ask, told) = oneshot::channel();
                variables.programs.try_send(Command::Web(ask));
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
        Head::Get { path, .. } if path == "/diagram" => {
            let _ = diagram(&variables.clients, &mut stream, peer).await;
            return drop(seat);
        }
        Head::Get { .. } => text("404 Not Found", "there are only /web/ and /diagram\n"),
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
