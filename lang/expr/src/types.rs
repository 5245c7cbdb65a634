//! Static types: single ones, sets of those still possible, and what may stand for what.
//!
//! An integer may stand where a float is wanted, and a table of integers where one of floats is; nothing else may stand
//! for something else. Knows no names and no tree.

use crate::limits;

/// A type. Tables are known by the index of their element's type.
#[derive(Clone, Copy, Debug, Eq, PartialEq)]
pub enum Type {
    /// Nothing is known.
    Any,
    /// Nothing is known, and nobody has said so yet: an element of a table never seen before, an argument of `print`.
    /// Unlike [`Type::Any`] it is reported when it stays.
    Open,
    /// Truths.
    Bool,
    /// Whole numbers.
    Int,
    /// Numbers.
    Float,
    /// Texts.
    Text,
    /// Nothing.
    Nil,
    /// A function.
    Function,
    /// A table, by its place in [`Types`].
    Table(u32),
}

/// The type of the elements of a table.
#[derive(Clone, Copy, Debug, Eq, PartialEq)]
pub enum Element {
    /// Settled.
    Settled(Type),
    /// That of a variable, which may still change.
    Variable(Variable),
}

/// A type variable by its index in [`Types`].
pub type Variable = u32;

/// Types that are still possible: none is a contradiction, one is settled.
#[derive(Clone, Copy, Debug, Default, Eq, PartialEq)]
pub struct Possible {
    types: [Option<Type>; 4],
}

impl Possible {
    /// Exactly one.
    pub fn one(only: Type) -> Self {
        Self {
            types: [Some(only), None, None, None],
        }
    }

    /// All of these, at most four.
    pub fn of(types: &[Type]) -> Self {
        let mut all = Self::default();
        types.iter().for_each(|&one| all.add(one));
        all
    }

    fn add(&mut self, one: Type) {
        if self.iter().any(|had| had == one) {
            return;
        }
        if let Some(free) = self.types.iter_mut().find(|place| place.is_none()) {
            *free = Some(one);
        }
    }

    /// Each of them.
    pub fn iter(&self) -> impl Iterator<Item = Type> {
        self.types.into_iter().flatten()
    }

    /// Whether nothing is possible.
    pub fn is_empty(&self) -> bool {
        self.types[0].is_none()
    }

    /// The first of them, or that nothing is known.
    pub fn first(&self) -> Type {
        self.types[0].unwrap_or(Type::Any)
    }

    /// Whether exactly one is possible, and known.
    pub fn is_settled(&self) -> bool {
        self.types[1].is_none() && !matches!(self.types[0], None | Some(Type::Any | Type::Open))
    }
}

/// How an assignment changed its target.
#[derive(Clone, Copy, Debug, Eq, PartialEq)]
pub struct Assigned {
    /// What the target can be now.
    pub target: Possible,
    /// Whether the value had to be converted or the target widened.
    pub cast: bool,
}

/// All tables and type variables of a project.
#[derive(Clone, Debug, Default)]
pub struct Types {
    elements: Vec<Element>,
    variables: Vec<Possible>,
    /// Looks through type variables where TRIK Studio does not.
    resolves: bool,
}

impl Types {
    /// No types yet; `resolves`: looks through type variables where TRIK Studio does not.
    pub fn new(resolves: bool) -> Self {
        Self {
            resolves,
            ..Self::default()
        }
    }

    /// The type of tables of these elements.
    pub fn table(&mut self, element: Element) -> Type {
        // Newest first: the same literal is analysed again and again.
        let known = self.elements.iter().rposition(|&had| had == element);
        let index = known.unwrap_or_else(|| {
            self.elements.push(element);
            self.elements.len() - 1
        });
        Type::Table(u32::try_from(index).unwrap_or(u32::MAX))
    }

    /// The type of the elements, if it is a table.
    pub fn element(&self, table: Type) -> Option<Element> {
        let Type::Table(index) = table else {
            return None;
        };
        self.elements.get(index as usize).copied()
    }

    /// A new variable.
    pub fn variable(&mut self, possible: Possible) -> Variable {
        self.variables.push(possible);
        u32::try_from(self.variables.len() - 1).unwrap_or(u32::MAX)
    }

    /// How many variables there are.
    pub fn variables(&self) -> usize {
        self.variables.len()
    }

