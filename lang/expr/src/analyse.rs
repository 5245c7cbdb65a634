//! Types of all parts of a text, inferred with what the project's other texts have taught about its names.
//!
//! The rules, the messages and their order are the real program's: children before parents, all over again while an
//! assignment widens a variable, at last a look for parts without a type. Types of parts are kept between analyses, as
//! there. Knows no values.

use super::literal;
use super::names::{Kind, Names, Slot};
use super::reserved::{FUNCTIONS, Function};
use super::tree::{Binary, Id, Node, Tree, Unary};
use super::types::{Element, Possible, Type, Variable};
use super::value::Compat;
use super::words::{Clash, Fault, Reason};
use crate::limits;
use lang_text::problem::Position;

/// Where the type of a part is kept.
#[derive(Clone, Copy, Debug, Default)]
pub(super) enum PartType {
    /// It has none (yet).
    #[default]
    None,
    /// Its own.
    Own(Possible),
    /// That of a name, or of the elements of a table.
    Shared(Variable),
    /// That of another part.
    Same(Id),
}

/// One analysis.
pub(super) struct Analysis<'a> {
    pub(super) tree: &'a Tree,
    /// Of each node of the tree.
    pub(super) parts: &'a mut Vec<PartType>,
    pub(super) names: &'a mut Names,
    /// The number of this reading of the text.
    pub(super) reading: u32,
    pub(super) faults: Vec<Fault>,
    again: bool,
}

const NUMBERS: [Type; 2] = [Type::Int, Type::Float];
const ORDERED: [Type; 3] = [Type::Int, Type::Float, Type::Text];

impl<'a> Analysis<'a> {
    pub(super) fn new(
        tree: &'a Tree,
        parts: &'a mut Vec<PartType>,
        names: &'a mut Names,
        reading: u32,
    ) -> Self {
        parts.resize(tree.nodes.len(), PartType::None);
        Self {
            tree,
            parts,
            names,
            reading,
            faults: Vec::new(),
            again: false,
        }
    }

    /// Analyses everything; the faults are in `faults`.
    pub(super) fn run(&mut self) {
        let Some(root) = self.tree.root else {
            return;
        };
        self.check_functions(root, None);
        for pass in 0..limits::EXPRESSION_PASSES_MAX {
            self.again = false;
            self.collect(root, pass == 0);
            if !self.again {
                break;
            }
        }
        self.check_settled(root);
        if self.names.compat() == Compat::Fixed {
            let mut told: Vec<Fault> = Vec::new();
            for fault in self.faults.drain(..) {
                if !told.contains(&fault) {
                    told.push(fault);
                }
            }
            self.faults = told;
        }
    }

    fn fault(&mut self, reason: Reason, at: Position) {
        if self.faults.len() < limits::EXPRESSION_PROBLEMS_MAX {
            self.faults.push(Fault::new(reason, at));
        }
    }

    fn fault_on(&mut self, reason: Reason, id: Id) {
        self.fault(reason, self.tree.place(id));
    }

    fn is_fixed(&self) -> bool {
        self.names.compat() == Compat::Fixed
    }

    fn function(&self, name: &str) -> Option<Function> {
        let slot = self.names.find(name)?;
        match self.names.kind(slot) {
            Some(Kind::Function(function)) => Some(*function),
            Some(Kind::Variable | Kind::Sensor(_) | Kind::Constant(_)) | None => None,
        }
    }

    /// Names of functions stand only where they are called.
    fn check_functions(&mut self, id: Id, parent: Option<Id>) {
        if let Node::Name(name) = self.tree.node(id)
            && self.function(name).is_some()
        {
            let called = parent.is_some_and(|parent| {
                matches!(self.tree.node(parent), Node::Call { function, .. } if *function == id)
            });
            if !called {
                self.fault_on(Reason::FunctionAsName, id);
            }
        }
        let tree = self.tree;
        tree.children(id, |child| self.check_functions(child, Some(id)));
    }

    fn collect(&mut self, id: Id, is_first: bool) {
        let tree = self.tree;
        tree.children(id, |child| self.collect(child, is_first));
        self.analyse(id, is_first);
    }

