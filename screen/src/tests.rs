//! Drawings, painted and looked at pixel by pixel.

use crate::colour::{BLACK, Colour, WHITE, colour};
use crate::drawing::{Drawing, Outline};
use crate::limits;
use crate::order::Effect;
use crate::picture::{self, RawFormat};
use crate::pixels::Pixels;

const RED: Colour = colour(255, 0, 0);

fn drawn(orders: &[&str]) -> Drawing {
    let mut drawing = Drawing::default();
    for order in orders {
        drawing.order(order).unwrap();
    }
    drawing
}

/// Pixels of a colour, and the rectangle that they fill: left, top, right, bottom.
fn extent(pixels: &Pixels, colour: Colour) -> (usize, [i32; 4]) {
    let mut count = 0;
    let mut place = [i32::MAX, i32::MAX, i32::MIN, i32::MIN];
    for y in 0..i32::from(pixels.height()) {
        for x in 0..i32::from(pixels.width()) {
            if pixels.at(x, y) == Some(colour) {
                count += 1;
                place = [
                    place[0].min(x),
                    place[1].min(y),
                    place[2].max(x),
                    place[3].max(y),
                ];
            }
        }
    }
    (count, place)
}

#[test]
fn colours_have_names_and_numbers() {
    assert_eq!(Colour::named("darkRed").unwrap(), colour(0x8b, 0, 0));
    assert_eq!(Colour::named("#f80").unwrap(), colour(0xff, 0x88, 0));
    assert_eq!(Colour::named("#0102fE").unwrap(), colour(1, 2, 0xfe));
    for bad in ["", "#", "#12", "#12345g", "redd", "#+12345", "\u{436}"] {
        let told = Colour::named(bad).unwrap_err();
        assert!(
            told.to_string().contains("darkyellow") && told.to_string().contains("#rrggbb"),
            "{told}"
        );
    }
    assert_eq!(WHITE.rgb565(), 0xffff);
    assert_eq!(colour(0xff, 0, 0).rgb565(), 0xf800);
    assert_eq!(colour(0, 0xff, 0).rgb565(), 0x07e0);
    assert_eq!(Colour::from_number(0x0012_3456).number(), 0x0012_3456);
}

#[test]
fn each_shape_is_where_it_was_drawn() {
    for (order, count, place) in [
        ("line 10 20 19 20", 10, [10, 20, 19, 20]),
        ("point 5 6", 1, [5, 6, 5, 6]),
        ("rect 10 20 30 40 1", 1200, [10, 20, 39, 59]),
        ("rect 10 20 30 40 0", 2 * 30 + 2 * 38, [10, 20, 39, 59]),
        ("rect 40 60 -30 -40 1", 1200, [10, 20, 39, 59]),
    ] {
        let pixels = drawn(&["color red", order]).paint();
        assert_eq!(extent(&pixels, RED), (count, place), "{order}");
    }
    let (count, place) = extent(
        &drawn(&["color red", "ellipse 100 100 40 20 1"]).paint(),
        RED,
    );
    assert_eq!(place, [100, 100, 139, 119]);
    // The area of the ellipse is 628.
    assert!((600..660).contains(&count), "{count}");
}

#[test]
fn wide_lines_are_as_wide_as_the_pen_in_every_direction() {
    for width in 2..8 {
        let seen = |order: &str| {
            let width = format!("width {width}");
            extent(&drawn(&["color red", &width, order]).paint(), RED)
        };
        let (count, place) = seen("line 100 50 200 50");
        assert_eq!(
            (count, place[3] - place[1]),
            (101 * width, width as i32 - 1),
            "{width}"
        );
        let (count, place) = seen("line 100 50 100 150");
        assert_eq!(
            (count, place[2] - place[0]),
            (101 * width, width as i32 - 1),
            "{width}"
        );
        // The root of 100 x 100 + 70 x 70, and half a pixel at each end.
        let area = 123.1 * width as f64;
        let (count, _) = seen("line 50 50 150 120");
        assert!(
            (count as f64 - area).abs() < area / 20.0 + 10.0,
            "{width}: {count} of {area}"
        );
        let (count, _) = seen("ellipse 50 50 100 100 0");
        let area = 314.0 * width as f64;
        assert!(
            (count as f64 - area).abs() < area / 8.0,
            "{width}: {count} of {area}"
        );
    }
}

