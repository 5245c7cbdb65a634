//! From what was said on the command line to a question for the planner.
//!
//! Owns the defaults, and the names of states, outputs and actions.

use super::args::PlanArgs;
use super::field::Stand;
use super::forms::{Assignments, Bodied, Linked, Named, Ranges};
use crate::refusal::Refusal;
use lang_dcml::robot::{Part, Robot};
use lang_dcml::syntax::Domain;
use lang_plan::obstacles::{Footprint, Obstacles};
use lang_plan::room::{Body, Parts};
use lang_plan::{Axis, Goal, Link, Problem};
use lang_text::near::did_you_mean;
use lang_text::problem::Locale;
use std::f64::consts::PI;

/// Radius of a robot of which nothing is said.
const RADIUS: f64 = 0.1;
/// What the whole range of a state that is no position counts, as a share of the size of the space.
const SHARE: f64 = 0.3;

/// A question, and what is needed to show its answer.
pub(super) struct Question {
    pub problem: Problem,
    pub parts: Parts,
    pub footprint: Footprint,
    /// Other bodies of the robot.
    pub bodies: Vec<Body>,
    /// States, then outputs.
    pub names: Vec<String>,
    /// The longer side of where it is planned.
    pub size: f64,
    /// Of x and of y.
    pub area: [(f64, f64); 2],
    /// What of the goal is a position: its middle and its radius.
    pub goal: ([Option<f64>; 2], f64),
}

/// The names of a robot, and what it may be asked.
struct Names<'a> {
    all: Vec<&'a Part>,
    states: usize,
}

impl Names<'_> {
    fn find(&self, name: &str, option: &str) -> Result<usize, Refusal> {
        let found = self.all.iter().position(|part| part.name == name);
        found.ok_or_else(|| {
            let all: Vec<&str> = self.all.iter().map(|part| part.name.as_str()).collect();
            Refusal::new(format!(
                "{option}: there is no state or output {name:?}; there are {}{}",
                all.join(", "),
                did_you_mean(name, all).in_locale(Locale::English)
            ))
        })
    }

    /// What each name was given.
    fn table<T: Copy>(
        &self,
        given: impl Iterator<Item = Named<T>>,
        option: &str,
    ) -> Result<Vec<Option<T>>, Refusal> {
        let mut values = vec![None; self.all.len()];
        for (name, value) in given {
            let at = self.find(&name, option)?;
            if values[at].replace(value).is_some() {
                return Err(Refusal::new(format!("{option}: {name} is there twice")));
            }
        }
        Ok(values)
    }

    fn position(&self, named: &[String]) -> Result<Parts, Refusal> {
        let find = |name: &str| self.find(name, "--position");
        match named {
            [] => {}
            [x, y] | [x, y, _] => {
                return Ok(Parts {
                    x: find(x)?,
                    y: find(y)?,
                    heading: named.get(2).map(|name| find(name)).transpose()?,
                });
            }
            _ => return Err(Refusal::new("--position: write X,Y or X,Y,HEADING")),
        }
        let usual = |name: &str| {
            let is_it = |part: &&Part| part.name.eq_ignore_ascii_case(name);
            self.all.iter().position(is_it)
        };
        match (usual("x"), usual("y")) {
            (Some(x), Some(y)) => Ok(Parts {
                x,
                y,
                heading: usual("theta"),
            }),
            _ => Err(Refusal::new(
                "the model has no x and y: say which of its states or outputs are the position, \
                 --position X,Y or --position X,Y,HEADING",
            )),
        }
    }
}

fn numbers(given: &[Assignments]) -> impl Iterator<Item = Named<f64>> {
    given.iter().flat_map(|one| one.0.iter().cloned())
}

fn spans(given: &[Ranges]) -> impl Iterator<Item = Named<(f64, f64)>> {
    given.iter().flat_map(|one| one.0.iter().cloned())
}

