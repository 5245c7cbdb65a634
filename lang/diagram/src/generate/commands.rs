//! What one block tells a device: an action with its properties as statements.
//!
//! Owns the meaning of each action, which is the machine's. Adding a block that tells a device something means a line
//! here and a row in each dialect.

use super::build::{self, text, whole};
use super::code::{Code, Kind, Light, Statement, Typed, What};
use super::routines::Lowerer;
use super::steps::{plain, tell};
use super::words;
use crate::blocks::Act;
use crate::ports::{Port, Sort, Way};
use crate::program::{Action, Node};

/// Height of letters when a block asks for none.
const FONT_SIZE: i64 = 20;

impl Lowerer<'_> {
    pub(super) fn act(&mut self, node: Node, action: &Action, out: &mut Vec<Statement>) {
        match action.act {
            Act::Forward | Act::Backward | Act::Stop => {
                self.motors(node, action, out);
                return;
            }
            Act::ClearEncoders => {
                let encoders = action
                    .ports
                    .iter()
                    .filter(|port| port.sort() == Sort::Encoder);
                for port in encoders {
                    tell(out, What::ResetEncoder, [Code::Port(port.name().into())]);
                }
                return;
            }
            _ => {}
        }
        let wholes = self.wholes(node, action);
        let written = action.texts.first().map_or("", |text| &**text);
        let number = |at: usize| Code::Int(action.numbers.get(at).copied().unwrap_or(0).into());
        let flag = |at: usize| action.flags.get(at).copied().unwrap_or(false);
        let first = |wholes: &[Code]| wholes.first().cloned().unwrap_or(Code::Int(0));
        let (what, operands) = match action.act {
            Act::Sound => (What::PlaySound, vec![plain(written)]),
            Act::Tone => (What::PlayTone, vec![number(0), number(1)]),
            Act::Say => (What::Say, vec![self.told(node, action, 0)]),
            Act::Led => (What::Led(light(written)), Vec::new()),
            Act::System if flag(0) => {
                self.fail(node, words::no_line_of_code());
                return;
            }
            Act::System => (What::System, vec![self.told(node, action, 0)]),
            Act::WriteFile => {
                let value = action
                    .sources
                    .first()
                    .map(|&source| self.value(node, source));
                let value = value.map_or(plain(""), text);
                (What::Append, vec![plain(written), value])
            }
            Act::RemoveFile => (What::Remove, vec![plain(written)]),
            Act::StartCamera => {
                let show = Code::Bool(flag(0));
                (What::StartCamera(build::camera(written)), vec![show])
            }
            Act::StopCamera => (What::StopCamera(build::camera(written)), Vec::new()),
            Act::Detect => (What::Detect(build::camera(written)), Vec::new()),
            Act::StartVideo => {
                let quality = Code::Int(written.parse().unwrap_or(0));
                (What::StartVideo, vec![quality, Code::Bool(flag(0))])
            }
            Act::StopVideo => (What::StopVideo, Vec::new()),
            Act::SendMail if action.sources.is_empty() => {
                (What::SendMailToAll, vec![plain(written)])
            }
            Act::SendMail => (What::SendMail, vec![first(&wholes), plain(written)]),
            Act::JoinNetwork => {
                let operands = vec![plain(written), number(0), first(&wholes)];
                (What::JoinNetwork, operands)
            }
            Act::CalibrateGyroscope => (What::Calibrate, Vec::new()),
            _ => self.shown(node, action, wholes),
        };
        tell(out, what, operands);
        if draws(action.act) && action.flags.last() == Some(&true) {
            tell(out, What::Redraw, []);
        }
    }

    /// What happens on the screen or with the marker.
    fn shown(&mut self, node: Node, action: &Action, wholes: Vec<Code>) -> (What, Vec<Code>) {
        let written = action.texts.first().map_or("", |text| &**text);
        let is_filled = action.flags.len() > 1 && action.flags.first() == Some(&true);
        let filled = |mut wholes: Vec<Code>| {
            wholes.push(Code::Bool(is_filled));
            wholes
        };
        match action.act {
            Act::Print => (What::Label, self.label(node, action)),
            Act::PenColor => (What::PenColor, vec![plain(written)]),
            Act::PenWidth => (What::PenWidth, wholes),
            Act::Background => (What::Background, vec![plain(written)]),
            Act::Pixel => (What::Pixel, wholes),
            Act::Line => (What::Line, wholes),
            Act::Rectangle => (What::Rectangle, filled(wholes)),
            Act::Ellipse => (What::Ellipse, filled(wholes)),
            Act::Arc => (What::Arc, wholes),
            Act::Smile => (What::Smile, Vec::new()),
            Act::SadSmile => (What::SadSmile, Vec::new()),
            Act::MarkerDown => (What::MarkerDown, vec![plain(written)]),
            Act::MarkerUp => (What::MarkerUp, Vec::new()),
            _ => (What::Clear, Vec::new()),
        }
    }

    /// All expressions of an action as whole numbers, if its block has only such ones.
    fn wholes(&mut self, node: Node, action: &Action) -> Vec<Code> {
        match action.act {
            Act::SendMail
            | Act::JoinNetwork
            | Act::PenWidth
            | Act::Pixel
            | Act::Line
            | Act::Rectangle
            | Act::Ellipse
            | Act::Arc => {
                let sources = action.sources.iter();
                sources
                    .map(|&source| whole(self.value(node, source)))
                    .collect()
            }
            _ => Vec::new(),
        }
    }

    /// A text that stands as it is, or is computed.
    fn told(&mut self, node: Node, action: &Action, at: usize) -> Code {
        match action.texts.first() {
            Some(text) => plain(text),
            None => match action.sources.get(at) {
                Some(&source) => text(self.value(node, source)),
                None => plain(""),
            },
        }
    }

    fn label(&mut self, node: Node, action: &Action) -> Vec<Code> {
        let mut number = |at: usize| match action.sources.get(at) {
            Some(&source) => whole(self.value(node, source)),
            None => Code::Int(0),
        };
        let (x, y) = (number(0), number(1));
        let size = match action.sources.len() {
            0..=2 => Code::Int(FONT_SIZE),
            count => number(count - 1),
        };
        let size = match size {
            Code::Int(size) if size <= 0 => Code::Int(FONT_SIZE),
            size => size,
        };
        let shown = match action.texts.first() {
            Some(text) => plain(text),
            None => {
                let value = action
                    .sources
                    .get(2)
                    .map(|&source| self.value(node, source));
                value.map_or(plain(""), printed)
            }
        };
        vec![shown, x, y, size]
    }

    fn motors(&mut self, node: Node, action: &Action, out: &mut Vec<Statement>) {
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
        let mut power = match action.sources.get(1) {
            Some(&source) if action.act != Act::Stop => whole(self.value(node, source)),
            _ => Code::Int(0),
        };
        if action.act == Act::Backward {
            power = match power {
                Code::Int(power) => Code::Int(-power),
                Code::Do(What::Negate, mut inner) if inner.len() == 1 => inner.remove(0),
                power => Code::does(What::Negate, [power]),
            };
        }
        if power.is_fickle() && ports.len() > 1 {
            let place = self.place(Kind::Int);
            out.push(Statement::Set(place.clone(), power));
            power = place;
        }
        for port in ports {
            let (Code::Port(name) | Code::Text(name)) = port else {
                self.fail(node, words::ports_must_be_plain());
                return;
            };
            let Some(port) = Port::find(self.program.kit, &name, Way::Out) else {
                out.push(Statement::Comment(format!("There is no port {name}")));
                continue;
            };
            let operand = Code::Port(port.name().into());
            match (action.act, port.sort()) {
                (Act::Stop, _) => tell(out, What::PowerOff, [operand]),
                (_, Sort::Servo) => tell(out, What::Servo, [operand, power.clone()]),
                _ => tell(out, What::SetPower, [operand, power.clone()]),
            }
        }
    }
}

fn printed(value: Typed) -> Code {
    match value.kind {
        Kind::Int | Kind::Bool => text(value),
        Kind::Text => match value.code {
            // What is surely no number stands as it is.
            Code::Text(text) if text.trim().parse::<f64>().is_err() => Code::Text(text),
            code => Code::does(What::Printed, [code]),
        },
        _ => Code::does(What::Printed, [text(value)]),
    }
}

fn light(color: &str) -> Light {
    match color {
        "red" => Light::Red,
        "green" => Light::Green,
        "orange" => Light::Orange,
        _ => Light::Off,
    }
}

/// Whether the last flag of an action asks for the picture to be shown.
fn draws(act: Act) -> bool {
    use Act::{Arc, Background, Clear, Ellipse, Line, Pixel, Print, Rectangle};
    matches!(
        act,
        Arc | Background | Clear | Ellipse | Line | Pixel | Print | Rectangle
    )
}
