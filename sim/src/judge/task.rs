//! A task: a world, its rules, and the sensors that a program needs beside those of the world.
//!
//! Owns what becomes of the texts of a project or a field. A field replaces the whole world of a project: walls, robot,
//! sensors and rules; pictures that the project holds stay within reach.

use super::words;
use crate::field::{Field, Locks, SensorKind};
use lang_constraint::{Rules, read_with_templates, unread};
use lang_diagram::devices::{self, Sensor};
use lang_diagram::ports::Port;
use lang_diagram::program::Program;
use lang_diagram::project::Project;
use lang_text::problem::{Problem, Words};
use std::collections::BTreeMap;
use std::rc::Rc;

/// A world with rules, ready for runs.
#[derive(Clone, Debug, Default)]
pub struct Task {
    /// The world.
    pub field: Field,
    /// What is demanded; none if the world has no rules.
    pub rules: Option<Rc<Rules>>,
    /// Sensors that go onto ports that are empty.
    pub sensors: Vec<(Port, SensorKind)>,
    /// What is told of these sensors before a run.
    pub told: Vec<Words>,
    /// What the task that was given out locks.
    pub locks: Locks,
}

/// The texts of a task.
#[derive(Clone, Copy, Debug, Default)]
pub struct Texts<'a> {
    /// The world model, as XML; empty for a save without one.
    pub world: &'a str,
    /// Embedded pictures, as XML.
    pub blobs: Option<&'a str>,
    /// Templates of rules by file, as XML.
    pub templates: Option<&'a BTreeMap<String, String>>,
}

impl Task {
    /// Reads world and rules; also what is odd in them.
    ///
    /// # Errors
    /// Everything for which nothing can be judged.
    pub fn read(texts: Texts<'_>) -> Result<(Self, Vec<Problem>), Vec<Problem>> {
        // A save without a world, or with an empty one, runs in an empty world.
        let (mut field, mut problems) = match texts.world.trim() {
            "" => (Field::default(), Vec::new()),
            _ => {
                let told = |all: Vec<Problem>| all.into_iter().map(unread).collect::<Vec<_>>();
                let opened = Field::read(texts.world).map_err(told)?;
                (opened.field, opened.problems)
            }
        };
        if let Some(blobs) = texts.blobs {
            problems.extend(field.add_blobs(blobs));
        }
        let templates = texts.templates.into_iter().flat_map(BTreeMap::values);
        let templates: Vec<&str> = templates.map(String::as_str).collect();
        let rules = match &field.constraints {
            Some(element) => {
                let rules = read_with_templates(element, &templates)?;
                problems.extend(rules.warnings().iter().cloned());
                Some(Rc::new(rules))
            }
            None => None,
        };
        let task = Self {
            field,
            rules,
            sensors: Vec::new(),
            told: Vec::new(),
            locks: Locks::default(),
        };
        Ok((task, problems))
    }

    /// Puts what a given task locks into the world of a solution, with the rules of the task; what was changed there is
    /// told.
    pub fn hold(&mut self, given: &Self, locks: Locks) -> Vec<Words> {
        self.locks = locks;
        if given.rules.is_some() {
            self.rules.clone_from(&given.rules);
        }
        self.field.hold(&given.field, locks)
    }

    /// Gives the robot the sensors that a diagram waits for, on ports that are empty, unless a teacher has locked them; and
    /// tells which ones.
    pub fn plug_in(&mut self, project: &Project, program: &Program) {
        if self.locks.sensors || Locks::of(&project.meta).sensors {
            return;
        }
        self.sensors.clear();
        self.told.clear();
        for (port, sensor) in devices::missing(project, program) {
            let kind = match sensor {
                Sensor::Infrared => Some(SensorKind::Infrared),
                Sensor::Sonar => Some(SensorKind::Sonar),
                Sensor::Light => Some(SensorKind::Light),
                Sensor::Touch => Some(SensorKind::Touch),
                Sensor::Other => None,
            };
            self.sensors.extend(kind.map(|kind| (port, kind)));
            self.told.push(words::configured(sensor, port.name()));
        }
    }
}
