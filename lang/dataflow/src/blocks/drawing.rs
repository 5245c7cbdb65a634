//! Rows of the blocks of the marker and the screen.

use super::Content::{self, Evaluated, Flag, Number, Whole};
use super::Kind::{Items, Text, Truth, Whole as Int};
use super::{Does, EVALUATE, Property, Row, Shape, control_in, control_out, input, property};

/// Colours of the pen and the marker.
pub(crate) const COLORS: &[&str] = &["black", "green", "yellow", "blue", "white", "red"];
/// Colours behind everything on the screen.
pub(crate) const BACKGROUNDS: &[&str] = &[
    "red",
    "white",
    "black",
    "gray",
    "yellow",
    "magenta",
    "cyan",
    "blue",
    "green",
    "light gray",
    "dark yellow",
    "dark magenta",
    "dark cyan",
    "dark blue",
    "dark green",
    "dark red",
];

const REDRAW: Property = property("redraw", "redraw", Flag, "true");
const FILLED: Property = property("Filled", "Filled", Flag, "false");

const fn number(name: &'static str, shown: &'static str, default: &'static str) -> Property {
    property(name, shown, Whole, default)
}

/// A figure: the same ports for all, and coordinates of so many numbers.
macro_rules! figure {
    ($element:literal, $shown:literal, $russian:literal, $shape:expr, $count:literal, $text:literal, [$($property:expr),* $(,)?]) => {
        Row {
            element: $element,
            shown: $shown,
            russian: $russian,
            size: (100, 115),
            ports: &[
                control_in(10, 16),
                super::control_out(90, 16),
                input("COORDS", Items($count), 2, 60),
            ],
            properties: &[$($property),*],
            text: $text,
            does: Does::Draw($shape),
        }
    };
}