    /// What a part can be; `None` if it has no type.
    pub(super) fn possible(&self, id: Id) -> Option<Possible> {
        match self.parts[id as usize] {
            PartType::None => None,
            PartType::Own(possible) => Some(possible),
            PartType::Shared(variable) => Some(self.names.types.get(variable)),
            PartType::Same(other) => match self.parts[other as usize] {
                PartType::Own(possible) => Some(possible),
                PartType::Shared(variable) => Some(self.names.types.get(variable)),
                PartType::None | PartType::Same(_) => None,
            },
        }
    }

    /// The settled type of a part, or the first of those possible.
    pub(super) fn type_of(&self, id: Id) -> Type {
        self.possible(id)
            .map_or(Type::Any, |possible| possible.first())
    }

    fn set(&mut self, id: Id, possible: Possible) {
        let id = if let PartType::Same(other) = self.parts[id as usize] {
            other
        } else {
            id
        };
        match &mut self.parts[id as usize] {
            PartType::Own(had) => *had = possible,
            PartType::Shared(variable) => {
                if self.names.types.set(*variable, possible) {
                    self.names.changed();
                }
            }
            PartType::None | PartType::Same(_) => {}
        }
    }

    /// Gives a part a type, or narrows the one it has.
    fn give(&mut self, id: Id, of: Type) {
        match self.possible(id) {
            Some(had) => {
                let left = self.names.types.constrained(had, Possible::one(of));
                self.set(id, left);
            }
            None => self.parts[id as usize] = PartType::Own(Possible::one(of)),
        }
    }

    /// Makes the part `id` have the type of `other`, from now on together.
    fn unite(&mut self, id: Id, other: Id) {
        self.parts[id as usize] = match self.parts[other as usize] {
            PartType::Own(_) => PartType::Same(other),
            shared @ (PartType::None | PartType::Shared(_) | PartType::Same(_)) => shared,
        };
    }

    /// Narrows a part to some types, on behalf of an operation, which is where it is told.
    fn constrain(&mut self, operation: Id, id: Id, wanted: &[Type]) {
        let Some(had) = self.possible(id) else {
            self.fault_on(Reason::NotAnalysed, id);
            return;
        };
        let left = self.names.types.constrained(had, Possible::of(wanted));
        if left.is_empty() {
            self.fault_on(Reason::TypeMismatch, operation);
            if self.is_fixed() {
                return;
            }
        }
        self.set(id, left);
    }

    fn analyse(&mut self, id: Id, is_first: bool) {
        let tree = self.tree;
        match tree.node(id) {
            Node::Assign { target, value } => self.assignment(id, *target, *value),
            Node::Name(name) => self.name(id, name),
            Node::Int(text) => {
                if is_first && let Some(counts) = literal::odd_whole(text, self.names.compat()) {
                    self.fault_on(Reason::OddNumber(text.to_string(), counts), id);
                }
                self.give(id, Type::Int);
            }
            Node::Float(text) => {
                if is_first && let Some(counts) = literal::odd_float(text, self.names.compat()) {
                    self.fault_on(Reason::OddNumber(text.to_string(), counts), id);
                }
                self.give(id, Type::Float);
            }
            Node::Bool(_) => self.give(id, Type::Bool),
            Node::Text(_) | Node::RawText(_) => self.give(id, Type::Text),
            Node::Nil => self.give(id, Type::Nil),
            Node::Unary(operator, operand) => self.unary(id, *operator, *operand),
            Node::Binary(operator, left, right) => self.binary(id, *operator, *left, *right),
            Node::Call {
                function,
                arguments,
            } => self.call(id, *function, arguments),
            Node::Table { fields, .. } => {
                let element = fields
                    .first()
                    .map_or(Type::Any, |field| self.type_of(field.value));
                let table = self.names.types.table(Element::Settled(element));
                self.give(id, table);
            }
            Node::Index { table, .. } => self.index(id, *table),
            Node::Method { .. } => self.fault_on(Reason::NotAnalysed, id),
            Node::Block(_) => {}
        }
    }

