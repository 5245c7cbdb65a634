//! XML as a tree with raw names, read within limits and written as Qt writes it.
//!
//! Owns the syntax. Knows no meaning of tags. A document type is refused: with it go entities that grow and files that
//! are named from outside. Names are kept as they stand, because saves have the tag `qReal::Id`, which no parser with
//! namespaces accepts.

use crate::limits;
use crate::problem::{Position, Problem, Words};
use scan::{Part, Scanner, Token};
use std::borrow::Cow;

mod scan;
mod words;

/// A tag with what is in it.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Element<'a> {
    /// Its name, colons included.
    pub name: Cow<'a, str>,
    /// Names and values, in the order of the text.
    pub attributes: Vec<(Cow<'a, str>, Cow<'a, str>)>,
    /// What stands between its beginning and its end.
    pub nodes: Vec<Node<'a>>,
}

/// Something between the beginning and the end of a tag.
#[derive(Clone, Debug, PartialEq)]
pub enum Node<'a> {
    /// A tag.
    Element(Element<'a>),
    /// Text that is more than space.
    Text(Cow<'a, str>),
    /// A remark, as it stands.
    Comment(Cow<'a, str>),
}

impl<'a> Element<'a> {
    /// A tag with nothing in it.
    pub fn new(name: impl Into<Cow<'a, str>>) -> Self {
        Self {
            name: name.into(),
            ..Self::default()
        }
    }

    /// The same with one more attribute.
    #[must_use]
    pub fn with(mut self, name: impl Into<Cow<'a, str>>, value: impl Into<Cow<'a, str>>) -> Self {
        self.attributes.push((name.into(), value.into()));
        self
    }

    /// Value of an attribute.
    pub fn attribute(&self, name: &str) -> Option<&str> {
        self.attributes
            .iter()
            .find(|(key, _)| key == name)
            .map(|(_, value)| value.as_ref())
    }

    /// Gives an attribute a value, at its old place if it has one.
    pub fn set(&mut self, name: &str, value: &str) {
        match self.attributes.iter_mut().find(|(key, _)| key == name) {
            Some((_, old)) => *old = Cow::Owned(value.to_owned()),
            None => self
                .attributes
                .push((Cow::Owned(name.to_owned()), Cow::Owned(value.to_owned()))),
        }
    }

    /// Takes an attribute away, and gives its value.
    pub fn take(&mut self, name: &str) -> Option<String> {
        let at = self.attributes.iter().position(|(key, _)| key == name)?;
        Some(self.attributes.remove(at).1.into_owned())
    }

    /// The tags in it, in order.
    pub fn elements(&self) -> impl Iterator<Item = &Element<'a>> {
        self.nodes.iter().filter_map(|node| match node {
            Node::Element(element) => Some(element),
            Node::Text(_) | Node::Comment(_) => None,
        })
    }

    /// The tags in it, in order, to be changed.
    pub fn elements_mut(&mut self) -> impl Iterator<Item = &mut Element<'a>> {
        self.nodes.iter_mut().filter_map(|node| match node {
            Node::Element(element) => Some(element),
            Node::Text(_) | Node::Comment(_) => None,
        })
    }

    /// The first tag in it with a name.
    pub fn child(&self, name: &str) -> Option<&Element<'a>> {
        self.elements().find(|element| element.name == name)
    }

    /// The first tag in it with a name, to be changed; made if it is not there.
    pub fn child_mut(&mut self, name: &str) -> &mut Element<'a> {
        let found = |node: &Node<'a>| matches!(node, Node::Element(one) if one.name == name);
        let at = match self.nodes.iter().position(found) {
            Some(at) => at,
            None => {
                self.nodes
                    .push(Node::Element(Element::new(name.to_owned())));
                self.nodes.len() - 1
            }
        };
        match &mut self.nodes[at] {
            Node::Element(element) => element,
            Node::Text(_) | Node::Comment(_) => unreachable!("position() found a tag"),
        }
    }
}

/// Reads one document.
///
/// # Errors
/// Text that is no XML, a document type, an entity that is not one of the five, and anything above the limits of
/// [`limits`]; with line and column.
pub fn parse(text: &str) -> Result<Element<'_>, Problem> {
    let text = text.strip_prefix('\u{feff}').unwrap_or(text);
    let mut builder = Builder::default();
    let mut scanner = Scanner::new(text);
    loop {
        let at = scanner.at();
        let located = |words: Words| located(words, text, at);
        match scanner.next().map_err(located)? {
            Token::Start(name) => builder.start(name, &mut scanner).map_err(located)?,
            Token::End(name) => builder.end_of(name).map_err(located)?,
            Token::Text(found) => {
                let found = plain(found).map_err(located)?;
                builder.text(found).map_err(located)?;
            }
            Token::Characters(found) => builder.text(found.into()).map_err(located)?,
            Token::Comment(found) => builder.push(Node::Comment(found.into())),
            Token::Instruction => {}
            Token::Finish => break,
        }
    }
    match builder.root {
        Some(root) if builder.open.is_empty() => Ok(root),
        _ => Err(located(words::unfinished(), text, text.len())),
    }
}

/// The open tags, outermost first, and what is finished.
#[derive(Default)]
struct Builder<'a> {
    open: Vec<Element<'a>>,
    root: Option<Element<'a>>,
    tags: usize,
}

