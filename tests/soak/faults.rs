//! What is done to the robot while it drives: kills, stops, errors instead of system calls.
//!
//! Owns the motor: one thread drives it, does one thing, and waits for its rest. Knows no other load.

use crate::figures::Figures;
use crate::robot::{DRIVE, DRIVEN, REST, Robot};
use harness::processes;
use needs::Random;
use nix::sys::signal::Signal;
use std::collections::VecDeque;
use std::io::{Read, Write};
use std::net::TcpStream;
use std::process::{Child, Command, Stdio};
use std::sync::Arc;
use std::thread::JoinHandle;
use std::time::{Duration, Instant};

/// How long calls fail before the motor is stopped: a tracer needs some time to take hold.
const TRACED: Duration = Duration::from_millis(500);
/// How long a tracer may take to let go.
const TRACER_PATIENCE: Duration = Duration::from_secs(1);
/// Between two faults.
const PAUSE: Duration = Duration::from_millis(700);
/// How long the motor may take to come to rest.
const PATIENCE: Duration = Duration::from_secs(20);
/// A guardian gives up after the fifth crash within a minute.
const CRASHES_MAX: usize = 3;
const CRASH_WINDOW: Duration = Duration::from_secs(60);

/// A shell program that drives the motor and waits to be ended.
fn program(robot: &Robot) -> String {
    let motor = robot.mount.path("motor/value");
    format!(
        "exec 3>{}; echo 100 1 >&3; exec sleep 1000",
        motor.display()
    )
}

/// Things that are done.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Fault {
    /// `stop` by a client of trikd.
    StopByClient,
    /// A program of trikd is killed while it has the motor open.
    KillProgram,
    /// A program of the robot, without trikd.
    KillWriter,
    KillDaemon,
    StopDaemon,
    StopGuardian,
    KillTrikd,
    /// Reads and answers at the kernel's border fail; the motor is stopped by its file then.
    FailCalls,
}

impl Fault {
    /// Often what costs no crash.
    const DRAWN: [Self; 12] = [
        Self::StopByClient,
        Self::StopByClient,
        Self::StopByClient,
        Self::KillProgram,
        Self::KillProgram,
        Self::KillWriter,
        Self::KillWriter,
        Self::StopGuardian,
        Self::FailCalls,
        Self::KillDaemon,
        Self::StopDaemon,
        Self::KillTrikd,
    ];

    fn name(self) -> &'static str {
        match self {
            Self::StopByClient => "a stop by a client of trikd",
            Self::KillProgram => "kill -9 of a program of trikd",
            Self::KillWriter => "kill -9 of a program that writes",
            Self::KillDaemon => "kill -9 of the daemon of the tree",
            Self::StopDaemon => "SIGSTOP of the daemon of the tree",
            Self::StopGuardian => "SIGSTOP of the guardian of the tree",
            Self::KillTrikd => "kill -9 of trikd with its program",
            Self::FailCalls => "a stop while calls at the kernel fail",
        }
    }

    /// Whose guardian counts it as a crash: that of the tree is the first, that of trikd the second.
    fn crashes(self) -> Option<usize> {
        match self {
            Self::KillDaemon | Self::StopDaemon => Some(0),
            Self::KillTrikd => Some(1),
            Self::StopByClient
            | Self::KillProgram
            | Self::KillWriter
            | Self::StopGuardian
            | Self::FailCalls => None,
        }
    }
}

/// Starts the thread.
pub fn start(robot: &Arc<Robot>, figures: &Arc<Figures>, seed: u32) -> JoinHandle<()> {
    let (robot, figures) = (Arc::clone(robot), Arc::clone(figures));
    std::thread::spawn(move || {
        let mut random = Random::new(seed);
        let mut crashes = [VecDeque::new(), VecDeque::new()];
        while !figures.is_over() {
            let fault = Fault::DRAWN[random.below(Fault::DRAWN.len())];
            let now = Instant::now();
            if let Some(guardian) = fault.crashes() {
                let crashes: &mut VecDeque<Instant> = &mut crashes[guardian];
                crashes.retain(|then| now.duration_since(*then) < CRASH_WINDOW);
                if crashes.len() >= CRASHES_MAX {
                    continue;
                }
                crashes.push_back(now);
            }
            if let Some(after) = attempt(&robot, &figures, fault) {
                figures.rested(fault.name(), after);
            }
            figures.pause(PAUSE);
        }
    })
}

