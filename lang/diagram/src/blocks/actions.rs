//! Rows of the blocks that tell a device something and go on: motors, servos, encoders, sound, light, files, camera, messages.
//!
//! Owns rows only.

use super::Content::{Choice, Evaluated, Number, Ports, Raw};
use super::Type::{List, Text, Whole};
use super::{Act, Category, Copied, Does, EVALUATE, Kits, Property, Row, Silent};
use super::{expression, flag, property, variable};

const fn row(
    kind: &'static str,
    shown: &'static str,
    act: Act,
    properties: &'static [Property],
    text: &'static str,
) -> Row {
    Row {
        kind,
        shown,
        category: Category::Actions,
        kits: Kits::Both,
        silent: Silent::Never,
        properties,
        text,
        does: Does::Act(act),
    }
}

const SENSORS: &[&str] = &["line", "object", "color"];
const MOTORS: Property = expression("Ports", "Ports", List, "M3, M4");
const POWER: Property = expression("Power", "Power (%)", Whole, "100");
const ANGLE: Property = expression("Power", "Angle (degrees)", Whole, "0");
const SERVO_TEXT: &str = "Turns servos to an angle in degrees.";
const CLEAR_TEXT: &str = "Sets encoders to 0.";

pub(super) const ROWS: &[Row] = &[
    row(
        "TrikV6EnginesForward",
        "Motors Forward",
        Act::Forward,
        &[MOTORS, POWER],
        "Sets the power of motors, in percent from -100 to 100; more counts as 100. The program goes on at once.",
    ),
    row(
        "TrikV6EnginesBackward",
        "Motors Backward",
        Act::Backward,
        &[MOTORS, POWER],
        "Sets the power of motors in the other direction.",
    ),
    row(
        "TrikV6EnginesStop",
        "Stop Motors",
        Act::Stop,
        &[
            property("Mode", "Mode", Choice(&["brake", "float"]), "float"),
            expression("Ports", "Ports", List, "M1, M2, M3, M4"),
        ],
        "Switches motors off. On TRIK both modes are the same.",
    ),
    Row {
        kits: Kits::V6,
        ..row(
            "TrikAngularServo",
            "Angular Servo",
            Act::Forward,
            &[expression("Ports", "Ports", List, "E1"), ANGLE],
            SERVO_TEXT,
        )
    },
    Row {
        kits: Kits::V62,
        ..row(
            "TrikV62AngularServo",
            "Angular Servo",
            Act::Forward,
            &[expression("Ports", "Ports", List, "S1"), ANGLE],
            SERVO_TEXT,
        )
    },
    Row {
        kits: Kits::V6,
        ..row(
            "TrikV6ClearEncoder",
            "Clear Encoder",
            Act::ClearEncoders,
            &[property("Ports", "Ports", Ports, "B1, B2, B3, B4")],
            CLEAR_TEXT,
        )
    },
    Row {
        kits: Kits::V62,
        ..row(
            "TrikV62ClearEncoder",
            "Clear Encoder",
            Act::ClearEncoders,
            &[property("Ports", "Ports", Ports, "E1, E2, E3, E4")],
            CLEAR_TEXT,
        )
    },
    row(
        "TrikPlayTone",
        "Play Sound",
        Act::Sound,
        &[property("FileName", "File Name", Raw, "media/beep.wav")],
        "Plays a sound file that is on the robot.",
    ),
    row(
        "TrikPlayToneHz",
        "Play Tone",
        Act::Tone,
        &[
            property("Frequency", "Frequency", Number, "1000"),
            property("Duration", "Duration", Number, "1000"),
        ],
        "Plays a tone of a number of Hz for a number of milliseconds. Both are plain numbers. The program goes on at once.",
    ),
    row(
        "TrikSay",
        "Say",
        Act::Say,
        &[property("Text", "Text", Evaluated, "Hi!"), EVALUATE],
        "Says a text, or the value of an expression if `Evaluate` is set.",
    ),
    row(
        "TrikLed",
        "Led",
        Act::Led,
        &[property(
            "Color",
            "Color",
            Choice(&["green", "red", "off", "orange"]),
            "red",
        )],
        "Sets the light on the board.",
    ),
    Row {
        silent: Silent::Simulated,
        ..row(
            "TrikSystem",
            "System Call",
            Act::System,
            &[
                property("Command", "Command", Evaluated, "echo 123"),
                flag("Code", "Code", "false"),
                EVALUATE,
            ],
            "Runs a shell command on the robot, or a line of a program if `Code` is set. In the simulator it does nothing.",
        )
    },
    row(
        "TrikWriteToFile",
        "Write To File",
        Act::WriteFile,
        &[
            property("File", "File", Raw, "output.txt"),
            expression("Text", "Text", Text, ""),
        ],
        "Appends the value of an expression to a file, without a newline.",
    ),
    row(
        "TrikRemoveFile",
        "Remove File",
        Act::RemoveFile,
        &[property("File", "File", Raw, "output.txt")],
        "Removes a file.",
    ),
    row(
        "TrikInitCamera",
        "Initialize Videocamera",
        Act::StartCamera,
        &[
            property("Mode", "Mode", Choice(SENSORS), "line"),
            flag("DrawStream", "Draw stream", "true"),
        ],
        "Starts a sensor of the camera. In the simulator the camera always works.",
    ),
    Row {
        silent: Silent::Always,
        ..row(
            "TrikStopCamera",
            "Stop Videocamera",
            Act::StopCamera,
            &[property("Mode", "Mode", Choice(SENSORS), "line")],
            "Stops a sensor of the camera. Only generated programs do that.",
        )
    },
    row(
        "TrikDetect",
        "Detect by Videocamera",
        Act::Detect,
        &[property(
            "Mode",
            "Mode",
            Choice(&["line", "object"]),
            "line",
        )],
        "The sensor of the camera learns the colour that it sees in its middle.",
    ),
    Row {
        does: Does::Copy(Copied::Line),
        ..row(
            "TrikDetectorToVariable",
            "Line Detector into Variable",
            Act::Detect,
            &[variable("Variable", "err")],
            "Assigns the place of the line, from -100 to 100, to a variable.",
        )
    },
    Row {
        silent: Silent::Simulated,
        ..row(
            "TrikInitVideoStreaming",
            "Enable Video Streaming",
            Act::StartVideo,
            &[
                flag("Grayscaled", "Grayscaled", "false"),
                property(
                    "Quality",
                    "Quality",
                    Choice(&["15", "30", "50", "80"]),
                    "30",
                ),
            ],
            "Starts the video of the camera. In the simulator it does nothing.",
        )
    },
    Row {
        silent: Silent::Simulated,
        ..row(
            "TrikStopVideoStreaming",
            "Disable Video Streaming",
            Act::StopVideo,
            &[],
            "Stops the video of the camera. In the simulator it does nothing.",
        )
    },
    Row {
        silent: Silent::WithoutMailbox,
        ..row(
            "TrikSendMessage",
            "Send message",
            Act::SendMail,
            &[
                property("Message", "Message", Raw, ""),
                expression("HullNumber", "Hull Number", Whole, ""),
            ],
            "Sends a text unchanged to the robot with a hull number; without a number, to all.",
        )
    },
    Row {
        silent: Silent::Real,
        ..row(
            "TrikCalibrateGyroscope",
            "Calibrate gyroscope",
            Act::CalibrateGyroscope,
            &[],
            "Sets the present heading to 0.",
        )
    },
    Row {
        does: Does::Copy(Copied::Lidar),
        ..row(
            "TrikReadLidar",
            "Read Lidar To Variable",
            Act::Detect,
            &[variable("variable", "x")],
            "Assigns all distances of the lidar, in cm, to a variable.",
        )
    },
];
