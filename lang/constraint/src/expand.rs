//! Templates put in: `use` and tags named like templates are replaced by what the templates say.
//!
//! Owns declarations of templates, substitution and its limits. Knows no meaning of what is put in.
//!
//! A body is text: `#{name}` stands for a parameter, and parameters are put in from the last to the first, so that one may
//! mention those before it. A template that stands in itself is an error, also by way of others. The tag `typeof` is a
//! value of the language, and so the template of that name is used by `use` only.

use std::borrow::Cow;
use std::collections::BTreeMap;

use super::library::LIBRARY;
use super::words;
use crate::limits;
use lang_text::problem::{Place, Problem, Severity, Words, keep};
use lang_text::xml::{self, Element, Node};

/// Tags of the language, in lower case: no template takes one away.
const LANGUAGE: [&str; 48] = [
    "abs",
    "bool",
    "boundingrect",
    "condition",
    "conditions",
    "constraint",
    "difference",
    "distance",
    "double",
    "drop",
    "dropped",
    "equals",
    "event",
    "fail",
    "greater",
    "init",
    "initialization",
    "inside",
    "int",
    "less",
    "log",
    "max",
    "message",
    "min",
    "minus",
    "mul",
    "not",
    "notequal",
    "notgreater",
    "notless",
    "objectstate",
    "replace",
    "return",
    "setstate",
    "settedup",
    "setter",
    "setup",
    "string",
    "success",
    "sum",
    "timelimit",
    "timer",
    "trigger",
    "triggers",
    "true",
    "typeof",
    "using",
    "variablevalue",
];

/// Prefixes of tags that are templates: those of the library and those of the field.
const PREFIXES: [&str; 2] = ["ts:", "u:"];

#[derive(Debug)]
struct Template {
    /// Names and defaults, in the order of the text.
    params: Vec<(String, Option<String>)>,
    body: String,
}

/// Constraints with all templates put in; `None` if there are none to put in.
pub(super) fn expand(
    constraints: &Element<'_>,
    others: Option<&Element<'_>>,
) -> Result<Option<Element<'static>>, Vec<Problem>> {
    let library = xml::parse(LIBRARY).map_err(|problem| vec![problem])?;
    let mut expander = Expander::default();
    // Cheap words first: most fields use no templates.
    let declares = constraints.elements().any(is_declaration);
    if !declares && !mentions(constraints, &names(&library, others)) {
        return Ok(None);
    }
    expander.declare_all(&library);
    if let Some(others) = others {
        expander.declare_all(others);
    }
    for declared in constraints.elements().filter(|one| is_declaration(one)) {
        expander.declare_all(declared);
    }
    let mut expanded = Element::new(constraints.name.clone().into_owned());
    if expander.problems.is_empty() {
        expander.nodes(constraints, &mut expanded, 0);
    }
    if expander.problems.is_empty() {
        Ok(Some(expanded))
    } else {
        Err(expander.problems)
    }
}

fn is_declaration(element: &Element<'_>) -> bool {
    element.name.eq_ignore_ascii_case("templates")
}

fn names<'a>(library: &'a Element<'_>, others: Option<&'a Element<'_>>) -> Vec<&'a str> {
    let all = library
        .elements()
        .chain(others.into_iter().flat_map(Element::elements));
    all.filter_map(|template| template.attribute("name"))
        .collect()
}

/// Whether a template may be used in a tag.
fn mentions(element: &Element<'_>, names: &[&str]) -> bool {
    element.elements().any(|inside| {
        let name = &*inside.name;
        name == "use"
            || PREFIXES.iter().any(|prefix| name.starts_with(prefix))
            || (names.contains(&name) && !is_language(name))
            || mentions(inside, names)
    })
}

fn is_language(tag: &str) -> bool {
    LANGUAGE.contains(&tag.to_ascii_lowercase().as_str())
}

#[derive(Default)]
struct Expander {
    templates: BTreeMap<String, Template>,
    problems: Vec<Problem>,
    /// Templates that are being put in, each in the one before.
    chain: Vec<String>,
    tags: usize,
    bytes: usize,
}

