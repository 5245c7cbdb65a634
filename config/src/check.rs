//! From plain values to a checked configuration: groups, names, nodes and the links between them.
//!
//! Owns the rules about names and the order in which nodes are built (a node that reads another needs its size first).
//! The fields of one description are the submodules' business. Runs no Lua.

mod fields;
mod node;
mod params;
mod regulator;
mod setup;
mod several;
mod source;
mod stages;

use crate::description::{Alias, Config, NodeDescription, SetupAction, SourceDescription};
use crate::fields::extended;
use crate::format::Format;
use crate::limits::{GROUP_DEPTH_MAX, LINKS_MAX, NAME_BYTES_MAX, NODES_MAX};
use crate::nearest::{nearest, suggestion};
use crate::problem::Problem;
use crate::search::Search;
use crate::source::kind::Delivery;
use crate::texts::Texts;
use crate::value::{Key, Table, Value, Values};
use fields::NodeFields;
use std::collections::HashMap;

/// Names at the top that belong to the filesystem.
const RESERVED_NODES: [&str; 4] = ["config", "log", "status", "stop"];
/// Names in a node that belong to the filesystem; `value0`, `value1` ... as well.
const RESERVED_ATTRIBUTES: [&str; 11] = [
    "bin_data", "device", "fault", "format", "owner", "params", "poll_ms", "stages", "stats",
    "units", "value",
];

/// Checks everything that a program left. Gives the configuration and what is suspicious in it.
///
/// # Errors
/// The first problem, in the order of the paths.
pub(crate) fn check(
    values: &Values,
    texts: &Texts,
    search: &Search,
) -> Result<(Config, Vec<Problem>), Problem> {
    let mut checker = Checker {
        values,
        texts,
        search,
        drafts: Vec::new(),
        index: HashMap::new(),
        warnings: Vec::new(),
        aliases: Vec::new(),
        trail: Vec::new(),
    };
    checker.root()?;
    for number in 0..checker.drafts.len() {
        checker.build(number, 0)?;
    }
    checker.check_aliases()?;
    let setup = checker.setup()?;
    Ok(checker.finish(setup))
}

/// A node or attribute that was found and is not built yet.
struct Draft<'a> {
    /// Path below the mount point.
    path: String,
    /// Keys in the text, from `trikfs` on.
    keys: Vec<String>,
    table: &'a Table,
    /// The node that an attribute belongs to.
    parent: Option<usize>,
    built: Built,
    /// Known when it is built.
    delivery: Delivery,
}

/// How far a draft is.
enum Built {
    Not,
    /// Another node's size is being asked for.
    Under,
    Done(Box<NodeDescription>),
}

struct Checker<'a> {
    values: &'a Values,
    texts: &'a Texts,
    search: &'a Search,
    drafts: Vec<Draft<'a>>,
    /// Number of each draft by its path.
    index: HashMap<String, usize>,
    warnings: Vec<Problem>,
    /// Second names, with the keys in the text.
    aliases: Vec<(Alias, Vec<String>)>,
    /// Paths of the nodes that are being built, each because the one before reads it.
    trail: Vec<String>,
}

impl<'a> Checker<'a> {
    /// A problem at the place of a key.
    fn problem(&self, keys: &[String], reason: String) -> Problem {
        let keys: Vec<&str> = keys.iter().map(String::as_str).collect();
        let place = self.texts.place(&keys);
        Problem::new(place.file, place.line, reason)
    }

    fn root(&mut self) -> Result<(), Problem> {
        let keys = vec!["trikfs".to_owned()];
        match &self.values.root {
            None => Err(self.problem(&[], "the program must leave a global table 'trikfs'".into())),
            Some(value) => match self.values.table(value) {
                Some(table)
                    if table
                        .get("src")
                        .is_some_and(|v| self.values.table(v).is_none()) =>
                {
                    Err(self.problem(
                        &keys,
                        "'trikfs' is the table of all nodes and cannot be a node itself".into(),
                    ))
                }
                Some(table) => self.group("", &keys, table),
                None => Err(self.problem(
                    &keys,
                    format!("'trikfs' must be a table, not {}", value.describe()),
                )),
            },
        }
    }

