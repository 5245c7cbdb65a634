//! The signs of a document, one after another: tags, attributes and what stands between them.
//!
//! Owns where each begins and ends. Knows neither which tag closes which nor what references stand for. Written by hand,
//! because a save is a thousand small documents: this takes half of the time of a parser for all of XML.

use super::words;
use crate::problem::Words;

/// Something of a document.
pub(super) enum Token<'a> {
    /// A tag begins; its attributes come next.
    Start(&'a str),
    /// A tag ends.
    End(&'a str),
    /// Text with references.
    Text(&'a str),
    /// Text without references, of a CDATA section.
    Characters(&'a str),
    /// A remark.
    Comment(&'a str),
    /// A declaration or instruction, which is for others.
    Instruction,
    /// The text is over.
    Finish,
}

/// Something between the name of a tag and its `>`.
pub(super) enum Part<'a> {
    /// A name and a value with references.
    Attribute(&'a str, &'a str),
    /// The end of a tag that has something in it.
    Open,
    /// The end of a tag that has nothing in it.
    Empty,
}

/// Which bytes cannot be in a name: space, and the signs of XML.
const ENDS_NAME: [bool; 256] = {
    let mut table = [false; 256];
    let mut byte = 0;
    while byte <= b' ' {
        table[byte as usize] = true;
        byte += 1;
    }
    let signs = b"<>/=&'\"?!";
    let mut at = 0;
    while at < signs.len() {
        table[signs[at] as usize] = true;
        at += 1;
    }
    table
};

/// A place in a text.
pub(super) struct Scanner<'a> {
    text: &'a str,
    at: usize,
}

impl<'a> Scanner<'a> {
    pub(super) fn new(text: &'a str) -> Self {
        Self { text, at: 0 }
    }

    /// How many bytes are read.
    pub(super) fn at(&self) -> usize {
        self.at
    }

    fn rest(&self) -> &'a str {
        // Signs of XML are ASCII, so that a place behind one is between characters.
        self.text.get(self.at..).unwrap_or_default()
    }

    /// The text up to a mark, which is passed.
    fn until(&mut self, mark: &str) -> Result<&'a str, Words> {
        let rest = self.rest();
        let end = rest.find(mark).ok_or_else(words::unfinished)?;
        self.at += end + mark.len();
        Ok(&rest[..end])
    }

    pub(super) fn next(&mut self) -> Result<Token<'a>, Words> {
        let rest = self.rest();
        let Some(inside) = rest.strip_prefix('<') else {
            if rest.is_empty() {
                return Ok(Token::Finish);
            }
            let length = rest.bytes().position(|byte| byte == b'<');
            let length = length.unwrap_or(rest.len());
            self.at += length;
            return Ok(Token::Text(&rest[..length]));
        };
        let skip = |scanner: &mut Self, mark: &str| scanner.at += 1 + mark.len();
        match inside.as_bytes().first() {
            Some(b'/') => {
                skip(self, "/");
                let name = self.name()?;
                self.space();
                match self.rest().strip_prefix('>') {
                    Some(_) => self.at += 1,
                    None => return Err(self.strange()),
                }
                Ok(Token::End(name))
            }
            Some(b'?') => {
                skip(self, "?");
                self.until("?>").map(|_| Token::Instruction)
            }
            Some(b'!') if inside.starts_with("!--") => {
                skip(self, "!--");
                self.until("-->").map(Token::Comment)
            }
            Some(b'!') if inside.starts_with("![CDATA[") => {
                skip(self, "![CDATA[");
                self.until("]]>").map(Token::Characters)
            }
            Some(b'!') if inside.starts_with("!DOCTYPE") => Err(words::document_type()),
            _ => {
                skip(self, "");
                self.name().map(Token::Start)
            }
        }
    }

    /// What comes next in a tag that began.
    pub(super) fn part(&mut self) -> Result<Part<'a>, Words> {
        let has_space = self.space();
        let rest = self.rest();
        if rest.starts_with('>') {
            self.at += 1;
            return Ok(Part::Open);
        }
        if rest.starts_with("/>") {
            self.at += 2;
            return Ok(Part::Empty);
        }
        if !has_space {
            return Err(self.strange());
        }
        let name = self.name()?;
        self.space();
        if !self.rest().starts_with('=') {
            return Err(words::no_value(name));
        }
        self.at += 1;
        self.space();
        let rest = self.rest().as_bytes();
        let quote = match rest.first() {
            Some(quote @ (b'"' | b'\'')) => *quote,
            Some(_) => return Err(words::no_value(name)),
            None => return Err(words::unfinished()),
        };
        let begin = self.at + 1;
        let length = rest[1..]
            .iter()
            .position(|&byte| byte == quote || byte == b'<');
        let length = length.ok_or_else(words::unfinished)?;
        if rest[1 + length] == b'<' {
            return Err(words::angle_in_value(name));
        }
        self.at = begin + length + 1;
        let value = self.text.get(begin..begin + length).unwrap_or_default();
        Ok(Part::Attribute(name, value))
    }

    fn name(&mut self) -> Result<&'a str, Words> {
        let rest = self.rest();
        let is_sign = |byte: u8| ENDS_NAME[usize::from(byte)];
        let length = rest.bytes().position(is_sign).unwrap_or(rest.len());
        if length == 0 {
            return Err(self.strange());
        }
        self.at += length;
        Ok(&rest[..length])
    }

    /// Passes space; whether there was any.
    fn space(&mut self) -> bool {
        let rest = self.rest().bytes();
        let length = rest.take_while(u8::is_ascii_whitespace).count();
        self.at += length;
        length > 0
    }

    /// What stands here should not.
    fn strange(&self) -> Words {
        match self.rest().chars().next() {
            Some(found) => words::strange(found),
            None => words::unfinished(),
        }
    }
}
