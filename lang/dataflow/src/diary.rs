//! What happens in a running program, for recordings: which blocks react, and the last token of each port that gives one.
//!
//! Owns how much of it is kept and told, and its form, which `docs/protocol.md` describes. A program that nobody records has
//! none. Knows no clock and no files.

use crate::limits;
use crate::machine::trace::Trace;
use crate::program::{Node, NodeId, Program};
use lang_diagram::debug::report::kind;
use lang_expr::Value;
use lang_text::json::{Object, quoted};
use std::collections::VecDeque;

/// Hears a machine, and tells what is new.
#[derive(Clone, Debug)]
pub struct Diary {
    blocks: Vec<Block>,
    /// Of all blocks, one after the other.
    ports: Vec<Output>,
    /// Blocks with something that was not told, the first first.
    news: VecDeque<NodeId>,
    others: Others,
    /// Counts begin with what is told next.
    is_anew: bool,
    /// Bytes that may be told now, and when that was so.
    bytes: usize,
    told_at: u32,
}

#[derive(Clone, Copy, Debug)]
struct Block {
    reacted: u32,
    /// Where its ports begin.
    ports: usize,
    is_news: bool,
    /// When its name was told.
    named_at: Option<u32>,
}

/// What a port has given.
#[derive(Clone, Debug, Default)]
struct Output {
    count: u32,
    is_news: bool,
    last: Last,
}

