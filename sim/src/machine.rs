//! The controller without its files: time, body, coprocessor, what the connectors carry, and faults in between.
//!
//! Time runs on when somebody looks: [`Machine::advance`] makes the steps that are due. So a value that is read is never
//! older than a step, and a board at which nobody looks costs nothing.

use crate::body::{BadOrder, Body, Drive, Power, Senses};
use crate::errno;
use crate::faults::{self, Faults};
use crate::field::{Field, Locks};
use crate::limits::{MAX_CATCH_UP_S, SAYINGS_MAX, STEP_S};
use crate::mlx90640::{self, Mlx90640};
use crate::msp430::{self, Msp430};
use crate::random::Random;
use std::collections::VecDeque;
use std::time::{Duration, Instant, SystemTime, UNIX_EPOCH};

/// Ticks of an encoder for one degree, as of TRIK's encoder95.
const TICKS_PER_DEGREE: f64 = 1.57;
/// Positive forward in the registers: M1 and E2, E4 count up, the others down.
const MOTOR_SIGNS: [f64; 4] = [1.0, -1.0, -1.0, -1.0];
const ENCODER_SIGNS: [f64; 4] = [-1.0, 1.0, -1.0, 1.0];
/// Full scale of the battery's converter: 3.3 V over a divider of 7.15k and 2.37k.
const BATTERY_FULL_V: f64 = 3.3 * (7.15 + 2.37) / 2.37;
const FULL_SCALE: f64 = 1023.0;
/// The converter's own noise, in counts.
const ANALOG_NOISE: f64 = 0.7;

/// One channel of pulse-width modulation as its files have it.
#[derive(Debug, Clone, Copy, Default)]
pub struct Pwm {
    /// Whether pulses come out.
    pub enable: bool,
    /// Length of a pulse.
    pub duty_ns: u32,
    /// From one pulse to the next.
    pub period_ns: u32,
}

/// What went over one bus.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub struct BusCount {
    /// From start to stop.
    pub transactions: u64,
    /// Clock cycles that the real bus would have needed.
    pub bits: u64,
}

/// What a bus does with a request.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Outcome {
    /// The bytes to read are there.
    Done,
    /// Linux' number of the error.
    Failed(i32),
    /// Nothing comes back.
    Silence,
}

/// The controller, its robot and its world.
pub(crate) struct Machine {
    body: Box<dyn Body>,
    /// What is wrong.
    pub faults: Faults,
    /// All chance comes from here.
    pub random: Random,
    /// The coprocessor.
    pub msp430: Msp430,
    /// Looks where the camera looks.
    mlx90640: Mlx90640,
    /// S1 to S6.
    pub pwm: [Pwm; 6],
    /// Green and red.
    pub led: (bool, bool),
    /// The supply of the power motors.
    pub has_motor_power: bool,
    /// The last words that were said.
    pub said: String,
    /// What was said since somebody asked, the newest of it.
    pub sayings: VecDeque<String>,
    /// I2C buses 1 and 2.
    pub buses: [BusCount; 2],
    drive: Drive,
    encoders_deg: [f64; 4],
    /// Real angles at the last step.
    shafts_deg: [f64; 4],
    speed: f64,
    began: Instant,
    began_real_ns: i64,
    steps: u64,
    /// Steps that are left out because the PC slept.
    skipped: u64,
}

impl Machine {
    /// A board that was just switched on.
    pub fn new(body: Box<dyn Body>, speed: f64, seed: u64) -> Self {
        let real = SystemTime::now()
            .duration_since(UNIX_EPOCH)
            .unwrap_or_default();
        let mut machine = Self {
            shafts_deg: body.senses().encoders_deg,
            body,
            faults: Faults::default(),
            random: Random::new(seed),
            msp430: Msp430::default(),
            mlx90640: Mlx90640::new(seed),
            pwm: [Pwm::default(); 6],
            led: (false, false),
            has_motor_power: true,
            said: String::new(),
            sayings: VecDeque::new(),
            buses: [BusCount::default(); 2],
            drive: Drive::default(),
            encoders_deg: [0.0; 4],
            speed,
            began: Instant::now(),
            began_real_ns: i64::try_from(real.as_nanos()).unwrap_or(0),
            steps: 0,
            skipped: 0,
        };
        machine.measure();
        machine
    }

