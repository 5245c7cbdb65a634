//! What one block tells a device: an action with its properties as statements.
//!
//! Owns the order in which properties are evaluated, which is the machine's. What a block says stands in its row.

use super::build::{text, whole};
use super::code::{Code, Command, Conversion, Kind, Number, Operation, Robot, Statement, Typed};
use super::routines::Lowerer;
use super::steps::{emit, plain};
use super::words;
use crate::blocks::Type;
use crate::blocks::act::{Effect, FONT_SIZE, Operand, Phrase, When};
use crate::ports::{Direction, Port, Sort};
use crate::program::{Action, Node, Source};

impl Lowerer<'_> {
    pub(super) fn act(&mut self, node: Node, action: &Action, out: &mut Vec<Statement>) {
        match action.act.effect {
            Effect::Drive(sign) => {
                self.motors(node, action, Some(sign), out);
            }
            Effect::Stop => self.motors(node, action, None, out),
            Effect::ResetEncoders => {
                let encoders = action
                    .ports
                    .iter()
                    .filter(|port| port.sort() == Sort::Encoder);
                for port in encoders {
                    emit(out, Robot::ResetEncoder, [Code::Port(port.name().into())]);
                }
            }
            Effect::Command(_) if action.act.may_be_code && action.flags.first() == Some(&true) => {
                self.fail(node, words::no_line_of_code());
            }
            Effect::Command(_) => {
                self.phrase(node, action, out);
                if action.redraws {
                    emit(out, Robot::Redraw, []);
                }
            }
        }
    }

    /// The phrase of the row that holds, with its operands.
    fn phrase(&mut self, node: Node, action: &Action, out: &mut Vec<Statement>) {
        let is_whole = |source: &Source| {
            let text = self.program.sources.get(*source as usize);
            text.is_some_and(|text| text.wanted == Type::Whole)
        };
        let (numbers, texts): (Vec<Source>, Vec<Source>) =
            action.sources.iter().copied().partition(is_whole);
        let wholes: Vec<Code> = numbers
            .into_iter()
            .map(|source| whole(self.value(node, source)))
            .collect();
        let computed = texts.first().map(|&source| self.value(node, source));
        let written = action.texts.first().map_or("", |text| &**text);
        let holds = |phrase: &&Phrase| match phrase.when {
            When::Always => true,
            When::Choice(choice) => choice == written,
            When::NoWhole => wholes.is_empty(),
        };
        let Some(phrase) = action.act.phrases.iter().find(holds) else {
            return;
        };
        let whole_at = |at: usize| wholes.get(at).cloned();
        let operands = phrase.operands.iter().map(|operand| match *operand {
            Operand::Whole(at) => whole_at(at).unwrap_or(Code::Int(0)),
            Operand::FontSize => match whole_at(2) {
                None => Code::Int(FONT_SIZE.into()),
                Some(Code::Int(size)) if size <= 0 => Code::Int(FONT_SIZE.into()),
                Some(size) => size,
            },
            Operand::Written => plain(written),
            Operand::WrittenWhole => Code::Int(written.parse().unwrap_or(0)),
            Operand::Text => match computed.clone() {
                None => plain(written),
                Some(value) if action.act.is_label => printed(value),
                Some(value) => text(value),
            },
            Operand::Number(at) => Code::Int(action.numbers.get(at).copied().unwrap_or(0).into()),
            Operand::Flag(at) => Code::Bool(action.flags.get(at).copied().unwrap_or(false)),
        });
        let operands: Vec<Code> = operands.collect();
        let row = self.program.row(node);
        let command = Command {
            phrase,
            english: row.map_or("", |row| row.shown),
            russian: match action.act.russian {
                "" => row.map_or("", |row| row.russian),
                other => other,
            },
            is_dispensable: action.act.is_dispensable,
        };
        emit(out, command, operands);
    }

    /// Power times a sign to each port of the list; without a sign they are switched off.
    fn motors(&mut self, node: Node, action: &Action, sign: Option<i32>, out: &mut Vec<Statement>) {
        let ports = action
            .sources
            .first()
            .map(|&source| self.value(node, source));
        let ports = match ports.map(|value| value.code) {
            Some(Code::List(ports)) => ports,
            Some(single @ (Code::Port(_) | Code::Text(_))) => vec![single],
            _ => {
                self.fail(node, words::ports_must_be_plain());
                return;
            }
        };
        let power = sign.map(|sign| {
            let power = match action.sources.get(1) {
                Some(&source) => signed(whole(self.value(node, source)), sign),
                None => Code::Int(0),
            };
            if !power.is_fickle() || ports.len() < 2 {
                return power;
            }
            let place = self.place(Kind::Int);
            out.push(Statement::Set(place.clone(), power));
            place
        });
        for port in ports {
            let (Code::Port(name) | Code::Text(name)) = port else {
                self.fail(node, words::ports_must_be_plain());
                return;
            };
            let Some(port) = Port::find(self.program.kit, &name, Direction::Out) else {
                out.push(Statement::Comment(format!("There is no port {name}")));
                continue;
            };
            let operand = Code::Port(port.name().into());
            match (&power, port.sort()) {
                (None, _) => emit(out, Robot::PowerOff, [operand]),
                (Some(power), Sort::Servo) => emit(out, Robot::Servo, [operand, power.clone()]),
                (Some(power), _) => emit(out, Robot::SetPower, [operand, power.clone()]),
            }
        }
    }
}

/// Power in the direction of a block.
fn signed(power: Code, sign: i32) -> Code {
    if sign > 0 {
        return power;
    }
    if let Code::Int(power) = power {
        return Code::Int(-power);
    }
    if let Code::Do(Operation::Number(Number::Negate), inner) = &power
        && let [inner] = &inner[..]
    {
        return inner.clone();
    }
    Code::does(Number::Negate, [power])
}

fn printed(value: Typed) -> Code {
    match value.kind {
        Kind::Int | Kind::Bool => text(value),
        Kind::Text => {
            let is_number = |text: &str| text.trim().parse::<f64>().is_ok();
            // What is surely no number stands as it is.
            if matches!(&value.code, Code::Text(text) if !is_number(text)) {
                return value.code;
            }
            Code::does(Conversion::Printed, [value.code])
        }
        Kind::Any | Kind::Float | Kind::List(_) => Code::does(Conversion::Printed, [text(value)]),
    }
}