impl Expander {
    fn error(&mut self, block: String, words: Words) {
        let words = if self.chain.is_empty() {
            words
        } else {
            words::chain(&words, &self.chain.join(" -> "))
        };
        let problem = Problem {
            severity: Severity::Error,
            place: Place {
                block: Some(block),
                ..Place::default()
            },
            words,
        };
        keep(&mut self.problems, problem);
    }

    fn declare_all(&mut self, templates: &Element<'_>) {
        for template in templates.elements() {
            if !template.name.eq_ignore_ascii_case("template") {
                self.error(
                    "templates".to_owned(),
                    words::not_a_template(&template.name),
                );
                continue;
            }
            let Some(name) = template.attribute("name").filter(|name| !name.is_empty()) else {
                self.error("templates".to_owned(), words::nameless_template());
                continue;
            };
            if self.templates.contains_key(name) {
                self.error(format!("template '{name}'"), words::template_twice(name));
                continue;
            }
            match declared(name, template) {
                Ok(template) => {
                    self.templates.insert(name.to_owned(), template);
                }
                Err(words) => self.error(format!("template '{name}'"), words),
            }
        }
    }

    /// Copies what is in a tag, with templates put in.
    fn nodes(&mut self, from: &Element<'_>, into: &mut Element<'static>, depth: usize) {
        if depth > limits::CONSTRAINT_DEPTH_MAX {
            self.error(from.name.to_string(), words::too_deep());
            return;
        }
        for node in &from.nodes {
            match node {
                Node::Comment(text) => into.nodes.push(Node::Comment(owned(text))),
                Node::Text(text) => into.nodes.push(Node::Text(owned(text))),
                Node::Element(element) if depth == 0 && is_declaration(element) => {}
                Node::Element(element) => self.element(element, into, depth),
            }
        }
    }

    fn element(&mut self, element: &Element<'_>, into: &mut Element<'static>, depth: usize) {
        self.tags += 1;
        if self.tags > limits::CONSTRAINT_TAGS_MAX {
            if self.tags == limits::CONSTRAINT_TAGS_MAX + 1 {
                self.error(element.name.to_string(), words::too_many_tags());
            }
            return;
        }
        let Some(name) = self.used(element) else {
            let mut copy = Element::new(element.name.clone().into_owned());
            let attributes = element.attributes.iter();
            copy.attributes = attributes
                .map(|(name, value)| (owned(name), owned(value)))
                .collect();
            self.nodes(element, &mut copy, depth + 1);
            into.nodes.push(Node::Element(copy));
            return;
        };
        match self.substituted(&name, element) {
            Ok(text) => {
                self.chain.push(name.clone());
                self.put_in(&name, &text, into, depth);
                self.chain.pop();
            }
            Err(words) => {
                let place = format!("{} '{name}'", element.name);
                self.error(place, words);
            }
        }
    }

    /// The name of the template that a tag uses.
    fn used(&self, element: &Element<'_>) -> Option<String> {
        let name = &*element.name;
        if name == "use" {
            return Some(element.attribute("template").unwrap_or_default().to_owned());
        }
        let is_ours = self.templates.contains_key(name) && !is_language(name);
        let has_prefix = PREFIXES.iter().any(|prefix| name.starts_with(prefix));
        (is_ours || has_prefix).then(|| name.to_owned())
    }

    fn put_in(&mut self, name: &str, text: &str, into: &mut Element<'static>, depth: usize) {
        let wrapped = format!("<root>{text}</root>");
        match xml::parse(&wrapped) {
            Ok(root) => {
                for element in root.elements() {
                    self.element(element, into, depth);
                }
            }
            Err(problem) => {
                let mut words = problem.words.clone();
                if let Some(at) = problem.place.position {
                    let at = format!("{}:{} ", at.line, at.column);
                    words.english.insert_str(0, &at);
                    words.russian.insert_str(0, &at);
                }
                self.error(format!("template '{name}'"), words::not_xml(name, &words));
            }
        }
    }

