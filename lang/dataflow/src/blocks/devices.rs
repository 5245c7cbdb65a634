//! Rows of the blocks of ports, sensors, motors and the gamepad.

use super::Content::{self, Flag, Number, Port as PortName, Sensor};
use super::Kind::{Any, Items, Text, Whole as Int};
use super::{Does, Row, SYNCHRONIZED, control_in, control_out, input, output, property};

/// Colours of the light.
pub(crate) const LED_COLORS: &[&str] = &["off", "green", "orange", "red"];

pub(super) const ROWS: &[Row] = &[
    Row {
        element: "DFConcreteInputPortBlock",
        shown: "Specific input",
        russian: "Запись в порт",
        size: (100, 115),
        ports: &[
            control_in(10, 16),
            control_out(90, 16),
            input("DATA", Int, 2, 65),
        ],
        properties: &[
            property("portName", "Port name", PortName, "M1"),
            property("portImpulse", "Impulse", Number, "100"),
        ],
        text: "Tells a port a number: the power of a motor, the angle of a servo; an encoder becomes 0 whatever the number.",
        does: Does::WritePort,
    },
    Row {
        element: "DFConcreteOutputPortBlock",
        shown: "Specific output",
        russian: "Чтение порта",
        size: (100, 115),
        ports: &[control_in(10, 16), output("OUT", Any, 98, 65)],
        properties: &[property("portName", "port name", PortName, "A1")],
        text: "Gives what a port reads at this instant, for each start.",
        does: Does::ReadPort,
    },
    Row {
        element: "DFSensorVarBlock",
        shown: "Sensor",
        russian: "Датчик",
        size: (100, 115),
        ports: &[control_in(12, 15), output("OUT", Any, 98, 65)],
        properties: &[property("VarName", "Sensor", Sensor, "sensorA1")],
        text: "Gives the reading of a sensor every 20 ms from its start on, changed or not.",
        does: Does::Sensor,
    },
    Row {
        element: "DFMotorsBlock",
        shown: "Motors",
        russian: "Моторы",
        size: (100, 115),
        ports: &[
            control_in(10, 16),
            control_out(90, 16),
            input("M1", Int, 2, 35),
            input("M2", Int, 2, 60),
            input("M3", Int, 2, 85),
            input("M4", Int, 2, 110),
        ],
        properties: &[
            property(SYNCHRONIZED, "synchronized", Flag, "false"),
            property("M1Power", "M1=", Number, "0"),
            property("M2Power", "M2=", Number, "0"),
            property("M3Power", "M3=", Number, "50"),
            property("M4Power", "M4=", Number, "50"),
        ],
        text: "Power of motors in percent: a token is the power of its motor, a start gives all four those of the properties. Motors are told once in an instant, and the last one to speak counts.",
        does: Does::Motors,
    },
    Row {
        element: "DFServoBlock",
        shown: "Servo motors",
        russian: "Сервомоторы",
        size: (100, 115),
        ports: &[
            control_in(10, 16),
            control_out(90, 16),
            input("S1", Int, 2, 35),
            input("S2", Int, 2, 60),
            input("S3", Int, 2, 85),
            input("S4", Int, 2, 110),
        ],
        properties: &[
            property(SYNCHRONIZED, "synchronized", Flag, "false"),
            property("S1Angle", "S1=", Number, "0"),
            property("S2Angle", "S2=", Number, "0"),
            property("S3Angle", "S3=", Number, "0"),
            property("S4Angle", "S4=", Number, "0"),
        ],
        text: "Angles of servos in degrees, as motors have their power.",
        does: Does::Servos,
    },
    Row {
        element: "DFEncodersBlock",
        shown: "Encoders",
        russian: "Энкодеры",
        size: (100, 115),
        ports: &[
            control_in(10, 16),
            control_out(90, 16),
            input("E1_IN", Int, 2, 35),
            input("E2_IN", Int, 2, 60),
            input("E3_IN", Int, 2, 85),
            input("E4_IN", Int, 2, 110),
            output("E1_OUT", Int, 98, 35),
            output("E2_OUT", Int, 98, 60),
            output("E3_OUT", Int, 98, 85),
            output("E4_OUT", Int, 98, 110),
        ],
        properties: &[
            property("E1Clear", "E1:", Flag, "false"),
            property("E2Clear", "E2:", Flag, "false"),
            property("E3Clear", "E3:", Flag, "true"),
            property("E4Clear", "E4:", Flag, "true"),
        ],
        text: "A start makes the encoders with a flag 0, a token makes its encoder that number of degrees; from then on its readings come every 20 ms.",
        does: Does::Encoders,
    },
    Row {
        element: "DFLedBlock",
        shown: "Led",
        russian: "Светодиод",
        size: (100, 115),
        ports: &[
            control_in(10, 16),
            control_out(90, 16),
            input("DATA", Text, 1, 63),
        ],
        properties: &[property(
            "ledColor",
            "color:",
            Content::Choice(LED_COLORS),
            "orange",
        )],
        text: "The light on the board: off, green, orange or red.",
        does: Does::Led,
    },
    Row {
        element: "DFGamepadBlock",
        shown: "Gamepad",
        russian: "Пульт",
        size: (100, 115),
        ports: &[
            control_in(10, 15),
            output("PAD", Items(3), 100, 30),
            output("BUTTON", Items(2), 100, 70),
            output("WHEEL", Int, 100, 110),
        ],
        properties: &[],
        text: "From its start on: {pad, x, y} while a pad is touched and {pad, 0, 0} when it is let go, {button, value} while a button is pressed, and the wheel when it turns.",
        does: Does::Gamepad,
    },
];
