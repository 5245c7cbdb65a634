//! Rows of the blocks that tell a device something and go on: motors, servos, encoders, sound, light, files, camera, messages.
//!
//! Owns rows only.

use super::Content::{Choice, Evaluated, Number, Ports, Raw};
use super::Type::{List, Text, Whole};
use super::act::Operand::{self, Flag, Written, WrittenWhole};
use super::act::{Act, Effect, Phrase, When, example, script};
use super::{Category, Copied, Does, ENVELOPE, EVALUATE, Kits, Property, Row, Silent};
use super::{expression, flag, property, variable};
use crate::brick::Command;

const fn row(
    kind: &'static str,
    shown: &'static str,
    act: &'static Act,
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

// Signs of several blocks.
const UP: &str = "<path class=\"i\" d=\"M0 14V-12M-9 -3L0 -12L9 -3\"/>";
const LOUDSPEAKER: &str =
    "<path class=\"f\" d=\"M-13 -5h6L1 -12v24L-7 5h-6z\"/><path class=\"i\" d=\"M7 -7q6 7 0 14\"/>";
const STOP_SIGN: &str = "<path class=\"i\" d=\"M-6 -14h12L14 -6v12L6 14h-12L-14 6v-12z\"/>";
const SHEET: &str = "<path class=\"i\" d=\"M-9 -13h12L10 -6V13h-19zM-4 0h9M-4 6h9\"/>";
const CAMERA: &str = "<rect class=\"i\" x=\"-14\" y=\"-9\" width=\"20\" height=\"18\" rx=\"3\"/><path class=\"f\" d=\"M7 -2L14 -8V8L7 2z\"/>";
const DRUM: &str = "<ellipse class=\"i\" rx=\"8\" ry=\"12\"/>";

/// Both kits have one, of other ports.
const SERVO: Act = Act::of(Effect::Drive(1))
    .icon(UP)
    .examples(&[example(&[("Power", "30")], &["servo S1 30"])]);
/// Where a row says otherwise what the block does.
const NOTHING: Act = Act::of(Effect::Stop);
const CLEAR: Act = Act::of(Effect::ResetEncoders)
    .icon(DRUM)
    .examples(&[example(&[("Ports", "E1")], &["reset E1"])]);

pub(super) const ROWS: &[Row] = &[
    row(
        "TrikV6EnginesForward",
        "Motors Forward",
        &Act::of(Effect::Drive(1)).icon(UP).examples(&[example(&[("Power", "150")], &["power M3 100", "power M4 100"])]),
        &[MOTORS, POWER],
        "Sets the power of motors, in percent from -100 to 100; more counts as 100. The program goes on at once.",
    ),
    row(
        "TrikV6EnginesBackward",
        "Motors Backward",
        &Act::of(Effect::Drive(-1)).icon("<path class=\"i\" d=\"M0 -14V12M-9 3L0 12L9 3\"/>").examples(&[example(&[("Power", "50")], &["power M3 -50", "power M4 -50"])]),
        &[MOTORS, POWER],
        "Sets the power of motors in the other direction.",
    ),
    row(
        "TrikV6EnginesStop",
        "Stop Motors",
        &Act::of(Effect::Stop).icon(STOP_SIGN).examples(&[example(&[("Mode", "brake"), ("Ports", "M1")], &["off M1 brake"])]),
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
            &SERVO,
            &[expression("Ports", "Ports", List, "E1"), ANGLE],
            SERVO_TEXT,
        )
    },
    Row {
        kits: Kits::V62,
        ..row(
            "TrikV62AngularServo",
            "Angular Servo",
            &SERVO,
            &[expression("Ports", "Ports", List, "S1"), ANGLE],
            SERVO_TEXT,
        )
    },
    Row {
        kits: Kits::V6,
        ..row(
            "TrikV6ClearEncoder",
            "Clear Encoder",
            &CLEAR,
            &[property("Ports", "Ports", Ports, "B1, B2, B3, B4")],
            CLEAR_TEXT,
        )
    },
    Row {
        kits: Kits::V62,
        ..row(
            "TrikV62ClearEncoder",
            "Clear Encoder",
            &CLEAR,
            &[property("Ports", "Ports", Ports, "E1, E2, E3, E4")],
            CLEAR_TEXT,
        )
    },
    row(
        "TrikPlayTone",
        "Play Sound",
        &Act::command(|with| Command::Sound { file: with.written }, &[script(&[Written], "brick.playSound($1)").tree("playSound($1)").dotnet("run(\"aplay --quiet \" + $1)")]).icon(LOUDSPEAKER).russian("Проиграть звук").examples(&[example(&[], &["sound \"media/beep.wav\""])]),
        &[property("FileName", "File Name", Raw, "media/beep.wav")],
        "Plays a sound file that is on the robot.",
    ),
    row(
        "TrikPlayToneHz",
        "Play Tone",
        &Act::command(|with| Command::Tone { hertz: with.number(0), ms: with.number(1) }, &[script(&[Operand::Number(0), Operand::Number(1)], "brick.playTone($1, $2)").tree("playTone($1, $2)")]).icon(LOUDSPEAKER).russian("Проиграть тон").examples(&[example(&[("Frequency", "x")], &["tone 0 1000"])]),
        &[
            property("Frequency", "Frequency", Number, "1000"),
            property("Duration", "Duration", Number, "1000"),
        ],
        "Plays a tone of a number of Hz for a number of milliseconds. Both are plain numbers. The program goes on at once.",
    ),
    row(
        "TrikSay",
        "Say",
        &Act::command(|with| Command::Say { text: with.text }, &[script(&[Operand::Text], "brick.say($1)").tree("say($1)").dotnet("run(\"espeak -v russian_test -s 100 \" + $1)")]).icon(LOUDSPEAKER).examples(&[example(&[("Text", "1 + 1")], &["say \"1 + 1\""]), example(&[("Text", "1 + 1"), ("Evaluate", "true")], &["say \"2\""])]),
        &[property("Text", "Text", Evaluated, "Hi!"), EVALUATE],
        "Says a text, or the value of an expression if `Evaluate` is set.",
    ),
    row(
        "TrikLed",
        "Led",
        &Act::command(|with| Command::Led { color: with.written }, &[script(&[], "brick.led().red()").tree("light(1, 0)").dotnet("model.Led.SetColor(LedColor.Red)").on("red"), script(&[], "brick.led().green()").tree("light(0, 1)").dotnet("model.Led.SetColor(LedColor.Green)").on("green"), script(&[], "brick.led().orange()").tree("light(1, 1)").dotnet("model.Led.SetColor(LedColor.Orange)").on("orange"), script(&[], "brick.led().off()").tree("light(0, 0)").dotnet("model.Led.PowerOff()")]).icon("<circle class=\"f\" r=\"7\"/><path class=\"i\" d=\"M0 -14v1M0 13v1M-14 0h1M13 0h1\"/>").examples(&[example(&[("Color", "orange")], &["led orange"])]),
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
            &Act { may_be_code: true, ..Act::command(|with| Command::System { command: with.text, code: with.flag(0) }, &[Phrase { c: "runCommand($1)", ..script(&[Operand::Text], "script.system($1)").tree("system($1)").dotnet("run($1)") }]).icon("<path class=\"i\" d=\"M-12 -8L-4 0L-12 8M0 9h12\"/>").examples(&[example(&[], &["system \"echo 123\" code=false"])]) },
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
        &Act::command(|with| Command::Append { file: with.written, text: with.text }, &[script(&[Written, Operand::Text], "script.writeToFile($1, $2)").tree("append($1, $2)").dotnet("IO.File.AppendAllText($1, $2)")]).icon(SHEET).russian("Записать в файл").examples(&[example(&[("Text", "'a' .. 5")], &["append \"output.txt\" \"a5\""])]),
        &[
            property("File", "File", Raw, "output.txt"),
            expression("Text", "Text", Text, ""),
        ],
        "Appends the value of an expression to a file, without a newline.",
    ),
    row(
        "TrikRemoveFile",
        "Remove File",
        &Act::command(|with| Command::Remove { file: with.written }, &[script(&[Written], "script.removeFile($1)").tree("removeFile($1)").dotnet("IO.File.Delete($1)")]).icon(SHEET).examples(&[example(&[], &["remove \"output.txt\""])]),
        &[property("File", "File", Raw, "output.txt")],
        "Removes a file.",
    ),
    row(
        "TrikInitCamera",
        "Initialize Videocamera",
        &Act::command(|with| Command::StartCamera { mode: with.written, show: with.flag(0) }, &[script(&[Flag(0)], "brick.objectSensor(\"video2\").init($1)").on("object"), script(&[Flag(0)], "brick.colorSensor(\"video2\").init($1)").on("color"), script(&[Flag(0)], "brick.lineSensor(\"video2\").init($1)")]).icon(CAMERA).russian("Инициализировать камеру").dispensable().examples(&[example(&[("DrawStream", "false")], &["camera line show=false"])]),
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
            &Act::command(|with| Command::StopCamera { mode: with.written }, &[script(&[], "brick.objectSensor(\"video2\").stop()").on("object"), script(&[], "brick.colorSensor(\"video2\").stop()").on("color"), script(&[], "brick.lineSensor(\"video2\").stop()")]).icon(STOP_SIGN).russian("Выключить камеру").dispensable()
.examples(&[example(&[], &[])]),
            &[property("Mode", "Mode", Choice(SENSORS), "line")],
            "Stops a sensor of the camera. Only generated programs do that.",
        )
    },
    row(
        "TrikDetect",
        "Detect by Videocamera",
        &Act::command(|with| Command::Detect { mode: with.written }, &[script(&[], "brick.objectSensor(\"video2\").detect()").tree("detect(\"object\")").on("object"), script(&[], "brick.lineSensor(\"video2\").detect()").tree("detect(\"line\")")]).icon(CAMERA).russian("Запомнить цвет").examples(&[example(&[], &["detect line"])]),
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
            &NOTHING,
            &[variable("Variable", "err")],
            "Assigns the place of the line, from -100 to 100, to a variable.",
        )
    },
    Row {
        silent: Silent::Simulated,
        ..row(
            "TrikInitVideoStreaming",
            "Enable Video Streaming",
            &Act::command(|with| Command::StartVideo { gray: with.flag(0), quality: with.written.parse().unwrap_or(0) }, &[Phrase { python: "script.system(\"/etc/init.d/mjpg-encoder-ov7670 start --jpeg-qual \" + str($1))", ..script(&[WrittenWhole, Flag(0)], "script.system(\"/etc/init.d/mjpg-encoder-ov7670 start --jpeg-qual \" + $1)") }]).icon(CAMERA).dispensable().examples(&[example(&[], &["video gray=false 30"])]),
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
            &Act::command(|_| Command::StopVideo, &[script(&[], "script.system(\"/etc/init.d/mjpg-encoder-ov7670 stop\")")]).icon(STOP_SIGN).dispensable().examples(&[example(&[], &["video off"])]),
            &[],
            "Stops the video of the camera. In the simulator it does nothing.",
        )
    },
    Row {
        silent: Silent::WithoutMailbox,
        ..row(
            "TrikSendMessage",
            "Send message",
            &Act { is_optional: true, ..Act::command(|with| Command::Send { message: with.written, hull: (with.count > 0).then_some(with.wholes[0]) }, &[Phrase { when: When::NoWhole, ..script(&[Written], "mailbox.send($1)") }, script(&[Operand::Whole(0), Written], "mailbox.send($1, $2)")]).icon(ENVELOPE).examples(&[example(&[("Message", "hi")], &["send \"hi\""]), example(&[("Message", "hi"), ("HullNumber", "1 + 2")], &["send \"hi\" 3"])]) },
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
            &Act::command(|_| Command::CalibrateGyroscope, &[script(&[], "brick.gyroscope().calibrate(1)")]).icon(DRUM).russian("Калибровать гироскоп").dispensable().examples(&[example(&[], &["calibrate"])]),
            &[],
            "Sets the present heading to 0.",
        )
    },
    Row {
        does: Does::Copy(Copied::Lidar),
        ..row(
            "TrikReadLidar",
            "Read Lidar To Variable",
            &NOTHING,
            &[variable("variable", "x")],
            "Assigns all distances of the lidar, in cm, to a variable.",
        )
    },
];
