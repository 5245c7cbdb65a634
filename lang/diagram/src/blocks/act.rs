//! What a block that tells a device something does, in every part that asks: the machine, the generators and the tests.
//!
//! Owns the shape of one such row; the rows stand beside their blocks, in `actions`, `core` and `drawing`. Knows neither
//! expressions nor languages: the machine and the generators evaluate what a row names.

use crate::brick::Command;

/// What a block tells a device.
#[derive(Clone, Copy, Debug)]
pub struct Act {
    /// What happens when the machine comes to the block.
    pub effect: Effect,
    /// How generated programs have it: the first row whose condition holds. Empty for motors and encoders, which every
    /// language has.
    pub phrases: &'static [Phrase],
    /// What messages of the generators call the block in Russian, if that is not its name in the palette.
    pub russian: &'static str,
    /// Whether a generated program is still one without it.
    pub is_dispensable: bool,
    /// Whether an empty expression counts as none.
    pub is_optional: bool,
    /// Whether its first flag makes the text a line of a program, which cannot be translated.
    pub may_be_code: bool,
    /// Whether numbers in its computed text have at most six decimals.
    pub is_label: bool,
}

/// What happens when the machine comes to a block.
#[derive(Clone, Copy, Debug)]
pub enum Effect {
    /// Power or angle to all ports of the list; a power of the expression, times 1 or -1.
    Drive(i32),
    /// All motors of the list off.
    Stop,
    /// Encoders to 0; the flow goes on after the present events.
    ResetEncoders,
    /// One command, made of the evaluated properties.
    Command(fn(Operands<'_>) -> Command<'_>),
}

/// The properties of a block, evaluated, in the order of its row.
#[derive(Clone, Copy, Debug)]
pub struct Operands<'a> {
    /// Expressions that give whole numbers; missing ones are 0.
    pub wholes: [i32; WHOLES_MAX],
    /// How many of them there are.
    pub count: usize,
    /// The text that stands as it is; empty if there is none.
    pub written: &'a str,
    /// The computed text, or the one that stands as it is.
    pub text: &'a str,
    /// Whether the computed text is one that nobody has set.
    pub is_unset: bool,
    /// Plain numbers.
    pub numbers: &'a [i32],
    /// Flags, without `Evaluate` and `Redraw`.
    pub flags: &'a [bool],
}

/// How many whole numbers a block has at most.
pub const WHOLES_MAX: usize = 6;

/// Height of letters in pixels when a block asks for none.
pub const FONT_SIZE: i32 = 20;

impl<'a> Operands<'a> {
    /// The first whole numbers.
    pub fn first<const N: usize>(self) -> [i32; N] {
        std::array::from_fn(|at| self.wholes.get(at).copied().unwrap_or(0))
    }

    /// A plain number; 0 if there is none.
    pub fn number(self, at: usize) -> i32 {
        self.numbers.get(at).copied().unwrap_or(0)
    }

    /// A flag; false if there is none.
    pub fn flag(self, at: usize) -> bool {
        self.flags.get(at).copied().unwrap_or(false)
    }

    /// A label with the size that the block asks for.
    pub fn label(self) -> Command<'a> {
        let [x, y, size] = self.first();
        Command::Label {
            x,
            y,
            size: if size > 0 { size } else { FONT_SIZE },
            text: self.text,
        }
    }
}

/// How a command is written in the languages of the generators; an empty text: the language cannot do it. `$1` and so on
/// stand for the operands.
#[derive(Clone, Copy, Debug, Eq, PartialEq)]
pub struct Phrase {
    /// When this row holds.
    pub when: When,
    /// What `$1` and so on are.
    pub operands: &'static [Operand],
    /// In JavaScript.
    pub javascript: &'static str,
    /// In Python.
    pub python: &'static str,
    /// In Lua.
    pub lua: &'static str,
    /// In C.
    pub c: &'static str,
    /// In the languages of .NET.
    pub dotnet: &'static str,
}

/// When a phrase holds.
#[derive(Clone, Copy, Debug, Eq, PartialEq)]
pub enum When {
    /// Always.
    Always,
    /// If the block has this choice.
    Choice(&'static str),
    /// If no whole number is given.
    NoWhole,
}

/// A property as an operand of a phrase.
#[derive(Clone, Copy, Debug, Eq, PartialEq)]
pub enum Operand {
    /// A whole number by its place among them.
    Whole(usize),
    /// The whole number of a font's size.
    FontSize,
    /// The text that stands as it is.
    Written,
    /// The text that stands as it is, as a whole number.
    WrittenWhole,
    /// The computed text, or the one that stands as it is.
    Text,
    /// A plain number by its place among them.
    Number(usize),
    /// A flag by its place among them.
    Flag(usize),
}

impl Act {
    /// One command.
    pub(super) const fn command(
        command: fn(Operands<'_>) -> Command<'_>,
        phrases: &'static [Phrase],
    ) -> Self {
        Self::of(Effect::Command(command)).phrases(phrases)
    }

    /// An effect that is no single command.
    pub(super) const fn of(effect: Effect) -> Self {
        Self {
            effect,
            phrases: &[],
            russian: "",
            is_dispensable: false,
            is_optional: false,
            may_be_code: false,
            is_label: false,
        }
    }

    const fn phrases(self, phrases: &'static [Phrase]) -> Self {
        Self { phrases, ..self }
    }

    /// With a name of its own for messages of the generators.
    pub(super) const fn russian(self, russian: &'static str) -> Self {
        Self { russian, ..self }
    }

    /// Left out where a language has no words for it.
    pub(super) const fn dispensable(self) -> Self {
        Self {
            is_dispensable: true,
            ..self
        }
    }
}

/// A phrase that every script of the controller has.
pub(crate) const fn script(operands: &'static [Operand], text: &'static str) -> Phrase {
    Phrase {
        when: When::Always,
        operands,
        javascript: text,
        python: text,
        lua: "",
        c: "",
        dotnet: "",
    }
}

impl Phrase {
    /// The same for one choice.
    pub(super) const fn on(self, choice: &'static str) -> Self {
        let when = When::Choice(choice);
        Self { when, ..self }
    }

    /// The same for programs over the tree: Lua and C.
    pub(crate) const fn tree(self, text: &'static str) -> Self {
        Self {
            lua: text,
            c: text,
            ..self
        }
    }

    /// The same with other words in Python.
    pub(super) const fn python(self, python: &'static str) -> Self {
        Self { python, ..self }
    }

    /// The same for .NET.
    pub(crate) const fn dotnet(self, dotnet: &'static str) -> Self {
        Self { dotnet, ..self }
    }
}
