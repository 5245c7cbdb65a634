//! Rows of the blocks that draw: on the screen, and with the marker on the floor.
//!
//! Owns rows only.

use super::Content::{Choice, Evaluated};
use super::Type;
use super::act::Operand::{self, Flag, FontSize, Whole, Written};
use super::act::{Act, example, script};
use super::{COLORS, Category, Does, EVALUATE, Kits, Property, REDRAW, Row, Silent};
use super::{expression, flag, property};
use crate::brick::{Command, Figure};

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
        category: Category::Drawing,
        kits: Kits::Both,
        silent: Silent::Never,
        properties,
        text,
        does: Does::Act(act),
    }
}

const fn whole(name: &'static str, shown: &'static str, default: &'static str) -> Property {
    expression(name, shown, Type::Whole, default)
}

const FILLED: Property = flag("Filled", "Filled", "false");
const PRINTED: Property = property("PrintText", "Text", Evaluated, "Enter some text here");

// Signs of several blocks.
const SCREEN: &str = "<rect class=\"i\" x=\"-13\" y=\"-10\" width=\"26\" height=\"20\"/>";
const PEN: &str = "<path class=\"i\" d=\"M-12 12l3 -9L7 -13l6 6L-3 9z\"/>";

/// The present block and the former one.
const PRINT: Act = Act {
    is_label: true,
    ..Act::command(
        |with| with.label(),
        &[script(
            &[Operand::Text, Whole(0), Whole(1), FontSize],
            "brick.display().addLabel($1, $2, $3, $4)",
        )
        .tree("label($1, $2, $3, $4)")
        .dotnet("label($1, $2, $3, $4)")],
    )
    .icon("<path class=\"i\" d=\"M-11 -11h22M0 -11v24\"/>")
    .examples(&[
        example(
            &[("PrintText", "1 + 1")],
            &["label 1 1 20 \"1 + 1\"", "redraw"],
        ),
        example(
            &[
                ("PrintText", "2 / 3"),
                ("Evaluate", "true"),
                ("FontSize", "-1"),
                ("Redraw", "false"),
            ],
            &["label 1 1 20 \"0.666667\""],
        ),
    ])
};