/// Makes the question.
///
/// # Errors
/// What is missing or means nothing, and what to say instead.
pub(super) fn ask(
    args: &PlanArgs,
    robot: &Robot,
    obstacles: &Obstacles,
    stands: Option<&Stand>,
) -> Result<Question, Refusal> {
    let names = Names {
        states: robot.state_parts().len(),
        all: robot
            .state_parts()
            .iter()
            .chain(robot.output_parts())
            .collect(),
    };
    let parts = names.position(&args.position)?;
    let footprint = match &args.footprint {
        Some(given) => given.0.clone(),
        None => stands
            .map_or_else(
                || Footprint::circle(RADIUS),
                |stand| Ok(stand.footprint.clone()),
            )
            .map_err(|fault| Refusal::new(fault.to_string()))?,
    };
    if parts.heading.is_none() && !footprint.corners_at(Default::default()).is_empty() {
        return Err(Refusal::new(
            "a polygon turns with the robot, but no heading is known: say --position X,Y,HEADING, or \
             --footprint circle:RADIUS",
        ));
    }
    let bodies = bodies(args, &names)?;
    let start = start(args, &names, parts, stands)?;
    let goal = names.table(numbers(&args.goal), "--goal")?;
    let bounds = names.table(spans(&args.bounds), "--bounds")?;
    let weights = names.table(numbers(&args.weights), "--weights")?;
    let area = area(obstacles, &names, parts, &bounds, &start, &goal);
    let size = (area[0].1 - area[0].0).max(area[1].1 - area[1].0);
    let mut axes = axes(args, &names, parts, &bounds, &goal, area)?;
    for axis in &mut axes {
        let is_position = axis.part == parts.x || axis.part == parts.y;
        let range = axis.high - axis.low;
        axis.weight = match weights[axis.part] {
            Some(weight) => weight,
            None if is_position => 1.0,
            None if range > 0.0 => SHARE * size / range,
            None => 0.0,
        };
    }
    let problem = Problem {
        goal: goals(args, parts, &axes, &goal),
        start,
        axes,
        actions: actions(args, robot)?,
        step: args.step,
        hold: steps(args),
        links: links(args, &names)?,
    };
    Ok(Question {
        problem,
        parts,
        footprint,
        bodies,
        names: names.all.iter().map(|part| part.name.clone()).collect(),
        size,
        area,
        goal: ([goal[parts.x], goal[parts.y]], args.goal_radius),
    })
}

fn bodies(args: &PlanArgs, names: &Names<'_>) -> Result<Vec<Body>, Refusal> {
    let one = |body: &Bodied| {
        let Bodied(named, footprint) = body;
        let find = |name: &String| names.find(name, "--body");
        let heading = named.get(2).map(find).transpose()?;
        if heading.is_none() && !footprint.corners_at(Default::default()).is_empty() {
            let why = "--body: a polygon turns with its body: say X,Y,HEADING=polygon:..., or take a circle";
            return Err(Refusal::new(why));
        }
        let (x, y) = (find(&named[0])?, find(&named[1])?);
        let parts = Parts { x, y, heading };
        let footprint = footprint.clone();
        Ok(Body { parts, footprint })
    };
    args.bodies.iter().map(one).collect()
}

fn links(args: &PlanArgs, names: &Names<'_>) -> Result<Vec<Link>, Refusal> {
    let one = |link: &Linked| {
        let Linked(named, tolerance) = link;
        let find = |at: usize| names.find(&named[at], "--link");
        Ok(Link {
            from: [find(0)?, find(1)?],
            to: [find(2)?, find(3)?],
            tolerance: *tolerance,
        })
    };
    args.links.iter().map(one).collect()
}

fn start(
    args: &PlanArgs,
    names: &Names<'_>,
    parts: Parts,
    stands: Option<&Stand>,
) -> Result<Vec<f64>, Refusal> {
    let given = names.table(numbers(&args.start), "--start")?;
    let computed = |(at, value): &(usize, &Option<f64>)| *at >= names.states && value.is_some();
    if let Some((at, _)) = given.iter().enumerate().find(computed) {
        let states: Vec<String> = names.all[..names.states]
            .iter()
            .map(|part| format!("{}=...", part.name))
            .collect();
        return Err(Refusal::new(format!(
            "--start: {} is computed from the state: say --start {}",
            names.all[at].name,
            states.join(",")
        )));
    }
    let mut start = vec![0.0; names.states];
    if let Some(stand) = stands {
        for (part, value) in [
            (Some(parts.x), stand.pose.at[0]),
            (Some(parts.y), stand.pose.at[1]),
            (parts.heading, stand.pose.heading),
        ] {
            if let Some(slot) = part.and_then(|part| start.get_mut(part)) {
                *slot = value;
            }
        }
    }
    for (slot, value) in start.iter_mut().zip(given) {
        *slot = value.unwrap_or(*slot);
    }
    Ok(start)
}

/// Where x and y are sampled.
fn area(
    obstacles: &Obstacles,
    names: &Names<'_>,
    parts: Parts,
    bounds: &[Option<(f64, f64)>],
    start: &[f64],
    goal: &[Option<f64>],
) -> [(f64, f64); 2] {
    let around = obstacles.bounds();
    let workspace = obstacles.workspace();
    let mut free = [(0.0, 0.0); 2];
    for (axis, part) in [parts.x, parts.y].into_iter().enumerate() {
        let mut known: Vec<f64> = around
            .iter()
            .flat_map(|all| [all[axis], all[axis + 2]])
            .collect();
        known.extend(start.get(part));
        known.extend(goal[part]);
        let low = known.iter().copied().fold(f64::INFINITY, f64::min);
        let high = known.iter().copied().fold(f64::NEG_INFINITY, f64::max);
        free[axis] = if low <= high { (low, high) } else { (0.0, 0.0) };
    }
    // Room to drive around everything.
    let longest = (free[0].1 - free[0].0).max(free[1].1 - free[1].0);
    let margin = (longest / 4.0).max(1.0);
    let mut area = free.map(|(low, high)| (low - margin, high + margin));
    for (axis, part) in [parts.x, parts.y].into_iter().enumerate() {
        let said = bounds[part].or_else(|| range_of(names.all[part]));
        let space = workspace.map(|all| (all[axis], all[axis + 2]));
        area[axis] = said.or(space).unwrap_or(area[axis]);
    }
    area
}

