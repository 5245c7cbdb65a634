//! Constraints read and checked on a world that a test writes down.

mod asked;
mod checking;
mod explain;
mod facts;
mod library;
mod naive;
mod own;
mod reading;
mod templates;
mod values;
mod verdicts;

use std::collections::BTreeMap;
use std::rc::Rc;

use super::{
    Checker, Entry, Level, Missing, Object, ObjectPoint, Rect, Rules, Scene, Unfit, Value, Verdict,
    read,
};
use lang_text::problem::{Locale, Problem, Severity};
use lang_text::xml;

/// A world: objects with a class, properties and, if they have a place, a rectangle; regions are of the class `Region`.
#[derive(Default)]
struct Stage {
    objects: Vec<(String, &'static str)>,
    properties: BTreeMap<(u32, String), Value>,
    places: BTreeMap<u32, Rect>,
    /// How often a property was asked for.
    asked: usize,
}

impl Stage {
    fn new() -> Self {
        let mut stage = Self::default();
        stage.add("robot1", "twoDModel::model::RobotModel");
        stage.place("robot1", 100, 100, 50, 50);
        stage
    }

    fn add(&mut self, name: &str, class: &'static str) {
        self.objects.push((name.to_owned(), class));
    }

    fn id(&self, name: &str) -> Option<u32> {
        let at = self.objects.iter().position(|(known, _)| known == name)?;
        u32::try_from(at).ok()
    }

    fn set(&mut self, name: &str, property: &str, value: Value) {
        let id = self.id(name).expect("the object is on the stage");
        self.properties.insert((id, property.to_owned()), value);
    }

    fn place(&mut self, name: &str, x: i32, y: i32, width: i32, height: i32) {
        let id = self.id(name).expect("the object is on the stage");
        let rect = Rect {
            x,
            y,
            width,
            height,
        };
        self.places.insert(id, rect);
    }

    fn region(&mut self, name: &str, x: i32, y: i32, width: i32, height: i32) {
        self.add(name, "Region");
        self.place(name, x, y, width, height);
    }
}

impl Scene for Stage {
    fn find(&mut self, name: &str) -> Option<Object> {
        self.id(name).map(Object)
    }

    fn type_of(&mut self, object: Object) -> Option<&'static str> {
        let class = self.objects[object.0 as usize].1;
        (!class.is_empty()).then_some(class)
    }

    fn property(&mut self, object: Object, chain: &[Box<str>]) -> Result<Value, Missing> {
        self.asked += 1;
        let value = self.properties.get(&(object.0, chain[0].to_string()));
        let value = value.cloned().ok_or(Missing::Property(0))?;
        value.descend(chain, 1)
    }

    fn set_property(&mut self, object: Object, property: &str, value: &Value) -> bool {
        match self.properties.get_mut(&(object.0, property.to_owned())) {
            Some(old) => *old = value.clone(),
            None => return false,
        }
        true
    }

    fn is_inside(
        &mut self,
        object: Object,
        region: Object,
        point: ObjectPoint,
    ) -> Result<bool, Unfit> {
        if self.objects[region.0 as usize].1 != "Region" {
            return Err(Unfit::NoRegion);
        }
        let outer = self.places[&region.0];
        let inner = self.places.get(&object.0).ok_or(Unfit::NoPlace)?;
        let right = |rect: &Rect| rect.x + rect.width;
        let bottom = |rect: &Rect| rect.y + rect.height;
        let holds = |x: i32, y: i32| {
            (outer.x..=right(&outer)).contains(&x) && (outer.y..=bottom(&outer)).contains(&y)
        };
        Ok(match point {
            ObjectPoint::Center => holds(inner.x + inner.width / 2, inner.y + inner.height / 2),
            ObjectPoint::All => holds(inner.x, inner.y) && holds(right(inner), bottom(inner)),
            ObjectPoint::Any => {
                inner.x <= right(&outer)
                    && outer.x <= right(inner)
                    && inner.y <= bottom(&outer)
                    && outer.y <= bottom(inner)
            }
        })
    }

    fn bounding_rect(&mut self, object: Object) -> Option<Rect> {
        self.places.get(&object.0).copied()
    }
}

/// Constraints with a time limit of a minute, if they do not name one.
fn document(inside: &str) -> String {
    let limit = if inside.contains("timelimit") {
        ""
    } else {
        r#"<timelimit value="60000"/>"#
    };
    format!("<constraints>{limit}{inside}</constraints>")
}

fn rules(inside: &str) -> Rc<Rules> {
    let text = document(inside);
    let element = xml::parse(&text).expect("the test writes XML");
    let told = |problems: Vec<Problem>| {
        let lines: Vec<_> = problems.iter().map(ToString::to_string).collect();
        lines.join("\n")
    };
    Rc::new(read(&element).map_err(told).expect("the rules are right"))
}

/// What is said of rules, one line for each problem; warnings begin with `?`.
fn problems(text: &str) -> Vec<String> {
    let element = xml::parse(text).expect("the test writes XML");
    let line = |problem: &Problem| {
        let sign = if problem.severity == Severity::Warning {
            "?"
        } else {
            ""
        };
        // Each error of the rules begins so.
        let text = problem.to_string();
        let text = text.replacen("Error while parsing constraints: ", "", 1);
        format!("{sign}{text}")
    };
    match read(&element) {
        Ok(rules) => rules.warnings().iter().map(line).collect(),
        Err(problems) => problems.iter().map(line).collect(),
    }
}

/// A run of rules on a stage.
struct Run {
    stage: Stage,
    checker: Checker,
    entries: Vec<Entry>,
    now_ms: u64,
}

impl Run {
    fn new(inside: &str) -> Self {
        Self::on(Stage::new(), inside)
    }

    fn on(stage: Stage, inside: &str) -> Self {
        Self {
            stage,
            checker: Checker::new(rules(inside), Locale::English),
            entries: Vec::new(),
            now_ms: 0,
        }
    }

    /// Ticks of 10 ms.
    fn ticks(&mut self, count: usize) -> Verdict {
        for _ in 0..count {
            self.now_ms += 10;
            self.checker
                .check(self.now_ms, &mut self.stage, &mut self.entries);
        }
        self.checker.verdict()
    }

    fn ends(&mut self) -> Verdict {
        self.checker
            .program_ended(self.now_ms, false, &mut self.stage, &mut self.entries)
    }

    /// What was told, without the variables.
    fn told(&self) -> Vec<&str> {
        let said = self.entries.iter();
        said.filter(|entry| entry.level != Level::Variables)
            .map(|entry| entry.text.as_str())
            .collect()
    }
}

/// Whether a condition holds in the first tick on a stage, and what was complained of.
fn holds_on(stage: Stage, condition: &str) -> (bool, Vec<String>) {
    let event = format!(
        r#"<init><setter name="five"><int value="5"/></setter></init>
        <event id="~" settedUpInitially="true"><condition><true/></condition><trigger><setUp id="a"/></trigger></event>
        <event id="a"><condition>{condition}</condition><trigger><message text="holds"/></trigger></event>"#
    );
    let mut run = Run::on(stage, &event);
    run.ticks(2);
    let told = run.told();
    let holds = told.contains(&"holds");
    let others = told.into_iter().filter(|text| *text != "holds");
    (holds, others.map(str::to_owned).collect())
}

fn holds(condition: &str) -> bool {
    let (holds, complaints) = holds_on(Stage::new(), condition);
    assert_eq!(complaints, [""; 0], "{condition}");
    holds
}