    /// Walks the entries of a group; `path` is empty at the top.
    fn group(&mut self, path: &str, keys: &[String], table: &'a Table) -> Result<(), Problem> {
        if keys.len() > GROUP_DEPTH_MAX + 1 {
            return Err(self.problem(
                keys,
                format!("{path}: groups are nested more than {GROUP_DEPTH_MAX} deep"),
            ));
        }
        if table.entries.is_empty() && !path.is_empty() {
            let warning = self.problem(keys, format!("{path}: the group is empty"));
            self.warnings.push(warning);
        }
        for (key, value) in &table.entries {
            let name = self.name(path, keys, key)?;
            if path.is_empty() && RESERVED_NODES.contains(&name.as_str()) {
                let reason =
                    format!("'{name}' is a file of the filesystem itself and cannot be a node");
                return Err(self.problem(&extended(keys, &name), reason));
            }
            let path = if path.is_empty() {
                name.clone()
            } else {
                format!("{path}/{name}")
            };
            let keys = extended(keys, &name);
            let Some(table) = self.values.table(value) else {
                return Err(self.stray(&path, &keys, &name, value));
            };
            if table.get("src").is_some() && !self.is_group_with_node_called_src(table) {
                self.node(path, keys, table, None)?;
            } else if let Some(Value::Text(node)) = table.get("alias") {
                let node = String::from_utf8_lossy(node).into_owned();
                self.alias(Alias { path, node }, keys, table)?;
            } else if let Some(known) = node::FIELDS.iter().find(|known| table.get(known).is_some())
            {
                let hint = table_hint(table);
                let reason = format!(
                    "{path}: 'src' is missing, and '{known}' makes no sense in a group{hint}"
                );
                return Err(self.problem(&keys, reason));
            } else {
                self.group(&path, &keys, table)?;
            }
        }
        Ok(())
    }

    /// A group may hold a node that is called `src`: then all its entries are tables with a `src` or groups of their own.
    fn is_group_with_node_called_src(&self, table: &Table) -> bool {
        let inner = table.get("src").and_then(|value| self.values.table(value));
        inner.is_some_and(|inner| inner.get("src").is_some() && inner.get("").is_none())
    }

    /// A value that is no table stands where a node or group belongs.
    fn stray(&self, path: &str, keys: &[String], name: &str, value: &Value) -> Problem {
        let hint = suggestion(name, ["src"]);
        self.problem(
            keys,
            format!(
                "{path}: {} stands where a node or a group belongs{hint}",
                value.describe()
            ),
        )
    }

    /// Takes note of a node or attribute, and of a node's attributes.
    fn node(
        &mut self,
        path: String,
        keys: Vec<String>,
        table: &'a Table,
        parent: Option<usize>,
    ) -> Result<(), Problem> {
        let number = self.drafts.len();
        if number == NODES_MAX {
            return Err(self.problem(&keys, format!("more than {NODES_MAX} nodes and attributes")));
        }
        self.index.insert(path.clone(), number);
        self.drafts.push(Draft {
            path: path.clone(),
            keys: keys.clone(),
            table,
            parent,
            built: Built::Not,
            delivery: Delivery::Unknown,
        });
        let Some(value) = table.get("attributes") else {
            return Ok(());
        };
        let keys = extended(&keys, "attributes");
        if parent.is_some() {
            return Err(self.problem(&keys, format!("{path}: an attribute has no attributes")));
        }
        let Some(attributes) = self.values.table(value) else {
            return Err(self.problem(
                &keys,
                format!(
                    "{path}: attributes must be a table, not {}",
                    value.describe()
                ),
            ));
        };
        for (key, value) in &attributes.entries {
            let name = self.name(&path, &keys, key)?;
            let keys = extended(&keys, &name);
            if is_reserved_attribute(&name) {
                let reason =
                    format!("{path}: '{name}' is a file of every node and cannot be an attribute");
                return Err(self.problem(&keys, reason));
            }
            let path = format!("{path}/{name}");
            match self.values.table(value) {
                Some(table) if table.get("src").is_some() => {
                    self.node(path, keys, table, Some(number))?
                }
                Some(table) => {
                    let hint = table_hint(table);
                    return Err(self.problem(&keys, format!("{path}: 'src' is missing{hint}")));
                }
                None => return Err(self.stray(&path, &keys, &name, value)),
            }
        }
        Ok(())
    }

