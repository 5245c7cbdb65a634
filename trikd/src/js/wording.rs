//! Messages of errors in the words that TRIK programs have always got.
//!
//! Pure: from the words of the engine and the line of the program to the old words. What is not known here stays as the
//! engine says it.

/// The message of an error of this name. The line is that of the innermost function, with the place in it that the
/// engine names, in characters from 0.
pub fn message(name: &str, message: &str, _line: Option<(&str, usize)>) -> String {
    let _ = name;
    message.to_owned()
}
