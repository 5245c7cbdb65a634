//! Rows of the blocks that tell a device something and go on: sound, light, files, camera, messages.
//!
//! Owns rows only.

use super::Content::{Choice, Evaluated, Number, Raw};
use super::Type::{Text, Whole};
use super::act::Operand::{self, Flag, Written, WrittenWhole};
use super::act::{Act, Phrase, When, script};
use super::example::{Stimulus, example, within};
use super::parts::{ENVELOPE, EVALUATE, block, expression, flag, property, variable};
use super::{Category, Copied, Does, Needed, Property, Row, Silent};
use crate::brick::Command;
use crate::words;

pub(super) const fn row(
    kind: &'static str,
    shown: [&'static str; 2],
    act: &'static Act,
    properties: &'static [Property],
    text: [&'static str; 2],
) -> Row {
    block(
        Category::Actions,
        kind,
        shown,
        Does::Act(act),
        properties,
        text,
    )
}

const SENSORS: &[&str] = &["line", "object", "color"];

// The video is started and stopped by a program of the controller.
const VIDEO_ON: &str = "script.system(\"/etc/init.d/mjpg-encoder-ov7670 start --jpeg-qual \" + $1)";
const VIDEO_ON_IN_PYTHON: &str =
    "script.system(\"/etc/init.d/mjpg-encoder-ov7670 start --jpeg-qual \" + str($1))";
const VIDEO_OFF: &str = "script.system(\"/etc/init.d/mjpg-encoder-ov7670 stop\")";

// Signs of several blocks.
const LOUDSPEAKER: &str =
    "<path class=\"f\" d=\"M-13 -5h6L1 -12v24L-7 5h-6z\"/><path class=\"i\" d=\"M7 -7q6 7 0 14\"/>";
pub(super) const STOP_SIGN: &str =
    "<path class=\"i\" d=\"M-6 -14h12L14 -6v12L6 14h-12L-14 6v-12z\"/>";
const SHEET: &str = "<path class=\"i\" d=\"M-9 -13h12L10 -6V13h-19zM-4 0h9M-4 6h9\"/>";
const CAMERA: &str = "<rect class=\"i\" x=\"-14\" y=\"-9\" width=\"20\" height=\"18\" rx=\"3\"/><path class=\"f\" d=\"M7 -2L14 -8V8L7 2z\"/>";
pub(super) const DRUM: &str = "<ellipse class=\"i\" rx=\"8\" ry=\"12\"/>";

/// A reading that goes into a variable.
const fn copy(
    kind: &'static str,
    shown: [&'static str; 2],
    copied: &'static Copied,
    properties: &'static [Property],
    text: [&'static str; 2],
) -> Row {
    let does = Does::Copy(copied);
    Row {
        icon: "<path class=\"i\" d=\"M-13 0h20M1 -7L8 0L1 7M13 -12v24\"/>",
        ..block(Category::Actions, kind, shown, does, properties, text)
    }
}

pub(super) const ROWS: &[Row] = &[
    Row {
        icon: LOUDSPEAKER,
        examples: &[example(&[], &["sound \"media/beep.wav\""])],
        ..row(
            "TrikPlayTone",
            ["Play Sound", "Играть звук"],
            &Act::command(
                |with| Command::Sound { file: with.written },
                &[script(&[Written], "brick.playSound($1)")
                    .tree("playSound($1)")
                    .dotnet("run(\"aplay --quiet \" + $1)")],
            )
            .russian("Проиграть звук"),
            &[property(
                "FileName",
                ["File Name", "Имя файла"],
                Raw,
                "media/beep.wav",
            )],
            ["Plays a sound file that is on the robot.", "Проигрывает звуковой файл, который есть на роботе."],
        )
    },
    Row {
        icon: LOUDSPEAKER,
        examples: &[example(&[("Frequency", "x")], &["tone 0 1000"])],
        ..row(
            "TrikPlayToneHz",
            ["Play Tone", "Гудок"],
            &Act::command(
                |with| Command::Tone {
                    hertz: with.number(0),
                    ms: with.number(1),
                },
                &[script(
                    &[Operand::Number(0), Operand::Number(1)],
                    "brick.playTone($1, $2)",
                )
                .tree("playTone($1, $2)")],
            )
            .russian("Проиграть тон"),
            &[
                property("Frequency", ["Frequency", "Частота"], Number, "1000"),
                property("Duration", ["Duration", "Длительность"], Number, "1000"),
            ],
            ["Plays a tone of a number of Hz for a number of milliseconds. Both are plain numbers. The program goes on at once.", "Издаёт тон заданной частоты в Гц заданное число миллисекунд. Оба - просто числа. Программа сразу продолжает."],
        )
    },
    Row {
        icon: LOUDSPEAKER,
        examples: &[
            example(&[("Text", "1 + 1")], &["say \"1 + 1\""]),
            example(&[("Text", "1 + 1"), ("Evaluate", "true")], &["say \"2\""]),
        ],
        ..row(
            "TrikSay",
            ["Say", "Сказать"],
            &Act::command(
                |with| Command::Say { text: (!with.is_unset).then_some(with.text) },
                &[script(&[Operand::Text], "brick.say($1)")
                    .tree("say($1)")
                    .dotnet("run(\"espeak -v russian_test -s 100 \" + $1)")],
            ),
            &[
                property("Text", ["Text", "Текст"], Evaluated, "Hi!"),
                EVALUATE,
            ],
            ["Says a text, or the value of an expression if `Evaluate` is set.", "Произносит текст или значение выражения, если стоит `Вычислять`."],
        )
    },
    Row {
        icon: "<circle class=\"f\" r=\"7\"/><path class=\"i\" d=\"M0 -14v1M0 13v1M-14 0h1M13 0h1\"/>",
        examples: &[example(&[("Color", "orange")], &["led orange"])],
        ..row(
            "TrikLed",
            ["Led", "Светодиод"],
            &Act::command(
                |with| Command::Led {
                    color: with.written,
                },
                &[
                    script(&[], "brick.led().red()")
                        .tree("light(1, 0)")
                        .dotnet("model.Led.SetColor(LedColor.Red)")
                        .on("red"),
                    script(&[], "brick.led().green()")
                        .tree("light(0, 1)")
                        .dotnet("model.Led.SetColor(LedColor.Green)")
                        .on("green"),
                    script(&[], "brick.led().orange()")
                        .tree("light(1, 1)")
                        .dotnet("model.Led.SetColor(LedColor.Orange)")
                        .on("orange"),
                    script(&[], "brick.led().off()")
                        .tree("light(0, 0)")
                        .dotnet("model.Led.PowerOff()"),
                ],
            ),
            &[property(
                "Color",
                ["Color", "Цвет"],
                Choice(&["green", "red", "off", "orange"]),
                "red",
            )],
            ["Sets the light on the board.", "Зажигает светодиод на контроллере."],
        )
    },
    Row {
        silent: Silent::Simulated,
        icon: "<path class=\"i\" d=\"M-12 -8L-4 0L-12 8M0 9h12\"/>",
        examples: &[example(&[], &["system \"echo 123\" code=false"])],
        ..row(
            "TrikSystem",
            ["System Call", "Системная команда"],
            &Act {
                may_be_code: true,
                ..Act::command(
                    |with| Command::System {
                        command: with.text,
                        code: with.flag(0),
                    },
                    &[Phrase {
                        c: "runCommand($1)",
                        ..script(&[Operand::Text], "script.system($1)")
                            .tree("system($1)")
                            .dotnet("run($1)")
                    }],
                )
            },
            &[
                property("Command", ["Command", "Команда"], Evaluated, "echo 123"),
                flag("Code", ["Code", "Код"], "false"),
                EVALUATE,
            ],
            ["Runs a shell command on the robot, or a line of a program if `Code` is set. In the simulator it does nothing.", "Выполняет команду на роботе или строку программы, если стоит `Код`. В имитаторе не делает ничего."],
        )
    },
    Row {
        icon: SHEET,
        examples: &[example(
            &[("Text", "'a' .. 5")],
            &["append \"output.txt\" \"a5\""],
        )],
        ..row(
            "TrikWriteToFile",
            ["Write To File", "Писать в файл"],
            &Act::command(
                |with| Command::Append {
                    file: with.written,
                    text: with.text,
                },
                &[
                    script(&[Written, Operand::Text], "script.writeToFile($1, $2)")
                        .tree("append($1, $2)")
                        .dotnet("IO.File.AppendAllText($1, $2)"),
                ],
            )
            .russian("Записать в файл"),
            &[
                property("File", ["File", "Файл"], Raw, "output.txt"),
                expression("Text", ["Text", "Текст"], Text, ""),
            ],
            ["Appends the value of an expression to a file, without a newline.", "Дописывает значение выражения в файл, без перевода строки."],
        )
    },
    Row {
        icon: SHEET,
        examples: &[example(&[], &["remove \"output.txt\""])],
        ..row(
            "TrikRemoveFile",
            ["Remove File", "Удалить файл"],
            &Act::command(
                |with| Command::Remove { file: with.written },
                &[script(&[Written], "script.removeFile($1)")
                    .tree("removeFile($1)")
                    .dotnet("IO.File.Delete($1)")],
            ),
            &[property("File", ["File", "Файл"], Raw, "output.txt")],
            ["Removes a file.", "Удаляет файл."],
        )
    },
    Row {
        icon: CAMERA,
        examples: &[example(
            &[("DrawStream", "false")],
            &["camera line show=false"],
        )],
        ..row(
            "TrikInitCamera",
            ["Initialize Videocamera", "Включить видеокамеру"],
            &Act::command(
                |with| Command::StartCamera {
                    mode: with.written,
                    show: with.flag(0),
                },
                &[
                    script(&[Flag(0)], "brick.objectSensor(\"video2\").init($1)").python("brick.configure(\"video2\", \"objectSensor\")\nbrick.objectSensor(\"video2\").init($1)").on("object"),
                    script(&[Flag(0)], "brick.colorSensor(\"video2\").init($1)").python("brick.configure(\"video2\", \"colorSensor\")\nbrick.colorSensor(\"video2\").init($1)").on("color"),
                    script(&[Flag(0)], "brick.lineSensor(\"video2\").init($1)").python("brick.configure(\"video2\", \"lineSensor\")\nbrick.lineSensor(\"video2\").init($1)"),
                ],
            )
            .russian("Инициализировать камеру")
            .dispensable(),
            &[
                property("Mode", ["Mode", "Режим"], Choice(SENSORS), "line"),
                flag("DrawStream", ["Draw stream", "Показывать видео"], "true"),
            ],
            ["Starts a sensor of the camera. In the simulator the camera always works.", "Включает датчик видеокамеры. В имитаторе камера работает всегда."],
        )
    },
    Row {
        silent: Silent::Always,
        icon: STOP_SIGN,
        examples: &[example(&[], &[])],
        ..row(
            "TrikStopCamera",
            ["Stop Videocamera", "Выключить видеокамеру"],
            &Act::command(
                |with| Command::StopCamera { mode: with.written },
                &[
                    script(&[], "brick.objectSensor(\"video2\").stop()").on("object"),
                    script(&[], "brick.colorSensor(\"video2\").stop()").on("color"),
                    script(&[], "brick.lineSensor(\"video2\").stop()"),
                ],
            )
            .russian("Выключить камеру")
            .dispensable(),
            &[property("Mode", ["Mode", "Режим"], Choice(SENSORS), "line")],
            ["Stops a sensor of the camera. Only generated programs do that.", "Выключает датчик видеокамеры. Это делают только сгенерированные программы."],
        )
    },
    Row {
        icon: CAMERA,
        examples: &[example(&[], &["detect line"])],
        ..row(
            "TrikDetect",
            ["Detect by Videocamera", "Захватить цвет видеокамерой"],
            &Act::command(
                |with| Command::Detect { mode: with.written },
                &[
                    script(&[], "brick.objectSensor(\"video2\").detect()")
                        .tree("detect(\"object\")")
                        .on("object"),
                    script(&[], "brick.lineSensor(\"video2\").detect()").tree("detect(\"line\")"),
                ],
            )
            .russian("Запомнить цвет"),
            &[property(
                "Mode",
                ["Mode", "Режим"],
                Choice(&["line", "object"]),
                "line",
            )],
            ["The sensor of the camera learns the colour that it sees in its middle.", "Датчик видеокамеры запоминает цвет, который видит посередине."],
        )
    },
    Row {
        examples: &[within(
            "start > * > print(err) > end",
            &[],
            &[(0, Stimulus::Numbers("LineSensorPort", &[-17, 0, 30]))],
            &["print \"-17\""],
        )],
        ..copy(
            "TrikDetectorToVariable",
            ["Line Detector into Variable", "Датчик линии в переменную"],
            &Copied {
                value: "lineSensor[0]",
                device: None,
            },
            &[variable("Variable", "err")],
            ["Assigns the place of the line, from -100 to 100, to a variable.", "Присваивает переменной положение линии от -100 до 100."],
        )
    },
    Row {
        silent: Silent::Simulated,
        icon: CAMERA,
        examples: &[example(&[], &["video gray=false 30"])],
        ..row(
            "TrikInitVideoStreaming",
            ["Enable Video Streaming", "Включить видеотрансляцию"],
            &Act::command(
                |with| Command::StartVideo {
                    gray: with.flag(0),
                    quality: with.written.parse().unwrap_or(0),
                },
                &[Phrase {
                    python: VIDEO_ON_IN_PYTHON,
                    ..script(&[WrittenWhole, Flag(0)], VIDEO_ON)
                }],
            )
            .dispensable(),
            &[
                flag("Grayscaled", ["Grayscaled", "Чёрно-белое"], "false"),
                property(
                    "Quality",
                    ["Quality", "Качество"],
                    Choice(&["15", "30", "50", "80"]),
                    "30",
                ),
            ],
            ["Starts the video of the camera. In the simulator it does nothing.", "Включает видеотрансляцию. В имитаторе не делает ничего."],
        )
    },
    Row {
        silent: Silent::Simulated,
        icon: STOP_SIGN,
        examples: &[example(&[], &["video off"])],
        ..row(
            "TrikStopVideoStreaming",
            ["Disable Video Streaming", "Выключить видеотрансляцию"],
            &Act::command(|_| Command::StopVideo, &[script(&[], VIDEO_OFF)]).dispensable(),
            &[],
            ["Stops the video of the camera. In the simulator it does nothing.", "Выключает видеотрансляцию. В имитаторе не делает ничего."],
        )
    },
    Row {
        silent: Silent::WithoutMailbox,
        icon: ENVELOPE,
        examples: &[
            example(&[("Message", "hi")], &["send \"hi\""]),
            example(
                &[("Message", "hi"), ("HullNumber", "1 + 2")],
                &["send \"hi\" 3"],
            ),
        ],
        ..row(
            "TrikSendMessage",
            ["Send message", "Отправить сообщение"],
            &Act {
                is_optional: true,
                ..Act::command(
                    |with| Command::Send {
                        message: with.written,
                        hull: (with.count > 0).then_some(with.wholes[0]),
                    },
                    &[
                        Phrase {
                            when: When::NoWhole,
                            ..script(&[Written], "mailbox.send($1)")
                        },
                        script(&[Operand::Whole(0), Written], "mailbox.send($1, $2)"),
                    ],
                )
            },
            &[
                property("Message", ["Message", "Сообщение"], Raw, ""),
                expression("HullNumber", ["Hull Number", "Бортовой номер"], Whole, ""),
            ],
            ["Sends a text unchanged to the robot with a hull number; without a number, to all.", "Отправляет текст без изменений роботу с бортовым номером; без номера - всем."],
        )
    },
    Row {
        silent: Silent::Real,
        icon: DRUM,
        examples: &[example(&[], &["calibrate"])],
        ..row(
            "TrikCalibrateGyroscope",
            ["Calibrate gyroscope", "Калибровка гироскопа"],
            &Act::command(
                |_| Command::CalibrateGyroscope,
                &[script(&[], "brick.gyroscope().calibrate(1)")],
            )
            .russian("Калибровать гироскоп")
            .dispensable(),
            &[],
            ["Sets the present heading to 0.", "Принимает нынешний курс за 0."],
        )
    },
    Row {
        examples: &[within(
            "start > * > print(far[1]) > end",
            &[("variable", "far")],
            &[(0, Stimulus::Numbers("LidarPort", &[5, 7, 9]))],
            &["print \"7\""],
        )],
        ..copy(
            "TrikReadLidar",
            ["Read Lidar To Variable", "Лидар в переменную"],
            &Copied {
                value: "lidar",
                device: Some(Needed {
                    port: "LidarPort",
                    absent: words::no_lidar,
                }),
            },
            &[variable("variable", "x")],
            ["Assigns all distances of the lidar, in cm, to a variable.", "Присваивает переменной все расстояния лидара, в см."],
        )
    },
];
