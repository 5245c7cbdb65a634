//! XML as a tree with raw names, read within limits and written as Qt writes it.
//!
//! Owns the tree and how it is written; `read` makes it from text. Knows no meaning of tags. Names are kept as they
//! stand, because saves have the tag `qReal::Id`, which no parser with namespaces accepts.

use crate::escape::entity;
use crate::problem::Problem;
use std::borrow::Cow;

mod read;
mod words;

pub use read::parse;

/// A tag with what is in it.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Element<'a> {
    /// Its name, colons included.
    pub name: Cow<'a, str>,
    /// Names and values, in the order of the text.
    pub attributes: Vec<(Cow<'a, str>, Cow<'a, str>)>,
    /// What stands between its beginning and its end.
    pub nodes: Vec<Node<'a>>,
    /// Where it began in the text that it was read from.
    pub start: Start,
}

/// Bytes of a text before a tag; 0 for a tag that was made. Two tags that differ in nothing else are the same tag.
#[derive(Clone, Copy, Debug, Default)]
pub struct Start(pub u32);

impl PartialEq for Start {
    fn eq(&self, _: &Self) -> bool {
        true
    }
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

    /// The same without the text that it was read from.
    pub fn into_owned(self) -> Element<'static> {
        let owned = |text: Cow<'a, str>| Cow::Owned(text.into_owned());
        Element {
            name: owned(self.name),
            attributes: self
                .attributes
                .into_iter()
                .map(|(name, value)| (owned(name), owned(value)))
                .collect(),
            nodes: self
                .nodes
                .into_iter()
                .map(|node| match node {
                    Node::Element(element) => Node::Element(element.into_owned()),
                    Node::Text(text) => Node::Text(owned(text)),
                    Node::Comment(text) => Node::Comment(owned(text)),
                })
                .collect(),
            start: self.start,
        }
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

/// Whether a document could not be read because it ends before its tags do.
pub fn is_cut_short(problem: &Problem) -> bool {
    problem.words == words::unfinished()
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
            '\n' => text.push_str("&#xa;"),
            '\r' => text.push_str("&#xd;"),
            '\t' => text.push_str("&#x9;"),
            c => match entity(c) {
                Some(entity) => text.push_str(entity),
                None => text.push(c),
            },
        }
    }
}

#[cfg(test)]
mod tests;
