//! The heads of HTTP requests, as far as two small servers need them.

/// What a client asks for.
#[derive(Clone, Debug, Eq, PartialEq)]
pub enum Head {
    /// GET of a path, without what follows a question mark, and with it.
    Get {
        /// The path.
        path: String,
        /// What follows the question mark.
        query: String,
    },
    /// Another method.
    OtherMethod,
    /// No request.
    Nonsense,
    /// Not whole yet.
    Partial,
}

/// Reads the head of a request out of the first bytes of a connection.
pub fn parse(bytes: &[u8]) -> Head {
    let ends = bytes.windows(4).any(|four| four == b"\r\n\r\n")
        || bytes.windows(2).any(|two| two == b"\n\n");
    if !ends {
        return Head::Partial;
    }
    let line = bytes
        .split(|byte| *byte == b'\n')
        .next()
        .unwrap_or_default();
    let Ok(line) = std::str::from_utf8(line) else {
        return Head::Nonsense;
    };
    let words: Vec<&str> = line.split_ascii_whitespace().collect();
    match words[..] {
        ["GET", target, version] if version.starts_with("HTTP/1.") && target.starts_with('/') => {
            let (path, query) = target.split_once('?').unwrap_or((target, ""));
            Head::Get {
                path: path.to_owned(),
                query: query.to_owned(),
            }
        }
        [method, _, version] if method != "GET" && version.starts_with("HTTP/") => {
            Head::OtherMethod
        }
        _ => Head::Nonsense,
    }
}

/// An answer that ends with its connection.
pub fn answer(status: &str, kind: &str, body: &str) -> Vec<u8> {
    let length = body.len();
    format!("HTTP/1.0 {status}\r\nContent-Type: {kind}\r\nContent-Length: {length}\r\nConnection: close\r\n\r\n{body}")
        .into_bytes()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_head_is_whole_or_not_and_asks_for_a_path() {
        let get = |path: &str, query: &str| Head::Get {
            path: path.to_owned(),
            query: query.to_owned(),
        };
        assert_eq!(parse(b"GET /web/ HTTP/1.0\r\n\r\n"), get("/web/", ""));
        let desktop = b"GET /?action=stream&filename=noname.jpg HTTP/1.1\r\nHost: x\r\n\r\n";
        assert_eq!(
            parse(desktop),
            get("/", "action=stream&filename=noname.jpg")
        );
        assert_eq!(parse(b"GET / HTTP/1.1\r\nHost: x\r\n"), Head::Partial);
        assert_eq!(parse(b"POST / HTTP/1.1\r\n\r\n"), Head::OtherMethod);
        for bad in [
            &b"\n\n"[..],
            b"GET\n\n",
            b"GET x HTTP/1.1\n\n",
            b"\xff\xff \n\n",
            b"GET / FTP\n\n",
        ] {
            assert_eq!(parse(bad), Head::Nonsense);
        }
    }
}
