//! The language of expressions: text in the properties of blocks.
