//! A save that a person draws: changes one after the other, each whole or not at all, taken back and made again.
//!
//! Owns what each change does to the objects of a save, and the way back. What a change does not name stays as it came, also
//! what nobody here understands. Knows no meaning of a block: what is wrong with a drawing is found by [`super::check`].

use super::objects::{self, Object, ROOT};
use super::project::{DiagramKind, Parameter};
use super::read::Meta;
use super::save::Save;
use crate::limits;
use lang_expr::Kit;
use lang_text::problem::{Locale, Problem};

mod changes;
pub mod notation;
mod pen;
mod piece;
mod route;
#[cfg(test)]
mod tests;
mod words;

use changes::carry_out;
use notation::{ControlFlow, Notation};
use pen::{Ids, Pen, Step};
pub use piece::{Drawn, Piece, Wire};

/// Which kit a save is for.
const KIT_KEY: &str = "lastKitId";

/// One change of a drawing. Ids are those of graphical objects.
#[derive(Clone, Debug, PartialEq)]
pub enum Change {
    /// Blocks and links appear in a diagram.
    Add {
        /// Its id.
        diagram: String,
        /// What appears.
        piece: Piece,
    },
    /// A block appears in a link: that ends at it then, and a new link goes on to where it ended.
    Insert {
        /// The id of the link.
        link: String,
        /// The block.
        block: Drawn,
        /// What stands at the new link.
        guard: String,
        /// Of a language with ports where the link ends at it, and where the new one begins.
        ports: Option<(u8, u8)>,
    },
    /// Blocks and links disappear, and with a block the links at it.
    Remove {
        /// Their ids.
        ids: Vec<String>,
    },
    /// Blocks move to other places, in px; their links go with them.
    Move {
        /// The id of each, and where its upper left corner is then.
        places: Vec<(String, (f64, f64))>,
    },
    /// A link from one block to another one of the same diagram.
    Connect {
        /// The id of the block where it begins.
        from: String,
        /// The id of the block where it ends.
        to: String,
        /// Its guard.
        guard: String,
        /// Of a language with ports those of both ends: their places among the ports of the block.
        ports: Option<(u8, u8)>,
    },
    /// A link begins or ends at another block.
    Reconnect {
        /// The id of the link.
        link: String,
        /// The id of the block where it begins then.
        from: String,
        /// The id of the block where it ends then.
        to: String,
        /// Of a language with ports those of both ends.
        ports: Option<(u8, u8)>,
    },
    /// A property of a block or link gets a value.
    Set {
        /// The id of the block or link.
        id: String,
        /// The name of the property in the save; of a link `Guard`, of data flow `Policy` and `Capacity`.
        property: String,
        /// What it is then.
        value: String,
    },
    /// What a call gives a parameter of its subprogram.
    Argument {
        /// The id of the call.
        id: String,
        /// The name of the parameter.
        name: String,
        /// The text of its expression.
        value: String,
    },
    /// A block calls another subprogram; what it gave parameters of the same names stays.
    Call {
        /// The id of the block, which is one for calls.
        id: String,
        /// The id of the diagram of the subprogram.
        diagram: String,
    },
    /// A new diagram, without blocks.
    AddDiagram {
        /// What it is for.
        kind: DiagramKind,
        /// Its name.
        name: String,
    },
    /// A diagram gets another name; the calls of a subprogram show it.
    Rename {
        /// Its id.
        diagram: String,
        /// What it is called then.
        name: String,
    },
    /// Which parameters a subprogram has.
    Parameters {
        /// Its id.
        diagram: String,
        /// All of them, in order.
        parameters: Vec<Parameter>,
    },
    /// A diagram disappears with everything in it. Calls of it stay, and call nothing.
    RemoveDiagram {
        /// Its id.
        diagram: String,
    },
    /// The world becomes another one, or the save has none.
    World {
        /// Its text in XML.
        text: Option<String>,
        /// The images that it names, as `blobs.xml` has them; those that are there stay if nothing is given, and an empty text
        /// takes them away.
        images: Option<String>,
    },
    /// The robot has another kit.
    Kit {
        /// Which one.
        kit: Kit,
    },
}

