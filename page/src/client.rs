//! A WebSocket as a client has it, as far as tests of the servers need one.
//!
//! Owns its frames, and that a test does not wait for ever.

use std::io::{self, Read, Write};
use std::net::{SocketAddr, TcpStream};
use std::time::{Duration, Instant};

/// A connection.
pub struct Socket {
    pub stream: TcpStream,
}

impl Socket {
    pub fn head(&mut self) -> String {
        let mut head = Vec::new();
        while !head.ends_with(b"\r\n\r\n") {
            let mut byte = [0];
            self.stream.read_exact(&mut byte).unwrap();
            head.push(byte[0]);
        }
        String::from_utf8(head).unwrap()
    }

    /// A text (1) or bytes (2), masked by zeros.
    pub fn send(&mut self, kind: u8, payload: &[u8]) {
        self.try_send(kind, payload).unwrap();
    }

    /// The same; fails if the server has closed the connection meanwhile.
    pub fn try_send(&mut self, kind: u8, payload: &[u8]) -> io::Result<()> {
        let mut frame = vec![0x80 | kind];
        match payload.len() {
            size @ 0..126 => frame.push(0x80 | size as u8),
            size => {
                frame.push(0x80 | 127);
                frame.extend((size as u64).to_be_bytes());
            }
        }
        frame.extend([0; 4]);
        frame.extend(payload);
        self.stream.write_all(&frame)
    }

    pub fn order(&mut self, text: &str) {
        self.send(1, text.as_bytes());
    }

    /// The next message that is none of the protocol itself; None at the end.
    pub fn next(&mut self) -> Option<(u8, String)> {
        loop {
            let mut head = [0; 2];
            self.stream.read_exact(&mut head).ok()?;
            let size = match head[1] {
                126 => {
                    let mut size = [0; 2];
                    self.stream.read_exact(&mut size).ok()?;
                    usize::from(u16::from_be_bytes(size))
                }
                size => usize::from(size),
            };
            let mut payload = vec![0; size];
            self.stream.read_exact(&mut payload).ok()?;
            match head[0] & 0x0f {
                // A ping has a pong, if there is still somebody to hear it.
                9 => self.try_send(10, &payload).ok()?,
                8 => return None,
                kind => return Some((kind, String::from_utf8_lossy(&payload).into_owned())),
            }
        }
    }

    /// Reads until a message has this in it.
    pub fn until(&mut self, text: &str) -> String {
        self.until_all(&[text]).remove(0)
    }

    /// Reads until each of these was in a message, in any order: what is told of control and of values has none.
    pub fn until_all(&mut self, texts: &[&str]) -> Vec<String> {
        // The server never falls silent: it says every second that it is there.
        let end = Instant::now() + Duration::from_secs(60);
        let mut found = vec![None; texts.len()];
        while found.iter().any(Option::is_none) {
            assert!(Instant::now() < end, "{texts:?}: came {found:?}");
            let (_, message) = self.next().unwrap_or_else(|| panic!("no {texts:?} came"));
            for (text, found) in texts.iter().zip(&mut found) {
                if found.is_none() && message.contains(text) {
                    *found = Some(message.clone());
                }
            }
        }
        found.into_iter().flatten().collect()
    }
}

/// The answer to a request with these headers beside `Host`, until the server closes.
pub fn get(at: SocketAddr, path: &str, headers: &str) -> String {
    let mut stream = TcpStream::connect(at).unwrap();
    stream
        .set_read_timeout(Some(Duration::from_secs(10)))
        .unwrap();
    let request =
        format!("GET {path} HTTP/1.1\r\nHost: {at}\r\nConnection: close\r\n{headers}\r\n");
    stream.write_all(request.as_bytes()).unwrap();
    let mut answer = Vec::new();
    stream.read_to_end(&mut answer).unwrap();
    String::from_utf8_lossy(&answer).into_owned()
}
