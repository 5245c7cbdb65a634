//! A server of HTTP/1.1 that gives one text, at one path.
//!
//! Owns the bounds of a request: bytes of its head, time, and how many there are at once. Each is served on a thread of its own
//! and its connection closed. Knows nothing of what the text says.

use crate::error::Error;
use crate::limits::{CONNECTIONS_MAX, HEAD_BYTES_MAX, REQUEST_TIME};
use std::io::{self, Read, Write};
use std::net::{SocketAddr, TcpListener, TcpStream};
use std::sync::Arc;
use std::sync::atomic::{AtomicUsize, Ordering};
use std::thread;
use std::time::{Duration, Instant};

/// What makes the text.
pub type Text = Arc<dyn Fn() -> String + Send + Sync>;

/// What is served.
#[derive(Clone)]
pub struct Served {
    /// At this path, and nowhere else.
    pub path: &'static str,
    /// Its type.
    pub media_type: &'static str,
    /// The text.
    pub text: Text,
}

/// Serves until the process ends; gives the address that it has.
///
/// # Errors
/// Nobody can listen there.
pub fn serve(address: SocketAddr, served: Served) -> Result<SocketAddr, Error> {
    let refused = |why: io::Error| Error::Address(address, why.to_string());
    let listener = TcpListener::bind(address).map_err(refused)?;
    let bound = listener.local_addr().map_err(refused)?;
    let work = move || accept(&listener, &served);
    let server = thread::Builder::new().name("http".to_owned()).spawn(work);
    server.map_err(|why| Error::Thread(why.to_string()))?;
    Ok(bound)
}

fn accept(listener: &TcpListener, served: &Served) {
    let count = Arc::new(AtomicUsize::new(0));
    loop {
        let Ok((mut client, _)) = listener.accept() else {
            // No more descriptors: others must end first.
            thread::sleep(Duration::from_millis(50));
            continue;
        };
        if count.fetch_add(1, Ordering::AcqRel) >= CONNECTIONS_MAX {
            count.fetch_sub(1, Ordering::AcqRel);
            // It fits into an empty buffer; one who does not take it has lost nothing.
            let _ = client.set_nonblocking(true);
            let _ =
                client.write(answer("503 Service Unavailable", "text/plain", "busy\n").as_bytes());
            continue;
        }
        let place = Place(count.clone());
        let served = served.clone();
        let work = move || {
            let _place = place;
            // A client that has gone needs no answer.
            let _ = one(&mut client, &served);
        };
        // Without a thread the connection is closed.
        let _ = thread::Builder::new()
            .name("http client".to_owned())
            .spawn(work);
    }
}

/// One of the places for requests, free again when it is dropped.
struct Place(Arc<AtomicUsize>);

impl Drop for Place {
    fn drop(&mut self) {
        self.0.fetch_sub(1, Ordering::AcqRel);
    }
}

/// Serves one request.
fn one(client: &mut TcpStream, served: &Served) -> io::Result<()> {
    let end = Instant::now() + REQUEST_TIME;
    let answer = match head(client, end)? {
        None => answer(
            "431 Request Header Fields Too Large",
            "text/plain",
            "too long\n",
        ),
        Some(head) => respond(&head, served),
    };
    let mut rest = answer.as_bytes();
    while !rest.is_empty() {
        client.set_write_timeout(Some(left(end)?))?;
        match client.write(rest)? {
            0 => return Ok(()),
            count => rest = &rest[count..],
        }
    }
    client.shutdown(std::net::Shutdown::Write)
}

/// Time until the end of a request; never zero.
fn left(end: Instant) -> io::Result<Duration> {
    let left = end.saturating_duration_since(Instant::now());
    (!left.is_zero())
        .then_some(left)
        .ok_or_else(|| io::ErrorKind::TimedOut.into())
}

/// The head of a request; None if it is too long.
fn head(client: &mut TcpStream, end: Instant) -> io::Result<Option<Vec<u8>>> {
    let mut head = vec![0; HEAD_BYTES_MAX];
    let mut length = 0;
    while length < head.len() {
        client.set_read_timeout(Some(left(end)?))?;
        let count = client.read(&mut head[length..])?;
        if count == 0 {
            return Err(io::ErrorKind::UnexpectedEof.into());
        }
        length += count;
        if head[..length].windows(4).any(|four| four == b"\r\n\r\n") {
            head.truncate(length);
            return Ok(Some(head));
        }
    }
    Ok(None)
}