#[test]
fn an_arc_begins_at_the_right_and_goes_up() {
    let (_, place) = extent(
        &drawn(&["color red", "arc 100 100 60 40 0 90"]).paint(),
        RED,
    );
    assert_eq!(place, [130, 100, 160, 120]);
    let (_, place) = extent(
        &drawn(&["color red", "arc 100 100 60 40 0 -90"]).paint(),
        RED,
    );
    assert_eq!(place, [130, 120, 160, 140]);
}

#[test]
fn the_pen_holds_for_what_comes_after_it() {
    let drawing = drawn(&[
        "width 4",
        "line 0 100 100 100",
        "color red",
        "line 0 50 100 50",
    ]);
    assert_eq!(drawing.shapes()[0].colour, BLACK);
    assert_eq!(drawing.shapes()[1].colour, RED);
    let (count, [_, top, _, bottom]) = extent(&drawing.paint(), RED);
    assert_eq!(bottom - top, 3);
    assert_eq!(count, 4 * 101);
}

#[test]
fn a_label_replaces_the_one_at_its_place_and_lies_on_top() {
    let drawing = drawn(&[
        "color red",
        "label 10 10 20 wrong",
        "label 10 10 20 I",
        "color blue",
        "rect 0 0 50 50 1",
    ]);
    assert_eq!(drawing.labels().count(), 1);
    let (count, place) = extent(&drawing.paint(), RED);
    assert!(count > 10, "{count}");
    // One letter of 10 x 20.
    assert!(
        place[0] >= 10 && place[2] < 20 && place[1] >= 10 && place[3] < 30,
        "{place:?}"
    );
}

#[test]
fn letters_grow_with_their_height_and_are_cyrillic_as_well() {
    let high = |height: u16, text: &str| {
        let order = format!("label 20 20 {height} {text}");
        let (_, [left, top, right, bottom]) = extent(&drawn(&["color red", &order]).paint(), RED);
        (right - left + 1, bottom - top + 1)
    };
    let sizes = [8, 13, 20, 40, 80].map(|height| high(height, "M").1);
    assert!(
        sizes.is_sorted_by(|small, large| small < large),
        "{sizes:?}"
    );
    // CYRILLIC CAPITAL LETTER ZHE is no question mark, which stands for what is not there.
    let seen = |text: &str| drawn(&[&format!("label 20 20 20 {text}")]).paint();
    assert_ne!(seen("\u{416}"), seen("?"));
    assert_ne!(seen("\u{416}"), seen("\u{417}"));
    assert_eq!(seen("\u{4e2d}"), seen("?"));
    let one = high(20, "M");
    assert_eq!(high(20, "M\\nM").1, one.1 + 20);
    assert_eq!(high(40, "M"), (2 * one.0, 2 * one.1));
}

#[test]
fn what_is_shown_and_when() {
    let mut drawing = Drawing::default();
    for (order, effect) in [
        ("line 0 0 1 1", Effect::Later),
        ("label 0 0 -1 a", Effect::Later),
        ("redraw", Effect::Show),
        ("background red", Effect::Show),
        ("removelabels", Effect::Show),
        ("smile", Effect::Show),
        ("hide", Effect::Hide),
        ("clear", Effect::Hide),
    ] {
        assert_eq!(drawing.order(order), Ok(effect), "{order}");
    }
    assert_eq!(drawing, Drawing::default());
}

