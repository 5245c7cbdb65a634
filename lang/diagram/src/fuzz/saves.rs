//! Arbitrary bytes as a save that is read, written, changed and read again: [`reader`].

use crate::archive::{self, Entry};
use crate::read::read;

/// Bytes as a save, and as the files of one: texts between zero bytes, of which every other one is a name. What is read
/// must survive being written, changed and read again.
pub fn reader(bytes: &[u8]) {
    save(bytes);
    let mut parts = bytes.split(|&byte| byte == 0);
    let mut entries = Vec::new();
    while let Some(name) = parts.next() {
        let name = String::from_utf8_lossy(name).into_owned();
        let bytes = parts.next().unwrap_or_default().to_vec();
        entries.push(Entry { name, bytes });
    }
    if let Ok(packed) = archive::pack(&entries) {
        save(&packed);
    }
}

fn save(bytes: &[u8]) {
    let Ok(mut opened) = read(bytes) else {
        return;
    };
    for diagram in &opened.project.diagrams {
        for link in &diagram.links {
            assert!(link.from.is_none_or(|end| end < diagram.blocks.len()));
            assert!(link.to.is_none_or(|end| end < diagram.blocks.len()));
        }
        for block in &diagram.blocks {
            let mut links = block.outgoing.iter().chain(&block.incoming);
            assert!(links.all(|&link| link < diagram.links.len()));
        }
    }
    // What was read has fewer bytes and files than a save may have, but folders and packing may add some.
    let Ok(written) = opened.save.write() else {
        return;
    };
    let again = read(&written).expect("what was written is read");
    assert_eq!(again.project, opened.project);
    opened.save.recover_orphans();
    let recovered = opened.save.project().0;
    let written = opened.save.write().expect("what was recovered is written");
    let again = read(&written).expect("what was changed is read");
    assert_eq!(again.project, recovered);
    opened.save.remove_orphans();
    assert_eq!(opened.save.project().0, recovered);
}
