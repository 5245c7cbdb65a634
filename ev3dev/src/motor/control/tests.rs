//! Commands and regulation on a motor made of equations: 1200 counts per second at full power, a lag of 80 ms.

use super::*;
use crate::motor::command::Polarity;

const MAX_SPEED: i32 = 1000;
const TICK_S: f64 = 0.01;

struct Rig {
    control: Control,
    now_s: f64,
    speed: f64,
    angle: f64,
    /// Counts per second at full power.
    full: f64,
    is_blocked: bool,
    output: Output,
    /// All texts of `state`, in order.
    states: Vec<String>,
}

impl Rig {
    fn new() -> Self {
        Self::of(Control::new(true, MAX_SPEED))
    }

    fn of(control: Control) -> Self {
        let mut rig = Self {
            control,
            now_s: 5.0,
            speed: 0.0,
            angle: 1000.0,
            full: 1200.0,
            is_blocked: false,
            output: Output::Power(0),
            states: Vec::new(),
        };
        rig.tick();
        rig
    }

    fn tick(&mut self) {
        let counts = self
            .control
            .has_encoder
            .then_some(self.angle.floor() as i32);
        self.output = self.control.tick(self.now_s, counts);
        let state = self.control.flags().text();
        if self.states.last() != Some(&state) {
            self.states.push(state);
        }
        for _ in 0..10 {
            let (target, lag_s) = match self.output {
                Output::Power(0) => (0.0, 0.2),
                Output::Power(percent) => (f64::from(percent) / 100.0 * self.full, 0.08),
                Output::Brake => (0.0, 0.02),
            };
            self.speed += (target - self.speed) * TICK_S / 10.0 / lag_s;
            if self.is_blocked {
                self.speed = 0.0;
            }
            self.angle += self.speed * TICK_S / 10.0;
        }
        self.now_s += TICK_S;
    }

    fn run(&mut self, seconds: f64) {
        let end = self.now_s + seconds - TICK_S / 2.0;
        while self.now_s < end {
            self.tick();
        }
    }

    fn command(&mut self, command: Command) {
        self.control.command(command, self.now_s);
        self.tick();
    }

    fn state(&self) -> String {
        self.control.flags().text()
    }

    /// Runs until it is not running any more; gives the time.
    fn until_done(&mut self) -> f64 {
        let start = self.now_s;
        while self.control.flags().running {
            assert!(self.now_s - start < 20.0, "still {}", self.state());
            self.tick();
        }
        self.now_s - start
    }
}

#[test]
fn forever_is_at_the_wanted_speed_whatever_the_battery() {
    for full in [1050.0, 1200.0, 1500.0] {
        for wanted in [-900, -300, 60, 300, 900] {
            let mut rig = Rig { full, ..Rig::new() };
            rig.control.setpoints.speed = wanted;
            rig.command(Command::RunForever);
            assert_eq!(rig.state(), "running");
            rig.run(3.0);
            let from = rig.angle;
            rig.run(2.0);
            let mean = (rig.angle - from) / 2.0;
            assert!(
                (mean - f64::from(wanted)).abs() < 3.0,
                "{wanted} at {full}: {mean}"
            );
            assert!((rig.control.speed() - wanted).abs() < 40);
            assert_eq!(rig.states, ["", "running"]);
        }
    }
}

#[test]
fn setpoints_are_those_at_the_command() {
    let mut rig = Rig::new();
    rig.control.setpoints.speed = 500;
    rig.command(Command::RunForever);
    rig.run(1.0);
    rig.control.setpoints.speed = -500;
    rig.run(1.0);
    assert!(rig.speed > 450.0);
    rig.command(Command::RunForever);
    rig.run(1.0);
    assert!(rig.speed < -450.0);
}

