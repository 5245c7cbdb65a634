//! Readings: one of each sensor in an instant, polls of blocks that give them, the gamepad and messages.
//!
//! Owns what is asked of the robot and when. Knows no order of tokens.

use super::state::Memory;
use super::values::list;
use super::words;
use super::{Env, Halt, Machine};
use crate::limits;
use crate::program::{Camera, NodeId, Op, Read, Source};
use crate::sensors;
use lang_diagram::brick::{Brick, Command};
use lang_diagram::ports::{Device, Port, Sort};
use lang_expr::reserved::SensorIndex;
use lang_expr::{Outside, Value};
use lang_text::problem::Problem;
use std::collections::BTreeMap;

/// What sensors say in an instant: each is asked once, so that all blocks see the same.
#[derive(Clone, Debug, Default)]
pub(super) struct Readings {
    known: BTreeMap<Port, Option<Value>>,
    scratch: Vec<i32>,
}

impl Readings {
    /// A new instant.
    pub fn begin(&mut self) {
        self.known.clear();
    }

    /// What a port says; `None` if nothing is plugged in there.
    pub fn of(&mut self, port: Port, brick: &mut dyn Brick) -> Option<Value> {
        if let Some(known) = self.known.get(&port) {
            return known.clone();
        }
        let value = match port.sort() {
            Sort::Vector => {
                self.scratch.clear();
                let is_there = brick.vector(port, &mut self.scratch);
                is_there.then(|| Value::ints(&self.scratch))
            }
            Sort::Motor | Sort::Servo | Sort::Encoder | Sort::Scalar | Sort::Button(_) => {
                brick.scalar(port).map(Value::Int)
            }
        };
        self.known.insert(port, value.clone());
        value
    }

    /// What a sensor variable says.
    fn variable(&mut self, sensor: SensorIndex, brick: &mut dyn Brick) -> Option<Value> {
        match sensors::part(sensor) {
            Some((port, place)) => self.part(port, place, brick),
            None => self.of(Port::shown_by(sensors::name(sensor))?, brick),
        }
    }

    /// One number of what a port says.
    fn part(&mut self, port: Port, place: u8, brick: &mut dyn Brick) -> Option<Value> {
        let all = self.of(port, brick)?;
        let items = super::values::items(&all).ok()?;
        items.get(usize::from(place)).cloned()
    }

    /// What a sensor of the camera says.
    fn camera(&mut self, camera: Camera, brick: &mut dyn Brick) -> Option<Value> {
        match camera {
            Camera::Line => self.of(Port::named("LineSensorPort")?, brick),
            Camera::Color => self.of(Port::named("ColorSensorPort")?, brick),
            Camera::Object => {
                let parts = [
                    "ObjectSensorXPort",
                    "ObjectSensorYPort",
                    "ObjectSensorSizePort",
                ];
                let values: Option<Vec<Value>> = parts
                    .into_iter()
                    .map(|part| self.of(Port::named(part)?, brick))
                    .collect();
                values.map(list)
            }
        }
    }
}

/// The robot as expressions see it.
pub(super) struct Robot<'a> {
    pub readings: &'a mut Readings,
    pub brick: &'a mut dyn Brick,
    pub now: u32,
    /// The first sensor that said nothing.
    pub missing: Option<SensorIndex>,
}

impl Outside for Robot<'_> {
    fn sensor(&mut self, sensor: SensorIndex) -> Value {
        match self.readings.variable(sensor, self.brick) {
            Some(value) => value,
            None => {
                self.missing.get_or_insert(sensor);
                Value::Nil
            }
        }
    }

    fn time(&mut self) -> i32 {
        i32::try_from(self.now).unwrap_or(i32::MAX)
    }

    fn print(&mut self, text: &str) {
        self.brick.command(Command::Console { text });
    }

    fn random(&mut self, below: i32) -> i32 {
        let most = below.saturating_sub(1).max(0);
        self.brick.random_of_function(0, most)
    }
}

/// Whether the camera tells what a sensor variable says.
fn is_of_camera(sensor: SensorIndex) -> bool {
    let port = match sensors::part(sensor) {
        Some((port, _)) => Some(port),
        None => Port::shown_by(sensors::name(sensor)),
    };
    port.is_some_and(|port| match port.device() {
        Device::LineSensor | Device::ColorSensor | Device::ObjectSensor(_) => true,
        Device::Motor
        | Device::Servo
        | Device::Encoder
        | Device::Plugged
        | Device::Gyroscope
        | Device::Accelerometer
        | Device::Lidar
        | Device::Button(_)
        | Device::Gamepad(_) => false,
    })
}

