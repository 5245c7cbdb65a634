//! Examples of blocks: what stands around one, what its robot says, and what the robot is told then. The tests run them.
//!
//! Owns the shape of an example. Every row has at least one.

/// One example of a block.
#[derive(Clone, Copy, Debug)]
pub struct Example {
    /// Properties that differ from their defaults.
    pub properties: &'static [(&'static str, &'static str)],
    /// The diagram, as words with blanks between them: chains `BLOCK > BLOCK =GUARD> BLOCK` with `;` between chains and
    /// `|` before the subprogram that the block calls. `*` is the block itself, `start` and `end` the two nodes, a word
    /// that begins with a capital is a type with at most one property, as `Timer:Delay=50`, and every other word is a
    /// statement. The same word is the same block.
    pub diagram: &'static str,
    /// What the robot says from some moment on, in milliseconds of the program.
    pub given: &'static [(u32, Stimulus)],
    /// What the robot is told, as a log has it.
    pub told: &'static [&'static str],
    /// When the program ends, in milliseconds, if the example shows that.
    pub end: Option<u32>,
}

/// Something that a robot says.
#[derive(Clone, Copy, Debug)]
pub enum Stimulus {
    /// The reading of a port with one number.
    Number(&'static str, i32),
    /// The reading of a port with several numbers.
    Numbers(&'static str, &'static [i32]),
    /// A message of another robot.
    Mail(&'static str),
    /// What a person answers.
    Answer(&'static str),
    /// The next random number.
    Random(i32),
}

/// What a block tells with these properties.
pub(super) const fn example(
    properties: &'static [(&'static str, &'static str)],
    told: &'static [&'static str],
) -> Example {
    within("start > * > end", properties, &[], told)
}

/// When the program goes on after a block with these properties.
pub(super) const fn waits(
    properties: &'static [(&'static str, &'static str)],
    given: &'static [(u32, Stimulus)],
    end: u32,
) -> Example {
    Example {
        end: Some(end),
        ..within("start > * > end", properties, given, &[])
    }
}

/// What a block does within another diagram.
pub(super) const fn within(
    diagram: &'static str,
    properties: &'static [(&'static str, &'static str)],
    given: &'static [(u32, Stimulus)],
    told: &'static [&'static str],
) -> Example {
    Example {
        properties,
        diagram,
        given,
        told,
        end: None,
    }
}
