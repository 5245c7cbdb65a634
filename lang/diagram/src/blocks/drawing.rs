//! Rows of the blocks that draw: on the screen, and with the marker on the floor.
//!
//! Owns rows only.

use super::Content::{Choice, Evaluated};
use super::Type;
use super::act::Operand::{self, Flag, FontSize, Whole, Written};
use super::act::{Act, script};
use super::example::{Example, example};
use super::parts::{COLORS, EVALUATE, REDRAW, block, expression, flag, property};
use super::{Category, Does, Property, Row, Silent};
use crate::brick::{Command, Figure};

const fn row(
    kind: &'static str,
    shown: [&'static str; 2],
    act: &'static Act,
    properties: &'static [Property],
    text: [&'static str; 2],
) -> Row {
    block(
        Category::Drawing,
        kind,
        shown,
        Does::Act(act),
        properties,
        text,
    )
}

const fn whole(name: &'static str, shown: [&'static str; 2], default: &'static str) -> Property {
    expression(name, shown, Type::Whole, default)
}

const FILLED: Property = flag("Filled", ["Filled", "Закрашивать"], "false");
const PRINTED: Property = property(
    "PrintText",
    ["Text", "Текст"],
    Evaluated,
    "Enter some text here",
);

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
        .dotnet("label_($1, $2, $3, $4)")],
    )
};
const LETTER: &str = "<path class=\"i\" d=\"M-11 -11h22M0 -11v24\"/>";
const PRINT_EXAMPLES: &[Example] = &[
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
];

