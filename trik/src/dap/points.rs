//! Breakpoints as a client sets them: by lines, by names of subprograms and blocks, by ids, by variables.
//!
//! Owns which of them are set. A client always says all of one kind; what it does not say any more is taken away.

use crate::debug::listing::Listing;
use crate::debug::target::{Target, why_not};
use crate::error::Error;
use lang_diagram::debug::order::Order;
use lang_diagram::debug::{Breakpoint, Spot};
use serde_json::{Value, json};
use std::fmt;

/// How a client says where a breakpoint is.
#[derive(Clone, Copy, Debug, Eq, PartialEq)]
pub(super) enum Kind {
    /// A line of the text.
    Line,
    /// A subprogram, or all blocks of a type.
    Name,
    /// The id of a block.
    Id,
    /// A variable that changes.
    Variable,
}

/// A breakpoint that is set.
#[derive(Clone, Debug)]
struct Set {
    kind: Kind,
    number: u64,
    point: Breakpoint,
}

/// All that are set.
#[derive(Debug, Default)]
pub(super) struct Points {
    set: Vec<Set>,
    /// Whether errors in blocks stop the program.
    pub stops_at_errors: bool,
}

fn text(value: &Value, name: &str) -> Box<str> {
    let text = value.get(name).and_then(Value::as_str);
    // A breakpoint is an order of lines.
    text.unwrap_or_default()
        .replace(['\n', '\r'], " ")
        .trim()
        .into()
}

/// Why a breakpoint of a client is not set. Each is for the client's person to mend, or for the robot, which says why.
#[derive(Clone, Debug, Eq, PartialEq)]
enum Unset {
    /// What is said of hits is no number of them.
    Hits,
    /// There is no block where it should be.
    Nowhere(Kind),
    /// The debugger refuses it.
    Refused(String),
}

impl fmt::Display for Unset {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::Hits => "a number of hits is wanted, such as 5, >= 5 or > 5",
            Self::Nowhere(Kind::Line) => "this line has no block",
            Self::Nowhere(Kind::Name) => "there is no subprogram and no block of this name",
            Self::Nowhere(Kind::Id) => "there is no block with this id",
            Self::Nowhere(Kind::Variable) => "a name of a variable is wanted",
            Self::Refused(why) => why,
        })
    }
}

/// From which hit on a breakpoint stops: `5`, `>= 5`, `> 5`.
///
/// # Errors
/// It is something else.
fn hits(text: &str) -> Result<u32, Unset> {
    let (digits, more) = match text.trim().strip_prefix(">=") {
        Some(rest) => (rest, 0),
        None => match text.trim().strip_prefix('>') {
            Some(rest) => (rest, 1),
            None => (text, 0),
        },
    };
    match digits.trim() {
        "" => Ok(0),
        digits => {
            let hits: Result<u32, _> = digits.parse();
            hits.map(|hits| hits.saturating_add(more))
                .map_err(|_| Unset::Hits)
        }
    }
}

impl Points {
    /// Sets all of a kind as a client says; for each what has become of it.
    pub fn set(
        &mut self,
        kind: Kind,
        wanted: &[Value],
        listing: &Listing,
        target: &mut dyn Target,
    ) -> Result<Value, Error> {
        let (gone, kept) = std::mem::take(&mut self.set)
            .into_iter()
            .partition(|set| set.kind == kind);
        self.set = kept;
        let gone: Vec<Set> = gone;
        for set in gone {
            if let Ok(number) = u32::try_from(set.number) {
                target.order(&Order::Clear(Some(number)))?;
            }
        }
        let mut told = Vec::new();
        for one in wanted {
            told.push(self.add(kind, one, listing, target)?);
        }
        Ok(json!({ "breakpoints": told }))
    }

    fn add(
        &mut self,
        kind: Kind,
        one: &Value,
        listing: &Listing,
        target: &mut dyn Target,
    ) -> Result<Value, Error> {
        let line = one.get("line").and_then(Value::as_u64);
        let line = line
            .and_then(|line| usize::try_from(line).ok())
            .unwrap_or(0);
        let refused = |why: &Unset| {
            let why = why.to_string();
            json!({"verified": false, "message": why, "line": line.max(1)})
        };
        let from_hit = match hits(&text(one, "hitCondition")) {
            Ok(hits) => hits,
            Err(why) => return Ok(refused(&why)),
        };
        let before = |blocks: Vec<Box<str>>| blocks.into_iter().map(Spot::Block).collect();
        let spots: Vec<Spot> = match kind {
            Kind::Line => before(listing.blocks(line).first().cloned().into_iter().collect()),
            Kind::Name => before(listing.named(&text(one, "name"))),
            Kind::Id => {
                let id = text(one, "instructionReference");
                before(listing.has(&id).then_some(id).into_iter().collect())
            }
            Kind::Variable => {
                let name = text(one, "dataId");
                let name = (!name.is_empty()).then_some(name);
                name.map(Spot::Change).into_iter().collect()
            }
        };
        let mut first = None;
        for spot in spots {
            let point = Breakpoint {
                at: spot.clone(),
                condition: text(one, "condition"),
                from_hit,
                log: text(one, "logMessage"),
                ..Breakpoint::default()
            };
            let answer = target.order(&Order::Break(point.clone()))?;
            if let Some(why) = why_not(&answer) {
                return Ok(refused(&Unset::Refused(why)));
            }
            let number = answer.get("number").and_then(Value::as_u64).unwrap_or(0);
            self.set.push(Set {
                kind,
                number,
                point,
            });
            let line = match &spot {
                Spot::Block(block) => Some(listing.line_of(block)),
                Spot::Change(_) => None,
            };
            first.get_or_insert((number, line));
        }
        Ok(match first {
            Some((number, None)) => json!({"id": number, "verified": true}),
            Some((number, Some(line))) => json!({"id": number, "verified": true, "line": line}),
            None => refused(&Unset::Nowhere(kind)),
        })
    }

    /// Sets all again, for a program that has begun anew; what is to be told of those that cannot be set any more.
    pub fn set_again(&mut self, target: &mut dyn Target) -> Result<Vec<Value>, Error> {
        let mut told = Vec::new();
        for set in &mut self.set {
            let answer = target.order(&Order::Break(set.point.clone()))?;
            if let Some(why) = why_not(&answer) {
                told.push(json!({"id": set.number, "verified": false, "message": why}));
            }
            set.number = answer.get("number").and_then(Value::as_u64).unwrap_or(0);
        }
        Ok(told)
    }

    /// Where those of blocks are in another text.
    pub fn places(&self, listing: &Listing) -> Vec<Value> {
        let places = self.set.iter().filter_map(|set| match &set.point.at {
            Spot::Block(block) if listing.has(block) => {
                let line = listing.line_of(block);
                Some(json!({"id": set.number, "verified": true, "line": line}))
            }
            Spot::Block(_) => {
                let why = "the new version has no such block";
                Some(json!({"id": set.number, "verified": false, "message": why}))
            }
            Spot::Change(_) => None,
        });
        places.collect()
    }
}