    fn name(&mut self, id: Id, name: &str) {
        if self.function(name).is_some() {
            return;
        }
        let Some(slot) = self.names.slot(name) else {
            self.fault_on(Reason::TooManyNames, id);
            return;
        };
        let entry = &mut self.names.entries[slot as usize];
        self.parts[id as usize] = PartType::Shared(entry.variable);
        if entry.declared.is_none() {
            entry.declared = Some((self.reading, id));
            self.names.changed();
        }
    }

    fn unary(&mut self, id: Id, operator: Unary, operand: Id) {
        match operator {
            Unary::Minus => {
                self.constrain(id, operand, &NUMBERS);
                self.unite(id, operand);
            }
            Unary::Not => self.give(id, Type::Bool),
            Unary::Length => {
                let of = self.type_of(operand);
                if !self.is_fixed() {
                    let any = self.names.types.table(Element::Settled(Type::Any));
                    self.constrain(id, operand, &[Type::Text, any]);
                    return;
                }
                if !matches!(of, Type::Table(_)) {
                    self.constrain(id, operand, &[Type::Text]);
                }
                self.give(id, Type::Int);
            }
            Unary::BitNot => {
                self.constrain(id, operand, &[Type::Int]);
                self.give(id, Type::Int);
            }
        }
    }

    fn binary(&mut self, id: Id, operator: Binary, left: Id, right: Id) {
        use Binary::{
            Add, And, BitAnd, BitOr, BitXor, Divide, DivideWhole, Equal, Greater, GreaterEqual,
            Join, Less, LessEqual, Modulo, Multiply, NotEqual, Or, Power, ShiftLeft, ShiftRight,
            Subtract,
        };
        let (wanted, result): (&[Type], Type) = match operator {
            Add | Subtract | Multiply => (&NUMBERS, Type::Float),
            Divide | Power => (&[Type::Float], Type::Float),
            DivideWhole | Modulo | BitAnd | BitOr | BitXor | ShiftLeft | ShiftRight => {
                (&[Type::Int], Type::Int)
            }
            Less | Greater | LessEqual | GreaterEqual => (&ORDERED, Type::Bool),
            Equal | NotEqual | And | Or => (&[], Type::Bool),
            Join => (&[], Type::Text),
        };
        if wanted.is_empty() {
            self.give(id, result);
            return;
        }
        self.constrain(id, left, wanted);
        self.constrain(id, right, wanted);
        if !matches!(operator, Add | Subtract | Multiply) {
            self.give(id, result);
            return;
        }
        let (Some(left), Some(right)) = (self.possible(left), self.possible(right)) else {
            return;
        };
        let whole = Possible::one(Type::Int);
        self.give(
            id,
            if left == whole && right == whole {
                Type::Int
            } else {
                result
            },
        );
    }

    fn index(&mut self, id: Id, table: Id) {
        if self.possible(table).is_none() {
            self.fault_on(Reason::NotAnalysed, table);
            return;
        }
        match self.names.types.element(self.type_of(table)) {
            Some(Element::Settled(of)) => self.give(id, of),
            Some(Element::Variable(variable)) => {
                self.parts[id as usize] = PartType::Shared(variable)
            }
            None => {
                if self.names.types.variables() >= limits::NAMES_MAX + limits::OPEN_TYPES_MAX {
                    self.fault_on(Reason::TooManyNames, id);
                    return;
                }
                let variable = self.names.types.variable(Possible::one(Type::Open));
                let of = self.names.types.table(Element::Variable(variable));
                self.constrain(table, table, &[of]);
                self.parts[id as usize] = PartType::Shared(variable);
            }
        }
    }

    fn call(&mut self, id: Id, function: Id, arguments: &[Id]) {
        let tree = self.tree;
        let Node::Name(name) = tree.node(function) else {
            self.fault_on(Reason::IndirectCall, id);
            self.give(function, Type::Any);
            self.give(id, Type::Any);
            return;
        };
        let Some(known) = self.function(name) else {
            self.fault_on(Reason::UnknownFunction, id);
            self.give(function, Type::Any);
            self.give(id, Type::Any);
            return;
        };
        let Some((_, _, formal, result)) = FUNCTIONS.iter().find(|(_, one, ..)| *one == known)
        else {
            return;
        };
        self.give(function, Type::Function);
        self.give(id, of_letter(*result));
        if arguments.len() > formal.len() {
            self.fault_on(Reason::TooManyArguments(formal.len()), id);
        } else if arguments.len() < formal.len() {
            self.fault_on(Reason::TooFewArguments(formal.len()), id);
        } else {
            for (&argument, letter) in arguments.iter().zip(formal.chars()) {
                self.constrain(argument, argument, &[of_letter(letter)]);
            }
        }
    }

