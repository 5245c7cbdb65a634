//! `trik dcml drive`: the actions of a planned path on the motors and servos of a robot, virtual or real.
//!
//! Owns the loop, its clock, and that motors are stopped whatever happens. How a port is written and read is known to
//! `drive/port`, what a path must be to `drive/path`. Knows the robot by its tree alone.

mod path;
mod port;

use self::path::Plan;
use self::port::{Driven, Stopping};
use super::load::load;
use super::values;
use crate::error::Error;
use crate::limits::{DRIVE_LAG_DEG, DRIVE_SETTLE_MS, DRIVE_TICK_MS, DRIVE_TOP_DEG_S};
use crate::output::standard;
use crate::place;
use crate::refusal::{REFUSED, Refusal};
use crate::remote::target::tree_of;
use clap::Args;
use lang_dcml::robot::Robot;
use lang_dcml::solve::propagate::Propagator;
use lang_dcml::syntax::Kind;
use lang_dcml::system::System;
use nix::poll::{PollFd, PollFlags, PollTimeout, poll};
use nix::sys::signal::{SigSet, Signal};
use nix::sys::signalfd::{SfdFlags, SignalFd};
use sim::body::rolling::{Actuator, Overrides, Rolling};
use sim::robots::MODEL_START;
use std::io::{self, IsTerminal, Write};
use std::os::fd::AsFd;
use std::path::PathBuf;
use std::time::{Duration, Instant};

/// What `trik dcml drive` can be told.
#[derive(Args, Clone, Debug)]
pub(crate) struct DriveArgs {
    /// The model by which the path was planned: a file, or the name of a shipped one.
    #[arg(value_name = "MODEL")]
    pub file: PathBuf,
    /// The path, as `trik dcml plan -o` writes it: a time and the actions from then on in each line.
    #[arg(value_name = "PATH.csv")]
    pub path: PathBuf,
    /// Which model, if the file has several.
    #[arg(long, value_name = "NAME")]
    pub model: Option<String>,
    /// A number for each parameter: L=0.4,r=0.1.
    #[arg(long, value_name = "NAME=NUMBER,...", default_value = "")]
    pub params: String,
    /// What drives the actions: u_l=M3 is the speed of the motor in rad/s, steer=S1 the angle of the servo in rad to the
    /// left, and *FACTOR says how much of the action one such unit is: speed=M3*0.03 [default: the name of the action, or
    /// the port after @port in its documentation].
    #[arg(long, value_name = "ACTION=PORT", value_delimiter = ',', value_parser = driven)]
    pub drive: Vec<(String, Actuator)>,
    /// The robot: where its tree is mounted, or the address of a virtual one [default: the virtual robot that runs on this
    /// computer, or else /trikfs].
    #[arg(long, env = "TRIK_TREE", value_name = "ROBOT")]
    pub robot: Option<PathBuf>,
    /// Speed of a motor at full power, in degrees per second; a path that needs more is refused.
    #[arg(long, value_name = "DEG_S", default_value_t = DRIVE_TOP_DEG_S)]
    pub top_speed: f64,
    /// A motor that is so far behind its encoder's part of the path ends the drive, in degrees of the shaft.
    #[arg(long, value_name = "DEG", default_value_t = DRIVE_LAG_DEG)]
    pub lag: f64,
}

/// `ACTION=PORT[*FACTOR]`; for the command line.
fn driven(text: &str) -> Result<(String, Actuator), String> {
    let (name, port) = text.split_once('=').ok_or("write ACTION=PORT")?;
    let actuator = Actuator::read(port).map_err(|why| why.to_string())?;
    Ok((name.trim().to_owned(), actuator))
}

