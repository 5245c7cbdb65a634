//! Templates put in: `use` and tags named like templates are replaced by what the templates say.
//!
//! Owns declarations of templates, their name spaces, substitution and its limits. Knows no meaning of what is put in.
//!
//! A body is text: `#{name}` stands for a parameter, and parameters are put in from the last to the first, so that one may
//! mention those before it. A template that stands in itself is an error, also by way of others. In the present release
//! names have prefixes, `ts:` those of the library and `u:` those of the save; constraints that use none of these are of an
//! older release, whose names stand alone and whose library is another one. There the tag `typeof` is a value of the
//! language, and so the template of that name is used by `use` only.
//!
//! Tags are gone through from the last to the first, and the first error is the only one, as in the original.

use std::borrow::Cow;
use std::collections::BTreeMap;

use super::former::FORMER;
use super::library::LIBRARY;
use super::lint::words as near;
use super::words;
use crate::limits;
use lang_text::near::nearest;
use lang_text::problem::{Place, Problem, Severity, Words, keep};
use lang_text::xml::{self, Element, Node, Start};

/// Tags of the language, in lower case: no template takes one away.
pub(super) const LANGUAGE: [&str; 48] = [
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

/// Prefixes of names: those of the library and those of the save.
const PREFIXES: [&str; 2] = [SYSTEM, USER];
const SYSTEM: &str = "ts:";
const USER: &str = "u:";

#[derive(Debug)]
struct Template {
    /// Names and defaults, in the order of the text.
    params: Vec<(String, Option<String>)>,
    body: String,
}

/// What has become of constraints.
pub(super) struct Expanded {
    /// With all templates put in; `None` if there are none to put in.
    pub constraints: Option<Element<'static>>,
    /// What is wrong with templates of the save: they are left out, and the rest works.
    pub faults: Vec<Problem>,
}

/// Puts templates in: those of the library, those that the texts of a save declare, and those that the constraints do.
///
/// # Errors
/// What is wrong with templates of the save, and with the first use that is wrong.
pub(super) fn expand(constraints: &Element<'_>, files: &[&str]) -> Result<Expanded, Vec<Problem>> {
    let mut expander = Expander {
        has_plain_names: !uses_prefixes(constraints),
        ..Expander::default()
    };
    for text in files {
        expander.file(text);
    }
    let faults = std::mem::take(&mut expander.problems);
    let parsed = |text| xml::parse(text).map_err(|problem| vec![problem]);
    let (library, former) = (parsed(LIBRARY)?, parsed(FORMER)?);
    // Cheap words first: most fields use no templates.
    let names: Vec<&str> = expander.templates.keys().map(String::as_str).collect();
    let former_names = former.elements().filter_map(|one| one.attribute("name"));
    let names: Vec<&str> = names.into_iter().chain(former_names).collect();
    if !constraints.elements().any(is_declaration) && !mentions(constraints, &names) {
        return Ok(Expanded {
            constraints: None,
            faults,
        });
    }
    expander.declare_library(&library, SYSTEM);
    if expander.has_plain_names {
        expander.declare_library(&former, "");
    }
    for declared in constraints.elements().filter(|one| is_declaration(one)) {
        expander.declare_all(declared, |_| 1, false);
    }
    let mut expanded = Element::new(constraints.name.clone().into_owned());
    expanded.start = constraints.start;
    if expander.problems.is_empty() {
        expanded.nodes = expander.nodes(constraints, 1, 0);
    }
    if expander.problems.is_empty() {
        Ok(Expanded {
            constraints: Some(expanded),
            faults,
        })
    } else {
        let mut all = faults;
        all.append(&mut expander.problems);
        Err(all)
    }
}

fn is_declaration(element: &Element<'_>) -> bool {
    element.name.eq_ignore_ascii_case("templates")
}

fn has_prefix(name: &str) -> bool {
    PREFIXES.iter().any(|prefix| name.starts_with(prefix))
}

/// Whether a tag in an element names a template of the present release.
fn uses_prefixes(element: &Element<'_>) -> bool {
    element.elements().any(|inside| {
        let used = inside.attribute("template").unwrap_or_default();
        has_prefix(&inside.name)
            || (inside.name == "use" && has_prefix(used))
            || uses_prefixes(inside)
    })
}

/// Whether a template may be used in a tag.
fn mentions(element: &Element<'_>, names: &[&str]) -> bool {
    element.elements().any(|inside| {
        let name = &*inside.name;
        name == "use"
            || has_prefix(name)
            || (names.contains(&name) && !is_language(name))
            || mentions(inside, names)
    })
}

fn is_language(tag: &str) -> bool {
    LANGUAGE.contains(&tag.to_ascii_lowercase().as_str())
}

/// How many lines an element takes where each tag has its own, as the original numbers them.
fn lines(element: &Element<'_>) -> usize {
    let inside: usize = element
        .nodes
        .iter()
        .map(|node| match node {
            Node::Element(element) => lines(element),
            Node::Comment(text) => 1 + text.matches('\n').count(),
            Node::Text(text) => text.matches('\n').count(),
        })
        .sum();
    match element.nodes.first() {
        None => 1,
        Some(Node::Text(_)) => 1 + inside,
        Some(Node::Element(_) | Node::Comment(_)) => 2 + inside,
    }
}

/// The line of a text in which something stands for the last time.
fn last_line(text: &str, what: &str) -> usize {
    let at = text.rfind(what).unwrap_or_default();
    1 + text[..at].matches('\n').count()
}

#[derive(Default)]
struct Expander {
    templates: BTreeMap<String, Template>,
    problems: Vec<Problem>,
    /// Templates that are being put in, each in the one before, with what their bodies have become.
    chain: Vec<(String, String)>,
    /// Whether names without a prefix are templates.
    has_plain_names: bool,
    /// Where the outermost use stands in the constraints: there everything stands that comes of it.
    at: Start,
    tags: usize,
    bytes: usize,
}

impl Expander {
    fn error(&mut self, block: String, words: Words) {
        let problem = Problem {
            severity: Severity::Error,
            place: Place {
                block: Some(block),
                offset: Some(self.at.0).filter(|&at| at > 0),
                ..Place::default()
            },
            words,
            hint: None,
        };
        keep(&mut self.problems, problem);
    }

    /// The first use that is wrong; no other follows it.
    fn fail(&mut self, block: String, tag: &str, line: usize, words: &Words) {
        let words = match self.chain.last() {
            None => words::in_constraints_line(words, line),
            Some((name, body)) => {
                words::in_body_line(words, last_line(body, &format!("<{tag}")), name)
            }
        };
        self.error(block.clone(), words::in_substitution(&words));
    }

    /// Where a use that is wrong stands in others.
    fn tell_chain(&mut self, block: String) {
        if !self.chain.is_empty() {
            let names: Vec<&str> = self.chain.iter().map(|(name, _)| name.as_str()).collect();
            let words = words::in_substitution(&words::chain(&names.join(" -> ")));
            self.error(block, words);
        }
    }

    /// Templates of a text of the save.
    fn file(&mut self, text: &str) {
        match xml::parse(text) {
            Ok(root) => {
                let starts: Vec<usize> = text
                    .match_indices("<template ")
                    .chain(text.match_indices("<template>"))
                    .map(|(at, _)| 1 + text[..at].matches('\n').count())
                    .collect();
                let mut starts = starts;
                starts.sort_unstable();
                self.declare_all(&root, |index| starts.get(index).copied().unwrap_or(1), true);
            }
            Err(problem) => keep(&mut self.problems, words::unread(problem)),
        }
    }

    fn declare_library(&mut self, library: &Element<'_>, prefix: &str) {
        for template in library.elements() {
            let name = template.attribute("name").unwrap_or_default();
            if let Ok(read) = declared(name, template, false) {
                self.templates.insert(format!("{prefix}{name}"), read);
            }
        }
    }

    fn declare_all(
        &mut self,
        templates: &Element<'_>,
        line: impl Fn(usize) -> usize,
        is_file: bool,
    ) {
        for (index, template) in templates.elements().enumerate() {
            let line = line(index);
            if let Err((block, words)) = self.declare(template, line, is_file) {
                self.error(block, words::in_template(&words));
            }
        }
    }

    fn declare(
        &mut self,
        template: &Element<'_>,
        line: usize,
        is_file: bool,
    ) -> Result<(), (String, Words)> {
        let outside = |words: Words| ("templates".to_owned(), words::line(&words, line));
        if !template.name.eq_ignore_ascii_case("template") {
            return Err(outside(words::not_a_template(&template.name)));
        }
        let name = template.attribute("name").filter(|name| !name.is_empty());
        let name = name.ok_or_else(|| outside(words::nameless_template()))?;
        let name = name.strip_prefix(USER).unwrap_or(name);
        let key = format!("{USER}{name}");
        if self.templates.contains_key(&key) {
            let words = words::line(&words::template_twice(name), line);
            return Err((format!("template '{name}'"), words));
        }
        let read = |is_file| {
            declared(name, template, is_file).map_err(|words| {
                let words = words::line_of_template(&words, line, name);
                (format!("template '{name}'"), words)
            })
        };
        self.templates.insert(key, read(is_file)?);
        if self.has_plain_names {
            self.templates.insert(name.to_owned(), read(is_file)?);
        }
        Ok(())
    }

    /// Copies of what is in a tag, with templates put in; the tag stands in a line of the constraints.
    fn nodes(&mut self, from: &Element<'_>, line: usize, depth: usize) -> Vec<Node<'static>> {
        if depth > limits::CONSTRAINT_DEPTH_MAX {
            self.error(from.name.to_string(), words::in_rules(&words::too_deep()));
            return Vec::new();
        }
        let mut starts = Vec::with_capacity(from.nodes.len());
        let mut next = line + 1;
        for node in &from.nodes {
            starts.push(next);
            next += match node {
                Node::Element(element) => lines(element),
                Node::Comment(_) | Node::Text(_) => 1,
            };
        }
        let mut copies: Vec<Node<'static>> = Vec::with_capacity(from.nodes.len());
        for (node, line) in from.nodes.iter().zip(starts).rev() {
            match node {
                Node::Comment(text) => copies.push(Node::Comment(owned(text))),
                Node::Text(text) => copies.push(Node::Text(owned(text))),
                Node::Element(element) if depth == 0 && is_declaration(element) => {}
                Node::Element(element) => self.element(element, line, depth, &mut copies),
            }
            if !self.problems.is_empty() {
                break;
            }
        }
        copies.reverse();
        copies
    }

    /// Adds the copy of a tag, or what a template makes of it, the last tag first.
    fn element(
        &mut self,
        element: &Element<'_>,
        line: usize,
        depth: usize,
        into: &mut Vec<Node<'static>>,
    ) {
        self.tags += 1;
        if self.tags > limits::CONSTRAINT_TAGS_MAX {
            self.error(
                element.name.to_string(),
                words::in_rules(&words::too_many_tags()),
            );
            return;
        }
        if self.chain.is_empty() {
            self.at = element.start;
        }
        let Some(name) = self.used(element) else {
            let mut copy = Element::new(element.name.clone().into_owned());
            let attributes = element.attributes.iter();
            copy.attributes = attributes
                .map(|(name, value)| (owned(name), owned(value)))
                .collect();
            copy.start = self.at;
            copy.nodes = self.nodes(element, line, depth + 1);
            into.push(Node::Element(copy));
            return;
        };
        match self.substituted(&name, element) {
            Ok(text) => {
                let root = format!("<root>{text}</root>");
                self.chain.push((name.clone(), text));
                match xml::parse(&root) {
                    Ok(root) => {
                        let inside: Vec<_> = root.elements().collect();
                        for element in inside.into_iter().rev() {
                            self.element(element, line, depth, into);
                            if !self.problems.is_empty() {
                                break;
                            }
                        }
                        self.chain.pop();
                    }
                    Err(problem) => {
                        self.chain.pop();
                        self.not_xml(&name, element, line, problem);
                    }
                }
            }
            Err(all) => {
                let block = format!("{} '{name}'", element.name);
                for words in &all {
                    self.fail(block.clone(), &element.name, line, words);
                }
                self.suggest(&name);
                self.tell_chain(block);
            }
        }
    }

    /// Adds to what was told last the template whose name is near to that of one that is not there.
    fn suggest(&mut self, name: &str) {
        if self.templates.contains_key(name) {
            return;
        }
        let known = self.templates.keys().map(String::as_str);
        if let Some(known) = nearest(name, known) {
            let told = self.problems.last_mut();
            told.into_iter()
                .for_each(|told| told.hint = Some(near::meant(known)));
        }
    }

    /// A body with its parameters is no XML; why it is not, the original does not say.
    fn not_xml(&mut self, name: &str, element: &Element<'_>, line: usize, mut problem: Problem) {
        let block = format!("template '{name}'");
        self.fail(block.clone(), &element.name, line, &words::not_xml(name));
        self.tell_chain(block.clone());
        problem.severity = Severity::Warning;
        problem.place.block = Some(block);
        keep(&mut self.problems, problem);
    }

    /// The name of the template that a tag uses.
    fn used(&self, element: &Element<'_>) -> Option<String> {
        let name = &*element.name;
        if name == "use" {
            return Some(element.attribute("template").unwrap_or_default().to_owned());
        }
        let is_plain = self.has_plain_names && self.templates.contains_key(name);
        (has_prefix(name) || is_plain && !is_language(name)).then(|| name.to_owned())
    }

    /// The body of a template with the parameters of a use.
    fn substituted(&mut self, name: &str, usage: &Element<'_>) -> Result<String, Vec<Words>> {
        if name.is_empty() {
            return Err(vec![words::nameless_use()]);
        }
        let is_inside = self.chain.iter().any(|(one, _)| one == name);
        if is_inside || self.chain.len() >= limits::TEMPLATE_DEPTH_MAX {
            let names: Vec<&str> = self.chain.iter().map(|(name, _)| name.as_str()).collect();
            let chain = format!("{} -> {name}", names.join(" -> "));
            return Err(vec![words::recursive(&chain)]);
        }
        let template = self
            .templates
            .get(name)
            .ok_or_else(|| vec![words::no_template(name)])?;
        let bare = PREFIXES
            .iter()
            .find_map(|prefix| name.strip_prefix(prefix))
            .unwrap_or(name);
        let given = given(bare, template, usage).map_err(|words| vec![words])?;
        let mut missing = Vec::new();
        let mut text = template.body.clone();
        for (param, default) in template.params.iter().rev() {
            let value = given
                .get(param.as_str())
                .map(Cow::as_ref)
                .or(default.as_deref());
            let Some(value) = value else {
                missing.push(words::missing_param(bare, param));
                continue;
            };
            let place = format!("#{{{param}}}");
            let grown = text.matches(&place).count().saturating_mul(value.len());
            if text.len().saturating_add(grown) > limits::TEMPLATE_TEXT_MAX {
                return Err(vec![words::too_much_text()]);
            }
            text = text.replace(&place, value);
        }
        if !missing.is_empty() {
            return Err(missing);
        }
        self.bytes = self.bytes.saturating_add(text.len());
        if self.bytes > limits::TEMPLATE_TEXT_MAX {
            return Err(vec![words::too_much_text()]);
        }
        Ok(text)
    }
}

/// A template as it is declared; in a text of a save its content is text alone.
fn declared(name: &str, element: &Element<'_>, is_file: bool) -> Result<Template, Words> {
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
        [] => String::new(),
        _ if is_file => return Err(words::no_text(name)),
        _ => content(body),
    };
    for (at, _) in body.match_indices("#{") {
        let rest = &body[at + 2..];
        if let Some((param, _)) = rest.split_once('}')
            && !params.iter().any(|(known, _)| known == param)
            && !param.contains(['\n', '<'])
        {
            let offset = body[..at].chars().count();
            return Err(words::undeclared(name, param, offset));
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