    /// The body of a template with the parameters of a use.
    fn substituted(&mut self, name: &str, usage: &Element<'_>) -> Result<String, Words> {
        if name.is_empty() {
            return Err(words::nameless_use());
        }
        let plain = PREFIXES
            .iter()
            .find_map(|prefix| name.strip_prefix(prefix))
            .unwrap_or(name);
        let is_same =
            |one: &String| one.trim_start_matches("ts:").trim_start_matches("u:") == plain;
        if self.chain.iter().any(is_same) || self.chain.len() >= limits::TEMPLATE_DEPTH_MAX {
            return Err(words::recursive(&format!(
                "{} -> {name}",
                self.chain.join(" -> ")
            )));
        }
        let template = self
            .templates
            .get(plain)
            .ok_or_else(|| words::no_template(name))?;
        let given = given(name, template, usage)?;
        let mut text = template.body.clone();
        for (param, default) in template.params.iter().rev() {
            let value = given
                .get(param.as_str())
                .map(Cow::as_ref)
                .or(default.as_deref());
            let value = value.ok_or_else(|| words::missing_param(name, param))?;
            let place = format!("#{{{param}}}");
            let grown = text.matches(&place).count().saturating_mul(value.len());
            if text.len().saturating_add(grown) > limits::TEMPLATE_TEXT_MAX {
                return Err(words::too_much_text());
            }
            text = text.replace(&place, value);
        }
        self.bytes = self.bytes.saturating_add(text.len());
        if self.bytes > limits::TEMPLATE_TEXT_MAX {
            return Err(words::too_much_text());
        }
        Ok(text)
    }
}

/// A template as it is declared.
fn declared(name: &str, element: &Element<'_>) -> Result<Template, Words> {
    let mut params: Vec<(String, Option<String>)> = Vec::new();
    for param in element
        .child("params")
        .into_iter()
        .flat_map(Element::elements)
    {
        if param.name != "param" {
            return Err(words::not_a_param(name, &param.name));
        }
        let found = param.attribute("name").filter(|name| !name.is_empty());
        let found = found.ok_or_else(|| words::nameless_param(name))?;
        let default = match param.attribute("default") {
            Some(text) => Some(text.to_owned()),
            None => (!param.nodes.is_empty()).then(|| content(param)),
        };
        params.push((found.to_owned(), default));
    }
    let body = element
        .child("content")
        .ok_or_else(|| words::no_content(name))?;
    let body = match &body.nodes[..] {
        [Node::Text(text)] => text.to_string(),
        _ => content(body),
    };
    for (_, rest) in body
        .match_indices("#{")
        .map(|(at, _)| body.split_at(at + 2))
    {
        if let Some((param, _)) = rest.split_once('}')
            && !params.iter().any(|(known, _)| known == param)
            && !param.contains(['\n', '<'])
        {
            return Err(words::undeclared(name, param));
        }
    }
    Ok(Template { params, body })
}

/// The parameters that a use gives.
fn given<'e>(
    name: &str,
    template: &Template,
    usage: &'e Element<'_>,
) -> Result<BTreeMap<&'e str, Cow<'e, str>>, Words> {
    let mut given = BTreeMap::new();
    let mut put = |param: &'e str, value: Cow<'e, str>| {
        if !template.params.iter().any(|(known, _)| known == param) {
            return Err(words::unknown_param(name, param));
        }
        given.insert(param, value);
        Ok(())
    };
    for (param, value) in &usage.attributes {
        if param != "template" {
            put(param, Cow::Borrowed(value))?;
        }
    }
    for with in usage.elements() {
        if !with.name.eq_ignore_ascii_case("with") {
            return Err(words::not_with());
        }
        if let Some(param) = with.attribute("param") {
            put(param, Cow::Owned(content(with)))?;
            continue;
        }
        for (param, value) in &with.attributes {
            put(param, Cow::Borrowed(value))?;
        }
    }
    Ok(given)
}

/// What is in a tag, as text.
fn content(element: &Element<'_>) -> String {
    let mut bare = Element::new("x");
    bare.nodes = element.nodes.clone();
    let text = xml::write(&bare, 0);
    let inside = text
        .strip_prefix("<x>")
        .and_then(|text| text.strip_suffix("</x>\n"));
    inside.unwrap_or_default().trim_matches('\n').to_owned()
}

fn owned(text: &str) -> Cow<'static, str> {
    Cow::Owned(text.to_owned())
}
