//! A task: a world, its rules, and the sensors that a program needs beside those of the world.
//!
//! Owns what becomes of the texts of a project or a field. A field replaces the whole world of a project: walls, robot,
//! sensors and rules; pictures that the project holds stay within reach.

use super::words;
use crate::field::{Field, Locks, SensorKind};
use lang_constraint::{Rules, read_with_templates};
use lang_diagram::devices::{self, Sensor};
use lang_diagram::ports::Port;
use lang_diagram::program::Program;
use lang_diagram::project::Project;
use lang_text::problem::{Problem, Words};
use lang_text::xml::{self, Element};
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
    /// What the task that was given out locks.
    pub locks: Locks,
}

/// The texts of a task.
#[derive(Clone, Copy, Debug, Default)]
pub struct Texts<'a> {
    /// The world model, as XML.
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
        let opened = Field::read(texts.world)?;
        let (mut field, mut problems): (Field, Vec<Problem>) = (opened.field, opened.problems);
        if let Some(blobs) = texts.blobs {
            problems.extend(field.add_blobs(blobs));
        }
        let templates = templates(texts.templates, &mut problems);
        let rules = match &field.constraints {
            Some(element) if element.elements().next().is_some() => {
                let rules = read_with_templates(element, templates.as_ref());
                let rules = rules.map_err(in_rules)?;
                problems.extend(rules.warnings().iter().cloned());
                Some(Rc::new(rules))
            }
            _ => None,
        };
        let task = Self {
            field,
            rules,
            sensors: Vec::new(),
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

    /// Gives the robot the sensors that a diagram waits for, on ports that are empty, unless a teacher has locked them.
    pub fn plug_in(&mut self, project: &Project, program: &Program) {
        if self.locks.sensors || Locks::of(&project.meta).sensors {
            return;
        }
        let kinds = devices::needed(program).into_iter();
        self.sensors = kinds
            .filter_map(|(port, sensor)| {
                let kind = match sensor {
                    Sensor::Infrared => SensorKind::Infrared,
                    Sensor::Sonar => SensorKind::Sonar,
                    Sensor::Light => SensorKind::Light,
                    Sensor::Touch => SensorKind::Touch,
                    Sensor::Other => return None,
                };
                Some((port, kind))
            })
            .collect();
    }
}

/// All templates of a project under one element; none if it has none. What cannot be read is told and left out.
fn templates(
    files: Option<&BTreeMap<String, String>>,
    problems: &mut Vec<Problem>,
) -> Option<Element<'static>> {
    let mut all = Element::new("templates");
    for text in files?.values() {
        match xml::parse(text) {
            Ok(element) => all.nodes.extend(element.into_owned().nodes),
            Err(problem) => problems.push(problem),
        }
    }
    (!all.nodes.is_empty()).then_some(all)
}

/// Problems of rules, with the words by which the original tells them.
fn in_rules(mut problems: Vec<Problem>) -> Vec<Problem> {
    for problem in &mut problems {
        problem.words = words::in_rules(&problem.words);
    }
    problems
}