/// What a block reads, by the name that people know.
pub(super) fn device(source: &Source) -> &'static str {
    match source {
        Source::Sensor(sensor) => crate::sensors::name(*sensor),
        Source::Detect(Camera::Line) => "lineSensor",
        Source::Detect(Camera::Object) => "objectSensor",
        Source::Detect(Camera::Color) => "colorSensor",
        Source::Encoders(_) => "encoders",
        Source::Gamepad => "gamepad",
        Source::Receive => "messages",
    }
}

impl Machine {
    /// A block gives readings from now on. A sensor that is not there ends the program at once.
    pub(super) fn subscribe(
        &mut self,
        id: NodeId,
        source: &Source,
        env: &mut Env<'_>,
    ) -> Result<(), Halt> {
        if let Err(at) = self.subscribed.binary_search(&id) {
            if !self.is_readable(source, env) {
                return Err(self.fault(id, words::no_reading(device(source)), env));
            }
            self.subscribed.insert(at, id);
        }
        Ok(())
    }

    /// Whether the robot has what a block gives readings of.
    pub(super) fn is_readable(&mut self, source: &Source, env: &mut Env<'_>) -> bool {
        match source {
            Source::Sensor(_) | Source::Detect(_) => self.reading(source, env).is_some(),
            Source::Encoders(_) | Source::Gamepad | Source::Receive => true,
        }
    }

    /// Sensors that the robot does not have and that blocks ask for later are told before anything moves: the first such
    /// block that starts ends the program. Those of blocks that start now end it now. The camera is not asked: that would
    /// start it, and it says nothing before its first picture.
    pub(super) fn tell_lacking(&mut self, env: &mut Env<'_>) {
        let main = env.program.instances.first();
        let starts = main.map_or(&[][..], |main| &main.starts);
        for (id, node) in (0..).zip(&env.program.nodes) {
            let Op::Source(source @ Source::Sensor(sensor)) = &node.op else {
                continue;
            };
            // They are in the order of the nodes.
            let starts_now = starts.binary_search_by_key(&id, |start| start.node).is_ok();
            if starts_now || is_of_camera(*sensor) || self.is_readable(source, env) {
                continue;
            }
            if self.warnings.len() < lang_text::limits::PROBLEMS {
                let mut problem = Problem::warning(words::no_reading_later());
                problem.place = env.program.place(id);
                self.warnings.push(problem);
            }
        }
    }

    /// The same for sensors that expressions read, each told once, at the first text that has it. A text that is computed
    /// in the first instant ends the program then.
    pub(super) fn tell_unreadable(&mut self, env: &mut Env<'_>) {
        for (formula, sensor) in self.formulas.sensors() {
            if is_of_camera(sensor) || self.readings.variable(sensor, env.brick).is_some() {
                continue;
            }
            if self.warnings.len() < lang_text::limits::PROBLEMS {
                let name = crate::sensors::name(sensor);
                let mut problem = Problem::warning(words::sensor_missing_later(name));
                let text = &env.program.formulas[formula as usize];
                problem.place = env.program.property_place(text.node, text.property, None);
                self.warnings.push(problem);
            }
        }
    }

    /// What a block would give now that gives one sensor's readings.
    fn reading(&mut self, source: &Source, env: &mut Env<'_>) -> Option<Value> {
        match source {
            Source::Sensor(sensor) => self.readings.variable(*sensor, env.brick),
            Source::Detect(camera) => self.readings.camera(*camera, env.brick),
            Source::Encoders(_) | Source::Gamepad | Source::Receive => None,
        }
    }

    /// The reading of a port for a block that asks for it now.
    pub(super) fn read_port(&mut self, read: Read, env: &mut Env<'_>) -> Option<Value> {
        match read {
            Read::Device(port) => self.readings.of(port, env.brick),
            Read::Part(port, place) => self.readings.part(port, place, env.brick),
            Read::Told(motor) => {
                let power = self.told.get(&motor).copied().unwrap_or_default();
                Some(Value::Int(power))
            }
        }
    }

    /// Blocks that give readings do so.
    pub(super) fn poll(&mut self, env: &mut Env<'_>) -> Result<(), Halt> {
        for at in 0..self.subscribed.len() {
            let id = self.subscribed[at];
            let Op::Source(source) = &env.program.node(id).op else {
                continue;
            };
            match source {
                Source::Sensor(_) | Source::Detect(_) => match self.reading(source, env) {
                    Some(value) => self.send(id, SENSOR_OUT, &value, env)?,
                    None => self.gap(id, env),
                },
                Source::Encoders(devices) => self.poll_encoders(id, devices, env)?,
                Source::Gamepad => self.poll_gamepad(id, env)?,
                Source::Receive => {}
            }
        }
        Ok(())
    }

