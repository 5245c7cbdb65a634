//! What devices say, one row for each reading: its ports, its words in each language, and the shape of what comes.
//!
//! Owns the table; a new sensor is a row. Knows no blocks and no statements.

use super::code::{Code, Element, Kind, Operation, Typed};
use crate::blocks::act::{self, Phrase};
use crate::ports::{Port, Sort};

/// What a device says.
#[derive(Debug, Eq, PartialEq)]
pub(super) struct Reading {
    /// Which ports give it.
    ports: Ports,
    shape: Shape,
    /// Its words in each language; `$1` is the operand.
    pub(super) phrase: Phrase,
    /// What messages call the device.
    pub(super) english: &'static str,
    pub(super) russian: &'static str,
    /// Whether two readings at once may differ.
    pub(super) is_fickle: bool,
}

/// The ports of a reading, and what its operand is.
#[derive(Debug, Eq, PartialEq)]
enum Ports {
    /// Encoders: the port.
    Encoders,
    /// Buttons of the board: the code of the button.
    Buttons,
    /// One port, without an operand.
    Named(&'static str),
    /// Ports with a number between these texts: the number.
    Numbered(&'static str, &'static str),
    /// All others: the port.
    Others,
}

/// What comes.
#[derive(Debug, Eq, PartialEq)]
enum Shape {
    /// A whole number.
    Whole,
    /// Whole numbers, surely so many.
    Table(i64),
    /// One of a table of whole numbers.
    Element(i64),
    /// A table of this reading and another one with the same operand.
    Pair(&'static Reading),
}

/// Words of JavaScript and Python, and of Lua and C; none of .NET.
const fn said(script: &'static str, tree: &'static str) -> Phrase {
    act::script(&[], script).tree(tree)
}

/// The same for a truth, which JavaScript and Python make a number in their own ways.
const fn truth(javascript: &'static str, python: &'static str, tree: &'static str) -> Phrase {
    Phrase {
        python,
        ..said(javascript, tree)
    }
}

const fn reading(ports: Ports, shape: Shape, phrase: Phrase) -> Reading {
    Reading {
        ports,
        shape,
        phrase,
        english: "",
        russian: "",
        is_fickle: false,
    }
}

impl Reading {
    /// With a name for messages: some language lacks it.
    const fn called(self, english: &'static str, russian: &'static str) -> Self {
        Self {
            english,
            russian,
            ..self
        }
    }
}

const CAMERA: [&str; 2] = ["a sensor of the camera", "датчик камеры"];
const GAMEPAD: [&str; 2] = ["the gamepad", "пульт"];

const OBJECT: Phrase = said("brick.objectSensor(\"video2\").read()", "objectSensor()");

static PAD_Y: Reading = reading(
    Ports::Numbered("GamepadPad", "PosPort"),
    Shape::Whole,
    said("gamepad.padY($1)", "pad($1, 1)"),
)
.called(GAMEPAD[0], GAMEPAD[1]);

/// The first row that has a port is its reading.
static READINGS: &[Reading] = &[
    reading(
        Ports::Encoders,
        Shape::Whole,
        said("brick.encoder($1).read()", "encoder($1)").dotnet("readEncoder($1)"),
    ),
    Reading {
        is_fickle: true,
        ..reading(
            Ports::Buttons,
            Shape::Whole,
            truth(
                "Number(brick.keys().isPressed($1))",
                "int(brick.keys().isPressed($1))",
                "button($1)",
            )
            .dotnet("isPressed($1)"),
        )
    },
    reading(
        Ports::Named("GyroscopePort"),
        Shape::Table(7),
        said("brick.gyroscope().read()", "gyroscope()").dotnet("readGyroscope()"),
    ),
    reading(
        Ports::Named("AccelerometerPort"),
        Shape::Table(3),
        said("brick.accelerometer().read()", "accelerometer()").dotnet("readAccelerometer()"),
    ),
    reading(
        Ports::Named("LineSensorPort"),
        Shape::Table(3),
        said("brick.lineSensor(\"video2\").read()", "lineSensor()").dotnet("readLine()"),
    ),
    reading(
        Ports::Named("ColorSensorPort"),
        Shape::Table(3),
        said("brick.colorSensor(\"video2\").read(1, 1)", "colorSensor()"),
    )
    .called(CAMERA[0], CAMERA[1]),
    reading(Ports::Named("ObjectSensorXPort"), Shape::Element(0), OBJECT)
        .called(CAMERA[0], CAMERA[1]),
    reading(Ports::Named("ObjectSensorYPort"), Shape::Element(1), OBJECT)
        .called(CAMERA[0], CAMERA[1]),
    reading(
        Ports::Named("ObjectSensorSizePort"),
        Shape::Element(2),
        OBJECT,
    )
    .called(CAMERA[0], CAMERA[1]),
    reading(
        Ports::Named("LidarPort"),
        Shape::Table(360),
        said("brick.lidar().read()", "lidar()"),
    )
    .called("the lidar", "лидар"),
    reading(
        Ports::Named("GamepadWheelPort"),
        Shape::Whole,
        said("gamepad.wheel()", "wheel()"),
    )
    .called(GAMEPAD[0], GAMEPAD[1]),
    reading(
        Ports::Named("GamepadConnectionIndicatorPort"),
        Shape::Whole,
        truth(
            "Number(gamepad.isConnected())",
            "int(gamepad.isConnected())",
            "gamepadConnected()",
        ),
    )
    .called(GAMEPAD[0], GAMEPAD[1]),
    reading(
        Ports::Numbered("GamepadPad", "PosPort"),
        Shape::Pair(&PAD_Y),
        said("gamepad.padX($1)", "pad($1, 0)"),
    )
    .called(GAMEPAD[0], GAMEPAD[1]),
    reading(
        Ports::Numbered("GamepadPad", "PressedPort"),
        Shape::Whole,
        truth(
            "Number(gamepad.isPadPressed($1))",
            "int(gamepad.isPadPressed($1))",
            "pad($1, 2)",
        ),
    )
    .called(GAMEPAD[0], GAMEPAD[1]),
    reading(
        Ports::Numbered("GamepadButton", "Port"),
        Shape::Whole,
        truth(
            "Number(gamepad.buttonIsPressed($1))",
            "int(gamepad.buttonIsPressed($1))",
            "padButton($1)",
        ),
    )
    .called(GAMEPAD[0], GAMEPAD[1]),
    reading(
        Ports::Others,
        Shape::Whole,
        said("brick.sensor($1).read()", "sensor($1)").dotnet("readSensor($1)"),
    ),
];

impl Ports {
    /// The operand, if the port is one of these.
    fn operand(&self, port: Port) -> Option<Vec<Code>> {
        let own = || vec![Code::Port(port.name().into())];
        match *self {
            Self::Encoders => (port.sort() == Sort::Encoder).then(own),
            Self::Buttons => match port.sort() {
                Sort::Button(code) => Some(vec![Code::Int(code.into())]),
                Sort::Motor | Sort::Servo | Sort::Encoder | Sort::Scalar | Sort::Vector => None,
            },
            Self::Named(name) => (port.name() == name).then(Vec::new),
            Self::Numbered(before, behind) => {
                let number = port.name().strip_prefix(before)?.strip_suffix(behind)?;
                Some(vec![Code::Int(number.parse().ok()?)])
            }
            Self::Others => Some(own()),
        }
    }
}

impl Reading {
    /// How many elements it surely has, if it is a table.
    pub(super) fn count(&self) -> i64 {
        match self.shape {
            Shape::Table(count) => count,
            Shape::Whole | Shape::Element(_) | Shape::Pair(_) => 0,
        }
    }

