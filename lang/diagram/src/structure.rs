//! Structural analysis: arrows between blocks become loops and branches.
//!
//! Owns the graph of one thread and the order of attempts. Knows no block by its type, only how many ways it has.
//!
//! In turn: conditions that share a target become `and` and `or`; loops with several entries get one by copying
//! blocks; what is left is walked along its dominators, and a place that two branches share and neither reaches last is
//! written twice. If copies would grow beyond a limit, or branches nest too deeply, the program becomes a loop over a
//! variable that says where it is. So every graph has a program.

mod conditions;
mod emit;
mod flow;
mod follow;
mod shape;
mod split;
mod states;
mod work;

#[cfg(test)]
#[allow(clippy::wildcard_enum_match_arm)]
mod tests;

use super::tree::Tree;

/// How control leaves a block.
#[derive(Clone, Debug, Eq, PartialEq)]
pub enum Exit {
    /// Not at all: the program ends here.
    End,
    /// To one block.
    Step(usize),
    /// To the first if it holds, else to the second.
    Test(usize, usize),
    /// To one of several, by number.
    Switch(Vec<usize>),
}

/// The blocks of one thread.
#[derive(Clone, Debug)]
pub struct Graph {
    /// All blocks; those that cannot be reached are left out of the program.
    pub ways: Vec<Exit>,
    /// Where it begins.
    pub entry: usize,
}

/// Which jumps the target language has.
#[derive(Clone, Copy, Debug, Default, Eq, PartialEq)]
pub enum Jumps {
    /// Breaks out of the innermost loop.
    #[default]
    Plain,
    /// Breaks out of outer loops too.
    Labelled,
    /// `goto` to places in what is around.
    Goto,
}

/// How a program came about.
#[derive(Clone, Copy, Debug, Eq, PartialEq)]
pub enum Manner {
    /// Each block once.
    Exact,
    /// Some blocks several times.
    Copied,
    /// A loop over a variable that says where the program is.
    States,
}

/// A structured program.
#[derive(Clone, Debug)]
pub struct Structured {
    /// Its statements.
    pub body: Vec<Tree>,
    /// How it came about.
    pub manner: Manner,
    /// How many variables of the analysis it has, from 0.
    pub variables: usize,
}

/// The program that visits the same blocks in the same order as the graph. Ways to blocks that do not exist end it.
pub fn structure(graph: &Graph, jumps: Jumps) -> Structured {
    let Some(mut work) = work::Work::new(graph) else {
        return Structured {
            body: Vec::new(),
            manner: Manner::Exact,
            variables: 0,
        };
    };
    let plain = work.clone();
    match analyse(&mut work, jumps) {
        Some((body, variables)) => {
            let body = shape::shape(body);
            let manner = if shape::has_copies(&body) {
                Manner::Copied
            } else {
                Manner::Exact
            };
            Structured {
                body,
                manner,
                variables,
            }
        }
        None => Structured {
            body: states::states(&plain),
            manner: Manner::States,
            variables: 1,
        },
    }
}

fn analyse(work: &mut work::Work, jumps: Jumps) -> Option<(Vec<Tree>, usize)> {
    split::split(work, work.len())?;
    let flow = flow::Flow::new(work)?;
    conditions::merge(work, &flow);
    let flow = flow::Flow::new(work)?;
    emit::emit(work, &flow, jumps)
}

/// The program as a loop over a variable that says where it is, whatever the graph: for languages that cannot leave
/// a loop or end a function in the middle. Ends stand last in their branches.
pub fn by_states(graph: &Graph) -> Structured {
    Structured {
        body: work::Work::new(graph).map_or_else(Vec::new, |work| states::states(&work)),
        manner: Manner::States,
        variables: 1,
    }
}