    /// What a variable can be.
    pub fn get(&self, variable: Variable) -> Possible {
        self.variables
            .get(variable as usize)
            .copied()
            .unwrap_or_default()
    }

    /// Sets what a variable can be; tells whether that is new.
    pub fn set(&mut self, variable: Variable, possible: Possible) -> bool {
        match self.variables.get_mut(variable as usize) {
            Some(had) if *had != possible => {
                *had = possible;
                true
            }
            _ => false,
        }
    }

    /// Whether a value of the first type may stand where the second is wanted. A table may be an element of itself: what
    /// is not unlike down to the depth that values can have, is alike.
    pub fn stands_for(&self, specific: Type, general: Type) -> bool {
        let (mut specific, mut general) = (specific, general);
        for _ in 0..=limits::LIST_DEPTH_MAX {
            (specific, general) = match (specific, general) {
                (Type::Int, Type::Float) | (Type::Any | Type::Open, Type::Any | Type::Open) => {
                    return true;
                }
                (Type::Table(one), Type::Table(two)) if one == two && self.resolves => return true,
                (Type::Table(_), Type::Table(_)) => {
                    match (self.plain_element(specific), self.plain_element(general)) {
                        (Some(one), Some(two)) => (one, two),
                        // TRIK Studio takes an element that came from an assignment for unlike every other.
                        _ => return false,
                    }
                }
                _ => return specific == general,
            };
        }
        true
    }

    fn plain_element(&self, table: Type) -> Option<Type> {
        match self.element(table)? {
            Element::Settled(only) => Some(only),
            Element::Variable(variable) => self.resolves.then(|| self.get(variable).first()),
        }
    }

    /// What is left of `had` when one of `wanted` is needed.
    pub fn constrained(&self, had: Possible, wanted: Possible) -> Possible {
        let mut left = Possible::default();
        for one in had.iter() {
            for other in wanted.iter() {
                if matches!(one, Type::Any | Type::Open) {
                    left.add(other);
                } else if matches!(other, Type::Any | Type::Open) || self.stands_for(one, other) {
                    left.add(one);
                }
            }
        }
        left
    }

    /// What a target becomes by an assignment; `widens`: it may become more general.
    pub fn assigned(&self, target: Possible, value: Possible, widens: bool) -> Assigned {
        let mut left = Possible::default();
        let mut cast = false;
        for one in target.iter() {
            let mut allowed = Possible::default();
            for other in value.iter() {
                if matches!(one, Type::Any | Type::Open) {
                    allowed.add(other);
                } else if matches!(other, Type::Any | Type::Open) {
                    left.add(one);
                } else if self.stands_for(other, one) {
                    allowed.add(one);
                }
            }
            if allowed.is_empty() {
                for other in value.iter() {
                    if self.stands_for(one, other) {
                        left.add(if widens { other } else { one });
                        cast = true;
                    }
                }
            }
            allowed.iter().for_each(|one| left.add(one));
        }
        Assigned { target: left, cast }
    }

    /// The name of a type in messages.
    pub fn name(&self, of: Type) -> String {
        self.name_within(of, 8)
    }

    fn name_within(&self, of: Type, depth: u8) -> String {
        match of {
            Type::Any | Type::Open => "any".into(),
            Type::Bool => "boolean".into(),
            Type::Int => "integer".into(),
            Type::Float => "float".into(),
            Type::Text => "string".into(),
            Type::Nil => "nil".into(),
            Type::Function => "function".into(),
            Type::Table(_) if depth == 0 => "table".into(),
            Type::Table(_) => match self.element(of) {
                Some(Element::Settled(one)) => {
                    format!("table[{}]", self.name_within(one, depth - 1))
                }
                Some(Element::Variable(variable)) => format!(
                    "table[{}]",
                    self.names_within(self.get(variable), depth - 1)
                ),
                None => "table".into(),
            },
        }
    }

    /// The names of all possible types, with commas.
    pub fn names(&self, possible: Possible) -> String {
        self.names_within(possible, 8)
    }

    fn names_within(&self, possible: Possible, depth: u8) -> String {
        let names: Vec<_> = possible
            .iter()
            .map(|one| self.name_within(one, depth))
            .collect();
        names.join(", ")
    }
}
