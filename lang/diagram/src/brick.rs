//! The robot as a running diagram sees it: commands out, readings in.
//!
//! Owns the border and nothing behind it: a stand-in, the simulator and the daemon over the tree implement [`Brick`].
//! Knows no blocks and no time.

use std::fmt;

use super::ports::Port;
use lang_text::problem::Problem;

/// Something that a device is told. Texts belong to the program; a command is gone when the call returns.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Command<'a> {
    /// Power of a motor in percent, -100 to 100.
    Power {
        /// The motor.
        port: Port,
        /// Percent.
        percent: i32,
    },
    /// A motor off.
    Off {
        /// The motor.
        port: Port,
        /// Whether to hold it; TRIK treats both alike.
        brake: bool,
    },
    /// Angle of a servo in degrees.
    Servo {
        /// The servo.
        port: Port,
        /// Degrees.
        degrees: i32,
    },
    /// An encoder to 0.
    ResetEncoder {
        /// The encoder.
        port: Port,
    },
    /// A sound file.
    Sound {
        /// Its name on the robot.
        file: &'a str,
    },
    /// A tone, which does not keep the program.
    Tone {
        /// Frequency in Hz.
        hertz: i32,
        /// Duration in milliseconds.
        ms: i32,
    },
    /// Speech.
    Say {
        /// The words; none of a text that nobody has set.
        text: Option<&'a str>,
    },
    /// The light on the board.
    Led {
        /// `green`, `red`, `orange` or `off`.
        color: &'a str,
    },
    /// A command of the system.
    System {
        /// The command, or a line of a program.
        command: &'a str,
        /// Whether it is a line of a program.
        code: bool,
    },
    /// Text at the end of a file.
    Append {
        /// The file as the user wrote it; the code that opens it decides where that is.
        file: &'a str,
        /// The text.
        text: &'a str,
    },
    /// A file away.
    Remove {
        /// The file as the user wrote it.
        file: &'a str,
    },
    /// A sensor of the camera on.
    StartCamera {
        /// `line`, `object` or `color`.
        mode: &'a str,
        /// Whether its picture is shown on the screen.
        show: bool,
    },
    /// A sensor of the camera off.
    StopCamera {
        /// `line`, `object` or `color`.
        mode: &'a str,
    },
    /// Video on.
    StartVideo {
        /// Without colours.
        gray: bool,
        /// Quality of JPEG in percent.
        quality: i32,
    },
    /// Video off.
    StopVideo,
    /// A sensor of the camera learns the colour in the middle.
    Detect {
        /// `line` or `object`.
        mode: &'a str,
    },
    /// A message to another robot.
    Send {
        /// The message.
        message: &'a str,
        /// To whom; nothing: to all.
        hull: Option<i32>,
    },
    /// Another robot's mailbox.
    Join {
        /// Its address.
        address: &'a str,
        /// Its TCP port.
        port: i32,
        /// The number of this robot.
        hull: i32,
    },
    /// The present heading becomes 0.
    CalibrateGyroscope,
    /// Text for the robot's console, of the function `print`.
    Console {
        /// The text.
        text: &'a str,
    },
    /// Colour of the pen.
    PenColor {
        /// Its name.
        color: &'a str,
    },
    /// Width of the pen in pixels.
    PenWidth {
        /// Pixels.
        width: i32,
    },
    /// Colour behind everything on the screen.
    Background {
        /// Its name.
        color: &'a str,
    },
    /// A figure on the screen.
    Draw(Figure),
    /// A label on the screen; it replaces the one at the same place.
    Label {
        /// Left, in pixels.
        x: i32,
        /// Top, in pixels.
        y: i32,
        /// Height of letters in pixels, above 0.
        size: i32,
        /// The text.
        text: &'a str,
    },
    /// A face.
    Smile {
        /// A sad one.
        sad: bool,
    },
    /// Everything but the background from the screen.
    ClearScreen,
    /// What was drawn becomes visible.
    Redraw,
    /// The marker down.
    MarkerDown {
        /// Its colour.
        color: &'a str,
    },
    /// The marker up.
    MarkerUp,
    /// The program has ended: all motors off, tone off.
    Rest,
}

/// A figure on the screen, in pixels and degrees.
#[derive(Clone, Copy, Debug, Eq, PartialEq)]
pub enum Figure {
    /// x, y.
    Pixel([i32; 2]),
    /// x, y of both ends.
    Line([i32; 4]),
    /// x, y, width, height, and whether it is filled.
    Rectangle([i32; 4], bool),
    /// x, y, width, height of the rectangle around it, and whether it is filled.
    Ellipse([i32; 4], bool),
    /// x, y, width, height of the rectangle around it, start and span.
    Arc([i32; 6]),
}

/// What a person has answered.
#[derive(Clone, Debug, Eq, PartialEq)]
pub enum Answer {
    /// Nothing yet.
    Waiting,
    /// This.
    Text(String),
    /// That there is no answer.
    Cancelled,
}

/// A question to a person.
#[derive(Clone, Copy, Debug, Eq, PartialEq)]
pub struct Question<'a> {
    /// Into which variable the answer goes.
    pub variable: &'a str,
    /// The question; empty: the asking side finds words.
    pub prompt: &'a str,
    /// What stands in the field.
    pub default: &'a str,
}

