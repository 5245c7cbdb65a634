//! A lithium battery of three cells: voltage from charge and current.

/// Full and empty, without load.
const FULL_V: f64 = 12.6;
const EMPTY_V: f64 = 9.6;
/// Of the cells, the cable and the plug.
const RESISTANCE_OHM: f64 = 0.18;
const CAPACITY_AH: f64 = 2.2;
/// What the board takes.
const BOARD_A: f64 = 0.5;
/// The sag follows the current with this lag.
const LAG_S: f64 = 0.02;

/// What is left in it, and the load.
#[derive(Debug, Clone, Copy)]
pub struct Battery {
    charge_ah: f64,
    current_a: f64,
    /// So much less than a good one gives.
    pub sag_v: f64,
}

impl Default for Battery {
    /// A charged one, a little used.
    fn default() -> Self {
        Self {
            charge_ah: CAPACITY_AH * 0.9,
            current_a: BOARD_A,
            sag_v: 0.0,
        }
    }
}

impl Battery {
    /// Gives this current to the motors for `dt_s`.
    pub fn step(&mut self, dt_s: f64, motors_a: f64) {
        let wanted = BOARD_A + motors_a;
        self.current_a += (wanted - self.current_a) * (dt_s / LAG_S).min(1.0);
        self.charge_ah = (self.charge_ah - self.current_a * dt_s / 3600.0).max(0.0);
    }

    /// At its terminals.
    pub fn voltage_v(&self) -> f64 {
        let open = EMPTY_V + (FULL_V - EMPTY_V) * self.charge_ah / CAPACITY_AH;
        (open - self.sag_v - RESISTANCE_OHM * self.current_a).max(0.0)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// 9.6 + 3 * 0.9 = 12.3 without load; 0.5 A take 0.09 V, 2 A more another 0.36 V.
    #[test]
    fn load_sags_the_voltage_and_time_empties_the_cells() {
        let mut battery = Battery::default();
        assert!((battery.voltage_v() - 12.21).abs() < 1e-9);
        for _ in 0..200 {
            battery.step(0.001, 2.0);
        }
        assert!((battery.voltage_v() - 11.85).abs() < 0.001);
        for _ in 0..3600 {
            battery.step(1.0, 2.0);
        }
        assert!(battery.voltage_v() < 9.6);
        let good_v = battery.voltage_v();
        battery.sag_v = 2.0;
        assert!((good_v - 2.0 - battery.voltage_v()).abs() < 1e-9);
    }
}