pub(super) const ROWS: &[Row] = &[
    Row {
        element: "DFPenBlock",
        shown: "Pen up/down",
        russian: "Перо",
        size: (100, 115),
        ports: &[
            control_in(10, 17),
            control_out(90, 17),
            input("UP_DOWN", Truth, 2, 45),
            input("COLOR", Text, 2, 90),
        ],
        properties: &[
            property("color", "pen color", Content::Choice(COLORS), "black"),
            property("state", "down:", Flag, "true"),
        ],
        text: "The marker of the robot on the floor: down in its colour, or up. COLOR chooses the colour for what follows.",
        does: Does::Pen,
    },
    Row {
        element: "DFPaintSettingsBlock",
        shown: "Paint settings",
        russian: "Кисть и фон",
        size: (100, 115),
        ports: &[
            control_in(16, 17),
            control_out(89, 16),
            input("BRUSH_COLOR", Text, 2, 35),
            input("BRUSH_WIDTH", Int, 2, 68),
            input("BACKGROUND_COLOR", Text, 2, 96),
        ],
        properties: &[
            property("color", "brush color", Content::Choice(COLORS), "black"),
            property("width", "brush width", Number, "1"),
            property(
                "backgroundColor",
                "background color",
                Content::Choice(BACKGROUNDS),
                "white",
            ),
            property("Redraw", "redraw", Flag, "true"),
        ],
        text: "Colour and width of the pen, and the colour behind everything: all of its own at a start, one of them by a token.",
        does: Does::Paint,
    },
    Row {
        element: "DFTextOnScreenBlock",
        shown: "Text on screen",
        russian: "Текст на экране",
        size: (100, 115),
        ports: &[
            control_in(10, 16),
            control_out(90, 16),
            input("COORDS", Items(2), 1, 51),
            input("TEXT", Text, 1, 91),
        ],
        properties: &[
            property("text", "text", Evaluated, "default text"),
            property(EVALUATE, EVALUATE, Flag, "false"),
            property("Redraw", "Redraw", Flag, "true"),
            number("xcord", "X=", "10"),
            number("ycord", "Y=", "10"),
        ],
        text: "Writes a text on the screen at a start or at {x, y}; a token at TEXT is the text for what follows.",
        does: Does::Print,
    },
    Row {
        element: "DFClearScreenBlock",
        shown: "Clear screen",
        russian: "Очистить экран",
        size: (101, 115),
        ports: &[control_in(9, 17), control_out(89, 15)],
        properties: &[],
        text: "Removes everything from the screen.",
        does: Does::Clear,
    },
    Row {
        element: "DFSmilePainterBlock",
        shown: "Smile painter",
        russian: "Смайлик",
        size: (100, 115),
        ports: &[
            control_in(10, 18),
            control_out(88, 16),
            input("DATA", Truth, 2, 88),
        ],
        properties: &[property("isHappy", "happy smile:", Flag, "true")],
        text: "Draws a face, happy or sad; a token says which for what follows.",
        does: Does::Smile,
    },
    figure!(
        "DFDrawPixelBlock",
        "Draw pixel",
        "Точка",
        Shape::Pixel,
        2,
        "Draws a point at {x, y}.",
        [
            number("XCoordinatePix", "X=", "10"),
            number("YCoordinatePix", "Y=", "10"),
            REDRAW
        ]
    ),
    figure!(
        "DFDrawLineBlock",
        "Draw line",
        "Линия",
        Shape::Line,
        4,
        "Draws a line from the first to the second point of {x1, y1, x2, y2}.",
        [
            number("X1CoordinatePix", "X1=", "10"),
            number("Y1CoordinatePix", "Y1=", "10"),
            number("X2CoordinatePix", "X2=", "20"),
            number("Y2CoordinatePix", "Y2=", "20"),
            REDRAW,
        ]
    ),
    figure!(
        "DFDrawRectBlock",
        "Draw rectangle",
        "Прямоугольник",
        Shape::Rectangle,
        4,
        "Draws a rectangle {x, y, width, height}.",
        [
            number("XCoordinatePix", "X1=", "10"),
            number("YCoordinatePix", "Y1=", "10"),
            number("Width", "X2=", "20"),
            number("Height", "Y2=", "20"),
            property("redraw", "Redraw", Flag, "true"),
            FILLED,
        ]
    ),
    figure!(
        "DFDrawRectNxtBlock",
        "Draw rectangle (NXT)",
        "Прямоугольник (NXT)",
        Shape::Rectangle,
        4,
        "Draws a rectangle {x, y, width, height} that is not filled.",
        [
            number("XCoordinatePix", "X1=", "10"),
            number("YCoordinatePix", "Y1=", "10"),
            number("Width", "X2=", "20"),
            number("Height", "Y2=", "20"),
            REDRAW,
        ]
    ),
    figure!(
        "DFDrawCircleTrikBlock",
        "Draw circle",
        "Эллипс",
        Shape::Ellipse,
        4,
        "Draws an ellipse in the rectangle {x, y, width, height}.",
        [
            number("XCoordinatePix", "X1=", "10"),
            number("YCoordinatePix", "Y1=", "10"),
            number("Width", "X2=", "20"),
            number("Height", "Y2=", "20"),
            property("redraw", "Redraw", Flag, "true"),
            FILLED,
        ]
    ),
    figure!(
        "DFDrawArcTrikBlock",
        "Draw arc",
        "Дуга",
        Shape::Arc,
        6,
        "Draws a part of an ellipse in the rectangle {x, y, width, height}, from the start angle over the span: {x, y, width, height, start, span} in degrees.",
        [
            number("XCoordinatePix", "X1=", "10"),
            number("YCoordinatePix", "Y1=", "10"),
            number("Width", "X2=", "20"),
            number("Height", "Y2=", "20"),
            number("StartAngle", "Start angle=", "20"),
            number("SpanAngle", "Span angle=", "20"),
            property("redraw", "Redraw", Flag, "true"),
        ]
    ),
];