#[test]
fn nonsense_changes_nothing_and_says_what_is_wrong() {
    let mut drawing = drawn(&["line 0 0 1 1"]);
    let before = drawing.clone();
    for (order, reason) in [
        ("", "'' is no order"),
        ("fly 1", "'fly' is no order"),
        ("line 1 2 3", "line takes 4 numbers first, not ''"),
        ("line 1 2 3 4 5", "line takes 4 numbers and no more: '5'"),
        ("line 1 2 3 NaN", "not 'NaN'"),
        ("rect 1 2 3 x 1", "not 'x'"),
        ("color reddish", "'reddish' is no colour"),
        ("background", "'' is no colour"),
    ] {
        let told = drawing.order(order).unwrap_err();
        assert!(told.to_string().contains(reason), "{order}: {told}");
    }
    let long = format!("label 0 0 1 {}", "x".repeat(limits::ORDER_BYTES));
    assert!(drawing.order(&long).is_err());
    assert_eq!(drawing, before);
}

#[test]
fn huge_numbers_are_cut() {
    // Going through all these pixels would not end within a day.
    let mut drawing = drawn(&["width 999999999"]);
    for order in [
        "line -2e9 -2e9 2e9 2e9",
        "ellipse -1e300 -2147483648 1e300 2147483647 1",
        "rect -2147483648 -2147483648 -1 -1 1",
        "arc -9e9 -9e9 18e9 18e9 -2147483648 2147483647",
        "label 2147483647 -2147483648 2147483647 x",
        "point 9e9 9e9",
    ] {
        drawing.order(order).unwrap();
    }
    let pixels = drawing.paint();
    assert_eq!((pixels.width(), pixels.height()), (320, 240));
}

#[test]
fn a_program_that_never_clears_keeps_its_picture_and_little_memory() {
    let mut drawing = drawn(&["color red"]);
    for number in 0..10_000 {
        drawing
            .order(&format!("point {} {}", number % 320, number / 320))
            .unwrap();
    }
    assert!(drawing.shapes().len() <= limits::SHAPES_MAX);
    assert_eq!(extent(&drawing.paint(), RED).0, 10_000);
    // The same again is nothing new.
    let before = drawing.shapes().len();
    drawing.order("point 79 31").unwrap();
    drawing.order("point 79 31").unwrap();
    assert!(drawing.shapes().len() <= before + 1);
    for number in 0..limits::LABELS_MAX {
        drawing.order(&format!("label {number} 0 8 x")).unwrap();
    }
    assert!(
        drawing
            .order("label 0 7 8 x")
            .unwrap_err()
            .to_string()
            .contains("removeLabels")
    );
    drawing.order("label 0 0 8 y").unwrap();
}

#[test]
fn faces_differ_in_their_mouths() {
    let happy = drawn(&["smile"]).paint();
    let sad = drawn(&["sadsmile"]).paint();
    assert_ne!(happy, sad);
    let yellow = colour(255, 210, 40);
    assert!(extent(&happy, yellow).0 > 20_000 && extent(&sad, yellow).0 > 20_000);
    // The corners of the mouth are above its middle, or below.
    let mouth = |pixels: &Pixels, x: i32| {
        (130..230)
            .find(|&y| pixels.at(x, y) == Some(BLACK))
            .unwrap()
    };
    assert!(mouth(&happy, 115) < mouth(&happy, 160));
    assert!(mouth(&sad, 115) > mouth(&sad, 160));
}

#[test]
fn frames_go_to_the_display_and_back() {
    let mut pixels = Pixels::new(4, 2, Some(WHITE));
    pixels.set(1, 0, RED);
    pixels.set(-1, 0, RED);
    pixels.set(4, 0, RED);
    let bytes = pixels.to_rgb565();
    assert_eq!(bytes.len(), 16);
    assert_eq!(bytes[..4], [0xff, 0xff, 0x00, 0xf8]);
    assert_eq!(Pixels::from_rgb565(4, 2, &bytes), pixels);
    assert!(
        pixels
            .to_ppm()
            .starts_with(b"P6\n4 2\n255\n\xff\xff\xff\xff\x00\x00")
    );
    assert_eq!(Pixels::from_rgb(4, 2, &pixels.to_rgb()), pixels);
    assert_eq!(pixels.scaled(8, 4).at(3, 1), Some(RED));
    assert_eq!(pixels.fitted(320, 240).height(), 160);
    assert_eq!(Pixels::new(0, 0, None).fitted(320, 240).width(), 0);
}

