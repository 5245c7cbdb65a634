//! Tests of lines: bytes cut at every place, and pipes that come, go and stay away.

use super::super::cutter::Pieces;
use super::*;
use crate::log::Log;
use crate::scratch::Scratch;
use nix::sys::stat::Mode;
use proptest::prelude::*;
use std::fs::OpenOptions;
use std::io::{Read, Write};
use std::os::unix::fs::OpenOptionsExt;

/// The lines of these bytes, without what fills them up, and how many were damaged.
fn all(bytes: &[u8], size: usize, piece: usize) -> (Vec<String>, u64) {
    let damaged = Arc::<Counter>::default();
    let mut cutter = Cutter::new(Splitter::default(), size, 16, damaged.clone());
    let tuples = Pieces::of(bytes, piece).drain(&mut cutter, size);
    let line = |tuple: &[u8]| {
        let end = tuple.iter().position(|byte| *byte == 0).unwrap_or(size);
        assert!(tuple[end..].iter().all(|byte| *byte == 0));
        String::from_utf8(tuple[..end].to_vec()).unwrap()
    };
    (tuples.chunks(size).map(line).collect(), damaged.get())
}

#[test]
fn lines_are_the_same_wherever_the_bytes_are_cut() {
    let bytes =
        b"loc: -5 0 42\r\n\nloc: 100 0 1\nloc: 100 100 10\nlo\x00c\n\xff\n12345678901234\nend";
    for piece in 1..=bytes.len() {
        let (lines, damaged) = all(bytes, 14, piece);
        let wanted = ["loc: -5 0 42", "", "loc: 100 0 1", "12345678901234"];
        assert_eq!((lines, damaged), (wanted.map(str::to_owned).to_vec(), 4));
    }
}

proptest! {
    #[test]
    fn any_bytes_give_the_good_lines_and_count_the_others(
        bytes in prop::collection::vec(prop_oneof![any::<u8>(), Just(b'\n'), Just(b'a')], 0..300),
        piece in 1usize..50,
    ) {
        let mut wanted = Vec::new();
        let mut damaged = 0;
        let parts: Vec<_> = bytes.split(|byte| *byte == b'\n').collect();
        for (index, part) in parts.iter().enumerate() {
            let line: Vec<u8> = part.iter().copied().filter(|byte| *byte != b'\r').collect();
            let good = line.len() <= 8 && line.iter().all(|b| matches!(b, b'\t' | b' '..=b'~'));
            if index + 1 == parts.len() {
                damaged += u64::from(!line.is_empty());
            } else if good {
                wanted.push(String::from_utf8(line).unwrap());
            } else {
                damaged += 1;
            }
        }
        prop_assert_eq!(all(&bytes, 8, piece), (wanted, damaged));
    }
}

fn plain(scratch: &Scratch) -> LinesDescription {
    LinesDescription {
        path: scratch.path("out"),
        input: Some(scratch.path("in")),
        start: None,
        stop: None,
        answer: None,
        are_pictures: false,
    }
}

fn pipe(path: &Path) {
    nix::unistd::mkfifo(path, Mode::S_IRWXU).unwrap();
}

#[test]
fn without_a_program_the_pipe_has_to_be_there() {
    let scratch = Scratch::new();
    let programs = Programs::new(Arc::new(Log::new()));
    let description = plain(&scratch);
    let open = || Lines::open(&description, 8, &programs, Arc::default());
    assert!(matches!(open(), Err(Error::NoDevice(_))));
    pipe(&description.path);
    let mut lines = open().unwrap();
    let mut buf = [0; 16];
    assert_eq!(lines.read(&mut buf), Ok(Got::Nothing));
    let mut writer = OpenOptions::new()
        .write(true)
        .open(&description.path)
        .unwrap();
    writer.write_all(b"one\ntwo\nthr").unwrap();
    assert_eq!(lines.read(&mut buf), Ok(Got::Bytes(16)));
    assert_eq!(&buf, b"one\0\0\0\0\0two\0\0\0\0\0");
    writer.write_all(b"ee\n").unwrap();
    assert_eq!(lines.read(&mut buf), Ok(Got::Bytes(8)));
    assert_eq!(&buf[..8], b"three\0\0\0");
    drop(writer);
    assert_eq!(lines.read(&mut buf), Ok(Got::End));
}

#[test]
fn what_is_written_becomes_a_line_for_the_reader_of_the_pipe() {
    let scratch = Scratch::new();
    let description = plain(&scratch);
    let mut sink = LinesSink::open(&description, 100, Arc::default()).unwrap();
    let refused = |sink: &mut LinesSink| sink.write(b"detect\0\0", true).unwrap_err().to_string();
    let path = scratch.path("in");
    let reason = |what: &str| format!("{}: the sensor is not running ({what})", path.display());
    assert_eq!(refused(&mut sink), reason("its pipe is missing"));
    std::fs::write(&path, "").unwrap();
    assert_eq!(refused(&mut sink), reason("what is there is no named pipe"));
    std::fs::remove_file(&path).unwrap();
    pipe(&path);
    assert_eq!(refused(&mut sink), reason("nobody reads its pipe"));
    let flags = nix::libc::O_NONBLOCK;
    let mut reader = OpenOptions::new()
        .read(true)
        .custom_flags(flags)
        .open(&path)
        .unwrap();
    sink.write(b"detect\0\0", true).unwrap();
    sink.write(b"mxn 3 3\n", true).unwrap();
    for wrong in [&b"a\nb"[..], b"a\0b", b"\xff"] {
        let error = sink.write(wrong, true).unwrap_err();
        assert_eq!(error.errno(), libc::EINVAL, "{wrong:?}");
    }
    let mut got = [0; 64];
    let n = reader.read(&mut got).unwrap();
    assert_eq!(&got[..n], b"detect\nmxn 3 3\n");
}
