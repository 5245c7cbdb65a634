//! Old words and their new ones, in the order in which they are replaced.

/// 3.0.0-a5.
pub(super) const PORTS: [(&str, &str); 32] = [
    ("JA1", "A1"),
    ("JA2", "A2"),
    ("JA3", "A3"),
    ("JA4", "A4"),
    ("JA5", "A5"),
    ("JA6", "A6"),
    ("JB1", "B1"),
    ("JB2", "B2"),
    ("JB3", "B3"),
    ("JB4", "B4"),
    ("JC1", "C1"),
    ("JC2", "C2"),
    ("JC3", "C3"),
    ("JD1", "D1"),
    ("JD2", "D2"),
    ("JE1", "E1"),
    ("JE2", "E2"),
    ("JE3", "E3"),
    ("JE4", "E4"),
    ("JF1", "F1"),
    ("JM1", "M1"),
    ("JM2", "M2"),
    ("JM3", "M3"),
    ("JM4", "M4"),
    ("digitSensor1", "sensorD1"),
    ("digitSensor2", "sensorD2"),
    ("sensor1", "sensorA1"),
    ("sensor2", "sensorA2"),
    ("sensor3", "sensorA3"),
    ("sensor4", "sensorA4"),
    ("sensor5", "sensorA5"),
    ("sensor6", "sensorA6"),
];

/// 3.0.1.
pub(super) const BUTTONS: [(&str, &str); 8] = [
    ("backButton", "buttonBack"),
    ("downButton", "buttonDown"),
    ("enterButton", "buttonEnter"),
    ("escapeButton", "buttonEscape"),
    ("leftButton", "buttonLeft"),
    ("powerButton", "buttonEsc"),
    ("rightButton", "buttonRight"),
    ("upButton", "buttonUp"),
];

/// Blocks that are gone since 3.0.1.
pub(super) const REMOVED: [&str; 16] = [
    "Ev3WaitForBack",
    "Ev3WaitForDown",
    "Ev3WaitForEnter",
    "Ev3WaitForLeft",
    "Ev3WaitForRight",
    "Ev3WaitForUp",
    "NxtWaitForEnter",
    "NxtWaitForEscape",
    "NxtWaitForLeft",
    "NxtWaitForRight",
    "TrikWaitForDown",
    "TrikWaitForEnter",
    "TrikWaitForLeft",
    "TrikWaitForPower",
    "TrikWaitForRight",
    "TrikWaitForUp",
];

/// 3.1.0.
pub(super) const CLASSES: [(&str, &str); 11] = [
    ("NxtRealRobotModel", "NxtUsbRealRobotModel"),
    ("TrikRealRobotModelV6", "TrikRealRobotModel"),
    ("commonTwoDModel", "twoDModel"),
    ("ev3KitInterpreter", "ev3"),
    ("interpreterBase", "kitBase"),
    ("lineSensorCross", "lineSensor[2]"),
    ("lineSensorSize", "lineSensor[1]"),
    ("lineSensorX", "lineSensor[0]"),
    ("nxtKitInterpreter", "nxt"),
    ("nxtKitRobot", "nxtKitUsbRobot"),
    ("trikKitInterpreter", "trik"),
];

/// 3.1.3.
pub(super) const VECTORS: [(&str, &str); 6] = [
    ("accelerometerX", "accelerometer[0]"),
    ("accelerometerY", "accelerometer[1]"),
    ("accelerometerZ", "accelerometer[2]"),
    ("gyroscopeX", "gyroscope[0]"),
    ("gyroscopeY", "gyroscope[1]"),
    ("gyroscopeZ", "gyroscope[2]"),
];

/// What a world has that still needs the step to 2020.4.
pub(super) const OLD_SENSORS: [&str; 2] = [
    "trik::robotModel::parts::TrikLineSensor",
    "value=\"trik::robotModel::twoD::parts::TwoDInfraredSensor",
];

/// 2020.4.
pub(super) const SENSORS: [(&str, &str); 4] = [
    (
        "value=\"trik::robotModel::twoD::parts::TwoDInfraredSensor",
        "value=\"twoDModel::robotModel::parts::RangeSensor",
    ),
    ("TrikLineSensorPort###lineSensor", "###"),
    ("LineSensorPort", "Video2Port"),
    ("TrikLineSensor", "TrikVideoCamera"),
];
