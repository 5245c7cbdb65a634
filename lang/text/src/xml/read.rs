//! Text to a tree: the events of `quick-xml`, within limits and with places in our own words.
//!
//! Owns what is refused. A document type is: with it go entities that grow and files that are named from outside. The
//! crate takes some text that is no XML; what matters is refused here: signs in names and `<` in values. Missing space
//! between two attributes is let through.

use super::{Element, Node, Start, words};
use crate::limits;
use crate::problem::{Problem, Words, position};
use quick_xml::errors::{Error, IllFormedError, SyntaxError};
use quick_xml::events::attributes::{AttrError, Attributes};
use quick_xml::events::{BytesStart, Event};
use quick_xml::reader::Reader;
use std::borrow::Cow;

/// Reads one document.
///
/// # Errors
/// Text that is no XML, a document type, an entity that is not one of the five, and anything above the limits of
/// [`limits`]; with line and column.
pub fn parse(text: &str) -> Result<Element<'_>, Problem> {
    let text = text.strip_prefix('\u{feff}').unwrap_or(text);
    let mut builder = Builder::default();
    let mut reader = Reader::from_str(text);
    loop {
        let at = usize::try_from(reader.buffer_position()).unwrap_or(usize::MAX);
        let located = |words: Words| located(words, text, at);
        let event = reader.read_event();
        let event = event.map_err(|error| located(refusal(&error, text, at)))?;
        match event {
            Event::Start(tag) => builder.start(raw(text, at, &tag), at).map_err(located)?,
            Event::Empty(tag) => {
                builder.start(raw(text, at, &tag), at).map_err(located)?;
                builder.end();
            }
            Event::End(_) => builder.end(),
            Event::Text(found) => {
                let found = lines(found.into_inner());
                builder.text(found).map_err(located)?;
            }
            Event::CData(found) => builder.text(found.into_inner()).map_err(located)?,
            Event::GeneralRef(found) => {
                let value = entity(&found).ok_or_else(|| words::entity(&brief(&found)));
                let value = value.map_err(located)?;
                builder.text(value.to_string().into()).map_err(located)?;
            }
            Event::Comment(found) => builder.push(Node::Comment(found.into_inner())),
            Event::DocType(_) => return Err(located(words::document_type())),
            Event::Decl(_) | Event::PI(_) => {}
            Event::Eof => break,
        }
    }
    match builder.root {
        Some(root) if builder.open.is_empty() => Ok(root),
        _ => Err(located(words::unfinished(), text, text.len())),
    }
}

/// What stands between the angles of a tag, borrowed from the text and not from the event, and the length of its name.
fn raw<'a>(text: &'a str, at: usize, tag: &BytesStart<'_>) -> (&'a str, usize) {
    let content = text.get(at..).unwrap_or_default();
    let content = content.strip_prefix('<').unwrap_or(content);
    let content = content.get(..tag.len()).unwrap_or_default();
    debug_assert_eq!(content, &**tag, "the tag stands where the reader was");
    (content, tag.name().as_ref().len())
}

/// Why the crate cannot go on at a byte of the text.
fn refusal(error: &Error, text: &str, at: usize) -> Words {
    match error {
        Error::Syntax(SyntaxError::InvalidBangMarkup) => words::strange('!'),
        Error::Syntax(SyntaxError::UnclosedDoctype)
        | Error::IllFormed(IllFormedError::MissingDoctypeName) => words::document_type(),
        Error::Syntax(_) => words::unfinished(),
        Error::IllFormed(IllFormedError::MismatchedEndTag { expected, found }) => {
            match found.chars().find(|&c| is_sign(c)) {
                Some(sign) => words::strange(sign),
                None => words::wrong_end(&brief(found), &brief(expected)),
            }
        }
        Error::IllFormed(IllFormedError::UnmatchedEndTag(found)) => {
            words::end_of_nothing(&brief(found))
        }
        Error::IllFormed(IllFormedError::UnclosedReference) => {
            let reference = text.get(at..).unwrap_or_default();
            words::entity(&brief(reference.strip_prefix('&').unwrap_or(reference)))
        }
        _ => words::strange(
            text.get(at..)
                .and_then(|rest| rest.chars().next())
                .unwrap_or('<'),
        ),
    }
}

/// Why the crate cannot read an attribute of a tag, whose name has a length.
fn attribute_refusal(error: &AttrError, content: &str, length: usize) -> Words {
    match *error {
        AttrError::ExpectedEq(at) | AttrError::ExpectedValue(at) | AttrError::UnquotedValue(at) => {
            let before = content.get(length..at).unwrap_or_default();
            let before = before.trim_end_matches(|c: char| c == '=' || c.is_ascii_whitespace());
            let found = before.rsplit(|c: char| c.is_ascii_whitespace()).next();
            name(found.unwrap_or_default())
                .map_or_else(|words| words, |name| words::no_value(&brief(name)))
        }
        AttrError::ExpectedQuote(..) => words::unfinished(),
        AttrError::Duplicated(at, _) => {
            let rest = content.get(at..).unwrap_or_default();
            let name = rest.split(is_sign).next();
            words::attribute_twice(&brief(name.unwrap_or_default()))
        }
    }
}

/// Whether a character cannot be in a name: space, and the signs of XML.
fn is_sign(c: char) -> bool {
    matches!(
        c,
        '\0'..=' ' | '<' | '>' | '/' | '=' | '&' | '\'' | '"' | '?' | '!'
    )
}