#[test]
fn pictures_of_files_lie_at_the_bottom_and_in_the_middle() {
    let side = 16;
    let mut file = Vec::new();
    let mut encoder = png::Encoder::new(&mut file, side, side);
    encoder.set_color(png::ColorType::Rgba);
    let pixels: Vec<u8> = (0..side * side)
        .flat_map(|index| {
            if index < side * 8 {
                [255, 0, 0, 255]
            } else {
                [0, 0, 255, 0]
            }
        })
        .collect();
    let mut writer = encoder.write_header().unwrap();
    writer.write_image_data(&pixels).unwrap();
    writer.finish().unwrap();
    let picture = picture::decode(&file).unwrap();
    let mut drawing = Drawing::default();
    drawing.show(&picture);
    let pixels = drawing.paint();
    assert_eq!(extent(&pixels, RED), (240 * 120, [40, 0, 279, 119]));
    assert_eq!(pixels.at(160, 200), Some(WHITE));

    let mut file = Vec::new();
    let encoder = jpeg_encoder::Encoder::new(&mut file, 90);
    encoder
        .encode(&[200; 3 * 64], 8, 8, jpeg_encoder::ColorType::Rgb)
        .unwrap();
    let picture = picture::decode(&file).unwrap();
    let seen = picture.at(4, 4).unwrap();
    assert!(seen.red.abs_diff(200) < 4, "{seen:?}");
    // Torn and flipped files are errors or pictures, and nothing worse.
    for end in 0..file.len() {
        let _ = picture::decode(&file[..end]);
        let mut flipped = file.clone();
        flipped[end] ^= 0x55;
        let _ = picture::decode(&flipped);
    }
    assert!(
        picture::decode(b"GIF89a")
            .unwrap_err()
            .to_string()
            .contains("neither")
    );
}

#[test]
fn numbers_of_programs_become_pictures() {
    let format = |name| RawFormat::named(name).unwrap();
    let red = picture::raw(&[0x00ff_0000; 4], 2, 2, format("rgb32")).unwrap();
    assert_eq!(red.at(1, 1), Some(RED));
    let same = picture::raw(&[-1, 0, 0].repeat(4), 2, 2, format("rgb888")).unwrap();
    assert_eq!(same, red);
    let grey = picture::raw(&[7], 1, 1, format("grayscale8")).unwrap();
    assert_eq!(grey.at(0, 0), Some(colour(7, 7, 7)));
    for (count, width, height) in [(3, 2, 2), (0, -1, 1), (0, 1 << 20, 1 << 20), (0, 1, 1)] {
        let told = picture::raw(&vec![0; count], width, height, RawFormat::Rgb32).unwrap_err();
        assert!(!told.to_string().is_empty());
    }
    assert!(RawFormat::named("bgr").is_err());
}

#[test]
fn arbitrary_orders_never_panic() {
    let verbs = [
        "line",
        "point",
        "rect",
        "ellipse",
        "arc",
        "label",
        "color",
        "width",
        "background",
        "redraw",
        "smile",
        "x",
    ];
    let words = [
        "0",
        "-1",
        "1e10",
        "-3.7",
        "\u{44f}",
        "#123",
        "",
        "320",
        "NaN",
        "-2147483648",
        "\\n",
    ];
    let mut numbers = needs::Random::new(12345);
    let mut random = |below: usize| numbers.below(below);
    let mut drawing = Drawing::new(40, 30);
    for _ in 0..3000 {
        let mut order = verbs[random(verbs.len())].to_owned();
        for _ in 0..random(8) {
            order.push(' ');
            order.push_str(words[random(words.len())]);
        }
        let _ = drawing.order(&order);
    }
    assert_eq!(drawing.paint().to_rgb565().len(), 40 * 30 * 2);
    drawing.draw(Outline::Point([1, 1]), false);
}