/// Drives the motor, does the thing, waits for the rest. None: the motor could not be driven, which is told if it matters.
fn attempt(robot: &Robot, figures: &Figures, fault: Fault) -> Option<Option<Duration>> {
    let mut writer = None;
    // Who hangs up while an answer is on its way may take back what it said.
    let mut ordering = None;
    match fault {
        Fault::KillProgram | Fault::KillTrikd => {
            let file = format!("file:m:#!/bin/sh\n{}\n", program(robot));
            let orders = format!("{}:{file}5:run:m", file.len());
            let client = ordering.insert(client(robot)?);
            client.write_all(orders.as_bytes()).ok()?;
            if !until(figures, || robot.motor() == DRIVEN) {
                figures.wrong("a program of trikd did not drive the motor".to_owned());
                return None;
            }
        }
        Fault::KillWriter => writer = Some(write_and_wait(robot)?),
        Fault::StopByClient
        | Fault::KillDaemon
        | Fault::StopDaemon
        | Fault::StopGuardian
        | Fault::FailCalls => {
            figures.call(
                "orders to the motor",
                || robot.mount.write("motor/value", DRIVE),
                |()| true,
            );
        }
    }
    if !until(figures, || robot.motor() == DRIVEN) {
        return None;
    }
    drop(ordering);
    figures.doing(fault.name());
    let mut helper = (fault == Fault::FailCalls)
        .then(|| make_calls_fail(robot, figures))
        .flatten();
    let begun = Instant::now();
    act(robot, figures, fault, writer.as_ref())?;
    let rested = until(figures, || robot.motor() == REST).then(|| begun.elapsed());
    for child in [&mut helper, &mut writer].into_iter().flatten() {
        // A tracer may wait for a thread that waits for one that it has stopped itself: then it is killed.
        processes::signal(child.id(), Signal::SIGTERM);
        let deadline = Instant::now() + TRACER_PATIENCE;
        while matches!(child.try_wait(), Ok(None)) && Instant::now() < deadline {
            figures.pause(Duration::from_millis(1));
        }
        let _ = child.kill();
        let _ = child.wait();
    }
    if fault == Fault::FailCalls {
        // It has let go just now, and what stood still until now may be late for a moment more.
        figures.slow(TRACER_PATIENCE);
    }
    recover(robot, figures);
    if rested.is_none() && figures.is_over() {
        return None;
    }
    Some(rested)
}

/// Does it. None: there is nobody to do it to.
fn act(robot: &Robot, figures: &Figures, fault: Fault, writer: Option<&Child>) -> Option<()> {
    let signal = |pid: u32, signal| {
        processes::signal(pid, signal);
        Some(())
    };
    match fault {
        Fault::StopByClient => {
            let mut client = client(robot)?;
            client.write_all(b"4:stop").ok()?;
            // Until it has been read.
            let _ = client.write_all(b"7:version");
            let _ = client.read(&mut [0; 64]);
            Some(())
        }
        Fault::KillProgram => {
            let program = processes::children(robot.trikd()?);
            signal(*program.first()?, Signal::SIGKILL)
        }
        Fault::KillWriter => signal(writer?.id(), Signal::SIGKILL),
        Fault::KillDaemon => {
            figures.disturb(Duration::ZERO);
            signal(robot.daemon()?, Signal::SIGKILL)
        }
        Fault::StopDaemon => {
            figures.disturb(Duration::from_secs(1));
            signal(robot.daemon()?, Signal::SIGSTOP)
        }
        Fault::StopGuardian => signal(robot.mount.guardian(), Signal::SIGSTOP),
        Fault::KillTrikd => {
            figures.disturb(Duration::ZERO);
            signal(robot.trikd()?, Signal::SIGKILL)
        }
        Fault::FailCalls => {
            figures.call(
                "stops while calls fail",
                || robot.mount.write("stop", "1"),
                |()| true,
            );
            Some(())
        }
    }
}

/// From here on, while the process given lives, every third call of the daemon on /dev/fuse fails.
fn make_calls_fail(robot: &Robot, figures: &Figures) -> Option<Child> {
    figures.slow(TRACED + 3 * TRACER_PATIENCE);
    let tracer = Command::new("strace")
        .args(["-f", "-q", "-P", "/dev/fuse", "-o", "/dev/null"])
        .args(["-e", "trace=read,write,writev"])
        .args(["-e", "inject=read,write,writev:error=ENOMEM:when=2+3"])
        .args(["-p", &robot.daemon()?.to_string()])
        .stdin(Stdio::null())
        .stdout(Stdio::null())
        .stderr(Stdio::null())
        .spawn();
    figures.pause(TRACED);
    tracer.ok()
}

/// A program that has the motor open when it is killed.
fn write_and_wait(robot: &Robot) -> Option<Child> {
    Command::new("sh")
        .args(["-c", &program(robot)])
        .stdout(Stdio::null())
        .stdin(Stdio::null())
        .stderr(Stdio::null())
        .spawn()
        .ok()
}

/// A connection to trikd that has been answered: others may hold places, but it is served.
fn client(robot: &Robot) -> Option<TcpStream> {
    let mut stream = TcpStream::connect(("127.0.0.1", robot.control)).ok()?;
    stream.set_read_timeout(Some(PATIENCE)).ok()?;
    // Orders are short, and each goes at once.
    stream.set_nodelay(true).ok()?;
    stream.write_all(b"7:version").ok()?;
    let size = stream.read(&mut [0; 64]).ok()?;
    (size > 0).then_some(stream)
}

/// Waits until something is so.
fn until(figures: &Figures, mut holds: impl FnMut() -> bool) -> bool {
    let deadline = Instant::now() + PATIENCE;
    while !holds() {
        if Instant::now() > deadline {
            return false;
        }
        figures.pause(Duration::from_micros(500));
    }
    true
}

/// Waits until everybody serves again.
fn recover(robot: &Robot, figures: &Figures) {
    let serves = until(figures, || {
        !processes::is_stopped(robot.mount.guardian())
            && robot.mount.read("motor/units").is_ok()
            && client(robot).is_some()
    });
    if !serves && !figures.is_over() {
        figures.wrong("the robot did not come back".to_owned());
        figures.end();
    }
    // Whatever trikd had begun again is ended, and the motor is free.
    if let Some(mut stop) = client(robot) {
        let _ = stop.write_all(b"4:stop");
    }
    until(figures, || robot.motor() == REST);
}
