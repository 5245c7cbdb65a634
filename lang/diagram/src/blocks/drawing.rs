//! Rows of the blocks that draw: on the screen, and with the marker on the floor.
//!
//! Owns rows only.

use super::Content::{Choice, Evaluated};
use super::Type::Whole;
use super::{Act, COLORS, Category, Does, EVALUATE, Kits, Property, REDRAW, Row, Silent};
use super::{expression, flag, property};

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
        category: Category::Drawing,
        kits: Kits::Both,
        silent: Silent::Never,
        properties,
        text,
        does: Does::Act(act),
    }
}

const fn whole(name: &'static str, shown: &'static str, default: &'static str) -> Property {
    expression(name, shown, Whole, default)
}

const FILLED: Property = flag("Filled", "Filled", "false");
const PRINTED: Property = property("PrintText", "Text", Evaluated, "Enter some text here");

pub(super) const ROWS: &[Row] = &[
    row(
        "TrikPrintText",
        "Print Text",
        Act::Print,
        &[
            whole("XCoordinateText", "X", "1"),
            whole("YCoordinateText", "Y", "1"),
            PRINTED,
            EVALUATE,
            REDRAW,
            whole("FontSize", "Font size", "20"),
        ],
        "Prints a text on the screen, or the value of an expression if `Evaluate` is set. Numbers are shown with at most six digits after the point. A text at the same place replaces the previous one.",
    ),
    Row {
        silent: Silent::Always,
        ..row(
            "PrintText",
            "Print Text",
            Act::Print,
            &[
                whole("XCoordinateText", "X", "1"),
                whole("YCoordinateText", "Y", "1"),
                PRINTED,
                EVALUATE,
                REDRAW,
            ],
            "The old Print Text, which does nothing on TRIK. Old saves are converted to TrikPrintText when they are read.",
        )
    },
    row(
        "ClearScreen",
        "Clear Screen",
        Act::Clear,
        &[REDRAW],
        "Removes everything from the screen except the background.",
    ),
    row(
        "TrikSetPainterColor",
        "Painter Color",
        Act::PenColor,
        &[property("Color", "Color", Choice(COLORS), "black")],
        "Sets the colour of what is drawn from now on.",
    ),
    row(
        "TrikSetPainterWidth",
        "Painter Width",
        Act::PenWidth,
        &[whole("Width", "Width", "1")],
        "Sets the width of what is drawn from now on, in pixels.",
    ),
    row(
        "TrikDrawPixel",
        "Draw Pixel",
        Act::Pixel,
        &[
            whole("XCoordinatePix", "X", "5"),
            whole("YCoordinatePix", "Y", "5"),
            REDRAW,
        ],
        "Draws a point.",
    ),
    row(
        "TrikDrawLine",
        "Draw Line",
        Act::Line,
        &[
            whole("X1CoordinateLine", "X1", "0"),
            whole("Y1CoordinateLine", "Y1", "0"),
            whole("X2CoordinateLine", "X2", "10"),
            whole("Y2CoordinateLine", "Y2", "10"),
            REDRAW,
        ],
        "Draws a line from one point to another.",
    ),
    row(
        "TrikDrawRect",
        "Draw Rectangle",
        Act::Rectangle,
        &[
            whole("XCoordinateRect", "X", "0"),
            whole("YCoordinateRect", "Y", "0"),
            whole("WidthRect", "Width", "5"),
            whole("HeightRect", "Height", "5"),
            FILLED,
            REDRAW,
        ],
        "Draws a rectangle from its upper left corner.",
    ),
    row(
        "TrikDrawEllipse",
        "Draw Ellipse",
        Act::Ellipse,
        &[
            whole("XCoordinateEllipse", "X", "0"),
            whole("YCoordinateEllipse", "Y", "0"),
            whole("WidthEllipse", "Width", "5"),
            whole("HeightEllipse", "Height", "5"),
            FILLED,
            REDRAW,
        ],
        "Draws an ellipse in a rectangle.",
    ),
    row(
        "TrikDrawArc",
        "Draw Arc",
        Act::Arc,
        &[
            whole("XCoordinateArc", "X", "0"),
            whole("YCoordinateArc", "Y", "0"),
            whole("WidthArc", "Width", "5"),
            whole("HeightArc", "Height", "5"),
            whole("StartAngle", "StartAngle", "20"),
            whole("SpanAngle", "SpanAngle", "20"),
            REDRAW,
        ],
        "Draws a part of an ellipse; angles are in degrees.",
    ),
    row("TrikSmile", "Smile", Act::Smile, &[], "Shows a happy face."),
    row(
        "TrikSadSmile",
        "Sad Smile",
        Act::SadSmile,
        &[],
        "Shows a sad face.",
    ),
    row(
        "TrikSetBackground",
        "Background Color",
        Act::Background,
        &[property("Color", "Color", Choice(COLORS), "white"), REDRAW],
        "Sets the colour behind everything on the screen.",
    ),
    row(
        "MarkerDown",
        "Marker Down",
        Act::MarkerDown,
        &[property("Color", "Color", Choice(COLORS), "blue")],
        "Lets the marker down in the simulator: the robot leaves a trace, which its light and colour sensors see.",
    ),
    row(
        "MarkerUp",
        "Marker Up",
        Act::MarkerUp,
        &[],
        "Lifts the marker.",
    ),
];
