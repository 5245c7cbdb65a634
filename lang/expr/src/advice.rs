//! Advice on a fault that only who knows all names can give: which name nothing gives a value, and which one was meant.
//!
//! Owns what is added to a fault on its way to people. Reports in the form of the real program do not have it.

mod words;

use super::names::{Kind, Names, Slot};
use super::tree::{Node, Tree};
use super::types::Type;
use super::value::Value;
use super::words::{Clash, Fault, Reason};
use lang_text::near::nearest;
use lang_text::problem::{Problem, Words};
use words::{did_you_mean, gives_no_value, keeps_type};

/// A fault of a text as a problem for people, with what the names say about it.
pub fn explained(fault: &Fault, tree: &Tree, names: &Names) -> Problem {
    let mut problem = fault.problem();
    problem.hint = match &fault.reason {
        Reason::Undeclared(name) => meant(name, names).map(did_you_mean),
        Reason::CannotDeduce(_) => {
            unknown_at(fault, tree, names).map(|name| gives_no_value(name, meant(name, names)))
        }
        Reason::Mismatched(Some(clash)) => Some(keeps_type(clash)),
        Reason::TextTooLong
        | Reason::UnknownSymbols(_)
        | Reason::UnexpectedToken(..)
        | Reason::UnexpectedEnd
        | Reason::Expected(..)
        | Reason::ExpectedAtEnd(_)
        | Reason::NotSupportedYet
        | Reason::TooDeep
        | Reason::CountsDiffer
        | Reason::AssignToCall
        | Reason::TooManyNames
        | Reason::FunctionAsName
        | Reason::AssignToValue
        | Reason::Mismatched(None)
        | Reason::ImplicitCast(_)
        | Reason::TypeMismatch
        | Reason::NoType
        | Reason::ReadOnly(_)
        | Reason::IndirectCall
        | Reason::UnknownFunction
        | Reason::TooManyArguments(_)
        | Reason::TooFewArguments(_)
        | Reason::NotAnalysed
        | Reason::OddNumber(..)
        | Reason::OutOfRange(_)
        | Reason::DivisionByZero
        | Reason::RandomOfNothing
        | Reason::Uninitialized(_)
        | Reason::NegativeIndex
        | Reason::NoNumber(_)
        | Reason::IndexNotNumber
        | Reason::IndexOfValue
        | Reason::KeyNotNumber
        | Reason::NotInterpreted
        | Reason::ValueTooLong
        | Reason::ValueTooDeep
        | Reason::StoreFull
        | Reason::TooMuchWork => None,
    };
    problem
}

/// What is said of a value that a variable cannot take, because it keeps its type.
pub fn refused(names: &mut Names, slot: Slot, value: &Value) -> Words {
    let given = names.type_of_value(value, 0);
    keeps_type(&Clash {
        name: names.name(slot).to_owned(),
        is_element: false,
        had: names.type_name(names.type_of(slot)),
        given: names.type_name(given),
    })
}

/// The variable at the place of a fault, if nothing has given it a type.
fn unknown_at<'a>(fault: &Fault, tree: &'a Tree, names: &Names) -> Option<&'a str> {
    (0u32..).zip(&tree.nodes).find_map(|(id, node)| {
        let Node::Name(name) = node else { return None };
        let is_unknown = names.find(name).is_none_or(|slot| {
            matches!(names.kind(slot), Some(Kind::Variable)) && names.type_of(slot) == Type::Any
        });
        (is_unknown && tree.place(id) == fault.at).then_some(&**name)
    })
}

/// The name that is nearest to one that nobody knows, among those that are known.
fn meant<'a>(name: &str, names: &'a Names) -> Option<&'a str> {
    let slots = 0..u32::try_from(names.len()).unwrap_or(u32::MAX);
    let known = slots.filter(|&slot| match names.kind(slot) {
        Some(Kind::Variable) => names.type_of(slot) != Type::Any,
        Some(Kind::Sensor(_) | Kind::Constant(_)) => true,
        Some(Kind::Function(_)) | None => false,
    });
    nearest(name, known.map(|slot| names.name(slot)))
}

#[cfg(test)]
mod tests {
    use crate::{Compat, Kit, Names, Source, Wanted, analyse};

    fn said(names: &mut Names, text: &str) -> Vec<String> {
        let found = analyse(&mut Source::new(text, Wanted::Any), names).err();
        let found = found.into_iter().flatten();
        found.map(|problem| problem.to_string()).collect()
    }

    #[test]
    fn an_unknown_name_is_said_with_the_one_that_was_meant() {
        let mut names = Names::new(Kit::V62, Compat::Studio);
        assert!(said(&mut names, "speed = 5").is_empty());
        let all = said(&mut names.clone(), "spede + 1").join("\n");
        assert!(
            all.contains("Can not deduce type")
                && all.contains("Nothing has given 'spede' a value. Did you mean 'speed'?"),
            "{all}"
        );
        let all = said(&mut names.clone(), "zzz + 1").join("\n");
        assert!(all.ends_with("Nothing has given 'zzz' a value."), "{all}");
        let all = said(&mut names, "x = sped").join("\n");
        assert!(all.ends_with("Did you mean 'speed'?"), "{all}");
    }

    #[test]
    fn a_value_of_another_type_is_said_with_both_types() {
        let mut names = Names::new(Kit::V62, Compat::Studio);
        assert!(said(&mut names, "n = 5; a = {1, 2}").is_empty());
        for (text, wanted) in [
            (
                "n = 'one'",
                "'n' is of the type 'integer', and this gives it 'string': a variable keeps its type",
            ),
            (
                "a[0] = 'one'",
                "An element of 'a' is of the type 'integer', and this gives it 'string'",
            ),
            (
                "a = 1",
                "'a' is of the type 'table[integer]', and this gives it 'integer'",
            ),
        ] {
            let all = said(&mut names.clone(), text).join("\n");
            assert!(all.contains(wanted), "{text}: {all}");
        }
    }

    #[test]
    fn what_a_report_in_the_form_of_the_real_program_has_stays_as_it_is() {
        let mut names = Names::new(Kit::V62, Compat::Studio);
        let mut source = Source::new("spede + 1", Wanted::Any);
        let found = analyse(&mut source, &mut names).unwrap_err();
        let without = source.faults().iter().map(super::Fault::problem);
        for (problem, fault) in found.iter().zip(without) {
            assert_eq!(problem.words, fault.words);
        }
    }

    #[test]
    fn a_number_that_counts_as_another_one_is_an_error_in_what_was_just_typed() {
        let mut names = Names::new(Kit::V62, Compat::Studio);
        let mut source = Source::new("1 + 99999999999999999999", Wanted::Any);
        assert!(
            analyse(&mut source, &mut names).is_ok(),
            "a program goes on"
        );
        let odd = source.odd_numbers();
        let told = odd[0].to_string();
        assert!(
            told.starts_with("1:5 The number 99999999999999999999 counts as 0."),
            "{told}"
        );
    }
}
