//! Names and texts that hurt.