    /// Whether it is surely a whole number.
    pub(super) fn is_whole(&self) -> bool {
        self.shape == Shape::Whole
    }
}

/// What the variable of a sensor gives.
pub(super) fn of(port: Port) -> Typed {
    let mut rows = READINGS.iter();
    // The last row has all ports.
    let Some((row, operand)) = rows.find_map(|row| Some((row, row.ports.operand(port)?))) else {
        return Typed {
            code: Code::Nil,
            kind: Kind::Any,
        };
    };
    let read = |row, operand| Code::does(Operation::Read(row), operand);
    let table = Kind::List(Box::new(Kind::Int));
    let (code, kind) = match row.shape {
        Shape::Whole => (read(row, operand), Kind::Int),
        Shape::Table(_) => (read(row, operand), table),
        Shape::Element(at) => {
            let operands = [read(row, operand), Code::Int(at)];
            (Code::does(Element::AtPlain, operands), Kind::Int)
        }
        Shape::Pair(other) => {
            let pair = vec![read(row, operand.clone()), read(other, operand)];
            (Code::List(pair), table)
        }
    };
    Typed { code, kind }
}

/// Whether a table is a pair of readings, whose elements may be read one by one.
pub(super) fn is_pair(parts: &[Code]) -> bool {
    let [
        Code::Do(Operation::Read(one), _),
        Code::Do(Operation::Read(other), _),
    ] = parts
    else {
        return false;
    };
    one.shape == Shape::Pair(other)
}
