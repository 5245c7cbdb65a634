//! Blocks of other kits: known by name, so that a message can say whose they are.
//!
//! Owns names only; nothing here runs.

/// A kit that is not TRIK's.
#[derive(Clone, Copy, Debug, Eq, PartialEq)]
pub enum Other {
    /// Lego Mindstorms EV3.
    Ev3,
    /// Lego Mindstorms NXT.
    Nxt,
    /// The quadcopter Pioneer.
    Pioneer,
    /// TRIK's first controllers, before V6.
    TrikV4,
}

impl Other {
    /// Its name for people.
    pub fn name(self) -> &'static str {
        match self {
            Self::Ev3 => "EV3",
            Self::Nxt => "NXT",
            Self::Pioneer => "Pioneer",
            Self::TrikV4 => "TRIK V4",
        }
    }
}

/// Beginnings of type names.
const BEGINNINGS: &[(&str, Other)] = &[
    ("Ev3", Other::Ev3),
    ("Nxt", Other::Nxt),
    ("Pioneer", Other::Pioneer),
    ("Geo", Other::Pioneer),
    ("GoTo", Other::Pioneer),
    ("TrikV4", Other::TrikV4),
];

/// The kit of a type name and the rest of it in words: `EnginesForward` of `Ev3EnginesForward`.
pub fn find(kind: &str) -> Option<(Other, &str)> {
    let (beginning, kit) = BEGINNINGS
        .iter()
        .find(|(beginning, _)| kind.starts_with(beginning))?;
    let rest = match *beginning {
        "Geo" | "GoTo" => kind,
        beginning => &kind[beginning.len()..],
    };
    (!rest.is_empty()).then_some((*kit, rest))
}