impl<'a> Builder<'a> {
    /// Opens a tag and takes its attributes.
    fn start(&mut self, name: &'a str, scanner: &mut Scanner<'a>) -> Result<(), Words> {
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
        let mut element = Element::new(name);
        let is_empty = loop {
            match scanner.part()? {
                Part::Attribute(name, value) => add(&mut element, name, value)?,
                Part::Open => break false,
                Part::Empty => break true,
            }
        };
        self.open.push(element);
        if is_empty {
            self.end();
        }
        Ok(())
    }

    fn end_of(&mut self, name: &str) -> Result<(), Words> {
        match self.open.last() {
            Some(element) if element.name == name => {}
            Some(element) => return Err(words::wrong_end(name, &element.name)),
            None => return Err(words::end_of_nothing(name)),
        }
        self.end();
        Ok(())
    }

    fn end(&mut self) {
        match self.open.pop() {
            Some(element) if self.open.is_empty() => self.root = Some(element),
            Some(element) => self.push(Node::Element(element)),
            None => {}
        }
    }

    fn push(&mut self, node: Node<'a>) {
        if let Some(parent) = self.open.last_mut() {
            parent.nodes.push(node);
        }
    }

    fn text(&mut self, found: Cow<'a, str>) -> Result<(), Words> {
        let Some(parent) = self.open.last_mut() else {
            return match found.trim().is_empty() {
                true => Ok(()),
                false => Err(words::text_outside()),
            };
        };
        match parent.nodes.last_mut() {
            Some(Node::Text(text)) => text.to_mut().push_str(&found),
            _ if found.bytes().all(|byte| byte.is_ascii_whitespace()) => {}
            _ => parent.nodes.push(Node::Text(found)),
        }
        Ok(())
    }
}

/// Adds an attribute to a tag.
fn add<'a>(element: &mut Element<'a>, name: &'a str, value: &'a str) -> Result<(), Words> {
    let attributes = &mut element.attributes;
    if attributes.is_empty() {
        // Most tags of a save have two.
        attributes.reserve_exact(2);
    }
    if attributes.len() == limits::XML_ATTRIBUTES {
        return Err(words::too_many_attributes());
    }
    if attributes.iter().any(|(known, _)| known == name) {
        return Err(words::attribute_twice(name));
    }
    attributes.push((Cow::Borrowed(name), plain(value)?));
    Ok(())
}

/// A text with its references replaced.
fn plain(value: &str) -> Result<Cow<'_, str>, Words> {
    // Without a branch for each byte, so that many are looked at together.
    let is_special = |found: bool, &byte: &u8| found | (byte == b'&') | (byte == b'\r');
    if !value.as_bytes().iter().fold(false, is_special) {
        return Ok(Cow::Borrowed(value));
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
    let at = (0..=at.min(text.len()))
        .rev()
        .find(|&at| text.is_char_boundary(at))
        .unwrap_or(0);
    let before = &text[..at];
    let line = before.bytes().filter(|&byte| byte == b'\n').count() + 1;
    let column = before.chars().rev().take_while(|&c| c != '\n').count() + 1;
    let mut problem = Problem::error(words);
    problem.place.position = Some(Position {
        line: u32::try_from(line).unwrap_or(u32::MAX),
        column: u32::try_from(column).unwrap_or(u32::MAX),
    });
    problem
}

/// Writes a document as Qt does: each tag on a line, `indent` spaces for each level.
pub fn write(element: &Element<'_>, indent: usize) -> String {
    let mut text = String::new();
    put(&mut text, element, indent, 0);
    text
}

fn put(text: &mut String, element: &Element<'_>, indent: usize, level: usize) {
    text.extend(std::iter::repeat_n(' ', indent * level));
    text.push('<');
    text.push_str(&element.name);
    for (name, value) in &element.attributes {
        text.push(' ');
        text.push_str(name);
        text.push_str("=\"");
        escape(text, value);
        text.push('"');
    }
    if element.nodes.is_empty() {
        text.push_str("/>\n");
        return;
    }
    text.push('>');
    // Spaces beside text would become part of it.
    let is_text = |node: &Node<'_>| matches!(node, Node::Text(_));
    let is_mixed = element.nodes.iter().any(is_text);
    let inner = if is_mixed { 0 } else { indent };
    if !is_mixed {
        text.push('\n');
    }
    for node in &element.nodes {
        match node {
            Node::Element(inside) => put(text, inside, inner, level + 1),
            Node::Text(inside) => escape(text, inside),
            Node::Comment(inside) => {
                text.extend(std::iter::repeat_n(' ', inner * (level + 1)));
                text.push_str("<!--");
                text.push_str(inside);
                text.push_str("-->");
                if !is_mixed {
                    text.push('\n');
                }
            }
        }
        if is_mixed && text.ends_with('\n') && matches!(node, Node::Element(_)) {
            text.pop();
        }
    }
    if !is_mixed {
        text.extend(std::iter::repeat_n(' ', indent * level));
    }
    text.push_str("</");
    text.push_str(&element.name);
    text.push_str(">\n");
}

fn escape(text: &mut String, value: &str) {
    for c in value.chars() {
        match c {
            '<' => text.push_str("&lt;"),
            '>' => text.push_str("&gt;"),
            '&' => text.push_str("&amp;"),
            '"' => text.push_str("&quot;"),
            '\n' => text.push_str("&#xa;"),
            '\r' => text.push_str("&#xd;"),
            '\t' => text.push_str("&#x9;"),
            _ => text.push(c),
        }
    }
}

#[cfg(test)]
mod tests;
