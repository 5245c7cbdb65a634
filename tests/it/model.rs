//! Streams against a naive model: random tuple sizes, random pieces in, random pieces out, through a real mount.
//!
//! The model knows nothing of buffers: everything that was ever written, cut into tuples, each turned around by the
//! obvious loop. What was read so far must be a beginning of that, and nothing of it may be missing when it is quiet.

use crate::mount_on;
use harness::{Board, Mount, eventually};
use proptest::prelude::*;
use proptest::test_runner::{Config, TestRunner};
use std::fs::File;
use std::io::{ErrorKind, Read, Write};
use std::os::fd::AsFd;

/// Input and output sizes of the nodes: equal, growing, shrinking, large.
const SIZES: [(usize, usize); 8] = [
    (1, 1),
    (3, 3),
    (4, 2),
    (2, 5),
    (7, 1),
    (1, 9),
    (64, 64),
    (600, 601),
];
/// The third of every three tuples is consumed.
const KEPT: usize = 3;

fn config() -> String {
    let mut text = "local function converter()
      local count = 0
      return function(a_s, a, b_s, b)
        count = count + 1
        if count % 3 == 0 then return false end
        for i = 0, b_s - 1 do ba.set(b, i, ba.get(a, i % a_s) + i + count) end
      end
    end
    trikfs = {}\n"
        .to_owned();
    for (number, (input, output)) in SIZES.iter().enumerate() {
        text.push_str(&format!(
            "trikfs.n{number} = {{ src = '$DIR/in{number}', input_tuple_size = {input}, output_tuple_size = {output}, converter = converter() }}\n"
        ));
    }
    text
}

/// What a reader gets of these bytes.
fn model(written: &[u8], input: usize, output: usize) -> Vec<u8> {
    let mut expected = Vec::new();
    for (index, tuple) in written.chunks_exact(input).enumerate() {
        let count = index + 1;
        if count % KEPT != 0 {
            expected.extend((0..output).map(|i| {
                let sum = usize::from(tuple[i % input]) + i + count;
                u8::try_from(sum % 256).unwrap_or(0)
            }));
        }
    }
    expected
}

#[derive(Clone, Debug)]
enum Step {
    /// The device delivers so many bytes.
    Deliver(usize),
    /// The program asks for at most so many bytes.
    Ask(usize),
    /// The program reads until there is no more, in pieces of this size.
    Drain(usize),
}

fn steps() -> impl Strategy<Value = (usize, Vec<Step>)> {
    let step = prop_oneof![
        (1usize..1500).prop_map(Step::Deliver),
        (1usize..6).prop_map(Step::Deliver),
        (1usize..1500).prop_map(Step::Ask),
        (1usize..6).prop_map(Step::Ask),
        (1usize..2000).prop_map(Step::Drain),
    ];
    (0..SIZES.len(), prop::collection::vec(step, 1..30))
}

struct Stream<'a> {
    m: &'a Mount,
    node: usize,
    file: File,
    pipe: File,
    written: Vec<u8>,
    read: Vec<u8>,
}

impl Stream<'_> {
    fn expected(&self) -> Vec<u8> {
        model(&self.written, SIZES[self.node].0, SIZES[self.node].1)
    }

    fn is_readable(&self) -> bool {
        let mut fds = [nix::poll::PollFd::new(
            self.file.as_fd(),
            nix::poll::PollFlags::POLLIN,
        )];
        nix::poll::poll(&mut fds, nix::poll::PollTimeout::ZERO).expect("poll works") > 0
    }

    /// Reads once; what comes must continue what came before. False: nothing there.
    fn ask(&mut self, size: usize) -> bool {
        let promised = self.is_readable();
        let mut buffer = vec![0; size];
        match self.file.read(&mut buffer) {
            Ok(n) => {
                assert!((1..=size).contains(&n), "{n} of {size} bytes");
                self.read.extend_from_slice(&buffer[..n]);
                let expected = self.expected();
                assert!(
                    expected.starts_with(&self.read),
                    "after {} bytes",
                    self.read.len()
                );
                true
            }
            Err(error) => {
                assert_eq!(
                    error.kind(),
                    ErrorKind::WouldBlock,
                    "{error}: {}",
                    self.m.complaints()
                );
                assert!(!promised, "poll promised what read does not give");
                false
            }
        }
    }

    /// Reads until everything that the model has was given, and not a byte more.
    fn drain(&mut self, size: usize) {
        let wanted = self.expected().len();
        eventually("all that was delivered", || {
            while self.ask(size) {}
            self.read.len() >= wanted
        });
        assert_eq!(self.read.len(), wanted);
        assert!(!self.is_readable());
    }

    /// Delivers as much as the queue of a slow reader certainly keeps.
    fn deliver(&mut self, size: usize) {
        let room = 200 * SIZES[self.node].0;
        for start in (0..size).step_by(room) {
            self.drain(4096);
            let piece: Vec<u8> = (start..size.min(start + room))
                .map(|i| u8::try_from((i * 31 + self.written.len()) % 256).unwrap_or(0))
                .collect();
            self.pipe.write_all(&piece).expect("the pipe takes bytes");
            self.written.extend_from_slice(&piece);
        }
    }
}

fn open(m: &Mount, node: usize) -> Stream<'_> {
    let mut options = File::options();
    std::os::unix::fs::OpenOptionsExt::custom_flags(&mut options, libc::O_NONBLOCK);
    let file = options
        .read(true)
        .open(m.path(&format!("n{node}/device")))
        .expect("the stream opens");
    let pipe = m.board().feed(&format!("in{node}"));
    Stream {
        m,
        node,
        file,
        pipe,
        written: Vec::new(),
        read: Vec::new(),
    }
}

#[test]
fn any_pieces_in_and_any_pieces_out_give_the_bytes_of_the_model() {
    let board = Board::new();
    for number in 0..SIZES.len() {
        board.fifo(&format!("in{number}"));
    }
    let Some(m) = mount_on(board, &config()) else {
        return;
    };
    let cases = Config {
        cases: 60,
        failure_persistence: None,
        ..Config::default()
    };
    let outcome = TestRunner::new(cases).run(&steps(), |(node, steps)| {
        let mut stream = open(&m, node);
        for step in steps {
            match step {
                Step::Deliver(size) => stream.deliver(size),
                Step::Ask(size) => drop(stream.ask(size)),
                Step::Drain(size) => stream.drain(size),
            }
        }
        stream.drain(100);
        Ok(())
    });
    outcome.unwrap_or_else(|failure| panic!("{failure}"));
}