    fn assignment(&mut self, id: Id, target: Id, value: Id) {
        let tree = self.tree;
        if let Node::Name(name) = tree.node(target)
            && let Some(slot) = self.names.find(name)
            && !matches!(self.names.kind(slot), Some(Kind::Variable))
        {
            self.fault_on(Reason::ReadOnly(name.to_string()), target);
            return;
        }
        self.constrain_assignment(id, target, value);
        self.check_declared(value);
    }

    fn constrain_assignment(&mut self, id: Id, target: Id, value: Id) {
        let tree = self.tree;
        if !matches!(tree.node(target), Node::Name(_) | Node::Index { .. }) {
            self.fault_on(Reason::AssignToValue, id);
            return;
        }
        let (Some(had), Some(given)) = (self.possible(target), self.possible(value)) else {
            return;
        };
        let widens = self.names.widens;
        let assigned = self.names.types.assigned(had, given, widens);
        if assigned.target.is_empty() {
            let clash = self.clash(target, had, given);
            self.fault_on(Reason::Mismatched(clash), id);
            if !self.is_fixed() {
                self.set(target, assigned.target);
            }
            return;
        }
        self.set(target, assigned.target);
        if !assigned.cast {
            return;
        }
        if !widens {
            let name = self.names.types.names(assigned.target);
            self.fault_on(Reason::ImplicitCast(name), id);
            return;
        }
        if let Node::Index { table, .. } = tree.node(target)
            && given.is_settled()
            && let Some(of_table) = self.possible(*table)
        {
            // The table itself has to be widened.
            let wider = self.names.types.table(Element::Settled(given.first()));
            let widened = self
                .names
                .types
                .assigned(of_table, Possible::one(wider), widens);
            self.set(*table, widened.target);
        }
        self.again = true;
    }

    /// What does not fit in an assignment, if both sides have a type.
    fn clash(&self, target: Id, had: Possible, given: Possible) -> Option<Clash> {
        let mut at = target;
        while let Node::Index { table, .. } = self.tree.node(at) {
            at = *table;
        }
        let Node::Name(name) = self.tree.node(at) else {
            return None;
        };
        let is_known = !had.is_empty() && !given.is_empty();
        is_known.then(|| Clash {
            name: name.to_string(),
            is_element: at != target,
            had: self.names.types.names(had),
            given: self.names.types.names(given),
        })
    }

    /// Names that are seen here for the first time have no value that could be read.
    fn check_declared(&mut self, id: Id) {
        let tree = self.tree;
        tree.children(id, |child| self.check_declared(child));
        let Node::Name(name) = tree.node(id) else {
            return;
        };
        let declared = self.names.find(name).and_then(|slot: Slot| {
            let entry = &self.names.entries[slot as usize];
            matches!(entry.kind, Kind::Variable).then_some(entry.declared)?
        });
        if declared == Some((self.reading, id)) {
            self.fault_on(Reason::Undeclared(name.to_string()), id);
        }
    }

    fn check_settled(&mut self, id: Id) {
        if let Some(possible) = self.possible(id) {
            if possible.is_empty() {
                self.fault_on(Reason::NoType, id);
            } else if !possible.is_settled() && possible.first() != Type::Any {
                let names = self.names.types.names(possible);
                self.fault_on(Reason::CannotDeduce(names), id);
            }
        }
        let tree = self.tree;
        tree.children(id, |child| self.check_settled(child));
    }
}

fn of_letter(letter: char) -> Type {
    match letter {
        'i' => Type::Int,
        'f' => Type::Float,
        's' => Type::Text,
        'n' => Type::Nil,
        _ => Type::Open,
    }
}
