//! Arbitrary bytes as choices of a person who draws, for the edits of both languages.
//!
//! Owns how a byte becomes a number, an id, a place or a text. What is chosen between is known to who asks.

/// Bytes as numbers, 0 when they are used up.
#[derive(Debug)]
pub struct Choices<'a> {
    bytes: &'a [u8],
    texts: &'static [&'static str],
}

impl<'a> Choices<'a> {
    /// These bytes, for which these texts are there.
    pub fn new(bytes: &'a [u8], texts: &'static [&'static str]) -> Self {
        Self { bytes, texts }
    }

    /// Whether bytes are left.
    pub fn is_over(&self) -> bool {
        self.bytes.is_empty()
    }

    /// A number below this one.
    pub fn below(&mut self, most: usize) -> usize {
        let Some((first, rest)) = self.bytes.split_first() else {
            return 0;
        };
        self.bytes = rest;
        usize::from(*first) % most.max(1)
    }

    /// One of the texts.
    pub fn text(&mut self) -> String {
        let at = self.below(self.texts.len());
        self.texts.get(at).copied().unwrap_or_default().to_owned()
    }

    /// One of these ids, or one that is not there.
    pub fn id(&mut self, ids: &[String]) -> String {
        let at = self.below(ids.len() + 1);
        ids.get(at).map_or("qrm:/a/b/c/{d}", |id| id).to_owned()
    }

    /// A place on a sheet, or none.
    pub fn place(&mut self) -> (f64, f64) {
        match self.below(40) {
            0 => (f64::NAN, 0.0),
            1 => (0.0, f64::INFINITY),
            x => (x as f64 * 20.0, self.below(40) as f64 * -20.0),
        }
    }

    /// Places of two ports, mostly.
    pub fn ports(&mut self) -> Option<(u8, u8)> {
        let ports = (self.below(15) as u8, self.below(15) as u8);
        (self.below(20) != 0).then_some(ports)
    }
}