#[test]
fn a_position_is_reached_and_held_to_a_count_without_much_overshoot() {
    for (speed, target) in [
        (1000, 720),
        (300, 360),
        (1000, -1800),
        (50, 10),
        (800, 3),
        (-500, 90),
    ] {
        let mut rig = Rig::new();
        rig.control.setpoints.speed = speed;
        rig.control.setpoints.position = target;
        rig.control.setpoints.stop_action = StopAction::Hold;
        rig.command(Command::RunToAbsPos);
        let mut farthest = 0;
        while rig.control.flags().running {
            rig.tick();
            farthest = farthest.max(rig.control.position() * target.signum());
            assert!(rig.now_s < 60.0, "{target} is not reached");
        }
        rig.run(1.0);
        assert!(farthest <= target.abs() + 4, "{farthest} for {target}");
        assert!((rig.control.position() - target).abs() <= 1);
        assert_eq!(rig.states, ["", "running", "holding"], "{target}");
    }
}

#[test]
fn the_time_of_a_move_is_that_of_its_speed() {
    let mut rig = Rig::new();
    rig.control.setpoints.speed = 500;
    rig.control.setpoints.position = 1000;
    rig.command(Command::RunToRelPos);
    let seconds = rig.until_done();
    // Two seconds, and what speeding up and slowing down cost.
    assert!((2.0..2.6).contains(&seconds), "{seconds}");
}

#[test]
fn relative_moves_one_after_the_other_add_no_errors() {
    let mut rig = Rig::new();
    rig.control.setpoints.speed = 600;
    rig.control.setpoints.position = 100;
    for turn in 1..=10 {
        rig.command(Command::RunToRelPos);
        rig.until_done();
        assert_eq!(rig.control.relative_end, Some(i64::from(turn) * 100));
    }
    rig.control.setpoints.stop_action = StopAction::Hold;
    rig.command(Command::RunToRelPos);
    rig.until_done();
    rig.run(0.5);
    assert!((rig.control.position() - 1100).abs() <= 1);
    // After another command, or where the place is called otherwise, a relative move begins where the motor is.
    rig.command(Command::Stop);
    rig.control.set_position(17);
    rig.command(Command::RunToRelPos);
    assert_eq!(rig.control.relative_end, Some(117));
    rig.control.set_position(7);
    rig.command(Command::RunToRelPos);
    assert_eq!(rig.control.relative_end, Some(107));
}

#[test]
fn a_timed_run_ends_in_time_by_the_stop_action() {
    for (action, state) in [
        (StopAction::Coast, ""),
        (StopAction::Brake, ""),
        (StopAction::Hold, "holding"),
    ] {
        let mut rig = Rig::new();
        rig.control.setpoints.speed = 500;
        rig.control.setpoints.time = 1000;
        rig.control.setpoints.stop_action = action;
        rig.command(Command::RunTimed);
        assert_eq!(rig.control.ends_at_s(), Some(rig.now_s - TICK_S + 1.0));
        let seconds = rig.until_done();
        assert!((0.98..=1.02).contains(&seconds), "{seconds}");
        assert_eq!(rig.state(), state);
        let way = rig.angle;
        rig.run(2.0);
        match action {
            StopAction::Coast => assert_eq!(rig.output, Output::Power(0)),
            StopAction::Brake => assert_eq!(rig.output, Output::Brake),
            StopAction::Hold => assert!((rig.angle - way).abs() < 15.0, "{}", rig.angle - way),
        }
        assert_eq!(rig.control.is_busy(rig.now_s), action == StopAction::Hold);
    }
}

#[test]
fn direct_power_changes_at_once_and_in_the_direction_of_the_polarity() {
    let mut rig = Rig::new();
    rig.control.setpoints.duty_cycle = 30;
    rig.command(Command::RunDirect);
    assert_eq!(rig.output, Output::Power(30));
    rig.control.setpoints.duty_cycle = -45;
    rig.tick();
    assert_eq!(rig.output, Output::Power(-45));
    rig.control.setpoints.polarity = Polarity::Inversed;
    rig.command(Command::RunDirect);
    assert_eq!(rig.output, Output::Power(45));
    assert_eq!(rig.control.duty_cycle(), -45);
    let before = rig.control.position();
    rig.run(1.0);
    assert!(rig.control.position() < before - 200);
}

