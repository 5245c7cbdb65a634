//! Rows of the blocks of sound, system, camera, messages and files.

use super::Content::{self, Evaluated, Flag, Number, Raw};
use super::Kind::{Items, List, Text, Whole as Int};
use super::{Does, EVALUATE, Property, Row, control_in, control_out, input, output, property};

const CAMERAS: Content = Content::Choice(&["color", "object", "line"]);
const EVALUATED: Property = property(EVALUATE, EVALUATE, Flag, "false");

pub(super) const ROWS: &[Row] = &[
    Row {
        element: "DFSayBlock",
        shown: "Say",
        russian: "Сказать",
        size: (100, 115),
        ports: &[
            control_in(10, 16),
            control_out(90, 16),
            input("DATA", Text, 2, 62),
        ],
        properties: &[
            EVALUATED,
            property("text", "text", Evaluated, "Hello world!"),
        ],
        text: "Says a text: that of the token, or its own.",
        does: Does::Say,
    },
    Row {
        element: "DFPlayToneBlock",
        shown: "Play tone",
        russian: "Сыграть файл",
        size: (100, 116),
        ports: &[
            input("FILE", Text, 2, 97),
            control_in(14, 15),
            control_out(88, 18),
        ],
        properties: &[property("file", "file name", Raw, "ololo.mp3")],
        text: "Plays a sound file: that of the token, or its own.",
        does: Does::Sound,
    },
    Row {
        element: "DFSystemCallBlock",
        shown: "System call",
        russian: "Команда",
        size: (100, 115),
        ports: &[
            control_in(10, 16),
            control_out(90, 16),
            input("COMMAND", Text, 1, 65),
        ],
        properties: &[
            EVALUATED,
            property("IsCode", "isCode", Flag, "false"),
            property("Command", "Command", Evaluated, "reboot"),
        ],
        text: "Runs a command of the system, or a line of a program: that of the token, or its own. A simulator runs none.",
        does: Does::System,
    },
    Row {
        element: "DFStreamingBlock",
        shown: "Video stream",
        russian: "Видеопоток",
        size: (101, 115),
        ports: &[control_in(9, 15), control_out(89, 16)],
        properties: &[],
        text: "Starts the video of the camera.",
        does: Does::Stream,
    },
    Row {
        element: "DFInitCameraBlock",
        shown: "Camera initialization",
        russian: "Включить камеру",
        size: (101, 115),
        ports: &[
            control_in(8, 15),
            control_out(89, 16),
            input("TYPE", Text, 2, 90),
        ],
        properties: &[property("type", "type:", CAMERAS, "Line")],
        text: "Starts a sensor of the camera: line, object or color.",
        does: Does::StartCamera,
    },
    Row {
        element: "DFDetectByVideoBlock",
        shown: "Object detector",
        russian: "Детектор",
        size: (100, 115),
        ports: &[
            control_in(10, 18),
            output("OUT", List, 98, 60),
            input("TYPE", Text, 2, 90),
        ],
        properties: &[property("type", "type:", CAMERAS, "Line")],
        text: "Gives the readings of a sensor of the camera every 20 ms from its start on: {x, crossing, width} of a line, {x, y, size} of an object, {r, g, b} of a colour.",
        does: Does::Detect,
    },
    Row {
        element: "DFMessageToRobotBlock",
        shown: "Message to robot",
        russian: "Сообщение роботу",
        size: (100, 115),
        ports: &[
            control_in(10, 15),
            control_out(90, 15),
            input("MSG", Text, 2, 45),
            input("NUMBER", Int, 2, 90),
        ],
        properties: &[
            property("robotNum", "robot number", Number, "0"),
            property("message", "message", Raw, "hello"),
        ],
        text: "Sends a message to the robot of that number; NUMBER chooses another robot for what follows.",
        does: Does::Send,
    },
    Row {
        element: "ReceiveMsg",
        shown: "Message receiver",
        russian: "Приём сообщений",
        size: (100, 115),
        ports: &[control_in(10, 19), output("OUT", Items(2), 98, 65)],
        properties: &[],
        text: "Gives each message of another robot as {number, text}, from its start on.",
        does: Does::Receive,
    },
    Row {
        element: "DFWriteToFileBlock",
        shown: "Write to file",
        russian: "Запись в файл",
        size: (100, 115),
        ports: &[
            control_in(14, 16),
            control_out(87, 16),
            input("FILE", Text, 3, 62),
            input("TEXT", Text, 3, 97),
        ],
        properties: &[
            property("fileName", "file name", Raw, "fileName"),
            property("text", "text", Raw, "text"),
        ],
        text: "Writes a text to the end of a file, without a new line: that of the token, or its own; FILE chooses another file for what follows.",
        does: Does::WriteFile,
    },
    Row {
        element: "DFReadFileBlock",
        shown: "Read file",
        russian: "Чтение файла",
        size: (100, 115),
        ports: &[
            control_in(11, 17),
            control_out(92, 17),
            input("FILE", Text, 2, 96),
            output("OUT", Text, 99, 62),
        ],
        properties: &[
            property("fileName", "file for read", Raw, "file.txt"),
            property("isbyWords", "by words", Flag, "true"),
        ],
        text: "Reads a file and sends each of its words, or each of its lines.",
        does: Does::ReadFile,
    },
    Row {
        element: "DFRemoveFileBlock",
        shown: "Remove file",
        russian: "Удалить файл",
        size: (100, 115),
        ports: &[
            control_in(11, 17),
            control_out(92, 17),
            input("FILE", Text, 2, 96),
        ],
        properties: &[property("fileName", "file for remove", Raw, "file.txt")],
        text: "Removes a file; it is no error if there is none.",
        does: Does::RemoveFile,
    },
];