fn respond(head: &[u8], served: &Served) -> String {
    let line = head.split(|&byte| byte == b'\r').next().unwrap_or_default();
    let line = String::from_utf8_lossy(line);
    let mut words = line.split(' ');
    let (method, target) = (words.next(), words.next().unwrap_or_default());
    let path = target.split('?').next();
    match (method, path) {
        (Some("GET"), Some(path)) if path == served.path => {
            answer("200 OK", served.media_type, &(served.text)())
        }
        (Some("GET"), _) => {
            let see = format!("see {}\n", served.path);
            answer("404 Not Found", "text/plain", &see)
        }
        _ => answer("405 Method Not Allowed", "text/plain", "only GET\n"),
    }
}

fn answer(status: &str, media_type: &str, body: &str) -> String {
    let length = body.len();
    format!(
        "HTTP/1.1 {status}\r\nContent-Type: {media_type}\r\nContent-Length: {length}\r\nConnection: close\r\n\r\n{body}"
    )
}

#[cfg(test)]
mod tests {
    use super::*;

    fn server() -> SocketAddr {
        let text: Text = Arc::new(|| "a 1\n# EOF\n".to_owned());
        let served = Served {
            path: "/metrics",
            media_type: "text/x",
            text,
        };
        serve(SocketAddr::from(([127, 0, 0, 1], 0)), served).unwrap()
    }

    fn ask(address: SocketAddr, request: &[u8]) -> String {
        let mut client = TcpStream::connect(address).unwrap();
        client.set_read_timeout(Some(4 * REQUEST_TIME)).unwrap();
        // The server may close before it has all of a request that it refuses.
        let _ = client.write_all(request);
        let mut bytes = Vec::new();
        let _ = client.read_to_end(&mut bytes);
        String::from_utf8_lossy(&bytes).into_owned()
    }

    #[test]
    fn one_text_is_served_and_nothing_else() {
        let address = server();
        let text = ask(address, b"GET /metrics HTTP/1.1\r\nHost: a\r\n\r\n");
        assert!(text.starts_with("HTTP/1.1 200 OK\r\n"), "{text}");
        assert!(text.ends_with("\r\n\r\na 1\n# EOF\n"), "{text}");
        for (request, status) in [
            ("GET / HTTP/1.1\r\n\r\n", "404"),
            ("GET /metrics/../x HTTP/1.1\r\n\r\n", "404"),
            ("POST /metrics HTTP/1.1\r\n\r\n", "405"),
            ("\0\0\r\n\r\n", "405"),
        ] {
            let text = ask(address, request.as_bytes());
            assert!(text.starts_with(&format!("HTTP/1.1 {status} ")), "{text}");
        }
    }

    #[test]
    fn a_huge_head_is_refused() {
        // Exactly as much as is read: more would be answered by a reset.
        let text = ask(server(), &vec![b'a'; HEAD_BYTES_MAX]);
        assert!(text.starts_with("HTTP/1.1 431 "), "{text}");
    }

    #[test]
    fn slow_clients_keep_others_out_for_a_bounded_time() {
        let address = server();
        let begin = Instant::now();
        let mut slow: Vec<TcpStream> = (0..100)
            .map(|_| TcpStream::connect(address).unwrap())
            .collect();
        for client in &mut slow {
            let _ = client.write(b"GET /met");
        }
        // All places are taken: it is told so at once, until the time of the slow ones is over.
        let busy = ask(address, b"GET /metrics HTTP/1.1\r\n\r\n");
        assert!(!busy.starts_with("HTTP/1.1 200"), "{busy}");
        while !ask(address, b"GET /metrics HTTP/1.1\r\n\r\n").starts_with("HTTP/1.1 200") {
            assert!(begin.elapsed() < 4 * REQUEST_TIME, "still busy");
            thread::sleep(Duration::from_millis(50));
        }
    }
}