    /// A key that can be a file name.
    fn name(&self, path: &str, keys: &[String], key: &Key) -> Result<String, Problem> {
        let place = if path.is_empty() { "trikfs" } else { path };
        let bytes = match key {
            Key::Text(bytes) => bytes,
            Key::Number(number) => {
                let reason = format!(
                    "{place}: names are strings, but there is an entry with the number {number}"
                );
                return Err(self.problem(keys, reason));
            }
            Key::Other(kind) => {
                return Err(self.problem(
                    keys,
                    format!("{place}: names are strings, but a key is a {kind}"),
                ));
            }
        };
        let shown: String = String::from_utf8_lossy(bytes)
            .chars()
            .take(64)
            .flat_map(char::escape_debug)
            .collect();
        let name = std::str::from_utf8(bytes)
            .map_err(|_| "is not UTF-8".to_owned())
            .and_then(|name| match name {
                "" => Err("is empty".to_owned()),
                "." | ".." => Err("is taken by every folder".to_owned()),
                _ if name.contains('/') => Err("contains a slash".to_owned()),
                _ if name.chars().any(char::is_control) => {
                    Err("contains a control character".to_owned())
                }
                _ if name.len() > NAME_BYTES_MAX => {
                    Err(format!("has more than {NAME_BYTES_MAX} bytes"))
                }
                _ => Ok(name.to_owned()),
            });
        name.map_err(|reason| {
            let keys = extended(keys, &String::from_utf8_lossy(bytes));
            self.problem(&keys, format!("{place}: the name '{shown}' {reason}"))
        })
    }

    /// Builds a draft, and before it those that it reads.
    fn build(&mut self, number: usize, depth: usize) -> Result<(), Problem> {
        let Some(draft) = self.drafts.get_mut(number) else {
            return Ok(());
        };
        if matches!(draft.built, Built::Done(_)) {
            return Ok(());
        }
        let (path, keys, table) = (draft.path.clone(), draft.keys.clone(), draft.table);
        let under = matches!(draft.built, Built::Under);
        draft.built = Built::Under;
        if under {
            let start = self.trail.iter().position(|at| *at == path).unwrap_or(0);
            let circle = self.trail[start..].join(" -> ");
            let reason = format!("{path}: the node reads itself in a circle: {circle} -> {path}");
            return Err(self.problem(&extended(&keys, "src"), reason));
        }
        if depth > LINKS_MAX {
            return Err(self.problem(
                &keys,
                format!("{path}: more than {LINKS_MAX} nodes read each other in a row"),
            ));
        }
        self.trail.push(path.clone());
        let description = NodeFields::new(self, path, keys, table, depth).description()?;
        self.trail.pop();
        let delivery = self.delivery(&description.source);
        if let Some(draft) = self.drafts.get_mut(number) {
            draft.delivery = delivery;
            draft.built = Built::Done(Box::new(description));
        }
        Ok(())
    }

    /// Bytes of the converted tuple of another node, for `trikfs:OTHER`.
    fn size_of_node(&mut self, other: &str, depth: usize) -> Result<Option<usize>, Problem> {
        let Some(number) = self.index.get(other).copied() else {
            return Ok(None);
        };
        self.build(number, depth + 1)?;
        Ok(self
            .drafts
            .get(number)
            .and_then(|draft| match &draft.built {
                Built::Done(description) => Some(description.output_tuple_size),
                _ => None,
            }))
    }

    /// Takes note of a second name.
    fn alias(&mut self, alias: Alias, keys: Vec<String>, table: &Table) -> Result<(), Problem> {
        let Alias { path, node } = &alias;
        if table.entries.len() > 1 {
            let reason = format!(
                "{path}: with 'alias' there is nothing else to say: the files are those of '{node}'"
            );
            return Err(self.problem(&keys, reason));
        }
        if self.aliases.len() == NODES_MAX {
            return Err(self.problem(&keys, format!("more than {NODES_MAX} second names")));
        }
        self.aliases.push((alias, keys));
        Ok(())
    }

