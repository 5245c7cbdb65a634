//! The rules of the project, as far as a program can check them without starting anything of it.

/// Circles of files that need each other.
mod circles;
/// Words, lengths, places of unsafe code, crates and documents.
mod tidy;