/// A save, and how it came to be what it is.
#[derive(Clone, Debug)]
pub struct Editor {
    notation: &'static dyn Notation,
    save: Save,
    ids: Ids,
    done: Vec<Step>,
    undone: Vec<Step>,
}

impl Editor {
    /// Begins to change the diagrams of control flow of a save. New objects get ids that `seed` decides: with a random one
    /// they are unlike those of other projects.
    pub fn new(save: Save, seed: u128) -> Self {
        Self::of(&ControlFlow, save, seed)
    }

    /// Begins to change the diagrams of a language of a save. Others stay as they are.
    pub fn of(notation: &'static dyn Notation, save: Save, seed: u128) -> Self {
        Self {
            notation,
            save,
            ids: Ids::new(seed),
            done: Vec::new(),
            undone: Vec::new(),
        }
    }

    /// A project with one main diagram of control flow, in which a program begins and ends; its names are in this language.
    pub fn blank(kit: Kit, locale: Locale, seed: u128) -> Self {
        Self::blank_of(&ControlFlow, kit, locale, seed)
    }

    /// The same of a language.
    pub fn blank_of(notation: &'static dyn Notation, kit: Kit, locale: Locale, seed: u128) -> Self {
        let mut objects = objects::Objects::default();
        let root = Object {
            id: ROOT.to_owned(),
            parent: objects::NOTHING.to_owned(),
            ..Object::default()
        };
        // There is nothing that could have its id.
        let _ = objects.add(root);
        let mut meta = Meta::default();
        let (key, version) = notation.elements().version;
        meta.keys.extend([(key.to_owned(), version.to_owned())]);
        let mut blank = Self::of(notation, Save::made(objects, meta), seed);
        let mut pen = Pen::new(notation, &mut blank.save, &mut blank.ids);
        pen.meta().keys.insert(KIT_KEY.to_owned(), kit.id().into());
        let made = pen.diagram(DiagramKind::Main, words::main_name(locale));
        let piece = notation.first(locale);
        // Its blocks are known.
        let _ = made.and_then(|diagram| piece::add(&mut pen, &diagram, &piece));
        let _ = pen.finish();
        blank
    }

    /// The save as it is now.
    pub fn save(&self) -> &Save {
        &self.save
    }

    /// Makes a change, whole or not at all. The ids of what is new: blocks first, then links, each in the order of the change.
    ///
    /// # Errors
    /// An id that is not there, a text that a save cannot carry, more than a project may have; nothing has changed then.
    pub fn apply(&mut self, change: &Change) -> Result<Vec<String>, Problem> {
        let mut pen = Pen::new(self.notation, &mut self.save, &mut self.ids);
        match carry_out(&mut pen, change) {
            Ok(new) => {
                let step = pen.finish();
                if !step.is_empty() {
                    self.undone.clear();
                    self.done.push(step);
                    self.forget();
                }
                Ok(new)
            }
            Err(why) => {
                let mut step = pen.finish();
                step.swap(&mut self.save);
                Err(why)
            }
        }
    }

    /// Takes the last change back. Whether there was one.
    pub fn undo(&mut self) -> bool {
        let Some(mut step) = self.done.pop() else {
            return false;
        };
        step.swap(&mut self.save);
        self.undone.push(step);
        true
    }

    /// Makes the change again that was taken back last. Whether there was one.
    pub fn redo(&mut self) -> bool {
        let Some(mut step) = self.undone.pop() else {
            return false;
        };
        step.swap(&mut self.save);
        self.done.push(step);
        true
    }

    /// How many changes can be taken back.
    pub fn undo_count(&self) -> usize {
        self.done.len()
    }

    /// How many changes can be made again.
    pub fn redo_count(&self) -> usize {
        self.undone.len()
    }

    /// Blocks, and links between them, as they can be added elsewhere.
    pub fn copy(&self, ids: &[String]) -> Piece {
        self.notation.copy(&self.save, ids)
    }

    /// The oldest changes go when all of them take too much memory.
    fn forget(&mut self) {
        let mut bytes: usize = self.done.iter().map(|step| step.bytes).sum();
        let mut gone = 0;
        while bytes > limits::EDIT_HISTORY_BYTES && gone + 1 < self.done.len() {
            bytes -= self.done[gone].bytes;
            gone += 1;
        }
        self.done.drain(..gone);
    }
}
