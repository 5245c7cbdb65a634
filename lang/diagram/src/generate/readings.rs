//! What devices say, one row for each reading: its words in each language, and the shape of what comes.
//!
//! Owns the rows and which device has which; a new device does not compile without one. Knows no blocks and no statements.

use super::code::{Code, Element, Kind, Operation, Typed};
use crate::blocks::act::{self, Phrase};
use crate::ports::{Device, GamepadPart, ObjectPart, Port};

/// What a device says.
#[derive(Debug, Eq, PartialEq)]
pub(super) struct Reading {
    shape: Shape,
    /// Its words in each language; `$1` is the operand.
    pub(super) phrase: Phrase,
    /// What messages call the device.
    pub(super) english: &'static str,
    pub(super) russian: &'static str,
    /// Whether two readings at once may differ.
    pub(super) is_fickle: bool,
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

const fn reading(shape: Shape, phrase: Phrase) -> Reading {
    Reading {
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

static ENCODER: Reading = reading(
    Shape::Whole,
    said("brick.encoder($1).read()", "encoder($1)").dotnet("readEncoder($1)"),
);

static BUTTON: Reading = Reading {
    is_fickle: true,
    ..reading(
        Shape::Whole,
        truth(
            "Number(brick.keys().isPressed($1))",
            "int(brick.keys().isPressed($1))",
            "button($1)",
        )
        .dotnet("isPressed($1)"),
    )
};

static GYROSCOPE: Reading = reading(
    Shape::Table(7),
    said("brick.gyroscope().read()", "gyroscope()").dotnet("readGyroscope()"),
);

static ACCELEROMETER: Reading = reading(
    Shape::Table(3),
    said("brick.accelerometer().read()", "accelerometer()").dotnet("readAccelerometer()"),
);

static LINE: Reading = reading(
    Shape::Table(3),
    said("brick.lineSensor(\"video2\").read()", "lineSensor()").dotnet("readLine()"),
);

static COLOR: Reading = reading(
    Shape::Table(3),
    said("brick.colorSensor(\"video2\").read(1, 1)", "colorSensor()"),
)
.called(CAMERA[0], CAMERA[1]);

static OBJECT_X: Reading = object(0);
static OBJECT_Y: Reading = object(1);
static OBJECT_SIZE: Reading = object(2);

static LIDAR: Reading = reading(Shape::Table(360), said("brick.lidar().read()", "lidar()"))
    .called("the lidar", "лидар");

static WHEEL: Reading =
    reading(Shape::Whole, said("gamepad.wheel()", "wheel()")).called(GAMEPAD[0], GAMEPAD[1]);

static CONNECTED: Reading = reading(
    Shape::Whole,
    truth(
        "Number(gamepad.isConnected())",
        "int(gamepad.isConnected())",
        "gamepadConnected()",
    ),
)
.called(GAMEPAD[0], GAMEPAD[1]);

static PAD_Y: Reading =
    reading(Shape::Whole, said("gamepad.padY($1)", "pad($1, 1)")).called(GAMEPAD[0], GAMEPAD[1]);

static PAD: Reading = reading(Shape::Pair(&PAD_Y), said("gamepad.padX($1)", "pad($1, 0)"))
    .called(GAMEPAD[0], GAMEPAD[1]);

static PAD_PRESSED: Reading = reading(
    Shape::Whole,
    truth(
        "Number(gamepad.isPadPressed($1))",
        "int(gamepad.isPadPressed($1))",
        "pad($1, 2)",
    ),
)
.called(GAMEPAD[0], GAMEPAD[1]);

static PAD_BUTTON: Reading = reading(
    Shape::Whole,
    truth(
        "Number(gamepad.buttonIsPressed($1))",
        "int(gamepad.buttonIsPressed($1))",
        "padButton($1)",
    ),
)
.called(GAMEPAD[0], GAMEPAD[1]);

static SENSOR: Reading = reading(
    Shape::Whole,
    said("brick.sensor($1).read()", "sensor($1)").dotnet("readSensor($1)"),
);

/// A number of the object that the camera sees.
const fn object(at: i64) -> Reading {
    reading(Shape::Element(at), OBJECT).called(CAMERA[0], CAMERA[1])
}

/// The reading of a port, and its operands.
fn row(port: Port) -> (&'static Reading, Vec<Code>) {
    let own = || vec![Code::Port(port.name().into())];
    let number = |number: i64| vec![Code::Int(number)];
    match port.device() {
        Device::Encoder => (&ENCODER, own()),
        Device::Button(code) => (&BUTTON, number(code.into())),
        Device::Gyroscope => (&GYROSCOPE, Vec::new()),
        Device::Accelerometer => (&ACCELEROMETER, Vec::new()),
        Device::LineSensor => (&LINE, Vec::new()),
        Device::ColorSensor => (&COLOR, Vec::new()),
        Device::ObjectSensor(ObjectPart::X) => (&OBJECT_X, Vec::new()),
        Device::ObjectSensor(ObjectPart::Y) => (&OBJECT_Y, Vec::new()),
        Device::ObjectSensor(ObjectPart::Size) => (&OBJECT_SIZE, Vec::new()),
        Device::Lidar => (&LIDAR, Vec::new()),
        Device::Gamepad(GamepadPart::Wheel) => (&WHEEL, Vec::new()),
        Device::Gamepad(GamepadPart::Connected) => (&CONNECTED, Vec::new()),
        Device::Gamepad(GamepadPart::Place(pad)) => (&PAD, number(pad.number() as i64)),
        Device::Gamepad(GamepadPart::Pressed(pad)) => (&PAD_PRESSED, number(pad.number() as i64)),
        Device::Gamepad(GamepadPart::Button(which)) => (&PAD_BUTTON, number(which.into())),
        // What is told something has no reading of its own; it is asked for like what is plugged in.
        Device::Plugged | Device::Motor | Device::Servo => (&SENSOR, own()),
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
    let (row, operand) = row(port);
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
