//! The languages of converters.
//!
//! Owns their names. Knows nothing of what is written in them.

/// What a program is written as.
#[derive(Clone, Copy, Debug, Eq, Hash, PartialEq)]
pub enum Target {
    /// A module in Lua for the global `dataflow` of configurations.
    Lua,
    /// A library for `trikfs_converter.h`.
    C,
}

impl Target {
    /// All of them.
    pub const ALL: [Self; 2] = [Self::Lua, Self::C];

    /// Its name for people.
    pub fn name(self) -> &'static str {
        match self {
            Self::Lua => "Lua",
            Self::C => "C",
        }
    }

    /// The ending of its files, without a point.
    pub fn ending(self) -> &'static str {
        match self {
            Self::Lua => "lua",
            Self::C => "c",
        }
    }

    /// The target of a name as a person types it, in any case.
    pub fn named(name: &str) -> Option<Self> {
        let mut all = Self::ALL.into_iter();
        all.find(|target| target.ending().eq_ignore_ascii_case(name))
    }
}