    /// A reading is missing; told once for each block.
    fn gap(&mut self, id: NodeId, env: &mut Env<'_>) {
        if let Memory::Readings { has_failed } | Memory::Offsets(_, has_failed) =
            &mut self.states[id as usize].memory
            && !std::mem::replace(has_failed, true)
            && self.warnings.len() < lang_text::limits::PROBLEMS
        {
            let mut problem = Problem::warning(words::reading_failed());
            problem.place = env.program.place(id);
            self.warnings.push(problem);
        }
    }

    fn poll_encoders(
        &mut self,
        id: NodeId,
        devices: &[(Port, bool); 4],
        env: &mut Env<'_>,
    ) -> Result<(), Halt> {
        let Memory::Offsets(offsets, _) = self.states[id as usize].memory else {
            return Ok(());
        };
        for (at, ((port, _), offset)) in devices.iter().zip(offsets).enumerate() {
            let Some(offset) = offset else {
                continue;
            };
            match self.readings.of(*port, env.brick) {
                Some(value) => {
                    let degrees = value.to_int().saturating_add(offset);
                    self.send(id, ENCODER_OUT + at as u8, &Value::Int(degrees), env)?;
                }
                None => self.gap(id, env),
            }
        }
        Ok(())
    }

    fn poll_gamepad(&mut self, id: NodeId, env: &mut Env<'_>) -> Result<(), Halt> {
        let Memory::Pads {
            mut pressed,
            mut wheel,
        } = self.states[id as usize].memory
        else {
            return Ok(());
        };
        for (at, was_pressed) in pressed.iter_mut().enumerate() {
            let number = Value::Int(at as i32 + 1);
            let is_pressed = self.pad_number(&format!("gamepadPad{}Pressed", at + 1), env) != 0;
            let port = Port::shown_by(&format!("gamepadPad{}", at + 1));
            let place = port.and_then(|port| self.readings.of(port, env.brick));
            let place = place
                .as_ref()
                .and_then(|place| super::values::items(place).ok());
            let at = match (is_pressed, place) {
                (true, Some([x, y, ..])) => Some([x.clone(), y.clone()]),
                (false, _) if *was_pressed => Some([Value::Int(0), Value::Int(0)]),
                (true | false, _) => None,
            };
            if let Some([x, y]) = at {
                self.send(id, PAD_OUT, &list(vec![number, x, y]), env)?;
            }
            *was_pressed = is_pressed;
        }
        for button in 1..=5 {
            let value = self.pad_number(&format!("gamepadButton{button}"), env);
            if value != 0 {
                let token = list(vec![Value::Int(button), Value::Int(value)]);
                self.send(id, BUTTON_OUT, &token, env)?;
            }
        }
        let turned = self.pad_number("gamepadWheel", env);
        if wheel != Some(turned) {
            if wheel.is_some() || turned != 0 {
                self.send(id, WHEEL_OUT, &Value::Int(turned), env)?;
            }
            wheel = Some(turned);
        }
        self.states[id as usize].memory = Memory::Pads { pressed, wheel };
        Ok(())
    }

    /// A number of the gamepad; 0 if there is none.
    fn pad_number(&mut self, variable: &str, env: &mut Env<'_>) -> i32 {
        let port = Port::shown_by(variable);
        let value = port.and_then(|port| self.readings.of(port, env.brick));
        value.map_or(0, |value| value.to_int())
    }

    /// Messages of other robots go to all blocks that wait for them.
    pub(super) fn receive(&mut self, env: &mut Env<'_>) -> Result<(), Halt> {
        let receives =
            |id: &NodeId| matches!(env.program.node(*id).op, Op::Source(Source::Receive));
        let receivers: Vec<NodeId> = self.subscribed.iter().copied().filter(receives).collect();
        if receivers.is_empty() {
            return Ok(());
        }
        for _ in 0..limits::MAIL_MAX {
            let Some((sender, text)) = env.brick.letter() else {
                break;
            };
            let token = list(vec![Value::Int(sender.unwrap_or(0)), Value::text(text)]);
            for &id in &receivers {
                self.send(id, SENSOR_OUT, &token, env)?;
            }
        }
        Ok(())
    }
}

/// Ports of the blocks that give readings; a test holds them against the table.
pub(super) const SENSOR_OUT: u8 = 1;
pub(super) const ENCODER_OUT: u8 = 6;
pub(super) const PAD_OUT: u8 = 1;
pub(super) const BUTTON_OUT: u8 = 2;
pub(super) const WHEEL_OUT: u8 = 3;