/// A robot.
pub trait Brick {
    /// Tells a device something. What the robot does not have is left out, as the original does.
    fn command(&mut self, command: Command<'_>);

    /// The newest reading of a sensor with one number; nothing if no such sensor is plugged in.
    fn scalar(&mut self, port: Port) -> Option<i32>;

    /// The newest reading of a sensor with several numbers, written after what is in `into`; false if no such sensor is
    /// plugged in.
    fn vector(&mut self, port: Port, into: &mut Vec<i32>) -> bool;

    /// The number that a sensor keeps instead of being read every now and then, because somebody has locked it. A sensor
    /// with several numbers keeps those that it has, whatever this one is.
    fn locked(&mut self, _port: Port) -> Option<i32> {
        None
    }

    /// A reading that somebody else has given to a sensor since the last call. It counts at once, as if the sensor had
    /// been read.
    fn announced(&mut self) -> Option<(Port, i32)> {
        None
    }

    /// A number of the function `random`; whatever else counts or rigs random numbers does not see it.
    fn random_of_function(&mut self, low: i32, high: i32) -> i32 {
        self.random(low, high)
    }

    /// A random whole number, both bounds included; `low` is not above `high`.
    fn random(&mut self, low: i32, high: i32) -> i32;

    /// The next message of another robot.
    fn mail(&mut self) -> Option<String> {
        None
    }

    /// The next message of another robot, with the number of who sent it if that is known.
    fn letter(&mut self) -> Option<(Option<i32>, String)> {
        self.mail().map(|text| (None, text))
    }

    /// What is in a file of the user; nothing if there is none, or if this robot keeps no files.
    fn contents(&mut self, _file: &str) -> Option<String> {
        None
    }

    /// Asks a person, again and again until there is an answer.
    fn ask(&mut self, _question: Question<'_>) -> Answer {
        Answer::Cancelled
    }

    /// Whether the person who has just answered this question can be asked it once more. If not, the program makes of the
    /// answer what it can.
    fn may_ask_again(&mut self, _question: Question<'_>) -> bool {
        false
    }

    /// Asks that person once more: the answer was no good, for these reasons.
    fn ask_again(&mut self, _question: Question<'_>, _why: &[Problem]) {}
}

impl fmt::Display for Command<'_> {
    /// One line in words that a person reads and a program compares.
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match *self {
            Self::Power { port, percent } => write!(f, "power {} {percent}", port.name()),
            Self::Off { port, brake } => {
                let how = if brake { "brake" } else { "float" };
                write!(f, "off {} {how}", port.name())
            }
            Self::Servo { port, degrees } => write!(f, "servo {} {degrees}", port.name()),
            Self::ResetEncoder { port } => write!(f, "reset {}", port.name()),
            Self::Sound { file } => write!(f, "sound {file:?}"),
            Self::Tone { hertz, ms } => write!(f, "tone {hertz} {ms}"),
            Self::Say { text } => write!(f, "say {:?}", text.unwrap_or_default()),
            Self::Led { color } => write!(f, "led {color}"),
            Self::System { command, code } => write!(f, "system {command:?} code={code}"),
            Self::Append { file, text } => write!(f, "append {file:?} {text:?}"),
            Self::Remove { file } => write!(f, "remove {file:?}"),
            Self::StartCamera { mode, show } => write!(f, "camera {mode} show={show}"),
            Self::StopCamera { mode } => write!(f, "camera {mode} off"),
            Self::StartVideo { gray, quality } => write!(f, "video gray={gray} {quality}"),
            Self::StopVideo => f.write_str("video off"),
            Self::Detect { mode } => write!(f, "detect {mode}"),
            Self::Send { message, hull } => match hull {
                Some(hull) => write!(f, "send {message:?} {hull}"),
                None => write!(f, "send {message:?}"),
            },
            Self::Join {
                address,
                port,
                hull,
            } => write!(f, "join {address} {port} {hull}"),
            Self::CalibrateGyroscope => f.write_str("calibrate"),
            Self::Console { text } => write!(f, "print {text:?}"),
            Self::PenColor { color } => write!(f, "pen {color}"),
            Self::PenWidth { width } => write!(f, "pen {width}"),
            Self::Background { color } => write!(f, "background {color}"),
            Self::Draw(figure) => write!(f, "{figure}"),
            Self::Label { x, y, size, text } => write!(f, "label {x} {y} {size} {text:?}"),
            Self::Smile { sad } => f.write_str(if sad { "smile sad" } else { "smile" }),
            Self::ClearScreen => f.write_str("clear"),
            Self::Redraw => f.write_str("redraw"),
            Self::MarkerDown { color } => write!(f, "marker {color}"),
            Self::MarkerUp => f.write_str("marker up"),
            Self::Rest => f.write_str("rest"),
        }
    }
}

impl fmt::Display for Figure {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let (name, numbers, filled): (_, &[i32], _) = match self {
            Self::Pixel(at) => ("pixel", at, false),
            Self::Line(ends) => ("line", ends, false),
            Self::Rectangle(sides, filled) => ("rectangle", sides, *filled),
            Self::Ellipse(sides, filled) => ("ellipse", sides, *filled),
            Self::Arc(numbers) => ("arc", numbers, false),
        };
        f.write_str(name)?;
        for number in numbers {
            write!(f, " {number}")?;
        }
        if filled {
            f.write_str(" filled")?;
        }
        Ok(())
    }
}
