//! What a picture of a field shows, as a save has it.
//!
//! Owns how its text begins. What is in it is read where a sensor sees it, or a page shows it.

/// Contents of a picture.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Blob {
    /// The path that it once had: its ending says what it is.
    pub path: String,
    /// Not in the project but in the file of `path`.
    pub is_external: bool,
    /// Base64 of a picture's file, or the text of an SVG.
    pub text: String,
}

/// How Base64 of a file begins that is a picture: PNG, JPEG, GIF, BMP, WebP.
const HEADS: [&str; 5] = ["iVBORw0KGgo", "/9j/", "R0lGOD", "Qk", "UklGR"];

impl Blob {
    /// Whether its contents begin as those of a picture do: all of them are read only where a sensor sees it.
    pub(crate) fn begins_as_picture(&self) -> bool {
        if self.path.to_ascii_lowercase().ends_with(".svg") {
            return self.text.contains("<svg");
        }
        let text = self.text.trim_ascii_start();
        HEADS.iter().any(|head| text.starts_with(head))
    }
}
