//! Rows of the blocks that tell motors, servos and encoders something and go on.
//!
//! Owns rows only.

use super::Content::{Choice, Ports};
use super::Type::{List, Whole};
use super::act::{Act, Effect};
use super::actions::{DRUM, STOP_SIGN, row};
use super::example::example;
use super::parts::{expression, property};
use super::{Kits, Property, Row};

const MOTORS: Property = expression("Ports", ["Ports", "Порты"], List, "M3, M4");
const POWER: Property = expression("Power", ["Power (%)", "Мощность (%)"], Whole, "100");
const ANGLE: Property = expression("Power", ["Angle (degrees)", "Угол (градусы)"], Whole, "0");

const UP: &str = "<path class=\"i\" d=\"M0 14V-12M-9 -3L0 -12L9 -3\"/>";

/// Both kits have one, of other ports.
const fn servo(kind: &'static str, properties: &'static [Property]) -> Row {
    Row {
        icon: UP,
        examples: const { &[example(&[("Power", "30")], &["servo S1 30"])] },
        ..row(
            kind,
            ["Angular Servo", "Угловой сервопривод"],
            const { &Act::of(Effect::Drive(1)) },
            properties,
            [
                "Turns servos to an angle in degrees.",
                "Поворачивает сервоприводы на угол в градусах.",
            ],
        )
    }
}

/// Both kits have one, of other ports.
const fn clear(kind: &'static str, properties: &'static [Property]) -> Row {
    Row {
        icon: DRUM,
        examples: const { &[example(&[("Ports", "E1")], &["reset E1"])] },
        ..row(
            kind,
            ["Clear Encoder", "Сбросить энкодер"],
            const { &Act::of(Effect::ResetEncoders) },
            properties,
            ["Sets encoders to 0.", "Сбрасывает энкодеры в 0."],
        )
    }
}

pub(super) const ROWS: &[Row] = &[
    Row {
        icon: UP,
        examples: &[example(
            &[("Power", "150")],
            &["power M3 100", "power M4 100"],
        )],
        ..row(
            "TrikV6EnginesForward",
            ["Motors Forward", "Моторы вперёд"],
            &Act::of(Effect::Drive(1)),
            &[MOTORS, POWER],
            [
                "Sets the power of motors, in percent from -100 to 100; more counts as 100. The program goes on at once.",
                "Задаёт мощность моторов в процентах от -100 до 100; большее считается как 100. Программа сразу продолжает.",
            ],
        )
    },
    Row {
        icon: "<path class=\"i\" d=\"M0 -14V12M-9 3L0 12L9 3\"/>",
        examples: &[example(
            &[("Power", "50")],
            &["power M3 -50", "power M4 -50"],
        )],
        ..row(
            "TrikV6EnginesBackward",
            ["Motors Backward", "Моторы назад"],
            &Act::of(Effect::Drive(-1)),
            &[MOTORS, POWER],
            [
                "Sets the power of motors in the other direction.",
                "Задаёт мощность моторов в обратную сторону.",
            ],
        )
    },
    Row {
        icon: STOP_SIGN,
        examples: &[example(
            &[("Mode", "brake"), ("Ports", "M1")],
            &["off M1 brake"],
        )],
        ..row(
            "TrikV6EnginesStop",
            ["Stop Motors", "Остановить моторы"],
            &Act::of(Effect::Stop),
            &[
                property(
                    "Mode",
                    ["Mode", "Режим"],
                    Choice(&["brake", "float"]),
                    "float",
                ),
                expression("Ports", ["Ports", "Порты"], List, "M1, M2, M3, M4"),
            ],
            [
                "Switches motors off. On TRIK both modes are the same.",
                "Выключает моторы. На ТРИК оба режима одинаковы.",
            ],
        )
    },
    Row {
        kits: Kits::V6,
        ..servo(
            "TrikAngularServo",
            &[expression("Ports", ["Ports", "Порты"], List, "E1"), ANGLE],
        )
    },
    Row {
        kits: Kits::V62,
        ..servo(
            "TrikV62AngularServo",
            &[expression("Ports", ["Ports", "Порты"], List, "S1"), ANGLE],
        )
    },
    Row {
        kits: Kits::V6,
        ..clear(
            "TrikV6ClearEncoder",
            &[property(
                "Ports",
                ["Ports", "Порты"],
                Ports,
                "B1, B2, B3, B4",
            )],
        )
    },
    Row {
        kits: Kits::V62,
        ..clear(
            "TrikV62ClearEncoder",
            &[property(
                "Ports",
                ["Ports", "Порты"],
                Ports,
                "E1, E2, E3, E4",
            )],
        )
    },
];