fn range_of(part: &Part) -> Option<(f64, f64)> {
    match part.domain {
        Some(Domain::Range(low, high)) => Some((low, high)),
        _ => None,
    }
}

fn axes(
    args: &PlanArgs,
    names: &Names<'_>,
    parts: Parts,
    bounds: &[Option<(f64, f64)>],
    goal: &[Option<f64>],
    area: [(f64, f64); 2],
) -> Result<Vec<Axis>, Refusal> {
    let mut angles = vec![false; names.all.len()];
    for name in &args.angles {
        angles[names.find(name, "--angles")?] = true;
    }
    let mut axes = Vec::new();
    for (part, about) in names.all.iter().enumerate() {
        let (low, high, is_angle) = if part == parts.x {
            (area[0].0, area[0].1, false)
        } else if part == parts.y {
            (area[1].0, area[1].1, false)
        } else if let Some((low, high)) = bounds[part].or_else(|| range_of(about)) {
            (low, high, false)
        } else if angles[part]
            || about.domain == Some(Domain::Circle)
            || parts.heading == Some(part)
        {
            (-PI, PI, true)
        } else if goal[part].is_none() && (part >= names.states || parts.x >= names.states) {
            // What only follows from the state; and the state behind a pose that is computed from it.
            continue;
        } else {
            let name = &about.name;
            return Err(Refusal::new(format!(
                "{name} has no range: say --bounds {name}=LOW..HIGH, or --angles {name} if it is an angle, or write \
                 `{name} in LOW .. HIGH` or `{name} in S1` in the model"
            )));
        };
        axes.push(Axis {
            part,
            weight: 1.0,
            low,
            high,
            is_angle,
        });
    }
    Ok(axes)
}

fn goals(args: &PlanArgs, parts: Parts, axes: &[Axis], goal: &[Option<f64>]) -> Vec<Goal> {
    let mut position = Vec::new();
    let mut goals = Vec::new();
    for (at, axis) in axes.iter().enumerate() {
        let Some(value) = goal[axis.part] else {
            continue;
        };
        if axis.part == parts.x || axis.part == parts.y {
            position.push((at, value));
        } else {
            let is_angle = axis.is_angle || parts.heading == Some(axis.part);
            goals.push(Goal {
                wanted: vec![(at, value)],
                tolerance: if is_angle {
                    args.goal_angle
                } else {
                    args.goal_radius
                },
            });
        }
    }
    if !position.is_empty() {
        goals.push(Goal {
            wanted: position,
            tolerance: args.goal_radius,
        });
    }
    goals
}

fn actions(args: &PlanArgs, robot: &Robot) -> Result<Vec<(f64, f64)>, Refusal> {
    let parts = robot.action_parts();
    let mut ranges: Vec<Option<(f64, f64)>> = parts.iter().map(range_of).collect();
    let mut said = vec![false; parts.len()];
    for (name, range) in spans(&args.actions) {
        let Some(at) = parts.iter().position(|part| part.name == name) else {
            let all: Vec<&str> = parts.iter().map(|part| part.name.as_str()).collect();
            return Err(Refusal::new(format!(
                "--actions: there is no action {name:?}; there are {}",
                all.join(", ")
            )));
        };
        if std::mem::replace(&mut said[at], true) {
            return Err(Refusal::new(format!("--actions: {name} is there twice")));
        }
        ranges[at] = Some(range);
    }
    let missing: Vec<String> = parts
        .iter()
        .zip(&ranges)
        .filter(|(_, range)| range.is_none())
        .map(|(part, _)| format!("{}=LOW..HIGH", part.name))
        .collect();
    if missing.is_empty() {
        Ok(ranges.into_iter().flatten().collect())
    } else {
        Err(Refusal::new(format!(
            "actions have no range: say --actions {}, or write `in LOW .. HIGH` after their names in the model",
            missing.join(",")
        )))
    }
}

/// How many steps an action is held; a planner refuses what is too many.
fn steps(args: &PlanArgs) -> (u32, u32) {
    let (low, high) = args.hold;
    let least = (low / args.step).round().max(1.0) as u32;
    let most = (high / args.step).round().max(1.0) as u32;
    (least, most.max(least))
}
