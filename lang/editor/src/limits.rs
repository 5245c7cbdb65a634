//! Every limit of this crate: how much an editor is told at once.

/// Bytes of a document of which an editor learns more than what is wrong with it.
pub const DCML_EDITOR_BYTES: usize = 8 << 20;
/// Places, coloured words and entries of an outline that an editor gets at once.
pub const DCML_EDITOR_PLACES: usize = 200_000;
/// Words that are offered at once.
pub const DCML_EDITOR_OFFERS: usize = 1000;
/// Findings of one stretch for which edits are offered.
pub const DCML_EDITOR_FIXES: usize = 50;
/// Words in which the call is looked for whose arguments are written.
pub const DCML_EDITOR_LOOK_BACK: usize = 10_000;
/// Bytes of a name that an outline shows, and of one that is put in by an editor.
pub const DCML_EDITOR_NAME_BYTES: usize = 250;
/// Bytes of a documentation or an equation that are shown.
pub const DCML_EDITOR_SHOWN_BYTES: usize = 2000;
