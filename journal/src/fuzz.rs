//! Entry points for fuzzing: arbitrary bytes instead of a recording.

use crate::layout::Layout;
use crate::read::Reader;
use crate::{mend, node};
use std::io::Cursor;

/// A recording of arbitrary bytes: read, sought in, and mended; what was mended is whole.
pub fn recording(bytes: &[u8]) {
    if let Ok(mut reader) = Reader::open(Cursor::new(bytes)) {
        let middle = reader.begin_ns() / 2 + reader.end_ns() / 2;
        let _ = reader.newest(middle);
        reader.seek(middle);
        for _ in 0..1000 {
            match reader.next() {
                Ok(Some(_)) => {}
                Ok(None) | Err(_) => break,
            }
        }
        for (name, _) in reader.attachments() {
            let _ = reader.attachment(&name);
        }
        let _ = reader.facts(crate::write::ABOUT);
        reader.seek_raw(middle);
        for _ in 0..1000 {
            match reader.next_raw() {
                Ok(Some(_)) => {}
                Ok(None) | Err(_) => break,
            }
        }
    }
    let _ = mend::check(bytes);
    let _ = mend::mend_file(Cursor::new(bytes), Cursor::new(Vec::new()));
    let mut whole = Vec::new();
    if mend::mend(bytes, Cursor::new(&mut whole)).is_ok() {
        let opened = Reader::open(Cursor::new(whole));
        assert!(
            !matches!(
                opened.err(),
                Some(crate::error::Error::Cut | crate::error::Error::NotARecording)
            ),
            "a mended recording has an end"
        );
    }
}

/// A message and a format, divided by a line end.
pub fn message(bytes: &[u8]) {
    let (format, message) = match bytes.iter().position(|byte| *byte == b'\n') {
        Some(at) => (&bytes[..at], &bytes[at + 1..]),
        None => (bytes, &[][..]),
    };
    let Ok(format) = std::str::from_utf8(format) else {
        return;
    };
    if let Ok(layout) = Layout::parse(format)
        && let Some(tuple) = node::decode(&layout, message)
    {
        assert_eq!(tuple.len(), layout.size());
        let _ = layout.show(&tuple);
    }
    let _ = crate::standard::Log::decode(message);
}
