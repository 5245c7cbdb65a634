//! Units of nodes in SI.
//!
//! Owns their words. A unit that is not here has no factor, so nobody takes it for another one.

use std::f64::consts::PI;

/// What is measured.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Quantity {
    Length,
    Angle,
    AngularSpeed,
    Acceleration,
    Voltage,
}

const DEGREE: f64 = PI / 180.0;
/// What a g is, by definition.
const GRAVITY: f64 = 9.806_65;

const WORDS: [(Quantity, &str, f64); 24] = [
    (Quantity::Length, "m", 1.0),
    (Quantity::Length, "dm", 0.1),
    (Quantity::Length, "cm", 0.01),
    (Quantity::Length, "mm", 0.001),
    (Quantity::Angle, "rad", 1.0),
    (Quantity::Angle, "mrad", 0.001),
    (Quantity::Angle, "deg", DEGREE),
    (Quantity::Angle, "\u{b0}", DEGREE),
    (Quantity::Angle, "mdeg", DEGREE / 1000.0),
    (Quantity::AngularSpeed, "rad/s", 1.0),
    (Quantity::AngularSpeed, "mrad/s", 0.001),
    (Quantity::AngularSpeed, "deg/s", DEGREE),
    (Quantity::AngularSpeed, "\u{b0}/s", DEGREE),
    (Quantity::AngularSpeed, "mdeg/s", DEGREE / 1000.0),
    (Quantity::AngularSpeed, "rpm", 2.0 * PI / 60.0),
    (Quantity::Acceleration, "m/s2", 1.0),
    (Quantity::Acceleration, "m/s^2", 1.0),
    (Quantity::Acceleration, "m/s\u{b2}", 1.0),
    (Quantity::Acceleration, "mm/s2", 0.001),
    (Quantity::Acceleration, "mm/s^2", 0.001),
    (Quantity::Acceleration, "g", GRAVITY),
    (Quantity::Acceleration, "mg", GRAVITY / 1000.0),
    (Quantity::Voltage, "V", 1.0),
    (Quantity::Voltage, "mV", 0.001),
];

/// What one of this unit is in that of SI; None if it does not measure this.
pub(super) fn factor(quantity: Quantity, unit: &str) -> Option<f64> {
    let mut words = WORDS.iter();
    let found = words.find(|(of, word, _)| *of == quantity && *word == unit.trim());
    found.map(|(_, _, factor)| *factor)
}