pub(super) const ROWS: &[Row] = &[
    Row {
        icon: LETTER,
        examples: PRINT_EXAMPLES,
        ..row(
            "TrikPrintText",
            ["Print Text", "Напечатать текст"],
            &PRINT,
            &[
                whole("XCoordinateText", ["X", "X"], "1"),
                whole("YCoordinateText", ["Y", "Y"], "1"),
                PRINTED,
                EVALUATE,
                REDRAW,
                whole("FontSize", ["Font size", "Размер шрифта"], "20"),
            ],
            [
                "Prints a text on the screen, or the value of an expression if `Evaluate` is set. Numbers are shown with at most six digits after the point. A text at the same place replaces the previous one.",
                "Печатает на экране текст или значение выражения, если стоит `Вычислять`. У чисел не больше шести цифр после точки. Текст на том же месте заменяет прежний.",
            ],
        )
    },
    Row {
        silent: Silent::Always,
        icon: LETTER,
        examples: PRINT_EXAMPLES,
        ..row(
            "PrintText",
            ["Print Text", "Напечатать текст"],
            &PRINT,
            &[
                whole("XCoordinateText", ["X", "X"], "1"),
                whole("YCoordinateText", ["Y", "Y"], "1"),
                PRINTED,
                EVALUATE,
                REDRAW,
            ],
            [
                "The old Print Text, which does nothing on TRIK. Old saves are converted to TrikPrintText when they are read.",
                "Старый блок печати, который на ТРИК не делает ничего. При чтении старых файлов он заменяется на TrikPrintText.",
            ],
        )
    },
    Row {
        icon: SCREEN,
        examples: &[example(&[], &["clear", "redraw"])],
        ..row(
            "ClearScreen",
            ["Clear Screen", "Очистить экран"],
            &Act::command(
                |_| Command::ClearScreen,
                &[script(&[], "brick.display().clear()")],
            )
            .dispensable(),
            &[REDRAW],
            [
                "Removes everything from the screen except the background.",
                "Убирает с экрана всё, кроме фона.",
            ],
        )
    },
    Row {
        icon: PEN,
        examples: &[example(&[("Color", "darkYellow")], &["pen darkYellow"])],
        ..row(
            "TrikSetPainterColor",
            ["Painter Color", "Цвет кисти"],
            &Act::command(
                |with| Command::PenColor {
                    color: with.written,
                },
                &[script(&[Written], "brick.display().setPainterColor($1)")],
            )
            .dispensable(),
            &[property(
                "Color",
                ["Color", "Цвет"],
                Choice(COLORS),
                "black",
            )],
            [
                "Sets the colour of what is drawn from now on.",
                "Задаёт цвет всего, что рисуется дальше.",
            ],
        )
    },
    Row {
        icon: PEN,
        examples: &[example(&[("Width", "1 + 2")], &["pen 3"])],
        ..row(
            "TrikSetPainterWidth",
            ["Painter Width", "Толщина кисти"],
            &Act::command(
                |with| Command::PenWidth {
                    width: with.wholes[0],
                },
                &[script(&[Whole(0)], "brick.display().setPainterWidth($1)")],
            )
            .dispensable(),
            &[whole("Width", ["Width", "Ширина"], "1")],
            [
                "Sets the width of what is drawn from now on, in pixels.",
                "Задаёт толщину всего, что рисуется дальше, в пикселях.",
            ],
        )
    },
    Row {
        icon: "<circle class=\"f\" r=\"3\"/>",
        examples: &[example(&[("Redraw", "false")], &["pixel 5 5"])],
        ..row(
            "TrikDrawPixel",
            ["Draw Pixel", "Нарисовать точку"],
            &Act::command(
                |with| Command::Draw(Figure::Pixel(with.first())),
                &[script(
                    &[Whole(0), Whole(1)],
                    "brick.display().drawPoint($1, $2)",
                )],
            )
            .dispensable(),
            &[
                whole("XCoordinatePix", ["X", "X"], "5"),
                whole("YCoordinatePix", ["Y", "Y"], "5"),
                REDRAW,
            ],
            ["Draws a point.", "Рисует точку."],
        )
    },
    Row {
        icon: "<path class=\"i\" d=\"M-12 10L12 -10\"/>",
        examples: &[example(&[], &["line 0 0 10 10", "redraw"])],
        ..row(
            "TrikDrawLine",
            ["Draw Line", "Нарисовать линию"],
            &Act::command(
                |with| Command::Draw(Figure::Line(with.first())),
                &[script(
                    &[Whole(0), Whole(1), Whole(2), Whole(3)],
                    "brick.display().drawLine($1, $2, $3, $4)",
                )],
            )
            .dispensable(),
            &[
                whole("X1CoordinateLine", ["X1", "X1"], "0"),
                whole("Y1CoordinateLine", ["Y1", "Y1"], "0"),
                whole("X2CoordinateLine", ["X2", "X2"], "10"),
                whole("Y2CoordinateLine", ["Y2", "Y2"], "10"),
                REDRAW,
            ],
            [
                "Draws a line from one point to another.",
                "Рисует линию от одной точки до другой.",
            ],
        )
    },
    Row {
        icon: "<rect class=\"i\" x=\"-12\" y=\"-8\" width=\"24\" height=\"16\"/>",
        examples: &[example(
            &[("Filled", "true"), ("Redraw", "false")],
            &["rectangle 0 0 5 5 filled"],
        )],
        ..row(
            "TrikDrawRect",
            ["Draw Rectangle", "Нарисовать прямоугольник"],
            &Act::command(
                |with| Command::Draw(Figure::Rectangle(with.first(), with.flag(0))),
                &[script(
                    &[Whole(0), Whole(1), Whole(2), Whole(3), Flag(0)],
                    "brick.display().drawRect($1, $2, $3, $4, $5)",
                )],
            )
            .dispensable(),
            &[
                whole("XCoordinateRect", ["X", "X"], "0"),
                whole("YCoordinateRect", ["Y", "Y"], "0"),
                whole("WidthRect", ["Width", "Ширина"], "5"),
                whole("HeightRect", ["Height", "Высота"], "5"),
                FILLED,
                REDRAW,
            ],
            [
                "Draws a rectangle from its upper left corner.",
                "Рисует прямоугольник от левого верхнего угла.",
            ],
        )
    },
    Row {
        icon: "<ellipse class=\"i\" rx=\"14\" ry=\"9\"/>",
        examples: &[example(
            &[("XCoordinateEllipse", "7")],
            &["ellipse 7 0 5 5", "redraw"],
        )],
        ..row(
            "TrikDrawEllipse",
            ["Draw Ellipse", "Нарисовать эллипс"],
            &Act::command(
                |with| Command::Draw(Figure::Ellipse(with.first(), with.flag(0))),
                &[script(
                    &[Whole(0), Whole(1), Whole(2), Whole(3), Flag(0)],
                    "brick.display().drawEllipse($1, $2, $3, $4, $5)",
                )],
            )
            .dispensable(),
            &[
                whole("XCoordinateEllipse", ["X", "X"], "0"),
                whole("YCoordinateEllipse", ["Y", "Y"], "0"),
                whole("WidthEllipse", ["Width", "Ширина"], "5"),
                whole("HeightEllipse", ["Height", "Высота"], "5"),
                FILLED,
                REDRAW,
            ],
            [
                "Draws an ellipse in a rectangle.",
                "Рисует эллипс, вписанный в прямоугольник.",
            ],
        )
    },
    Row {
        icon: "<path class=\"i\" d=\"M-13 6a14 14 0 0 1 26 0\"/>",
        examples: &[example(&[("Redraw", "false")], &["arc 0 0 5 5 20 20"])],
        ..row(
            "TrikDrawArc",
            ["Draw Arc", "Нарисовать дугу"],
            &Act::command(
                |with| Command::Draw(Figure::Arc(with.first())),
                &[script(
                    &[Whole(0), Whole(1), Whole(2), Whole(3), Whole(4), Whole(5)],
                    "brick.display().drawArc($1, $2, $3, $4, $5, $6)",
                )],
            )
            .dispensable(),
            &[
                whole("XCoordinateArc", ["X", "X"], "0"),
                whole("YCoordinateArc", ["Y", "Y"], "0"),
                whole("WidthArc", ["Width", "Ширина"], "5"),
                whole("HeightArc", ["Height", "Высота"], "5"),
                whole("StartAngle", ["StartAngle", "Начальный угол"], "20"),
                whole("SpanAngle", ["SpanAngle", "Угол дуги"], "20"),
                REDRAW,
            ],
            [
                "Draws a part of an ellipse; angles are in degrees.",
                "Рисует часть эллипса; углы в градусах.",
            ],
        )
    },
    Row {
        icon: "<circle class=\"i\" r=\"13\"/><path class=\"i\" d=\"M-6 3q6 7 12 0M-5 -4v1M5 -4v1\"/>",
        examples: &[example(&[], &["smile"])],
        ..row(
            "TrikSmile",
            ["Smile", "Смайлик"],
            &Act::command(
                |_| Command::Smile { sad: false },
                &[script(&[], "brick.smile()")
                    .python("brick.display().showImage(\"media/trik_smile_normal.png\")")],
            )
            .russian("Улыбка")
            .dispensable(),
            &[],
            ["Shows a happy face.", "Показывает весёлое лицо."],
        )
    },
    Row {
        icon: "<circle class=\"i\" r=\"13\"/><path class=\"i\" d=\"M-6 7q6 -7 12 0M-5 -4v1M5 -4v1\"/>",
        examples: &[example(&[], &["smile sad"])],
        ..row(
            "TrikSadSmile",
            ["Sad Smile", "Грустный смайлик"],
            &Act::command(
                |_| Command::Smile { sad: true },
                &[script(&[], "brick.sadSmile()")
                    .python("brick.display().showImage(\"media/trik_smile_sad.png\")")],
            )
            .russian("Грустная улыбка")
            .dispensable(),
            &[],
            ["Shows a sad face.", "Показывает грустное лицо."],
        )
    },
    Row {
        icon: SCREEN,
        examples: &[example(&[("Redraw", "false")], &["background white"])],
        ..row(
            "TrikSetBackground",
            ["Background Color", "Цвет фона"],
            &Act::command(
                |with| Command::Background {
                    color: with.written,
                },
                &[script(&[Written], "brick.display().setBackground($1)")],
            )
            .russian("Фон")
            .dispensable(),
            &[
                property("Color", ["Color", "Цвет"], Choice(COLORS), "white"),
                REDRAW,
            ],
            [
                "Sets the colour behind everything on the screen.",
                "Задаёт цвет позади всего на экране.",
            ],
        )
    },
    Row {
        icon: PEN,
        examples: &[example(&[], &["marker blue"])],
        ..row(
            "MarkerDown",
            ["Marker Down", "Опустить маркер"],
            &Act::command(
                |with| Command::MarkerDown {
                    color: with.written,
                },
                &[script(&[Written], "brick.marker().down($1)")],
            )
            .dispensable(),
            &[property("Color", ["Color", "Цвет"], Choice(COLORS), "blue")],
            [
                "Lets the marker down in the simulator: the robot leaves a trace, which its light and colour sensors see.",
                "Опускает маркер в имитаторе: робот оставляет след, который видят его датчики света и цвета.",
            ],
        )
    },
    Row {
        icon: PEN,
        examples: &[example(&[], &["marker up"])],
        ..row(
            "MarkerUp",
            ["Marker Up", "Поднять маркер"],
            &Act::command(|_| Command::MarkerUp, &[script(&[], "brick.marker().up()")])
                .dispensable(),
            &[],
            ["Lifts the marker.", "Поднимает маркер."],
        )
    },
];