#[test]
fn an_inversed_motor_is_regulated_all_the_same() {
    let mut rig = Rig::new();
    rig.control.setpoints.polarity = Polarity::Inversed;
    rig.control.setpoints.speed = 400;
    rig.control.setpoints.position = 360;
    rig.control.setpoints.stop_action = StopAction::Hold;
    rig.command(Command::RunToRelPos);
    rig.until_done();
    rig.run(0.5);
    assert!((rig.control.position() - 360).abs() <= 1);
    assert!((rig.angle - (1000.0 - 360.0)).abs() < 3.0, "{}", rig.angle);
}

#[test]
fn ramps_are_as_long_as_their_share_of_the_greatest_speed() {
    let mut rig = Rig::new();
    rig.control.setpoints.speed = 500;
    rig.control.setpoints.ramp_up = 2000;
    rig.control.setpoints.ramp_down = 1000;
    rig.command(Command::RunForever);
    assert_eq!(rig.state(), "running ramping");
    let start = rig.now_s;
    while rig.control.flags().ramping {
        rig.tick();
    }
    assert!((rig.now_s - start - 1.0).abs() < 0.05);
    rig.run(0.5);
    rig.command(Command::Stop);
    assert_eq!(rig.state(), "running ramping");
    let seconds = rig.until_done();
    assert!((seconds - 0.5).abs() < 0.05, "{seconds}");
    assert_eq!(rig.state(), "");
}

#[test]
fn a_blocked_shaft_is_stalled_and_a_slow_one_is_overloaded() {
    let mut rig = Rig::new();
    rig.is_blocked = true;
    rig.control.setpoints.speed = 500;
    rig.command(Command::RunForever);
    rig.run(1.5);
    assert!(rig.state().contains("running") && rig.state().contains("stalled"));
    rig.is_blocked = false;
    rig.run(1.5);
    assert_eq!(rig.state(), "running");
    rig.full = 300.0;
    rig.run(3.0);
    assert_eq!(rig.state(), "running overloaded");
    // What the regulation could not do is not made up for without measure.
    rig.full = 1200.0;
    rig.run(1.0);
    assert!((rig.speed - 500.0).abs() < 60.0, "{}", rig.speed);
}

#[test]
fn a_blocked_move_goes_on_when_it_can() {
    let mut rig = Rig::new();
    rig.control.setpoints.speed = 500;
    rig.control.setpoints.position = 1000;
    rig.control.setpoints.stop_action = StopAction::Hold;
    rig.command(Command::RunToAbsPos);
    rig.run(0.5);
    rig.is_blocked = true;
    rig.run(3.0);
    assert!(rig.state().contains("stalled"), "{}", rig.state());
    rig.is_blocked = false;
    rig.until_done();
    rig.run(0.5);
    assert!((rig.control.position() - 1000).abs() <= 1);
}

#[test]
fn reset_forgets_everything_but_the_encoder() {
    let mut rig = Rig::new();
    rig.control.setpoints.speed = 500;
    rig.control.hold_gains.kp = 1;
    rig.command(Command::RunForever);
    rig.run(1.0);
    assert!(rig.control.position() > 200);
    rig.command(Command::Reset);
    assert_eq!(rig.control.setpoints, Setpoints::default());
    assert_eq!(rig.control.hold_gains, HOLD_GAINS);
    assert_eq!((rig.state().as_str(), rig.output), ("", Output::Power(0)));
    // It still runs out, and the position counts on from 0.
    let way = rig.angle;
    rig.run(2.0);
    assert!((f64::from(rig.control.position()) - (rig.angle - way)).abs() < 10.0);
    assert!(!rig.control.is_busy(rig.now_s) && rig.control.is_let_go());
    assert_eq!(rig.control.speed(), 0);
}

