//! Programs with loops and branches instead of arrows: what structural analysis makes and printers print.
//!
//! Owns the shape of such a program. Knows blocks as numbers only: what a block does is known to who prints it.

/// A condition made of blocks that decide between two ways, evaluated from left to right and no further than needed.
#[derive(Clone, Debug, Eq, PartialEq)]
pub enum Condition {
    /// The block of this number takes its first way.
    Test(usize),
    /// The opposite.
    Not(Box<Condition>),
    /// Both.
    And(Box<Condition>, Box<Condition>),
    /// At least one.
    Or(Box<Condition>, Box<Condition>),
}

/// One statement; blocks are numbers of the graph that was analysed.
#[derive(Clone, Debug, Eq, PartialEq)]
pub enum Tree {
    /// A block with one way out.
    Step(usize),
    /// Two branches.
    If {
        /// What decides.
        when: Condition,
        /// If it holds.
        yes: Vec<Tree>,
        /// If not.
        no: Vec<Tree>,
    },
    /// Many branches.
    Switch {
        /// The block that decides.
        on: usize,
        /// Ways of the block that lead to one place, and what is done there. All ways are named once.
        branches: Vec<(Vec<usize>, Vec<Tree>)>,
    },
    /// A loop without end, but for breaks.
    Loop {
        /// Its name for breaks.
        label: usize,
        /// What is repeated.
        body: Vec<Tree>,
    },
    /// A loop with the condition at its head.
    While {
        /// Its name for breaks.
        label: usize,
        /// Goes on while this holds.
        when: Condition,
        /// What is repeated.
        body: Vec<Tree>,
    },
    /// A loop with the condition at its foot. There is no [`Tree::Continue`] of it in the body.
    DoWhile {
        /// Its name for breaks.
        label: usize,
        /// What is repeated.
        body: Vec<Tree>,
        /// Goes on while this holds.
        when: Condition,
    },
    /// Leaves the loop of this label.
    Break(usize),
    /// Begins the loop of this label anew.
    Continue(usize),
    /// The end of the program, at this block.
    End(usize),
    /// A variable of the analysis gets a number.
    Set {
        /// Which variable.
        variable: usize,
        /// Its number.
        value: usize,
    },
    /// Branches by a variable of the analysis; without an arm for its number, nothing.
    Choice {
        /// Which variable.
        variable: usize,
        /// Numbers with what is done.
        arms: Vec<(usize, Vec<Tree>)>,
    },
    /// A jump, always forward or to the head of a loop around, never into a branch or loop.
    Goto(usize),
    /// Where a jump goes.
    Label(usize),
}

impl Condition {
    /// The opposite, without doubled negations.
    pub fn negated(self) -> Self {
        match self {
            Self::Not(inner) => *inner,
            other @ (Self::Test(_) | Self::And(..) | Self::Or(..)) => Self::Not(Box::new(other)),
        }
    }

    /// Calls `seen` for each block, from left to right.
    pub fn tests(&self, seen: &mut dyn FnMut(usize)) {
        match self {
            Self::Test(block) => seen(*block),
            Self::Not(inner) => inner.tests(seen),
            Self::And(left, right) | Self::Or(left, right) => {
                left.tests(seen);
                right.tests(seen);
            }
        }
    }

    /// How many blocks.
    pub fn size(&self) -> usize {
        let mut size = 0;
        self.tests(&mut |_| size += 1);
        size
    }

    /// The condition when `holds` tells what each block decides; asked from left to right, no further than needed.
    pub fn decide<E>(&self, holds: &mut dyn FnMut(usize) -> Result<bool, E>) -> Result<bool, E> {
        match self {
            Self::Test(block) => holds(*block),
            Self::Not(inner) => Ok(!inner.decide(holds)?),
            Self::And(left, right) => Ok(left.decide(holds)? && right.decide(holds)?),
            Self::Or(left, right) => Ok(left.decide(holds)? || right.decide(holds)?),
        }
    }
}

impl Tree {
    /// The lists of statements inside.
    pub fn parts(&self) -> Vec<&[Tree]> {
        match self {
            Self::If { yes, no, .. } => vec![yes, no],
            Self::Switch { branches, .. } => branches.iter().map(|(_, body)| &body[..]).collect(),
            Self::Choice { arms, .. } => arms.iter().map(|(_, body)| &body[..]).collect(),
            Self::Loop { body, .. } | Self::While { body, .. } | Self::DoWhile { body, .. } => {
                vec![body]
            }
            Self::Step(_)
            | Self::Break(_)
            | Self::Continue(_)
            | Self::End(_)
            | Self::Set { .. }
            | Self::Goto(_)
            | Self::Label(_) => Vec::new(),
        }
    }

    /// Whether nothing that follows it is reached.
    pub fn leaves(&self) -> bool {
        match self {
            Self::Break(_) | Self::Continue(_) | Self::End(_) | Self::Goto(_) => true,
            Self::If { yes, no, .. } => leave(yes) && leave(no),
            Self::Switch { branches, .. } => branches.iter().all(|(_, body)| leave(body)),
            Self::Loop { label, body } => !body.iter().any(|part| part.breaks(*label)),
            Self::Step(_)
            | Self::While { .. }
            | Self::DoWhile { .. }
            | Self::Set { .. }
            | Self::Choice { .. }
            | Self::Label(_) => false,
        }
    }

    /// Whether a break of this loop is inside.
    pub fn breaks(&self, label: usize) -> bool {
        *self == Self::Break(label) || self.has(&mut |part| *part == Self::Break(label))
    }

    /// Whether one of the statements inside, itself not counted, is as asked.
    pub fn has(&self, asked: &mut dyn FnMut(&Tree) -> bool) -> bool {
        let parts = self.parts();
        parts
            .into_iter()
            .flatten()
            .any(|part| asked(part) || part.has(asked))
    }
}

/// Whether the end of a list is never reached.
pub fn leave(list: &[Tree]) -> bool {
    list.last().is_some_and(Tree::leaves)
}

/// How many statements there are in all.
pub fn size(list: &[Tree]) -> usize {
    let parts = list.iter().flat_map(Tree::parts);
    list.len() + parts.map(size).sum::<usize>()
}