    /// The loudspeaker gives these words.
    pub fn say(&mut self, words: String) {
        if self.sayings.len() == SAYINGS_MAX {
            self.sayings.pop_front();
        }
        self.sayings.push_back(words.clone());
        self.said = words;
    }

    /// Orders the world something, see [`Body::order`].
    pub fn order(&mut self, words: &str) -> Result<(), BadOrder> {
        self.body.order(words)
    }

    /// Puts another world around the robot, see [`Body::enter`].
    pub fn enter(&mut self, field: &Field, locks: Locks) -> Result<(), BadOrder> {
        self.body.enter(field, locks)
    }

    /// Makes the steps that are due by now.
    pub fn advance(&mut self) {
        let due = self.began.elapsed().as_secs_f64() * self.speed / STEP_S;
        let missing = (due as u64).saturating_sub(self.steps + self.skipped);
        let most = (MAX_CATCH_UP_S / STEP_S) as u64;
        if missing > most {
            self.skipped += missing - most;
        }
        for _ in 0..missing.min(most) {
            self.step();
        }
    }

    /// One step of the physics.
    pub fn step(&mut self) {
        for motor in 0..4 {
            self.drive.motors[motor] = self.power(motor);
        }
        for (servo, pwm) in self.drive.servos_ns.iter_mut().zip(&self.pwm) {
            let runs = pwm.enable && pwm.duty_ns <= pwm.period_ns;
            *servo = if runs { pwm.duty_ns } else { 0 };
        }
        self.body.weaken_battery(self.faults[faults::BATTERY].sag_v);
        self.body.step(STEP_S, &self.drive);
        self.steps += 1;
        let shafts = self.body.shafts_deg();
        for (encoder, shaft_deg) in shafts.iter().enumerate() {
            let fault = self.faults[faults::ENCODER + encoder];
            let moved = shaft_deg - self.shafts_deg[encoder];
            if !fault.unplug && !fault.stuck {
                self.encoders_deg[encoder] += moved * (1.0 - fault.drop);
            }
        }
        self.shafts_deg = shafts;
    }

    /// What a motor gets from the coprocessor, the supply and its faults.
    fn power(&mut self, motor: usize) -> Power {
        let fault = self.faults[faults::MOTOR + motor];
        let duty = self.msp430.duty[motor];
        if fault.unplug || !self.has_motor_power {
            Power::Open
        } else if fault.stuck {
            Power::Blocked
        } else if duty.unsigned_abs() > 100 {
            Power::Brake
        } else {
            let noise = if duty != 0 && fault.noise > 0.0 {
                self.random.within(fault.noise)
            } else {
                0.0
            };
            Power::Duty((f64::from(duty) * MOTOR_SIGNS[motor] + noise).clamp(-100.0, 100.0))
        }
    }

    /// Simulated seconds since the start.
    pub fn time_s(&self) -> f64 {
        self.steps as f64 * STEP_S
    }

    /// The simulated real time now in nanoseconds: that of the start plus simulated time.
    pub fn real_time_ns(&self) -> i64 {
        self.real_time_ns_at(self.time_s())
    }

    /// The same for another simulated time, to the microsecond.
    pub fn real_time_ns_at(&self, time_s: f64) -> i64 {
        let since_ns = ((time_s * 1e6).round() as i64).saturating_mul(1000);
        self.began_real_ns.saturating_add(since_ns)
    }

    /// How long it really takes until `time_s`.
    pub fn wall_time_until(&self, time_s: f64) -> Duration {
        let seconds = (time_s - self.time_s()).max(0.0) / self.speed;
        Duration::try_from_secs_f64(seconds).unwrap_or(Duration::MAX)
    }

    /// What the connectors carry.
    pub fn senses(&self) -> Senses {
        self.body.senses()
    }

