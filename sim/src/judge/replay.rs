//! A recorded run held against the rules of a task, as if it happened now.
//!
//! Owns the way back from a trajectory to a world: robots are put where they were, and devices are told again what they
//! were told. Sensors of such a world show what they would have shown there.

use super::recorder::replay;
use super::run::{Outcome, Run, Settings, Verdict};
use super::task::Task;
use super::trajectory::{Record, Trajectory};
use super::words;
use crate::arena::{Arena, Setup};
use lang::diagram::brick::{Brick, Command};
use lang::diagram::machine::STEP_MS;
use lang::diagram::ports::Port;
use lang::diagram::stand_in::Pose;
use std::time::Instant;

/// Judges a recorded run. Its last moment is the end of its program.
pub fn judge_recorded(task: &Task, trajectory: &Trajectory, settings: &Settings) -> Outcome {
    let mut field = task.field.clone();
    // What moved a robot is known; nothing is to be added to it.
    field.settings = crate::field::Settings {
        background: field.settings.background,
        ..crate::field::Settings::default()
    };
    let mut arena = Arena::new(&field, Setup::default());
    let mut run = Run::new(task, settings, &arena);
    let has_poses = |record: &Record| matches!(record, Record::Pose { .. });
    if !trajectory.records.iter().any(has_poses) {
        run.fail(0, words::nothing_recorded());
        run.verdict = Some(Verdict::Unknown);
        return run.outcome(0);
    }
    let mut tracks: Vec<Track> = (0..arena.robots().len())
        .map(|robot| Track::new(trajectory, robot as u16))
        .collect();
    let mut told = trajectory.records.iter().peekable();
    let end = trajectory.records.last().map_or(0, Record::ms);
    let began = Instant::now();
    let mut now = 0;
    loop {
        for (index, track) in tracks.iter_mut().enumerate() {
            track.put(now, &mut arena, index);
        }
        while let Some(record) = told.next_if(|record| record.ms() <= now) {
            if let Record::Told { robot, told, .. } = record
                && usize::from(*robot) < tracks.len()
            {
                replay(&mut arena.robot(usize::from(*robot)), told);
            }
        }
        run.record(now, &arena);
        if now > 0 && run.look(now, &mut arena) {
            break;
        }
        if now >= end.min(settings.longest_ms) {
            run.ended(now, false, &mut arena);
            break;
        }
        if began.elapsed() > settings.longest {
            run.fail(now, words::too_slow(settings.longest.as_secs_f64()));
            run.verdict = Some(Verdict::Unknown);
            break;
        }
        now += STEP_MS;
        arena.tick();
    }
    run.outcome(now)
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
            arena.robot(index).tell(Command::Power { port, percent });
        }
    }
}
