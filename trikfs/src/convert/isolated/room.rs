//! How many processes of isolated converters one configuration may have.
//!
//! Owns the number that follows from the memory of the machine. That a node's process ends with the node is known to
//! `isolated`.

use crate::limits::{ISOLATED_DATA_MIB, ISOLATED_NODES_LEAST, ISOLATED_NODES_MOST};
use crate::memory;
use config::description::NodeDescription;
use config::problem::Problem;

/// Checks that there are no more nodes with a process than there is room for.
///
/// # Errors
/// The first one for which there is none, with how many there are and may be.
pub fn admit<'a>(nodes: impl Iterator<Item = &'a NodeDescription>) -> Result<(), Problem> {
    let isolated: Vec<_> = nodes.filter(|node| node.isolate).collect();
    // Nobody else asks the system for its memory.
    if isolated.is_empty() {
        return Ok(());
    }
    let machine_bytes = memory::bytes();
    let most = most(machine_bytes);
    let Some(node) = isolated.get(most) else {
        return Ok(());
    };
    Err(Problem::new(
        node.place.file.clone(),
        node.place.line,
        format!(
            "node {}: isolate: the configuration has {} isolated nodes, each with a process that may take {ISOLATED_DATA_MIB} MiB, and {} MiB of memory have room for {most} of them; leave isolate away where you trust the code, or convert several values in one node",
            node.path,
            isolated.len(),
            machine_bytes >> 20,
        ),
    ))
}

fn most(machine_bytes: u64) -> usize {
    let fitting = (machine_bytes >> 20) / u64::from(ISOLATED_DATA_MIB);
    let fitting = usize::try_from(fitting).unwrap_or(usize::MAX);
    fitting.clamp(ISOLATED_NODES_LEAST, ISOLATED_NODES_MOST)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_machine_has_room_for_as_many_as_can_take_their_memory_within_bounds() {
        assert_eq!(most(0), 8);
        assert_eq!(most(192 << 20), 8, "a small board");
        assert_eq!(most(1 << 30), 16);
        assert_eq!(most((1 << 30) + (63 << 20)), 16);
        assert_eq!(most(8 << 30), 128);
        assert_eq!(most(64 << 30), 256);
        assert_eq!(most(u64::MAX), 256);
    }
}