    /// The robot.
    pub fn body(&self) -> &dyn Body {
        self.body.as_ref()
    }

    /// What the motors and servos get now.
    pub fn drive(&self) -> &Drive {
        &self.drive
    }

    /// The encoders as they are counted: degrees, positive is forward.
    pub fn encoders_deg(&self) -> [f64; 4] {
        self.encoders_deg
    }

    /// One transaction on a bus (1 or 2), without the time that it takes.
    pub fn transact(&mut self, bus: u8, address: u16, written: &[u8], read: &mut [u8]) -> Outcome {
        self.advance();
        let count = &mut self.buses[usize::from(bus - 1)];
        count.transactions += 1;
        count.bits += bits_on_the_wire(written.len(), read.len());
        let line = self.faults[faults::I2C + usize::from(bus) - 1];
        let chip = self.chip_fault(bus, address);
        if line.stuck || self.random.chance(line.drop.max(chip.drop)) {
            return Outcome::Silence;
        }
        let is_deaf = line.unplug || chip.unplug || self.random.chance(line.nack.max(chip.nack));
        if is_deaf {
            return Outcome::Failed(errno::NACK);
        }
        let result = match (bus, address) {
            (1, mlx90640::ADDRESS) if self.body.has_infrared_camera() => {
                let now_s = self.time_s();
                let body = self.body.as_ref();
                self.mlx90640.capture(now_s, body, &mut self.random);
                self.mlx90640.transact(written, read)
            }
            (2, msp430::ADDRESS) => self.ask_msp430(chip.stuck, written, read),
            _ => Err(errno::NACK),
        };
        if line.garbage || chip.garbage {
            self.random.fill(read);
        }
        result.map_or_else(Outcome::Failed, |()| Outcome::Done)
    }

    fn ask_msp430(&mut self, stuck: bool, written: &[u8], read: &mut [u8]) -> Result<(), i32> {
        if stuck {
            // It answers with what it had, and nothing that is written has an effect.
            return self.msp430.clone().transact(written, read);
        }
        self.measure();
        let result = self.msp430.transact(written, read);
        for (encoder, cleared) in self.msp430.take_cleared().into_iter().enumerate() {
            if cleared {
                self.encoders_deg[encoder] = 0.0;
            }
        }
        result
    }

    /// How long the bus and the chip make a transaction wait.
    pub fn slow_ms(&self, bus: u8, address: u16) -> u32 {
        let line = self.faults[faults::I2C + usize::from(bus) - 1];
        line.with(self.chip_fault(bus, address)).slow_ms
    }

    /// Whether a bus is not there at all.
    pub fn is_bus_unplugged(&self, bus: u8) -> bool {
        self.faults[faults::I2C + usize::from(bus) - 1].unplug
    }

    /// Clock cycles that a bus has seen.
    pub fn bits(&self, bus: u8) -> u64 {
        self.buses[usize::from(bus) - 1].bits
    }

    fn chip_fault(&self, bus: u8, address: u16) -> faults::Fault {
        if bus == 2 && address == msp430::ADDRESS {
            self.faults[faults::MSP430]
        } else {
            faults::Fault::default()
        }
    }

    /// Puts what the connectors carry into the coprocessor's registers.
    fn measure(&mut self) {
        let senses = self.senses();
        let common = self.faults[faults::MSP430].noise;
        for port in 0..6 {
            let kept = self.msp430.analog[port];
            let raw = senses.analog[port];
            self.msp430.analog[port] = self.count(faults::ANALOG + port, raw, kept, common);
        }
        let battery = senses.battery_v / BATTERY_FULL_V * FULL_SCALE;
        let kept = self.msp430.battery;
        self.msp430.battery = self.count(faults::BATTERY, Some(battery), kept, common);
        for (encoder, sign) in ENCODER_SIGNS.into_iter().enumerate() {
            let fault = self.faults[faults::ENCODER + encoder];
            let turned = self.encoders_deg[encoder] * sign * TICKS_PER_DEGREE;
            let noise = self.random.within(fault.noise);
            // The counter has 32 bits and wraps.
            let ticks = (turned + noise).floor() as i64;
            self.msp430.ticks[encoder] = if fault.garbage {
                self.random.bits() as i32
            } else {
                ticks as i32
            };
        }
    }