#[test]
fn a_position_that_is_set_while_it_is_held_moves_nothing() {
    let mut rig = Rig::new();
    rig.control.setpoints.stop_action = StopAction::Hold;
    rig.command(Command::Stop);
    rig.run(0.2);
    rig.control.set_position(i32::MAX);
    rig.run(0.5);
    assert_eq!(rig.output, Output::Power(0));
    assert_eq!(rig.control.position(), i32::MAX);
    // Beyond the end it goes on at the other one.
    rig.angle += 2.0;
    rig.tick();
    assert_eq!(rig.control.position(), i32::MIN + 1);
}

#[test]
fn an_encoder_that_is_set_back_is_no_way() {
    let mut rig = Rig::new();
    rig.control.setpoints.speed = 500;
    rig.command(Command::RunForever);
    rig.run(2.0);
    let before = rig.control.position();
    rig.angle -= 20_000.0;
    rig.tick();
    assert!((rig.control.position() - before).abs() < 20);
    rig.run(0.1);
    assert!((rig.control.speed() - 500).abs() < 60);
}

#[test]
fn a_motor_that_cannot_be_driven_is_let_go_and_not_watched() {
    let mut rig = Rig::new();
    rig.control.setpoints.speed = 500;
    rig.command(Command::RunForever);
    rig.run(1.0);
    let place = rig.control.position();
    rig.control.let_go();
    assert!(!rig.control.is_busy(rig.now_s) && rig.control.is_let_go());
    assert_eq!((rig.control.speed(), rig.state().as_str()), (0, ""));
    // Its way meanwhile counts when it is seen again.
    rig.angle += 100.0;
    rig.tick();
    assert!((rig.control.position() - place - 100).abs() < 20);
}

#[test]
fn without_an_encoder_power_follows_the_ramps() {
    let mut rig = Rig::of(Control::new(false, 100));
    rig.control.setpoints.duty_cycle = -60;
    rig.command(Command::RunForever);
    assert_eq!(rig.output, Output::Power(-60));
    assert_eq!(rig.state(), "running");
    rig.control.setpoints.ramp_down = 1000;
    rig.command(Command::Stop);
    assert_eq!(rig.state(), "running ramping");
    let seconds = rig.until_done();
    assert!((seconds - 0.6).abs() < 0.05, "{seconds}");
    rig.control.setpoints.ramp_down = 0;
    rig.control.setpoints.stop_action = StopAction::Brake;
    rig.control.setpoints.time = 100;
    rig.command(Command::RunTimed);
    rig.until_done();
    assert_eq!(rig.output, Output::Brake);
    assert!(!rig.control.is_busy(rig.now_s));
}

#[test]
fn beyond_32_bits_moves_go_as_far_as_they_should_and_a_place_is_held() {
    for (start, way) in [(i32::MAX - 50, 360), (i32::MIN + 50, -360)] {
        let mut rig = Rig::new();
        rig.control.setpoints.speed = 500;
        rig.control.setpoints.stop_action = StopAction::Hold;
        rig.control.set_position(start);
        rig.control.setpoints.position = way;
        let from = rig.angle;
        rig.command(Command::RunToRelPos);
        rig.until_done();
        let end = start.wrapping_add(way);
        assert!((rig.angle - from - f64::from(way)).abs() < 5.0);
        assert!(rig.control.position().wrapping_sub(end).abs() <= 1);
        // Held on the other side, and told to go where it is, and stopped on the way: it stays.
        rig.run(1.0);
        rig.control.setpoints.position = end;
        rig.command(Command::RunToAbsPos);
        rig.until_done();
        rig.command(Command::Stop);
        rig.run(1.0);
        assert_eq!(rig.state(), "holding");
        assert!(rig.control.position().wrapping_sub(end).abs() <= 2);
    }
}
