//! Rules that are thrown by chance, and the text that a file has for them.
//!
//! Owns the shapes, how often each comes, and their form as XML. Knows nothing of what they mean.

use proptest::prelude::*;

/// Ids of events; the one of an event is that of its index. Their order is not that of any locale.
pub(super) const IDS: [&str; 8] = [
    "a",
    "\u{44f}",
    "Z",
    "on_success",
    "~",
    "9",
    "on_success2",
    "ab",
];
/// What nobody has declared.
pub(super) const GHOST: &str = "ghost";
pub(super) const VARIABLES: [&str; 3] = ["v", "w", "total_score"];
pub(super) const PROPERTIES: [&str; 5] = ["n", "d", "t", "b", "none"];
#[derive(Clone, Debug, PartialEq)]
pub(super) enum Plain {
    Null,
    Bool(bool),
    Int(i32),
    Double(f64),
    Text(&'static str),
}

#[derive(Clone, Debug)]
pub(super) enum Val {
    Plain(Plain),
    Variable(&'static str),
    State(&'static str, &'static str),
    Either(String),
    One(&'static str, Box<Val>),
    Two(&'static str, Box<[Val; 2]>),
}

#[derive(Clone, Debug)]
pub(super) enum Cond {
    True,
    Glue(bool, Vec<Cond>),
    Not(Box<Cond>),
    Compare(&'static str, Box<[Val; 2]>),
    Inside(&'static str),
    SettedUp(&'static str),
    Dropped(&'static str),
    Timer(i32, bool),
    Using(Vec<Trig>, Box<Cond>),
}

#[derive(Clone, Debug)]
pub(super) enum Trig {
    Fail,
    Success(bool),
    Say(&'static str, Vec<String>),
    Set(&'static str, Val),
    SetUp(&'static str),
    Drop(&'static str),
    SetState(&'static str, &'static str, Val),
}

#[derive(Clone, Debug)]
pub(super) struct Happening {
    pub initially: bool,
    pub drops: bool,
    pub condition: Cond,
    pub triggers: Vec<Trig>,
}

/// What the world does before a tick: where the robot goes, and what becomes of a property.
pub(super) type Change = (i32, &'static str, Plain);

pub(super) fn plain() -> impl Strategy<Value = Plain> {
    let texts = [
        "", "0", "false", "3", "-2", " 7 ", "1e2", "x1", "0x10", "abc", "ABC", "\u{44f}", "10", "9",
    ];
    prop_oneof![
        any::<bool>().prop_map(Plain::Bool),
        (-4..12).prop_map(Plain::Int),
        Just(Plain::Int(i32::MAX)),
        // Quarters, which are exact and far enough from each other.
        (-8..40).prop_map(|quarters| Plain::Double(f64::from(quarters) / 4.0)),
        prop::sample::select(texts.to_vec()).prop_map(Plain::Text),
    ]
}

pub(super) fn one_of(names: &'static [&'static str]) -> impl Strategy<Value = &'static str> {
    prop::sample::select(names)
}

fn id() -> impl Strategy<Value = &'static str> {
    prop_oneof![9 => one_of(&IDS), 1 => Just(GHOST)]
}

fn path() -> impl Strategy<Value = String> {
    prop_oneof![
        one_of(&VARIABLES).prop_map(str::to_owned),
        one_of(&PROPERTIES).prop_map(|property| format!("o.{property}")),
        Just("nobody.n".to_owned()),
    ]
}

fn val() -> impl Strategy<Value = Val> {
    let leaf = prop_oneof![
        3 => plain().prop_map(Val::Plain),
        2 => one_of(&VARIABLES).prop_map(Val::Variable),
        2 => one_of(&PROPERTIES).prop_map(|property| Val::State("o", property)),
        1 => Just(Val::State("nobody", "n")),
        2 => path().prop_map(Val::Either),
    ];
    leaf.prop_recursive(2, 6, 2, |inner| {
        prop_oneof![
            (one_of(&["minus", "abs"]), inner.clone())
                .prop_map(|(name, one)| Val::One(name, Box::new(one))),
            (
                one_of(&["sum", "difference", "mul", "min", "max"]),
                inner.clone(),
                inner
            )
                .prop_map(|(name, left, right)| Val::Two(name, Box::new([left, right]))),
        ]
    })
}

pub(super) fn trig() -> impl Strategy<Value = Trig> {
    prop_oneof![
        1 => Just(Trig::Fail),
        1 => any::<bool>().prop_map(Trig::Success),
        6 => (one_of(&["message", "log"]), prop::collection::vec(path(), 0..3))
            .prop_map(|(tag, paths)| Trig::Say(tag, paths)),
        4 => (one_of(&VARIABLES), val()).prop_map(|(name, value)| Trig::Set(name, value)),
        3 => id().prop_map(Trig::SetUp),
        2 => id().prop_map(Trig::Drop),
        2 => (one_of(&PROPERTIES), val()).prop_map(|(property, value)| Trig::SetState("o", property, value)),
    ]
}

fn cond() -> impl Strategy<Value = Cond> {
    let comparisons = one_of(&[
        "equals",
        "notEqual",
        "greater",
        "less",
        "notGreater",
        "notLess",
    ]);
    let leaf = prop_oneof![
        1 => Just(Cond::True),
        5 => (comparisons, val(), val())
            .prop_map(|(name, left, right)| Cond::Compare(name, Box::new([left, right]))),
        2 => one_of(&["center", "any", "all"]).prop_map(Cond::Inside),
        1 => id().prop_map(Cond::SettedUp),
        1 => id().prop_map(Cond::Dropped),
        3 => (-10..60, any::<bool>()).prop_map(|(ms, drops)| Cond::Timer(ms, drops)),
    ];
    leaf.prop_recursive(3, 8, 3, |inner| {
        let some = prop::collection::vec(inner.clone(), 1..3);
        let triggers = prop::collection::vec(trig(), 1..3);
        prop_oneof![
            3 => (any::<bool>(), some).prop_map(|(is_and, all)| Cond::Glue(is_and, all)),
            2 => inner.clone().prop_map(|one| Cond::Not(Box::new(one))),
            1 => (triggers, inner).prop_map(|(triggers, one)| Cond::Using(triggers, Box::new(one))),
        ]
    })
}

pub(super) fn happening() -> impl Strategy<Value = Happening> {
    let triggers = prop::collection::vec(trig(), 1..4);
    (any::<bool>(), any::<bool>(), cond(), triggers).prop_map(
        |(initially, drops, condition, triggers)| Happening {
            initially,
            drops,
            condition,
            triggers,
        },
    )
}

/// As the file has it.
trait Written {
    fn xml(&self) -> String;
}

impl Written for Val {
    fn xml(&self) -> String {
        match self {
            Self::Plain(Plain::Null) => "<variableValue name=\"never\"/>".to_owned(),
            Self::Plain(Plain::Bool(one)) => format!("<bool value=\"{one}\"/>"),
            Self::Plain(Plain::Int(one)) => format!("<int value=\"{one}\"/>"),
            Self::Plain(Plain::Double(one)) => format!("<double value=\"{one}\"/>"),
            Self::Plain(Plain::Text(one)) => format!("<string value=\"{one}\"/>"),
            Self::Variable(name) => format!("<variableValue name=\"{name}\"/>"),
            Self::State(object, property) => {
                format!("<objectState object=\"{object}.{property}\"/>")
            }
            // The short form is there for attributes alone: the lesser of one value is that value, as a whole number.
            Self::Either(path) => format!("<min _1=\"${{{path}}}\" _2=\"${{{path}}}\"/>"),
            Self::One(name, one) => format!("<{name}>{}</{name}>", one.xml()),
            Self::Two(name, two) => format!("<{name}>{}{}</{name}>", two[0].xml(), two[1].xml()),
        }
    }
}

impl Written for Cond {
    fn xml(&self) -> String {
        match self {
            Self::True => "<true/>".to_owned(),
            Self::Glue(is_and, all) => {
                let glue = if *is_and { "and" } else { "or" };
                format!("<conditions glue=\"{glue}\">{}</conditions>", together(all))
            }
            Self::Not(one) => format!("<not>{}</not>", one.xml()),
            Self::Compare(name, two) => {
                format!("<{name}>{}{}</{name}>", two[0].xml(), two[1].xml())
            }
            Self::Inside(point) => {
                format!("<inside objectId=\"robot1\" regionId=\"zone\" objectPoint=\"{point}\"/>")
            }
            Self::SettedUp(id) => format!("<settedUp id=\"{id}\"/>"),
            Self::Dropped(id) => format!("<dropped id=\"{id}\"/>"),
            Self::Timer(ms, drops) => {
                format!("<timer timeout=\"{ms}\" forceDropOnTimeout=\"{drops}\"/>")
            }
            Self::Using(triggers, one) => {
                format!(
                    "<using>{}<return>{}</return></using>",
                    together(triggers),
                    one.xml()
                )
            }
        }
    }
}

impl Written for Trig {
    fn xml(&self) -> String {
        match self {
            Self::Fail => "<fail message=\"no\"/>".to_owned(),
            Self::Success(deferred) => format!("<success deferred=\"{deferred}\"/>"),
            Self::Say(tag, paths) => format!("<{tag} text=\"{}\"/>", text_of(paths)),
            Self::Set(name, value) => format!("<setter name=\"{name}\">{}</setter>", value.xml()),
            Self::SetUp(id) => format!("<setUp id=\"{id}\"/>"),
            Self::Drop(id) => format!("<drop id=\"{id}\"/>"),
            Self::SetState(object, property, value) => format!(
                "<setState object=\"{object}\" property=\"{property}\">{}</setState>",
                value.xml()
            ),
        }
    }
}

fn together<T: Written>(all: &[T]) -> String {
    all.iter().map(Written::xml).collect()
}

pub(super) fn text_of(paths: &[String]) -> String {
    let places = paths.iter().map(|path| format!(" ${{{path}}}"));
    format!("said{}", places.collect::<String>())
}

pub(super) fn rules_of(events: &[Happening], init: &[Trig]) -> String {
    let mut text = String::from("<constraints><timelimit value=\"600000\"/>");
    if !init.is_empty() {
        text.push_str(&format!("<init>{}</init>", together(init)));
    }
    for (event, id) in events.iter().zip(IDS) {
        text.push_str(&format!(
            "<event id=\"{id}\" settedUpInitially=\"{}\" dropsOnFire=\"{}\"><condition>{}</condition><triggers>{}</triggers></event>",
            event.initially,
            event.drops,
            event.condition.xml(),
            together(&event.triggers),
        ));
    }
    text + "</constraints>"
}
