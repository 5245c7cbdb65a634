//! What the sources of nodes give, before it is converted.
//!
//! Owns of which nodes it is looked at: those whose trees publish it, that are no actuators, of which a recording has what is
//! written, and whose tuples are small. It is looked at as samples are, by `watch`.

use crate::entry::Entry;
use crate::limits;
use crate::watched::{From, Watched, Wish};
use journal::node::Node;
use sample_bus::Reader;
use std::path::Path;

/// Of some nodes.
#[derive(Default)]
pub(crate) struct Raws(Vec<Watched>);

impl Raws {
    /// How many they are.
    pub(crate) fn count(&self) -> usize {
        self.0.len()
    }

    /// All of them.
    pub(crate) fn all(&self) -> impl Iterator<Item = &Watched> {
        self.0.iter()
    }

    /// Those of these nodes; rings that have ended are left.
    pub(crate) fn find<'a>(
        &mut self,
        root: &Path,
        nodes: impl Iterator<Item = &'a Node>,
        numbers: &mut u32,
        out: &mut Vec<Entry>,
    ) {
        let before = std::mem::take(&mut self.0);
        let mut before: Vec<Watched> = (before.into_iter())
            .filter(|one| one.ring.is_current())
            .collect();
        for node in nodes.filter(|node| node.rest.is_empty()) {
            let same = before
                .iter()
                .position(|one| one.known.node.path == node.path);
            if let Some(same) = same {
                self.0.push(before.swap_remove(same));
                continue;
            }
            let Ok(ring) = Reader::open_raw(root, &node.path) else {
                continue;
            };
            let bytes = ring.tuple_bytes();
            if bytes > limits::RAW_BYTES_MAX {
                continue;
            }
            *numbers += 1;
            let raw = Watched::new(
                *numbers,
                Node::raw(&node.path, bytes),
                ring,
                Wish::ByTheClock,
            );
            out.push(Entry::Node(raw.known.clone()));
            self.0.push(raw);
        }
    }

    /// Takes what has come; gives how much was overwritten before.
    pub(crate) fn look(
        &mut self,
        from: &From<'_>,
        tuple: &mut Vec<u8>,
        out: &mut Vec<Entry>,
    ) -> u64 {
        let looked = self.0.iter_mut().map(|one| one.look(from, tuple, out));
        looked.sum()
    }
}
