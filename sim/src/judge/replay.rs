//! A recorded run held against the rules of a task, as if it happened now.
//!
//! Owns the way back from a trajectory to a world: robots are put where they were, and devices are changed again as they
//! were. Sensors of such a world show what they would have shown there.

use super::recorder::replay;
use super::run::{Outcome, Run, Settings, Verdict};
use super::task::Task;
use super::trajectory::{Record, Trajectory};
use super::words;
use crate::arena::{Arena, Setup};
use crate::field::{self, Field};
use lang_diagram::brick::{Brick, Command};
use lang_diagram::machine::STEP_MS;
use lang_diagram::ports::Port;
use lang_diagram::stand_in::Pose;
use lang_text::problem::Words;
use std::rc::Rc;

/// Judges a recorded run: every robot of it that the world knows by its name. Its last moment is the end of its program.
pub fn judge_recorded(task: &Task, trajectory: &Trajectory, settings: &Settings) -> Outcome {
    let mut field = task.field.clone();
    // What moved a robot is known; nothing is to be added to it.
    field.settings = field::Settings {
        background: field.settings.background,
        ..field::Settings::default()
    };
    let (others, cast) = cast(&field, trajectory);
    let setup = Setup {
        others,
        ..Setup::default()
    };
    let mut arena = Arena::new(&field, setup);
    let mut run = Run::new(task, &Rc::new(settings.clone()), &arena);
    let is_pose_of_ours = |record: &Record| match record {
        Record::Pose { robot, .. } => cast[usize::from(*robot)].is_some(),
        Record::Device { .. } => false,
    };
    if !trajectory.records.iter().any(is_pose_of_ours) {
        let why = match cast.iter().any(Option::is_some) || cast.is_empty() {
            true => words::nothing_recorded(),
            false => words::nobody_known(&trajectory.robots),
        };
        run.fail(0, why);
        run.verdict = Some(Verdict::Unknown);
        return run.outcome(0, &arena);
    }
    let mut tracks: Vec<(Track, usize)> = (0..)
        .zip(&cast)
        .filter_map(|(robot, index)| Some((Track::new(trajectory, robot), (*index)?)))
        .collect();
    let mut records = trajectory.records.iter().peekable();
    let end = trajectory.records.last().map_or(0, Record::ms);
    let began = settings.clock.now();
    let mut now = 0;
    loop {
        for (track, index) in &mut tracks {
            track.put(now, &mut arena, *index);
        }
        while let Some(record) = records.next_if(|record| record.ms() <= now) {
            if let Record::Device { robot, change, .. } = record
                && let Some(index) = cast[usize::from(*robot)]
            {
                replay(&mut arena.robot(index), change);
            }
        }
        run.record(now, &arena);
        arena.renew();
        if now > 0 && run.check(now, &mut arena) {
            break;
        }
        if now >= end.min(settings.longest_ms) {
            run.ended(now, false, &mut arena);
            break;
        }
        if settings.clock.since(began) > settings.longest {
            run.fail(now, words::too_slow(settings.longest.as_secs_f64()));
            run.verdict = Some(Verdict::Unknown);
            break;
        }
        now += STEP_MS;
        arena.tick();
    }
    run.outcome(now, &arena)
}

/// What of a record does not fit the world: robots that are not there, whose poses count for nothing, or that have
/// another name.
pub fn strange_in_record(task: &Task, trajectory: &Trajectory) -> Vec<Words> {
    let (_, cast) = cast(&task.field, trajectory);
    let own = first_name(&task.field);
    let strange = trajectory.robots.iter().zip(&cast);
    strange
        .filter_map(|(name, index)| match index {
            None => Some(words::robot_unknown(name)),
            Some(0) if name != own => Some(words::robot_renamed(name, own)),
            Some(_) => None,
        })
        .collect()
}

/// The name of the robot that an arena of this field begins with.
fn first_name(field: &Field) -> &str {
    let first = field.robot().or_else(|| field.robots.first());
    first.map_or("", |robot| &robot.id)
}

/// Robots that stand beside the first one, and which robot of the arena plays each one of the record. A record of one
/// robot is that of the first one, whatever it is called.
fn cast(field: &Field, trajectory: &Trajectory) -> (Vec<field::Robot>, Vec<Option<usize>>) {
    let own = first_name(field);
    let mut others: Vec<field::Robot> = Vec::new();
    let is_alone = trajectory.robots.len() == 1;
    let mut cast = Vec::with_capacity(trajectory.robots.len());
    for name in &trajectory.robots {
        let found = field.robots.iter().find(|robot| robot.id == *name);
        cast.push(match found {
            _ if name == own || is_alone => Some(0),
            Some(robot) => {
                others.push(robot.clone());
                Some(others.len())
            }
            None => None,
        });
    }
    (others, cast)
}