    /// What the converter of 10 bits gives for a port; one without a sensor is at 0.
    fn count(&mut self, device: usize, raw: Option<f64>, kept: u16, common_noise: f64) -> u16 {
        let fault = self.faults[device];
        if fault.stuck || self.random.chance(fault.drop) {
            return kept;
        }
        if fault.garbage {
            return (self.random.bits() & 0x3FF) as u16;
        }
        let Some(raw) = raw.filter(|_| !fault.unplug) else {
            return 0;
        };
        let noise =
            self.random.normal() * ANALOG_NOISE + self.random.within(fault.noise + common_noise);
        (raw + noise).round().clamp(0.0, FULL_SCALE) as u16
    }
}

/// Clock cycles of a transaction: start and stop, nine for each byte, and an address before each direction.
fn bits_on_the_wire(written: usize, read: usize) -> u64 {
    let part = |bytes: usize| 9 * (bytes as u64 + 1) + 1;
    let write = if written > 0 || read == 0 {
        part(written)
    } else {
        0
    };
    let read = if read > 0 { part(read) } else { 0 };
    write + read + 1
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::robots;

    fn machine() -> Machine {
        // So slow that no step is due by itself.
        Machine::new(robots::by_name("two-wheels").unwrap().body(), 1e-9, 1)
    }

    fn word(machine: &mut Machine, register: u8) -> u16 {
        let mut bytes = [0; 2];
        let outcome = machine.transact(2, 0x48, &[register], &mut bytes);
        assert_eq!(outcome, Outcome::Done);
        u16::from_le_bytes(bytes)
    }

    fn ticks(machine: &mut Machine, register: u8) -> i32 {
        let mut bytes = [0; 4];
        let outcome = machine.transact(2, 0x48, &[register], &mut bytes);
        assert_eq!(outcome, Outcome::Done);
        i32::from_le_bytes(bytes)
    }

    fn run(machine: &mut Machine, steps: u32) {
        for _ in 0..steps {
            machine.step();
        }
    }

    /// M3 and M4 are sent the negated percent; E3 counts down and E4 up.
    #[test]
    fn forward_is_minus_in_the_registers_of_m3_and_m4() {
        let mut machine = machine();
        let start = machine.senses().pose.at.x;
        for register in [0x16, 0x17] {
            machine.transact(2, 0x48, &[register, 0xCE], &mut []);
        }
        run(&mut machine, 300);
        let senses = machine.senses();
        assert!(senses.pose.at.x > start + 0.05);
        let degrees = senses.encoders_deg[2];
        assert_eq!(ticks(&mut machine, 0x33), (-degrees * 1.57).floor() as i32);
        assert_eq!(ticks(&mut machine, 0x32), (degrees * 1.57).floor() as i32);
        assert_eq!(ticks(&mut machine, 0x30), 0);
    }

    #[test]
    fn the_last_duty_stays_until_the_brake() {
        let mut machine = machine();
        machine.transact(2, 0x48, &[0x16, 0xEC], &mut []);
        run(&mut machine, 1000);
        assert_eq!(machine.drive().motors[2], Power::Duty(20.0));
        machine.transact(2, 0x48, &[0x16, 0x7F], &mut []);
        run(&mut machine, 1);
        assert_eq!(machine.drive().motors[2], Power::Brake);
    }

    #[test]
    fn a_cleared_encoder_counts_from_zero() {
        let mut machine = machine();
        machine.transact(2, 0x48, &[0x17, 0x9C], &mut []);
        run(&mut machine, 500);
        assert!(ticks(&mut machine, 0x32) > 100);
        machine.transact(2, 0x48, &[0x32, 0], &mut []);
        assert_eq!(ticks(&mut machine, 0x32), 0);
        run(&mut machine, 10);
        let after = ticks(&mut machine, 0x32);
        assert!((1..100).contains(&after), "{after}");
    }

    /// 12.21 V / 13.2557 V * 1023 = 942.3.
    #[test]
    fn battery_and_analog_ports_are_in_their_registers() {
        let mut machine = machine();
        assert!((940..=945).contains(&word(&mut machine, 0x26)));
        assert!(
            (997..=1003).contains(&word(&mut machine, 0x23)),
            "A3: bumper"
        );
        assert_eq!(word(&mut machine, 0x24), 0, "nothing in A2");
        // 0.8 m to the wall of the box less the sensor's own place.
        let expected = 8697.0 / (50.0 - 11.0 + 2.0);
        assert!((f64::from(word(&mut machine, 0x25)) - expected).abs() < 4.0);
    }

    #[test]
    fn the_infrared_camera_answers_on_bus_1_where_there_is_one() {
        let mut machine = machine();
        let mut word = [0; 2];
        let outcome = machine.transact(1, 0x33, &[0x80, 0x0D], &mut word);
        assert_eq!((outcome, word), (Outcome::Done, [0x19, 0x01]));
        let mut bare = Machine::new(robots::by_name("bare").unwrap().body(), 1e-9, 1);
        let outcome = bare.transact(1, 0x33, &[0x80, 0x0D], &mut word);
        assert_eq!(outcome, Outcome::Failed(121));
    }

    #[test]
    fn only_the_coprocessor_answers() {
        let mut machine = machine();
        for (bus, address) in [(1, 0x48), (2, 0x49), (2, 0x8048)] {
            let outcome = machine.transact(bus, address, &[0x26], &mut [0; 2]);
            assert_eq!(outcome, Outcome::Failed(121), "bus {bus}, {address:#x}");
        }
        assert_eq!(machine.buses[1].transactions, 2);
    }

    /// Start, address, register, start, address, two bytes, stop: 1 + 9 + 9 + 1 + 9 + 18 + 1.
    #[test]
    fn a_word_read_takes_48_cycles() {
        assert_eq!(bits_on_the_wire(1, 2), 48);
        assert_eq!(bits_on_the_wire(2, 0), 29);
        assert_eq!(bits_on_the_wire(0, 0), 11);
    }

    #[test]
    fn faults_do_what_they_are_called() {
        let mut machine = machine();
        let set = |machine: &mut Machine, name: &str, text: &str| {
            machine.faults.set(name, text).unwrap();
        };
        let before = word(&mut machine, 0x23);
        set(&mut machine, "msp430", "unplug");
        let outcome = machine.transact(2, 0x48, &[0x26], &mut [0; 2]);
        assert_eq!(outcome, Outcome::Failed(121));
        set(&mut machine, "msp430", "drop 1");
        let outcome = machine.transact(2, 0x48, &[0x26], &mut [0; 2]);
        assert_eq!(outcome, Outcome::Silence);
        set(&mut machine, "msp430", "stuck");
        machine.transact(2, 0x48, &[0x14, 50], &mut []);
        assert_eq!(machine.msp430.duty[0], 0);
        assert_eq!(word(&mut machine, 0x23), before);
        set(&mut machine, "msp430", "");
        set(&mut machine, "A3", "unplug");
        assert_eq!(word(&mut machine, 0x23), 0);
        set(&mut machine, "A3", "noise 300");
        let values: Vec<u16> = (0..50).map(|_| word(&mut machine, 0x23)).collect();
        assert!(values.iter().max() > values.iter().min().map(|low| low + 100).as_ref());
        set(&mut machine, "M4", "unplug");
        set(&mut machine, "E3", "stuck");
        for register in [0x16, 0x17] {
            machine.transact(2, 0x48, &[register, 0x9C], &mut []);
        }
        run(&mut machine, 200);
        let senses = machine.senses();
        assert!(senses.encoders_deg[2] > 10.0 && senses.encoders_deg[3] == 0.0);
        assert_eq!(ticks(&mut machine, 0x33), 0);
    }
}
