//! What goes to a motor and comes from it: commands, setpoints, gains, output, flags.
//!
//! Owns the defaults. Knows no regulation.

/// Greatest power in percent.
pub const POWER_MAX: f64 = 100.0;

/// Whether positive is forward.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Polarity {
    /// It is.
    #[default]
    Normal,
    /// It is backward, for power and position alike.
    Inversed,
}

impl Polarity {
    /// 1 or -1.
    pub fn sign(self) -> i32 {
        match self {
            Self::Normal => 1,
            Self::Inversed => -1,
        }
    }
}

/// What happens to a motor that stops.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum StopAction {
    /// It runs out.
    #[default]
    Coast,
    /// Its terminals are shorted.
    Brake,
    /// It is held where it is by its encoder.
    Hold,
}

/// Commands.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Command {
    /// Until another command.
    RunForever,
    /// To `position_sp`.
    RunToAbsPos,
    /// By `position_sp`, from the end of the relative move before, else from here.
    RunToRelPos,
    /// For `time_sp`.
    RunTimed,
    /// With the power `duty_cycle_sp`, which may change meanwhile.
    RunDirect,
    /// By `stop_action`.
    Stop,
    /// Coasts, sets all setpoints and gains to their defaults and the position to 0.
    Reset,
}

/// Setpoints. A command takes them as they are; later changes are for the next one.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Setpoints {
    /// See [`Polarity`].
    pub polarity: Polarity,
    /// In percent.
    pub duty_cycle: i32,
    /// In counts per second.
    pub speed: i32,
    /// In counts.
    pub position: i32,
    /// In ms.
    pub time: i32,
    /// In ms for 0 to the greatest speed.
    pub ramp_up: i32,
    /// In ms for the greatest speed to 0.
    pub ramp_down: i32,
    /// See [`StopAction`].
    pub stop_action: StopAction,
}

/// Gains in thousandths.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Gains {
    /// Proportional.
    pub kp: i32,
    /// Integral.
    pub ki: i32,
    /// Derivative.
    pub kd: i32,
}

/// Of the speed: percent for each count per second, for each count, for each count per second per second.
pub const SPEED_GAINS: Gains = Gains {
    kp: 50,
    ki: 500,
    kd: 0,
};

/// Of the position: percent for each count, for each count and second, for each count per second.
pub const HOLD_GAINS: Gains = Gains {
    kp: 1500,
    ki: 1000,
    kd: 50,
};

/// What the motor is to get.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Output {
    /// Percent in the direction of the tree; 0 lets it run out.
    Power(i32),
    /// Shorted terminals.
    Brake,
}

/// Flags of `state`.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Flags {
    /// A command moves it.
    pub running: bool,
    /// On a ramp that was asked for.
    pub ramping: bool,
    /// It stands and is held.
    pub holding: bool,
    /// It turns slower than it should, at full power.
    pub overloaded: bool,
    /// It should turn and does not.
    pub stalled: bool,
}

impl Flags {
    /// The words, with one space between.
    pub fn text(self) -> String {
        let words = [
            (self.running, "running"),
            (self.ramping, "ramping"),
            (self.holding, "holding"),
            (self.overloaded, "overloaded"),
            (self.stalled, "stalled"),
        ];
        let set = words.iter().filter(|(is_set, _)| *is_set);
        set.map(|(_, word)| *word).collect::<Vec<_>>().join(" ")
    }
}