/// Drives it, and says where it is by its encoders.
pub(super) fn run(args: &DriveArgs) -> Result<u8, Refusal> {
    for (option, number) in [("--top-speed", args.top_speed), ("--lag", args.lag)] {
        if !(number.is_finite() && number > 0.0) {
            return Err(Refusal::new(format!("{option}: give a number above 0")));
        }
    }
    for (at, (name, _)) in args.drive.iter().enumerate() {
        if args.drive[..at].iter().any(|(other, _)| other == name) {
            return Err(Refusal::new(format!("--drive: {name} is there twice")));
        }
    }
    let (_, model) = load(&args.file, args.model.as_deref())?;
    let of =
        |kind: Kind| -> Vec<&str> { model.of_kind(kind).map(|one| one.name.as_str()).collect() };
    let names = of(Kind::Param);
    let given = values::values("--params", &args.params, &names)?;
    let params = values::complete("--params", &names, given)?;
    let refused = |why: String| Refusal::new(format!("{}: {why}", model.name));
    let robot = Robot::new(&model, &params).map_err(|why| refused(why.to_string()))?;
    let said = Overrides {
        params: names
            .iter()
            .map(|name| (*name).to_owned())
            .zip(params)
            .collect(),
        drive: args.drive.clone(),
        start: Vec::new(),
    };
    let rolling =
        Rolling::new(&model, &said, MODEL_START).map_err(|why| refused(why.to_string()))?;
    let plan = Plan::read(&args.path, &robot)?;
    let tree = tree(args)?;
    let ports: Vec<Driven> = of(Kind::Action)
        .into_iter()
        .zip(rolling.actuators())
        .map(|(name, actuator)| Driven::new(&tree, name, *actuator, args.top_speed))
        .collect::<Result<_, Error>>()?;
    plan.check(&ports)?;
    Ok(Drive::new(args, robot, plan, ports)?.run()?)
}

/// Where the tree of the robot is.
fn tree(args: &DriveArgs) -> Result<PathBuf, Error> {
    if let Some(tree) = &args.robot {
        return tree_of(tree);
    }
    match place::running()?.as_slice() {
        [] => Ok(PathBuf::from("/trikfs")),
        [one] => Ok(one.mountpoint.clone()),
        several => {
            let all: Vec<_> = several
                .iter()
                .map(|one| one.mountpoint.display().to_string())
                .collect();
            let all = all.join(", ");
            Err(Error::Refused(format!(
                "several robots run: say which with --robot: {all}"
            )))
        }
    }
}

/// Why the drive goes on no longer.
enum End {
    Arrived,
    Signal,
}

/// A drive from its first action to its end.
struct Drive {
    robot: Robot,
    plan: Plan,
    ports: Stopping,
    lag_deg: f64,
    signals: SignalFd,
    /// By the encoders.
    state: Vec<f64>,
    propagator: Propagator,
    farthest_deg: f64,
}

impl Drive {
    fn new(args: &DriveArgs, robot: Robot, plan: Plan, ports: Vec<Driven>) -> Result<Self, Error> {
        // A program that is put to sleep would leave motors running too.
        let all = [
            Signal::SIGINT,
            Signal::SIGTERM,
            Signal::SIGHUP,
            Signal::SIGQUIT,
            Signal::SIGTSTP,
        ];
        let mask: SigSet = all.into_iter().collect();
        let own = |error: nix::Error| Error::system("signals", error);
        mask.thread_block().map_err(own)?;
        let flags = SfdFlags::SFD_NONBLOCK | SfdFlags::SFD_CLOEXEC;
        Ok(Self {
            state: plan.start(robot.states()),
            robot,
            plan,
            ports: Stopping(ports),
            lag_deg: args.lag,
            signals: SignalFd::with_flags(&mask, flags).map_err(own)?,
            propagator: Propagator::new(),
            farthest_deg: 0.0,
        })
    }

    fn run(mut self) -> Result<u8, Error> {
        let ended = self.follow();
        // First of all, whatever happened.
        let stopped = self.ports.stop();
        let ended = match (ended, stopped) {
            (Err(error), Ok(())) => Err(Error::Robot(format!("{error}; the motors are stopped"))),
            (Err(error), Err(why)) => Err(Error::Robot(format!("{error}; {why}"))),
            (Ok(_), Err(why)) => Err(why),
            (Ok(end), Ok(())) => Ok(end),
        }?;
        match ended {
            End::Arrived => {
                let _ = standard(self.summary().as_bytes());
                Ok(0)
            }
            End::Signal => {
                let _ = writeln!(
                    io::stderr(),
                    "trik: stopped by a signal; the motors are stopped"
                );
                Ok(REFUSED)
            }
        }
    }

