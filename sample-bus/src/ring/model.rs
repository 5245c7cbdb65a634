//! All orders in which a reader on another processor can see what the publisher of a ring stores.
//!
//! Compiled with `--cfg loom` only; `tests/sanitize.sh loom` runs it.

use super::{Memory, newest, read, write};
use crate::layout::{HEADER_BYTES, Layout, SLOT_HEADER_BYTES};
use crate::reader::Event;
use loom::sync::Arc;
use loom::sync::atomic::{AtomicU32, AtomicUsize, Ordering, fence};
use loom::thread;

const WORD_BYTES: usize = size_of::<usize>();

/// A ring of one slot: each event overwrites the one before, which is the hardest for a reader.
const LAYOUT: Layout = Layout {
    tuple_bytes: WORD_BYTES,
    slots: 1,
    slot_bytes: SLOT_HEADER_BYTES + WORD_BYTES,
};

/// Memory whose every access is a choice of the model. Numbers and words never share a place.
struct Chosen {
    numbers: Vec<AtomicU32>,
    words: Vec<AtomicUsize>,
}

impl Chosen {
    fn new() -> Self {
        let bytes = HEADER_BYTES + LAYOUT.slot_bytes;
        Self {
            numbers: (0..bytes / 4).map(|_| AtomicU32::new(0)).collect(),
            words: (0..bytes / WORD_BYTES)
                .map(|_| AtomicUsize::new(0))
                .collect(),
        }
    }
}

impl Memory for Chosen {
    fn get(&self, at: usize) -> u32 {
        self.numbers[at / 4].load(Ordering::Relaxed)
    }

    fn set(&self, at: usize, number: u32) {
        self.numbers[at / 4].store(number, Ordering::Relaxed);
    }

    fn copy_in(&self, at: usize, bytes: &[u8]) {
        let (words, _) = bytes.as_chunks::<WORD_BYTES>();
        for (index, word) in words.iter().enumerate() {
            self.words[at / WORD_BYTES + index]
                .store(usize::from_ne_bytes(*word), Ordering::Relaxed);
        }
    }

    fn copy_out(&self, at: usize, bytes: &mut [u8]) {
        let (words, _) = bytes.as_chunks_mut::<WORD_BYTES>();
        for (index, word) in words.iter_mut().enumerate() {
            *word = self.words[at / WORD_BYTES + index]
                .load(Ordering::Relaxed)
                .to_ne_bytes();
        }
    }

    fn fence(&self, order: Ordering) {
        fence(order);
    }
}

/// An event that says its number in its time and in each byte of its tuple.
fn publish(memory: &Chosen, sequence: u32) {
    let event = Event {
        sequence,
        time_ns: u64::from(sequence),
        errno: 0,
    };
    write(memory, &LAYOUT, event, &[sequence as u8; WORD_BYTES]);
}

/// Whatever event was read, it is whole.
fn is_whole(event: Event, tuple: &[u8]) {
    assert_eq!(event.time_ns, u64::from(event.sequence));
    assert_eq!(event.errno, 0);
    assert_eq!(tuple, [event.sequence as u8; WORD_BYTES]);
}

/// A publisher of two more events beside a reader.
fn beside(reader: fn(&Chosen)) {
    loom::model(move || {
        let memory = Arc::new(Chosen::new());
        publish(&memory, 1);
        let publisher = {
            let memory = Arc::clone(&memory);
            thread::spawn(move || (2..=3).for_each(|sequence| publish(&memory, sequence)))
        };
        reader(&memory);
        publisher.join().unwrap();
        let mut tuple = Vec::new();
        let last = read(&*memory, &LAYOUT, newest(&*memory), &mut tuple).unwrap();
        assert_eq!(last.sequence, 3);
        is_whole(last, &tuple);
    });
}

#[test]
fn the_newest_event_is_never_torn() {
    beside(|memory| {
        let mut tuple = Vec::new();
        if let Some(event) = read(memory, &LAYOUT, newest(memory), &mut tuple) {
            is_whole(event, &tuple);
        }
    });
}

#[test]
fn an_event_asked_for_by_its_number_is_never_torn() {
    beside(|memory| {
        let mut tuple = Vec::new();
        if let Some(event) = read(memory, &LAYOUT, 2, &mut tuple) {
            is_whole(event, &tuple);
        }
    });
}
