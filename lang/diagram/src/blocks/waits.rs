//! Rows of the blocks that wait until a sensor, a button or the gamepad says something.
//!
//! Owns rows only.

use super::Content::{Choice, Number, Port};
use super::Type::Whole;
use super::example::{Stimulus, waits};
use super::parts::{SIGN, block, expression, property};
use super::wait::{Asked, Every, Measure, Reading, Until, Wait};
use super::{Category, Does, Kits, Property, Row, Silent};
use crate::words;
use lang_text::problem::Words;

const fn row(
    kind: &'static str,
    shown: [&'static str; 2],
    wait: &'static Wait,
    properties: &'static [Property],
    text: [&'static str; 2],
) -> Row {
    Row {
        icon: "<path class=\"i\" d=\"M-14 0q14 -15 28 0q-14 15 -28 0z\"/><circle class=\"f\" r=\"4\"/>",
        ..block(
            Category::Wait,
            kind,
            shown,
            Does::Wait(wait),
            properties,
            text,
        )
    }
}

/// How often sensors are asked.
const EVERY: Every = Every::Ms(20);
const ANALOG: Property = property(
    "Port",
    ["Port", "Порт"],
    Port(&["A1", "A2", "A3", "A4", "A5", "A6"]),
    "A1",
);
const DISTANCE: Property = expression("Distance", ["Distance", "Расстояние"], Whole, "0");
const LIMIT: Property = expression("TachoLimit", ["Tacho Limit", "Предел оборотов"], Whole, "");
const ENCODER_SHOWN: [&str; 2] = ["Wait for Encoder", "Ждать энкодер"];
const ENCODER_TEXT: [&str; 2] = [
    "Waits until an encoder has passed a number of degrees. It checks every 10 ms.",
    "Ждёт, пока энкодер не перейдёт через число градусов. Проверяет каждые 10 мс.",
];

/// Both kits have one, of other ports.
const ENCODER: Wait = Wait {
    every: Every::Step,
    absent: |port| words::not_configured("Encoder", port),
    ..sensor("TachoLimit", "")
};

/// A sensor with one number on a port of choice against the expression in a property.
const fn sensor(value: &'static str, sensor: &'static str) -> Wait {
    Wait {
        port: Asked::Named("Port"),
        reading: Reading::Of(Measure::Only),
        until: Until::Compared(value),
        every: EVERY,
        sensor,
        absent: |port| words::not_configured("Sensor", port),
    }
}

/// Something that is pressed.
const fn pressed(port: Asked, absent: fn(&str) -> Words) -> Wait {
    Wait {
        port,
        reading: Reading::Of(Measure::Only),
        until: Until::Positive,
        every: EVERY,
        sensor: "",
        absent,
    }
}

/// Something of the gamepad that is pressed.
const fn gamepad(port: Asked) -> Wait {
    pressed(port, |port| words::not_configured("Gamepad", port))
}

const PAD_BUTTONS: &[&str] = &[
    "GamepadButton1Port",
    "GamepadButton2Port",
    "GamepadButton3Port",
    "GamepadButton4Port",
    "GamepadButton5Port",
    "GamepadButtonPort",
];
const PADS: &[&str] = &[
    "GamepadPad1PressedPort",
    "GamepadPad2PressedPort",
    "GamepadPadPressedPort",
];
const CONNECTED: Asked = Asked::Fixed("GamepadConnectionIndicatorPort");
const AXES: &[(&str, Measure)] = &[
    ("xAxis", Measure::At(0)),
    ("yAxis", Measure::At(1)),
    ("zAxis", Measure::At(2)),
    ("normal", Measure::Length),
];

pub(super) const ROWS: &[Row] = &[
    Row {
        examples: &[waits(
            &[("Degrees", "45"), ("Sign", "equals")],
            &[
                (
                    0,
                    Stimulus::Numbers("GyroscopePort", &[0, 0, 0, 0, 0, 0, 44_999]),
                ),
                (
                    75,
                    Stimulus::Numbers("GyroscopePort", &[0, 0, 0, 0, 0, 0, 45_999]),
                ),
            ],
            80,
        )],
        ..row(
            "TrikWaitForGyroscope",
            ["Wait for Gyroscope", "Ждать гироскоп"],
            &Wait {
                port: Asked::Fixed("GyroscopePort"),
                // Millidegrees, the last of seven numbers.
                reading: Reading::Of(Measure::ThousandthAt(6)),
                absent: |port| words::not_configured("Gyroscope", port),
                ..sensor("Degrees", "")
            },
            &[
                expression("Degrees", ["Degrees", "Градусы"], Whole, "0"),
                SIGN,
            ],
            [
                "Waits until the heading, in whole degrees from -180 to 180, has passed a value.",
                "Ждёт, пока курс в целых градусах от -180 до 180 не перейдёт через значение.",
            ],
        )
    },
    Row {
        examples: &[waits(
            &[("Port", "A2")],
            &[
                (0, Stimulus::Number("A2", 0)),
                (75, Stimulus::Number("A2", 1)),
            ],
            80,
        )],
        ..row(
            "TrikWaitForTouchSensor",
            ["Wait for Touch Sensor", "Ждать датчик касания"],
            &Wait {
                sensor: "TrikTouchSensor",
                ..pressed(Asked::Named("Port"), |port| {
                    words::not_configured("Touch sensor", port)
                })
            },
            &[ANALOG],
            [
                "Waits until a touch sensor is pressed.",
                "Ждёт, пока не нажат датчик касания.",
            ],
        )
    },
    Row {
        examples: &[waits(
            &[("Percents", "10 * 3")],
            &[
                (0, Stimulus::Number("A1", 30)),
                (75, Stimulus::Number("A1", 31)),
            ],
            80,
        )],
        ..row(
            "TrikWaitForLight",
            ["Wait for Light", "Ждать датчик освещённости"],
            &sensor("Percents", "TrikLightSensor"),
            &[
                ANALOG,
                expression("Percents", ["Percents", "Проценты"], Whole, "0"),
                SIGN,
            ],
            [
                "Waits until a light sensor has passed a value in percent. In the simulator white is 0 and black is 99.",
                "Ждёт, пока датчик освещённости не перейдёт через значение в процентах. В имитаторе белое - 0, чёрное - 99.",
            ],
        )
    },
    Row {
        examples: &[waits(
            &[("Distance", "20"), ("Sign", "less"), ("Port", "D2")],
            &[
                (0, Stimulus::Number("D2", 20)),
                (75, Stimulus::Number("D2", 19)),
            ],
            80,
        )],
        ..row(
            "TrikWaitForSonarDistance",
            [
                "Wait for Ultrasonic Distance",
                "Ждать ультразвуковой датчик",
            ],
            &sensor("Distance", "TrikSonarSensor"),
            &[
                property("Port", ["Port", "Порт"], Port(&["D1", "D2"]), "D1"),
                DISTANCE,
                SIGN,
            ],
            [
                "Waits until an ultrasonic sensor has passed a distance in cm.",
                "Ждёт, пока ультразвуковой датчик не перейдёт через расстояние в см.",
            ],
        )
    },
    Row {
        examples: &[waits(
            &[("Distance", "20"), ("Sign", "notGreater")],
            &[
                (0, Stimulus::Number("A1", 21)),
                (75, Stimulus::Number("A1", 20)),
            ],
            80,
        )],
        ..row(
            "TrikWaitForIRDistance",
            ["Wait for Infrared Distance", "Ждать инфракрасный датчик"],
            &sensor("Distance", "TrikInfraredSensor"),
            &[ANALOG, DISTANCE, SIGN],
            [
                "Waits until an infrared sensor has passed a distance in cm.",
                "Ждёт, пока инфракрасный датчик не перейдёт через расстояние в см.",
            ],
        )
    },
    Row {
        kits: Kits::V6,
        examples: &[waits(
            &[("TachoLimit", "360"), ("Sign", "notLess")],
            &[
                (0, Stimulus::Number("E3", 0)),
                (75, Stimulus::Number("E3", 360)),
            ],
            80,
        )],
        ..row(
            "TrikWaitForEncoder",
            ENCODER_SHOWN,
            &ENCODER,
            &[
                property(
                    "Port",
                    ["Port", "Порт"],
                    Port(&["B1", "B2", "B3", "B4"]),
                    "B3",
                ),
                LIMIT,
                SIGN,
            ],
            ENCODER_TEXT,
        )
    },
    Row {
        kits: Kits::V62,
        examples: &[waits(
            &[("TachoLimit", "360"), ("Sign", "notLess")],
            &[
                (0, Stimulus::Number("E3", 0)),
                (75, Stimulus::Number("E3", 360)),
            ],
            80,
        )],
        ..row(
            "TrikV62WaitForEncoder",
            ENCODER_SHOWN,
            &ENCODER,
            &[
                property(
                    "Port",
                    ["Port", "Порт"],
                    Port(&["E1", "E2", "E3", "E4"]),
                    "E3",
                ),
                LIMIT,
                SIGN,
            ],
            ENCODER_TEXT,
        )
    },
    Row {
        examples: &[waits(
            &[("Button", "Esc")],
            &[(75, Stimulus::Number("Esc", 1))],
            80,
        )],
        ..row(
            "TrikWaitForButton",
            ["Wait for Button", "Ждать нажатия кнопки"],
            &pressed(Asked::Named("Button"), words::no_button),
            &[property(
                "Button",
                ["Button", "Кнопка"],
                Port(&["Up", "Down", "Left", "Right", "Enter", "Esc"]),
                "Up",
            )],
            [
                "Waits until a button of the board is pressed.",
                "Ждёт нажатия кнопки контроллера.",
            ],
        )
    },
    Row {
        silent: Silent::Simulated,
        examples: &[
            waits(
                &[("Acceleration", "2")],
                &[
                    (0, Stimulus::Numbers("AccelerometerPort", &[2, 3, 4])),
                    (75, Stimulus::Numbers("AccelerometerPort", &[3, 0, 0])),
                ],
                80,
            ),
            waits(
                &[("AccelerationAxis", "yAxis"), ("Acceleration", "2")],
                &[
                    (0, Stimulus::Numbers("AccelerometerPort", &[3, 2, 4])),
                    (75, Stimulus::Numbers("AccelerometerPort", &[0, 3, 0])),
                ],
                80,
            ),
            waits(
                &[("AccelerationAxis", "zAxis"), ("Acceleration", "4000")],
                &[
                    (0, Stimulus::Numbers("AccelerometerPort", &[4090, 4090, 3])),
                    (75, Stimulus::Numbers("AccelerometerPort", &[3, 4, 4090])),
                ],
                80,
            ),
            waits(
                &[
                    ("AccelerationAxis", "normal"),
                    ("Acceleration", "5"),
                    ("Sign", "equals"),
                ],
                &[
                    (0, Stimulus::Numbers("AccelerometerPort", &[5, 5, 5])),
                    (75, Stimulus::Numbers("AccelerometerPort", &[-3, 4, 1])),
                ],
                80,
            ),
        ],
        ..row(
            "TrikWaitForAccelerometer",
            ["Wait for Accelerometer", "Ждать акселерометр"],
            &Wait {
                port: Asked::Fixed("AccelerometerPort"),
                reading: Reading::Chosen("AccelerationAxis", AXES),
                absent: |port| words::not_configured("Accelerometer", port),
                ..sensor("Acceleration", "")
            },
            &[
                expression("Acceleration", ["Acceleration", "Ускорение"], Whole, "0"),
                SIGN,
                property(
                    "AccelerationAxis",
                    ["Acceleration Axis", "Ось ускорения"],
                    Choice(&["xAxis", "yAxis", "zAxis", "normal"]),
                    "xAxis",
                ),
            ],
            [
                "Waits until the acceleration along an axis has passed a value. In the simulator it does nothing.",
                "Ждёт, пока ускорение по оси не перейдёт через значение. В имитаторе не делает ничего.",
            ],
        )
    },
    Row {
        silent: Silent::Simulated,
        examples: &[waits(
            &[],
            &[
                (0, Stimulus::Number("F1", 0)),
                (75, Stimulus::Number("F1", 1)),
            ],
            80,
        )],
        ..row(
            "TrikWaitForMotion",
            ["Wait for Motion", "Ждать датчик движения"],
            &pressed(Asked::Fixed("F1"), |port| {
                words::not_configured("Motion sensor", port)
            }),
            &[],
            [
                "Waits until the motion sensor on F1 sees something move. In the simulator it does nothing.",
                "Ждёт, пока датчик движения на F1 не увидит движение. В имитаторе не делает ничего.",
            ],
        )
    },
    Row {
        silent: Silent::WithoutGamepad,
        examples: &[waits(
            &[("Button", "5")],
            &[
                (0, Stimulus::Number("GamepadButton5Port", 0)),
                (75, Stimulus::Number("GamepadButton5Port", 1)),
            ],
            80,
        )],
        ..row(
            "TrikWaitGamepadButton",
            ["Wait Gamepad Button", "Ждать кнопку пульта"],
            &Wait {
                every: Every::Ms(200),
                ..gamepad(Asked::Numbered("Button", PAD_BUTTONS))
            },
            &[property("Button", ["Button", "Кнопка"], Number, "1")],
            [
                "Waits until a button of the gamepad, 1 to 5, is pressed. It checks every 200 ms.",
                "Ждёт нажатия кнопки пульта, от 1 до 5. Проверяет каждые 200 мс.",
            ],
        )
    },
    Row {
        silent: Silent::WithoutGamepad,
        examples: &[waits(
            &[("Pad", "2")],
            &[
                (0, Stimulus::Number("GamepadPad2PressedPort", 0)),
                (75, Stimulus::Number("GamepadPad2PressedPort", 1)),
            ],
            80,
        )],
        ..row(
            "TrikWaitPadPress",
            ["Wait Pad Press", "Ждать нажатия джойстика пульта"],
            &gamepad(Asked::Numbered("Pad", PADS)),
            &[property("Pad", ["Pad", "Джойстик"], Number, "1")],
            [
                "Waits until a pad of the gamepad is touched: 1 is the left one, 2 the right one.",
                "Ждёт касания джойстика пульта: 1 - левый, 2 - правый.",
            ],
        )
    },
    Row {
        silent: Silent::WithoutGamepad,
        examples: &[waits(
            &[("Angle", "-50"), ("Sign", "less")],
            &[
                (0, Stimulus::Number("GamepadWheelPort", -50)),
                (75, Stimulus::Number("GamepadWheelPort", -51)),
            ],
            80,
        )],
        ..row(
            "TrikWaitGamepadWheel",
            ["Wait for Gamepad Wheel", "Ждать руль пульта"],
            &Wait {
                until: Until::Compared("Angle"),
                ..gamepad(Asked::Fixed("GamepadWheelPort"))
            },
            &[expression("Angle", ["Angle", "Угол"], Whole, "0"), SIGN],
            [
                "Waits until the wheel of the gamepad, from -100 to 100, has passed a value.",
                "Ждёт, пока руль пульта, от -100 до 100, не перейдёт через значение.",
            ],
        )
    },
    Row {
        silent: Silent::WithoutGamepad,
        examples: &[waits(
            &[],
            &[
                (0, Stimulus::Number("GamepadConnectionIndicatorPort", 1)),
                (75, Stimulus::Number("GamepadConnectionIndicatorPort", 0)),
            ],
            80,
        )],
        ..row(
            "TrikWaitGamepadDisconnect",
            ["Wait for Gamepad Disconnect", "Ждать отключения пульта"],
            &Wait {
                until: Until::Zero,
                ..gamepad(CONNECTED)
            },
            &[],
            [
                "Waits until the gamepad is disconnected.",
                "Ждёт, пока пульт не отключится.",
            ],
        )
    },
    Row {
        silent: Silent::WithoutGamepad,
        examples: &[waits(
            &[],
            &[
                (0, Stimulus::Number("GamepadConnectionIndicatorPort", 0)),
                (75, Stimulus::Number("GamepadConnectionIndicatorPort", 1)),
            ],
            80,
        )],
        ..row(
            "TrikWaitGamepadConnect",
            ["Wait for Gamepad Connect", "Ждать подключения пульта"],
            &gamepad(CONNECTED),
            &[],
            [
                "Waits until a gamepad is connected.",
                "Ждёт подключения пульта.",
            ],
        )
    },
];