    fn follow(&mut self) -> Result<End, Error> {
        let mut action = self.plan.at(0.0).to_vec();
        for (port, value) in self.ports.0.iter_mut().zip(&action) {
            port.prepare(*value)?;
        }
        // Servos take their time, and the first motor waits for them.
        let begun = Instant::now();
        if self.ports.0.iter().any(Driven::is_servo)
            && self.wait(begun + Duration::from_millis(DRIVE_SETTLE_MS))?
        {
            return Ok(End::Signal);
        }
        let is_watched = io::stderr().is_terminal();
        let settle = Duration::from_millis(DRIVE_SETTLE_MS).as_secs_f64();
        let (begun, mut before) = (Instant::now(), 0.0);
        let mut next = begun;
        loop {
            let now = begun.elapsed().as_secs_f64();
            let is_over = now >= self.plan.duration();
            self.measure(&action, now - before, now)?;
            before = now;
            let is_settled = self.ports.0.iter().all(Driven::is_settled);
            if is_over && (is_settled || now >= self.plan.duration() + 2.0 * settle) {
                return Ok(End::Arrived);
            }
            action.copy_from_slice(self.plan.at(now));
            for (port, value) in self.ports.0.iter_mut().zip(&action) {
                port.apply(*value, is_over)?;
            }
            if is_watched {
                let all = self.plan.duration();
                let done = now.min(all);
                let _ = write!(io::stderr(), "\r{done:.1} of {all:.1} s\x1b[K");
            }
            next = (next + Duration::from_millis(DRIVE_TICK_MS)).max(Instant::now());
            let is_signalled = self.wait(next)?;
            if is_watched && (is_signalled || is_over) {
                let _ = write!(io::stderr(), "\r\x1b[K");
            }
            if is_signalled {
                return Ok(End::Signal);
            }
        }
    }

    /// Looks where wheels are, and where that brings the robot. `action` was held for `seconds` until now.
    fn measure(&mut self, action: &[f64], seconds: f64, now: f64) -> Result<(), Error> {
        let mut measured = action.to_vec();
        for (at, port) in self.ports.0.iter_mut().enumerate() {
            let wanted = self.plan.sum(at, now);
            if let Some(turned) = port.measure(wanted)?
                && seconds > 0.0
            {
                measured[at] = turned / seconds;
            }
            let lag = port.lag_deg();
            self.farthest_deg = self.farthest_deg.max(lag.abs());
            if lag.abs() > self.lag_deg {
                let (name, most) = (port.name(), self.lag_deg);
                return Err(Error::Robot(format!(
                    "{name} is {lag:.0} degrees behind the path at {now:.2} s, more than {most}: it is blocked, slower than \
                     --top-speed says, or its encoder counts the other way"
                )));
            }
        }
        if seconds > 0.0 {
            self.propagator
                .run(&mut self.robot, &mut self.state, &measured, seconds, 1);
        }
        Ok(())
    }

    /// Waits until then; whether a signal came.
    fn wait(&mut self, until: Instant) -> Result<bool, Error> {
        loop {
            let left = until.saturating_duration_since(Instant::now());
            let left = u16::try_from(left.as_millis()).unwrap_or(u16::MAX);
            let mut fds = [PollFd::new(self.signals.as_fd(), PollFlags::POLLIN)];
            match poll(&mut fds, PollTimeout::from(left)) {
                Err(nix::Error::EINTR) => {}
                Err(error) => return Err(Error::system("poll", error)),
                Ok(0) if left == 0 || Instant::now() >= until => return Ok(false),
                Ok(0) => {}
                Ok(_) => return Ok(matches!(self.signals.read_signal(), Ok(Some(_)))),
            }
        }
    }

    fn summary(&mut self) -> String {
        let mut text = format!("Driven in {:.2} s", self.plan.duration());
        if !self.ports.0.iter().any(Driven::is_measured) {
            text.push_str(" without encoders: where it is, is not known.\n");
            return text;
        }
        text.push_str(&format!(
            "; no wheel was more than {:.0} degrees away from the path.\n",
            self.farthest_deg
        ));
        let rest = vec![0.0; self.robot.actions()];
        let Some(planned) = self.plan.end() else {
            return text;
        };
        let here = path::position(&mut self.robot, &self.state, &rest);
        let there = path::position(&mut self.robot, &planned, &rest);
        if let (Some([x, y]), Some([to_x, to_y])) = (here, there) {
            let away = (x - to_x).hypot(y - to_y);
            text.push_str(&format!(
                "By its encoders it is at x = {x:.3}, y = {y:.3}, which is {away:.3} from the end of the path.\n"
            ));
        }
        text
    }
}