/// A name as it stands, if it is one.
fn name(found: &str) -> Result<&str, Words> {
    match found.chars().find(|&c| is_sign(c)) {
        Some(sign) => Err(words::strange(sign)),
        None if found.is_empty() => Err(words::strange('<')),
        None => Ok(found),
    }
}

/// The open tags, outermost first, and what is finished.
#[derive(Default)]
struct Builder<'a> {
    open: Vec<Element<'a>>,
    root: Option<Element<'a>>,
    /// Text of the innermost tag that may go on.
    text: Cow<'a, str>,
    tags: usize,
}

impl<'a> Builder<'a> {
    /// Opens a tag and takes its attributes.
    fn start(&mut self, (content, length): (&'a str, usize), at: usize) -> Result<(), Words> {
        self.tags += 1;
        if self.tags > limits::XML_TAGS {
            return Err(words::too_many_tags());
        }
        if self.open.len() == limits::XML_DEPTH {
            return Err(words::too_deep());
        }
        if self.root.is_some() {
            return Err(words::two_roots());
        }
        self.keep_text();
        let mut element = Element::new(name(content.get(..length).unwrap_or_default())?);
        element.start = Start(u32::try_from(at).unwrap_or_default());
        for found in Attributes::new(content, length) {
            let found = found.map_err(|error| attribute_refusal(&error, content, length))?;
            let attributes = &mut element.attributes;
            if attributes.is_empty() {
                // Most tags of a save have two.
                attributes.reserve_exact(2);
            }
            if attributes.len() == limits::XML_ATTRIBUTES {
                return Err(words::too_many_attributes());
            }
            let key = name(found.key.0)?;
            let value = match found.value {
                Cow::Borrowed(value) => plain(key, value)?,
                Cow::Owned(value) => Cow::Owned(plain(key, &value)?.into_owned()),
            };
            attributes.push((Cow::Borrowed(key), value));
        }
        self.open.push(element);
        Ok(())
    }

    fn end(&mut self) {
        self.keep_text();
        match self.open.pop() {
            Some(element) if self.open.is_empty() => self.root = Some(element),
            Some(element) => self.push(Node::Element(element)),
            None => {}
        }
    }

    /// Adds something that ends a text.
    fn push(&mut self, node: Node<'a>) {
        self.keep_text();
        if let Some(parent) = self.open.last_mut() {
            parent.nodes.push(node);
        }
    }

    /// Adds to the text of the innermost tag.
    fn text(&mut self, found: Cow<'a, str>) -> Result<(), Words> {
        if self.open.is_empty() {
            return match found.trim().is_empty() {
                true => Ok(()),
                false => Err(words::text_outside()),
            };
        }
        match self.text.is_empty() {
            true => self.text = found,
            false => self.text.to_mut().push_str(&found),
        }
        Ok(())
    }

    /// The text is over.
    fn keep_text(&mut self) {
        let text = std::mem::take(&mut self.text);
        if text.bytes().all(|byte| byte.is_ascii_whitespace()) {
            return;
        }
        if let Some(parent) = self.open.last_mut() {
            parent.nodes.push(Node::Text(text));
        }
    }
}

/// A text in which each line ends with one character, as XML demands of every system.
fn lines(text: Cow<'_, str>) -> Cow<'_, str> {
    match text.contains('\r') {
        true => Cow::Owned(text.replace("\r\n", "\n").replace('\r', "\n")),
        false => text,
    }
}

/// The value of an attribute with its references replaced.
fn plain<'a>(key: &str, value: &'a str) -> Result<Cow<'a, str>, Words> {
    // Without a branch for each byte, so that many are looked at together.
    let is_special = |found: bool, &byte: &u8| found | matches!(byte, b'&' | b'\r' | b'<');
    if !value.as_bytes().iter().fold(false, is_special) {
        return Ok(Cow::Borrowed(value));
    }
    if value.contains('<') {
        return Err(words::angle_in_value(key));
    }
    let mut plain = String::with_capacity(value.len());
    let mut rest = value;
    while let Some(at) = rest.find(['&', '\r']) {
        plain.push_str(&rest[..at]);
        if let Some(after) = rest[at..].strip_prefix('\r') {
            // The end of a line in any system is one character.
            plain.push_str(if after.starts_with('\n') { "" } else { "\n" });
            rest = after;
            continue;
        }
        let name = &rest[at + 1..];
        let end = name.find(';').ok_or_else(|| words::entity(&brief(name)))?;
        let value = entity(&name[..end]).ok_or_else(|| words::entity(&brief(&name[..end])))?;
        plain.push(value);
        rest = &name[end + 1..];
    }
    plain.push_str(rest);
    Ok(Cow::Owned(plain))
}

/// The beginning of a text, for messages.
fn brief(text: &str) -> String {
    text.chars().take(20).collect()
}

/// What a reference stands for: one of the five of XML, or a number.
fn entity(name: &str) -> Option<char> {
    match name {
        "lt" => return Some('<'),
        "gt" => return Some('>'),
        "amp" => return Some('&'),
        "quot" => return Some('"'),
        "apos" => return Some('\''),
        _ => {}
    }
    let number = name.strip_prefix('#')?;
    let code = match number.strip_prefix('x') {
        Some(digits) => u32::from_str_radix(digits, 16).ok()?,
        None => number.parse().ok()?,
    };
    let is_legal = |found: &char| *found >= ' ' || ['\t', '\n', '\r'].contains(found);
    char::from_u32(code).filter(is_legal)
}

/// A problem at a byte of the text.
fn located(words: Words, text: &str, at: usize) -> Problem {
    let mut problem = Problem::error(words);
    problem.place.position = Some(position(text, at));
    problem
}
