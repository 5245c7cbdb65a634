//! Labels of blocks that have none: from their ids, their captions, or the names of their rows.
//!
//! Owns which texts are good labels. No two blocks of a diagram get the same.

use super::ids::Inside;
use super::lexer::is_word;
use crate::limits;
use crate::project::{Block, Diagram};
use std::collections::{HashMap, HashSet};

/// The labels of all blocks of a diagram.
pub(super) fn labels(diagram: &Diagram, inside: &Inside) -> Vec<String> {
    let mut taken: HashSet<String> = HashSet::new();
    let mut labels: Vec<Option<String>> = Vec::with_capacity(diagram.blocks.len());
    // What people have called it in a text; then what they have called it in the editor.
    for block in &diagram.blocks {
        let known = inside.label(&block.element, &block.id);
        let known = known.filter(|label| is_word(label) && taken.insert(label.clone()));
        labels.push(known);
    }
    for (label, block) in labels.iter_mut().zip(&diagram.blocks) {
        let caption = &block.name;
        if label.is_none() && is_good(caption) && taken.insert(caption.clone()) {
            *label = Some(caption.clone());
        }
    }
    let mut numbers: HashMap<String, usize> = HashMap::new();
    let all = labels.into_iter().zip(&diagram.blocks);
    let numbered = |(label, block): (Option<String>, &Block)| {
        label.unwrap_or_else(|| {
            let stem = stem(block);
            let number = numbers.entry(stem.clone()).or_default();
            loop {
                *number += 1;
                let label = format!("{stem}{number}");
                if taken.insert(label.clone()) {
                    return label;
                }
            }
        })
    };
    all.map(numbered).collect()
}

fn is_good(caption: &str) -> bool {
    caption.len() <= limits::LABEL_BYTES_MAX && is_word(caption)
}

/// The name of a block as one word, as `flowReplacer`.
fn stem(block: &Block) -> String {
    let name = block.row.map_or("block", |row| row.shown);
    let words = name.split(|c: char| !c.is_ascii_alphanumeric());
    let mut stem = String::new();
    for word in words.filter(|word| !word.is_empty()) {
        let word = word.to_ascii_lowercase();
        match stem.is_empty() {
            true => stem.push_str(&word),
            false => {
                stem.push_str(&word[..1].to_ascii_uppercase());
                stem.push_str(&word[1..]);
            }
        }
    }
    stem
}