    /// Every second name stands for a node; attributes, groups and other second names have none.
    fn check_aliases(&self) -> Result<(), Problem> {
        for (Alias { path, node }, keys) in &self.aliases {
            let number = self.index.get(node).copied();
            match number.and_then(|number| self.drafts.get(number)) {
                Some(draft) if draft.parent.is_none() => {}
                Some(_) => {
                    let reason =
                        format!("{path}: '{node}' is an attribute and can have no second name");
                    return Err(self.problem(keys, reason));
                }
                None if self.aliases.iter().any(|(other, _)| other.path == *node) => {
                    let reason = format!(
                        "{path}: '{node}' is a second name itself; name the node that it stands for"
                    );
                    return Err(self.problem(keys, reason));
                }
                None => {
                    let hint = self.nearest_node(node);
                    let reason = format!("{path}: there is no node '{node}'{hint}");
                    return Err(self.problem(keys, reason));
                }
            }
        }
        Ok(())
    }

    /// How tuples come out of a source. The nodes that it reads have been built.
    fn delivery(&self, source: &SourceDescription) -> Delivery {
        source.delivery(&|path| self.delivery_of_node(path))
    }

    /// How the tuples of a node come out. That was found out when it was built, so that nobody walks through all that it
    /// reads.
    fn delivery_of_node(&self, path: &str) -> Delivery {
        let number = self.index.get(path).copied();
        let draft = number.and_then(|number| self.drafts.get(number));
        draft.map_or(Delivery::Unknown, |draft| draft.delivery)
    }

    /// True if what another node gives can also be written to it. It has been built.
    fn takes_tuples(&self, other: &str) -> bool {
        self.built(other).is_some_and(|node| {
            node.mode & 0o222 != 0 && node.written_tuple_size() == node.output_tuple_size
        })
    }

    /// A node that is built already.
    fn built(&self, path: &str) -> Option<&NodeDescription> {
        match &self.drafts.get(*self.index.get(path)?)?.built {
            Built::Done(description) => Some(description),
            _ => None,
        }
    }

    /// The format of a node that is built already, single bytes if it gave none.
    fn format_of_node(&self, other: &str) -> Option<Format> {
        let description = self.built(other)?;
        let format = description.format.clone();
        Some(format.unwrap_or_else(|| Format::bytes(description.output_tuple_size)))
    }

    /// The existing path that a wrong one was probably meant to be.
    fn nearest_node(&self, wrong: &str) -> String {
        if let Some((alias, _)) = self.aliases.iter().find(|(one, _)| one.path == wrong) {
            return format!(": it is a second name; write '{}'", alias.node);
        }
        nearest(wrong, self.index.keys().map(String::as_str))
            .map_or_else(String::new, |n| format!(", did you mean '{n}'"))
    }

    /// Puts the attributes into their nodes.
    fn finish(self, setup: Vec<SetupAction>) -> (Config, Vec<Problem>) {
        let mut attributes: HashMap<usize, Vec<NodeDescription>> = HashMap::new();
        let mut nodes = Vec::new();
        for (number, draft) in self.drafts.into_iter().enumerate() {
            let Built::Done(description) = draft.built else {
                continue;
            };
            match draft.parent {
                Some(parent) => attributes.entry(parent).or_default().push(*description),
                None => nodes.push((number, *description)),
            }
        }
        let mut nodes: Vec<NodeDescription> = nodes
            .into_iter()
            .map(|(number, mut node)| {
                node.attributes = attributes.remove(&number).unwrap_or_default();
                node
            })
            .collect();
        nodes.sort_by(|a, b| a.path.cmp(&b.path));
        let mut aliases: Vec<Alias> = self.aliases.into_iter().map(|(alias, _)| alias).collect();
        aliases.sort_by(|a, b| a.path.cmp(&b.path));
        let config = Config {
            nodes,
            setup,
            aliases,
        };
        (config, self.warnings)
    }
}

/// Names in a node's directory that the filesystem makes itself.
fn is_reserved_attribute(name: &str) -> bool {
    let numbered = name
        .strip_prefix("value")
        .is_some_and(|rest| rest.bytes().all(|byte| byte.is_ascii_digit()));
    RESERVED_ATTRIBUTES.contains(&name) || numbered
}

/// Points at a key that was probably meant to be `src`.
fn table_hint(table: &Table) -> String {
    let texts = table.entries.iter().filter_map(|(key, _)| match key {
        Key::Text(text) => std::str::from_utf8(text).ok(),
        _ => None,
    });
    let wrong = texts
        .filter(|name| !node::FIELDS.contains(name))
        .find(|name| nearest(name, ["src"]).is_some());
    wrong.map_or_else(String::new, |name| format!(", is '{name}' a typing error"))
}

#[cfg(test)]
mod tests;