#[derive(Clone, Debug, Default)]
enum Last {
    #[default]
    Nothing,
    Token(Value),
    /// Of a long one what is told.
    Long(Box<(&'static str, Shown)>),
}

/// What happened at blocks that are too many.
#[derive(Clone, Copy, Debug, Default)]
struct Others {
    reactions: u32,
    tokens: u32,
    is_news: bool,
}

impl Diary {
    /// For what happens in this program from now on.
    pub fn new(program: &Program) -> Self {
        let mut ports = 0;
        let nodes = program.nodes.iter().take(limits::DIARY_BLOCKS_MAX);
        let blocks = nodes
            .map(|node| {
                let first = ports;
                ports += node.outs.len();
                Block {
                    reacted: 0,
                    ports: first,
                    is_news: false,
                    named_at: None,
                }
            })
            .collect();
        Self {
            blocks,
            ports: vec![Output::default(); ports],
            news: VecDeque::new(),
            others: Others::default(),
            is_anew: true,
            bytes: limits::DIARY_BYTES_MAX,
            told_at: 0,
        }
    }

    /// Whether something was not told yet.
    pub fn has_news(&self) -> bool {
        !self.news.is_empty() || self.others.is_news
    }

    /// Everything that is known is told again, for somebody who has missed some of it.
    pub fn tell_again(&mut self) {
        self.news.clear();
        for id in (0..).take(self.blocks.len()) {
            let [from, to] = span(&self.blocks, self.ports.len(), id);
            let block = &mut self.blocks[id as usize];
            block.named_at = None;
            block.is_news = block.reacted > 0;
            for output in &mut self.ports[from..to] {
                output.is_news = output.count > 0;
                block.is_news |= output.is_news;
            }
            if block.is_news {
                self.news.push_back(id);
            }
        }
        self.others.is_news = self.others.reactions > 0 || self.others.tokens > 0;
    }

    /// The next telling is the last one: it may be as long as any.
    pub fn is_last(&mut self) {
        self.bytes = limits::DIARY_BYTES_MAX;
    }

    /// Tells what is new, as members of an object; what is too much is told later, and counted now.
    pub fn tell(&mut self, mut told: Object, program: &Program, now: u32) -> Object {
        let passed = now.saturating_sub(self.told_at) as usize;
        let more = passed.saturating_mul(limits::DIARY_BYTES_PER_MS);
        self.bytes = self.bytes.saturating_add(more).min(limits::DIARY_BYTES_MAX);
        self.told_at = now;
        if std::mem::take(&mut self.is_anew) {
            told = told.plain("anew", true);
        }
        let mut blocks = Vec::new();
        while self.bytes > 0
            && let Some(&id) = self.news.front()
        {
            let (text, is_named) = self.block(program, id, now);
            if text.len() > self.bytes && !blocks.is_empty() {
                break;
            }
            self.news.pop_front();
            self.settle(id, is_named.then_some(now));
            self.bytes = self.bytes.saturating_sub(text.len());
            blocks.push(text);
        }
        told = told.list("blocks", blocks);
        if !self.news.is_empty() {
            told = told.plain("blocks_left_out", self.news.len());
        }
        if std::mem::take(&mut self.others.is_news) {
            let others = object().plain("reacted", self.others.reactions);
            told = told.plain("others", others.plain("tokens", self.others.tokens).done());
        }
        told
    }

    /// What is new at a block, and whether its name is told with it.
    fn block(&self, program: &Program, id: NodeId, now: u32) -> (String, bool) {
        let [from, to] = span(&self.blocks, self.ports.len(), id);
        let block = &self.blocks[id as usize];
        let node = program.node(id);
        // Readers compare it.
        let whole = quoted(&node.id, limits::SOURCE_ID_BYTES_MAX);
        let mut told = object().plain("id", whole);
        if node.instance > 0 {
            told = told.plain("instance", node.instance);
        }
        let is_known = |at: u32| now.saturating_sub(at) < limits::DIARY_NAMES_MS;
        let is_named = !block.named_at.is_some_and(is_known);
        if is_named {
            let instance = &program.instances[node.instance as usize];
            told = told
                .text("diagram", &instance.name)
                .text("block", node.row.element)
                .text("caption", &node.caption);
        }
        if block.reacted > 0 {
            told = told.plain("reacted", block.reacted);
        }
        let ports = (0..).zip(&self.ports[from..to]);
        let ports: Vec<String> = ports
            .filter(|(_, output)| output.is_news)
            .map(|(port, output)| output.tell(node, port))
            .collect();
        let told = match ports.is_empty() {
            true => told.done(),
            false => told.list("ports", ports).done(),
        };
        (told, is_named)
    }

    /// It is told.
    fn settle(&mut self, id: NodeId, named_at: Option<u32>) {
        let [from, to] = span(&self.blocks, self.ports.len(), id);
        let block = &mut self.blocks[id as usize];
        block.is_news = false;
        block.named_at = named_at.or(block.named_at);
        for output in &mut self.ports[from..to] {
            output.is_news = false;
        }
    }

    /// Something is new at a block: where its ports begin; `None`: it is one too many.
    #[inline]
    fn touch(&mut self, id: NodeId) -> Option<&mut Block> {
        let block = self.blocks.get_mut(id as usize)?;
        if !block.is_news {
            block.is_news = true;
            self.news.push_back(id);
        }
        Some(block)
    }
}

impl Trace for Diary {
    fn sent(&mut self, _now: u32, from: NodeId, port: u8, value: &Value) {
        let Some(first) = self.touch(from).map(|block| block.ports) else {
            self.others.tokens = self.others.tokens.saturating_add(1);
            self.others.is_news = true;
            return;
        };
        if let Some(output) = self.ports.get_mut(first + usize::from(port)) {
            output.count = output.count.saturating_add(1);
            output.is_news = true;
            output.last = match value.cells() > limits::TAP_CELLS_MAX {
                true => Last::Long(Box::new((kind(value), Shown::of(value)))),
                false => Last::Token(value.clone()),
            };
        }
    }

    fn fired(&mut self, _now: u32, node: NodeId) {
        if let Some(block) = self.touch(node) {
            block.reacted = block.reacted.saturating_add(1);
        } else {
            self.others.reactions = self.others.reactions.saturating_add(1);
            self.others.is_news = true;
        }
    }
}

impl Output {
    fn tell(&self, node: &Node, port: u8) -> String {
        let told = object().text("port", node.port_name(port));
        let told = match &self.last {
            Last::Nothing => told,
            Last::Token(value) => Shown::of(value).put(kind(value), told),
            Last::Long(long) => long.1.put(long.0, told),
        };
        told.plain("count", self.count).done()
    }
}

/// A token as it is told.
#[derive(Clone, Debug)]
struct Shown {
    text: String,
    /// If that is not all of it: how many bytes or items it has.
    whole: Option<(&'static str, usize)>,
}

impl Shown {
    fn of(value: &Value) -> Self {
        match value {
            Value::Nil | Value::Unset | Value::Bool(_) | Value::Int(_) | Value::Float(_) => Self {
                text: value.brief(),
                whole: None,
            },
            Value::Text(text) => match text.char_indices().nth(limits::DIARY_CHARACTERS_MAX) {
                Some((end, _)) => Self {
                    text: text[..end].to_owned(),
                    whole: Some(("bytes", text.len())),
                },
                None => Self {
                    text: text.to_string(),
                    whole: None,
                },
            },
            Value::List(list) => Self::of_list(list.items()),
        }
    }

    /// As [`Value::brief`] has it, without looking at all of a long one.
    fn of_list(items: &[Value]) -> Self {
        let mut text = "[".to_owned();
        for (index, item) in items.iter().enumerate() {
            if text.len() > limits::DIARY_CHARACTERS_MAX {
                let whole = Some(("items", items.len()));
                return Self { text, whole };
            }
            if index > 0 {
                text.push_str(", ");
            }
            match item {
                Value::List(_) => text.push_str("[...]"),
                Value::Nil
                | Value::Unset
                | Value::Bool(_)
                | Value::Int(_)
                | Value::Float(_)
                | Value::Text(_) => text.push_str(&Self::of(item).text),
            }
        }
        text.push(']');
        let is_cut = text.chars().count() > limits::DIARY_CHARACTERS_MAX;
        Self {
            text,
            whole: is_cut.then_some(("items", items.len())),
        }
    }

    fn put(&self, kind: &str, told: Object) -> Object {
        let told = told.text("type", kind).text("value", &self.text);
        match self.whole {
            Some((name, size)) => told.plain(name, size),
            None => told,
        }
    }
}

/// Where the ports of a block begin, and end.
fn span(blocks: &[Block], ports: usize, id: NodeId) -> [usize; 2] {
    let at = |id: usize| blocks.get(id).map_or(ports, |block| block.ports);
    [at(id as usize), at(id as usize + 1)]
}

/// An object without members.
fn object() -> Object {
    Object::new(limits::DIARY_CHARACTERS_MAX)
}

#[cfg(test)]
mod tests;
