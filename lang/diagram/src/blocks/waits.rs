//! Rows of the blocks that wait until a sensor, a button or the gamepad says something.
//!
//! Owns rows only.

use super::Content::{Choice, Number, Port};
use super::Type::Whole;
use super::{Category, Does, Kits, Property, Row, SIGN, Silent, Watch};
use super::{expression, property};

const fn row(
    kind: &'static str,
    shown: &'static str,
    watch: Watch,
    properties: &'static [Property],
    text: &'static str,
) -> Row {
    Row {
        kind,
        shown,
        category: Category::Wait,
        kits: Kits::Both,
        silent: Silent::Never,
        properties,
        text,
        does: Does::Watch(watch),
    }
}

const ANALOG: Property = property(
    "Port",
    "Port",
    Port(&["A1", "A2", "A3", "A4", "A5", "A6"]),
    "A1",
);
const DISTANCE: Property = expression("Distance", "Distance", Whole, "0");
const LIMIT: Property = expression("TachoLimit", "Tacho Limit", Whole, "");
const ENCODER_TEXT: &str =
    "Waits until an encoder has passed a number of degrees. It checks every 10 ms.";

pub(super) const ROWS: &[Row] = &[
    row(
        "TrikWaitForGyroscope",
        "Wait for Gyroscope",
        Watch::Gyroscope("Degrees"),
        &[expression("Degrees", "Degrees", Whole, "0"), SIGN],
        "Waits until the heading, in whole degrees from -180 to 180, has passed a value.",
    ),
    row(
        "TrikWaitForTouchSensor",
        "Wait for Touch Sensor",
        Watch::Touch,
        &[ANALOG],
        "Waits until a touch sensor is pressed.",
    ),
    row(
        "TrikWaitForLight",
        "Wait for Light",
        Watch::Sensor("Percents"),
        &[ANALOG, expression("Percents", "Percents", Whole, "0"), SIGN],
        "Waits until a light sensor has passed a value in percent. In the simulator white is 0 and black is 99.",
    ),
    row(
        "TrikWaitForSonarDistance",
        "Wait for Ultrasonic Distance",
        Watch::Sensor("Distance"),
        &[
            property("Port", "Port", Port(&["D1", "D2"]), "D1"),
            DISTANCE,
            SIGN,
        ],
        "Waits until an ultrasonic sensor has passed a distance in cm.",
    ),
    row(
        "TrikWaitForIRDistance",
        "Wait for Infrared Distance",
        Watch::Sensor("Distance"),
        &[ANALOG, DISTANCE, SIGN],
        "Waits until an infrared sensor has passed a distance in cm.",
    ),
    Row {
        kits: Kits::V6,
        ..row(
            "TrikWaitForEncoder",
            "Wait for Encoder",
            Watch::Encoder("TachoLimit"),
            &[
                property("Port", "Port", Port(&["B1", "B2", "B3", "B4"]), "B3"),
                LIMIT,
                SIGN,
            ],
            ENCODER_TEXT,
        )
    },
    Row {
        kits: Kits::V62,
        ..row(
            "TrikV62WaitForEncoder",
            "Wait for Encoder",
            Watch::Encoder("TachoLimit"),
            &[
                property("Port", "Port", Port(&["E1", "E2", "E3", "E4"]), "E3"),
                LIMIT,
                SIGN,
            ],
            ENCODER_TEXT,
        )
    },
    row(
        "TrikWaitForButton",
        "Wait for Button",
        Watch::Button,
        &[property(
            "Button",
            "Button",
            Port(&["Up", "Down", "Left", "Right", "Enter", "Esc"]),
            "Up",
        )],
        "Waits until a button of the board is pressed.",
    ),
    Row {
        silent: Silent::Simulated,
        ..row(
            "TrikWaitForAccelerometer",
            "Wait for Accelerometer",
            Watch::Acceleration("Acceleration"),
            &[
                expression("Acceleration", "Acceleration", Whole, "0"),
                SIGN,
                property(
                    "AccelerationAxis",
                    "Acceleration Axis",
                    Choice(&["xAxis", "yAxis", "zAxis", "normal"]),
                    "xAxis",
                ),
            ],
            "Waits until the acceleration along an axis has passed a value. In the simulator it does nothing.",
        )
    },
    Row {
        silent: Silent::Simulated,
        ..row(
            "TrikWaitForMotion",
            "Wait for Motion",
            Watch::Motion,
            &[],
            "Waits until the motion sensor on F1 sees something move. In the simulator it does nothing.",
        )
    },
    Row {
        silent: Silent::WithoutGamepad,
        ..row(
            "TrikWaitGamepadButton",
            "Wait Gamepad Button",
            Watch::PadButton,
            &[property("Button", "Button", Number, "1")],
            "Waits until a button of the gamepad, 1 to 5, is pressed. It checks every 200 ms.",
        )
    },
    Row {
        silent: Silent::WithoutGamepad,
        ..row(
            "TrikWaitPadPress",
            "Wait Pad Press",
            Watch::Pad,
            &[property("Pad", "Pad", Number, "1")],
            "Waits until a pad of the gamepad is touched: 1 is the left one, 2 the right one.",
        )
    },
    Row {
        silent: Silent::WithoutGamepad,
        ..row(
            "TrikWaitGamepadWheel",
            "Wait for Gamepad Wheel",
            Watch::Wheel("Angle"),
            &[expression("Angle", "Angle", Whole, "0"), SIGN],
            "Waits until the wheel of the gamepad, from -100 to 100, has passed a value.",
        )
    },
    Row {
        silent: Silent::WithoutGamepad,
        ..row(
            "TrikWaitGamepadDisconnect",
            "Wait for Gamepad Disconnect",
            Watch::Disconnected,
            &[],
            "Waits until the gamepad is disconnected.",
        )
    },
    Row {
        silent: Silent::WithoutGamepad,
        ..row(
            "TrikWaitGamepadConnect",
            "Wait for Gamepad Connect",
            Watch::Connected,
            &[],
            "Waits until a gamepad is connected.",
        )
    },
];
