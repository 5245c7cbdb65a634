//! What a stream keeps, read as JSON: there no subject and no header does harm.
//!
//! A client that is given a message whose header it cannot read drops the connection, and one that is given the status of a server
//! takes it for the server's own. The server checks neither when somebody publishes. Owns what a header has to be so that nothing of
//! that happens. Knows no submissions.

use crate::error::Error;
use async_nats::jetstream::{Context, ErrorCode};
use base64::Engine;
use base64::engine::general_purpose::STANDARD;
use serde_json::{Value, json};

/// A message as the server keeps it.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Kept {
    /// Its place in the stream.
    pub sequence: u64,
    /// Where it was published; bytes that are no text are U+FFFD.
    pub subject: String,
    /// Whatever stands for a header.
    pub header: Vec<u8>,
    /// Its payload.
    pub bytes: Vec<u8>,
}

/// Which message is asked for.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Which<'a> {
    /// The first one from this place on; the stream has these subjects.
    From(u64, &'a str),
    /// The newest one of a subject.
    Newest(&'a str),
}

/// A message of a stream, if there is such a one.
///
/// # Errors
/// The server does not answer, or not as servers do.
pub async fn kept(
    context: &Context,
    stream: &str,
    which: Which<'_>,
) -> Result<Option<Kept>, Error> {
    let what = "a message of the queue";
    let wanted = match which {
        Which::From(sequence, subjects) => {
            json!({"seq": sequence, "next_by_subj": format!("{subjects}*")})
        }
        Which::Newest(subject) => json!({"last_by_subj": subject}),
    };
    let answer = context.request(format!("STREAM.MSG.GET.{stream}"), &wanted);
    let answer: Value = answer.await.map_err(|why| Error::asked(what, why))?;
    if let Some(error) = answer.get("error") {
        return match error["err_code"].as_u64() {
            Some(code) if code == ErrorCode::NO_MESSAGE_FOUND.0 => Ok(None),
            Some(_) | None => Err(Error::asked(what, &error["description"])),
        };
    }
    let message = &answer["message"];
    let bytes = |name: &str| {
        let text = message[name].as_str().unwrap_or_default();
        STANDARD.decode(text).map_err(|why| Error::asked(what, why))
    };
    Ok(Some(Kept {
        sequence: (message["seq"].as_u64())
            .ok_or_else(|| Error::asked(what, "it has no number"))?,
        subject: message["subject"].as_str().unwrap_or_default().to_owned(),
        header: bytes("hdrs")?,
        bytes: bytes("data")?,
    }))
}

/// The fields of a header, all as they stand; None: clients must not be given it.
pub fn fields(header: &[u8]) -> Option<Vec<(&str, &str)>> {
    if header.is_empty() {
        return Some(Vec::new());
    }
    let text = str::from_utf8(header).ok()?;
    let lines = text.strip_prefix("NATS/1.0\r\n")?.strip_suffix("\r\n")?;
    let field = |line| {
        let (name, value): (&str, &str) = str::split_once(line, ':')?;
        let is_name = !name.is_empty() && name.bytes().all(|byte| byte.is_ascii_graphic());
        // Clients take it for the end of a line.
        let is_value = !value.contains('\n');
        (is_name && is_value).then(|| (name, value.trim()))
    };
    lines.split_terminator("\r\n").map(field).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_header_is_lines_with_names_and_anything_else_is_none() {
        let good = "NATS/1.0\r\nTrik-Task: l\u{ed}nea\r\nA:b:c\r\nEmpty:\r\n\r\n";
        let expected = [("Trik-Task", "l\u{ed}nea"), ("A", "b:c"), ("Empty", "")];
        assert_eq!(fields(good.as_bytes()), Some(expected.to_vec()));
        assert_eq!(fields(b""), Some(Vec::new()));
        assert_eq!(fields(b"NATS/1.0\r\n\r\n"), Some(Vec::new()));
        for bad in [
            &b"NATS/1.0"[..],
            b"NATS/1.0\r\n",
            b"NATS/1.0\r\nA: b",
            b"NATS/1.0\nA: b\n\n",
            b"NATS/1.0\r\nA: b\nC: d\r\n\r\n",
            b"NATS/1.0\r\nA b\r\n\r\n",
            b"NATS/1.0\r\n: b\r\n\r\n",
            b"NATS/1.0\r\nA: \xff\r\n\r\n",
            b"NATS/1.0\r\nA: b\r\n c\r\n\r\n",
            b"NATS/1.0\r\n\r\nA: b\r\n\r\n",
            b"NATS/1.0 404\r\nA: b\r\n\r\n",
            b"NATS/1.0 100 Idle Heartbeat\r\n\r\n",
            b"HTTP/1.0\r\nA: b\r\n\r\n",
            b"\r\n\r\n",
        ] {
            assert_eq!(fields(bad), None, "{}", bad.escape_ascii());
        }
    }
}