/// Where one robot was.
struct Track {
    poses: Vec<[f64; 4]>,
    next: usize,
}

impl Track {
    fn new(trajectory: &Trajectory, robot: u16) -> Self {
        Self {
            poses: trajectory.poses(robot).collect(),
            next: 0,
        }
    }

    /// Puts a robot where it was at a moment. Its motors are on if it moves in the tick that follows: power shows in the
    /// pose of the next tick.
    fn put(&mut self, now: u32, arena: &mut Arena, index: usize) {
        let is_due = |pose: &[f64; 4]| pose[0] <= f64::from(now);
        while self.poses.get(self.next).is_some_and(is_due) {
            self.next += 1;
        }
        let Some(&[_, x, y, degrees]) = self.next.checked_sub(1).and_then(|at| self.poses.get(at))
        else {
            return;
        };
        if let Some(robot) = arena.robot_mut(index) {
            robot.put(Pose { x, y, degrees });
        }
        let soon = f64::from(now + STEP_MS);
        let is_riding = self
            .poses
            .get(self.next)
            .is_some_and(|next| next[0] <= soon && next[1..] != [x, y, degrees]);
        let percent = i32::from(is_riding);
        if let Some(port) = Port::named("M3") {
            arena.robot(index).command(Command::Power { port, percent });
        }
    }
}

#[cfg(test)]
mod tests {
    use super::super::{Settings, Texts};
    use super::*;

    /// A floor with two robots, and a rule: the second one reaches the region.
    fn task() -> Task {
        let world = r#"<root version="20251219"><world><regions>
<region id="there" type="rectangle" x="200" y="0" width="100" height="100"/></regions>
<robot position="0:0" direction="0"/></world>
<robots><robot id="trikKitRobot"/><robot id="second"/></robots>
<settings/>
<constraints><timelimit value="1000"/>
<event settedUpInitially="true"><condition><inside objectId="robot2" regionId="there"/></condition>
<trigger><success/></trigger></event></constraints></root>"#;
        let texts = Texts {
            world,
            ..Texts::default()
        };
        Task::read(texts).unwrap().0
    }

    fn record(names: [&str; 2]) -> Trajectory {
        let one = |name: &str, ms, x| {
            format!(r#"{{"robotId":"{name}","timestamp":{ms},"x":{x},"y":10,"rotation":0}}"#)
        };
        let [a, b] = names;
        let all = [
            one(a, 10, 0),
            one(b, 10, 0),
            one(a, 20, 5),
            one(b, 20, 220),
            one(a, 30, 9),
        ];
        Trajectory::read(&format!("[{}]", all.join(","))).unwrap()
    }

    #[test]
    fn every_robot_of_a_record_is_judged() {
        let task = task();
        let recorded = record(["trikKitRobot", "second"]);
        let outcome = judge_recorded(&task, &recorded, &Settings::default());
        assert_eq!((outcome.verdict, outcome.ms), (Verdict::Accomplished, 20));
        assert_eq!(strange_in_record(&task, &recorded), []);
        // The order in which they are met does not matter.
        let recorded = record(["second", "trikKitRobot"]);
        let outcome = judge_recorded(&task, &recorded, &Settings::default());
        assert_eq!(outcome.verdict, Verdict::Failed);
    }

    #[test]
    fn robots_that_the_world_does_not_know_are_told() {
        let task = task();
        let recorded = record(["trikKitRobot", "stranger"]);
        let strange = strange_in_record(&task, &recorded);
        assert!(strange[0].english.contains("'stranger'"), "{strange:?}");
        assert_eq!(strange.len(), 1);
        let none = record(["someone", "stranger"]);
        let outcome = judge_recorded(&task, &none, &Settings::default());
        assert_eq!(outcome.verdict, Verdict::Unknown);
        assert!(outcome.entries[0].text.contains("'someone', 'stranger'"));
        // One alone is the robot of the world, by another name.
        let mut alone = record(["other", "other"]);
        alone.robots.truncate(1);
        assert_eq!(strange_in_record(&task, &alone).len(), 1);
        let outcome = judge_recorded(&task, &alone, &Settings::default());
        assert_ne!(outcome.verdict, Verdict::Unknown);
    }
}