pub(super) const ROWS: &[Row] = &[
    row(
        "TrikPrintText",
        "Print Text",
        &PRINT,
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
            &PRINT,
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
        &Act::command(|_| Command::ClearScreen, &[script(&[], "brick.display().clear()")]).icon(SCREEN).dispensable().examples(&[example(&[], &["clear", "redraw"])]),
        &[REDRAW],
        "Removes everything from the screen except the background.",
    ),
    row(
        "TrikSetPainterColor",
        "Painter Color",
        &Act::command(|with| Command::PenColor { color: with.written }, &[script(&[Written], "brick.display().setPainterColor($1)")]).icon(PEN).dispensable().examples(&[example(&[("Color", "darkYellow")], &["pen darkYellow"])]),
        &[property("Color", "Color", Choice(COLORS), "black")],
        "Sets the colour of what is drawn from now on.",
    ),
    row(
        "TrikSetPainterWidth",
        "Painter Width",
        &Act::command(|with| Command::PenWidth { width: with.wholes[0] }, &[script(&[Whole(0)], "brick.display().setPainterWidth($1)")]).icon(PEN).dispensable().examples(&[example(&[("Width", "1 + 2")], &["pen 3"])]),
        &[whole("Width", "Width", "1")],
        "Sets the width of what is drawn from now on, in pixels.",
    ),
    row(
        "TrikDrawPixel",
        "Draw Pixel",
        &Act::command(|with| Command::Draw(Figure::Pixel(with.first())), &[script(&[Whole(0), Whole(1)], "brick.display().drawPoint($1, $2)")]).icon("<circle class=\"f\" r=\"3\"/>").dispensable().examples(&[example(&[("Redraw", "false")], &["pixel 5 5"])]),
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
        &Act::command(|with| Command::Draw(Figure::Line(with.first())), &[script(&[Whole(0), Whole(1), Whole(2), Whole(3)], "brick.display().drawLine($1, $2, $3, $4)")]).icon("<path class=\"i\" d=\"M-12 10L12 -10\"/>").dispensable().examples(&[example(&[], &["line 0 0 10 10", "redraw"])]),
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
        &Act::command(|with| Command::Draw(Figure::Rectangle(with.first(), with.flag(0))), &[script(&[Whole(0), Whole(1), Whole(2), Whole(3), Flag(0)], "brick.display().drawRect($1, $2, $3, $4, $5)")]).icon("<rect class=\"i\" x=\"-12\" y=\"-8\" width=\"24\" height=\"16\"/>").dispensable().examples(&[example(&[("Filled", "true"), ("Redraw", "false")], &["rectangle 0 0 5 5 filled"])]),
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
        &Act::command(|with| Command::Draw(Figure::Ellipse(with.first(), with.flag(0))), &[script(&[Whole(0), Whole(1), Whole(2), Whole(3), Flag(0)], "brick.display().drawEllipse($1, $2, $3, $4, $5)")]).icon("<ellipse class=\"i\" rx=\"14\" ry=\"9\"/>").dispensable().examples(&[example(&[("XCoordinateEllipse", "7")], &["ellipse 7 0 5 5", "redraw"])]),
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
        &Act::command(|with| Command::Draw(Figure::Arc(with.first())), &[script(&[Whole(0), Whole(1), Whole(2), Whole(3), Whole(4), Whole(5)], "brick.display().drawArc($1, $2, $3, $4, $5, $6)")]).icon("<path class=\"i\" d=\"M-13 6a14 14 0 0 1 26 0\"/>").dispensable().examples(&[example(&[("Redraw", "false")], &["arc 0 0 5 5 20 20"])]),
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
    row("TrikSmile", "Smile", &Act::command(|_| Command::Smile { sad: false }, &[script(&[], "brick.smile()")]).icon("<circle class=\"i\" r=\"13\"/><path class=\"i\" d=\"M-6 3q6 7 12 0M-5 -4v1M5 -4v1\"/>").russian("Улыбка").dispensable().examples(&[example(&[], &["smile"])]), &[], "Shows a happy face."),
    row(
        "TrikSadSmile",
        "Sad Smile",
        &Act::command(|_| Command::Smile { sad: true }, &[script(&[], "brick.sadSmile()")]).icon("<circle class=\"i\" r=\"13\"/><path class=\"i\" d=\"M-6 7q6 -7 12 0M-5 -4v1M5 -4v1\"/>").russian("Грустная улыбка").dispensable().examples(&[example(&[], &["smile sad"])]),
        &[],
        "Shows a sad face.",
    ),
    row(
        "TrikSetBackground",
        "Background Color",
        &Act::command(|with| Command::Background { color: with.written }, &[script(&[Written], "brick.display().setBackground($1)")]).icon(SCREEN).russian("Фон").dispensable().examples(&[example(&[("Redraw", "false")], &["background white"])]),
        &[property("Color", "Color", Choice(COLORS), "white"), REDRAW],
        "Sets the colour behind everything on the screen.",
    ),
    row(
        "MarkerDown",
        "Marker Down",
        &Act::command(|with| Command::MarkerDown { color: with.written }, &[script(&[Written], "brick.marker().down($1)")]).icon(PEN).dispensable().examples(&[example(&[], &["marker blue"])]),
        &[property("Color", "Color", Choice(COLORS), "blue")],
        "Lets the marker down in the simulator: the robot leaves a trace, which its light and colour sensors see.",
    ),
    row(
        "MarkerUp",
        "Marker Up",
        &Act::command(|_| Command::MarkerUp, &[script(&[], "brick.marker().up()")]).icon(PEN).dispensable().examples(&[example(&[], &["marker up"])]),
        &[],
        "Lifts the marker.",
    ),
];
