//! Values: how they compare and what can be worked out of them.

use super::{Rect, Stage, Value, holds, holds_on};
use crate::Point;
use crate::value::shown;

fn equal(left: &str, right: &str) -> bool {
    holds(&format!("<equals>{left}{right}</equals>"))
}

#[test]
fn constants_of_all_types_are_equal_to_themselves_only() {
    let all = [
        r#"<bool value="false"/>"#,
        r#"<int value="7"/>"#,
        r#"<double value="7.5"/>"#,
        r#"<string value="seven"/>"#,
        r#"<variableValue name="never"/>"#,
    ];
    for (at, left) in all.iter().enumerate() {
        for (other, right) in all.iter().enumerate() {
            assert_eq!(equal(left, right), at == other, "{left} {right}");
        }
    }
}

#[test]
fn numbers_compare_as_numbers_also_with_texts_that_are_numbers() {
    assert!(equal(r#"<int value="1"/>"#, r#"<double value="1"/>"#));
    assert!(equal(r#"<int value="1"/>"#, r#"<bool value="true"/>"#));
    assert!(equal(r#"<string value="5"/>"#, r#"<int value="5"/>"#));
    assert!(equal(r#"<int value="5"/>"#, r#"<string value="5"/>"#));
    assert!(equal(r#"<string value="5.0"/>"#, r#"<int value="5"/>"#));
    // Two texts are texts, whatever they look like; with what is no number a number is a text too.
    assert!(!equal(r#"<string value="5.0"/>"#, r#"<string value="5"/>"#));
    assert!(holds(
        r#"<less><string value="10"/><string value="9"/></less>"#
    ));
    assert!(holds(r#"<greater _1="x1" _2="5"/>"#));
    assert!(holds(r#"<less _1="0x10" _2="16"/>"#));
    // By their codes.
    assert!(holds(r#"<greater _1="abc" _2="ABC"/>"#));
    assert!(equal(r#"<double value="5"/>"#, r#"<string value="5.0"/>"#));
    // Beside true or false everything else is one of these, but for other than whole numbers.
    assert!(equal(r#"<bool value="false"/>"#, r#"<string value="0"/>"#));
    assert!(equal(r#"<bool value="true"/>"#, r#"<string value="yes"/>"#));
    assert!(equal(r#"<int value="5"/>"#, r#"<bool value="true"/>"#));
    assert!(holds(
        r#"<greater><bool value="true"/><double value="0.5"/></greater>"#
    ));
    assert!(!equal(
        r#"<int value="0"/>"#,
        r#"<variableValue name="never"/>"#
    ));
    assert!(equal(
        r#"<double value="0.3"/>"#,
        r#"<double value="0.30000000000000004"/>"#
    ));
    assert!(!equal(r#"<string value="a"/>"#, r#"<string value="A"/>"#));
}

#[test]
fn every_comparison_is_known_and_strict_where_it_says_so() {
    let signs = |left: &str, right: &str| {
        let tags = [
            "equals",
            "notEqual",
            "notEquals",
            "greater",
            "less",
            "notGreater",
            "notLess",
        ];
        let one = |tag: &&str| holds(&format!(r#"<{tag} _1="{left}" _2="{right}"/>"#));
        tags.iter().map(one).map(u8::from).collect::<Vec<_>>()
    };
    assert_eq!(signs("1", "2"), [0, 1, 1, 0, 1, 1, 0]);
    assert_eq!(signs("2", "2.0"), [1, 0, 0, 0, 0, 1, 1]);
    assert_eq!(signs("3", "2.5"), [0, 1, 1, 1, 0, 0, 1]);
    assert_eq!(signs("abc", "abd"), [0, 1, 1, 0, 1, 1, 0]);
    assert_eq!(signs("10", "9"), [0, 1, 1, 1, 0, 0, 1]);
}

#[test]
fn attributes_are_typed_by_their_looks() {
    assert!(matches!(Value::guess("true"), Value::Bool(true)));
    assert!(matches!(Value::guess("-3"), Value::Int(-3)));
    assert!(matches!(Value::guess("1e3"), Value::Double(number) if number == 1000.0));
    assert!(matches!(Value::guess("99999999999"), Value::Double(_)));
    assert!(matches!(Value::guess("inf"), Value::Text(_)));
    assert!(matches!(Value::guess("nan"), Value::Text(_)));
    assert!(matches!(Value::guess(""), Value::Text(_)));
    assert!(matches!(Value::guess("True"), Value::Text(_)));
    // Attributes go by name, not by place.
    assert!(holds(r#"<greater _2="1" _1="2"/>"#));
}

#[test]
fn arithmetic_is_that_of_whole_numbers() {
    let is = |value: &str, wanted: &str| {
        holds(&format!(
            r#"<equals>{value}<int value="{wanted}"/></equals>"#
        ))
    };
    assert!(is(r#"<sum _1="2.5" _2="2.5"/>"#, "6"));
    assert!(is(
        r#"<sum><int value="2"/><variableValue name="never"/></sum>"#,
        "2"
    ));
    assert!(is(r#"<difference _1="2" _2="5"/>"#, "-3"));
    assert!(is(r#"<mul _1="4" _2="-2"/>"#, "-8"));
    assert!(is(r#"<min _1="4" _2="-2"/>"#, "-2"));
    assert!(is(r#"<max _1="4" _2="-2"/>"#, "4"));
    assert!(is(r#"<minus _1="4"/>"#, "-4"));
    assert!(is(r#"<abs><int value="-4"/></abs>"#, "4"));
    assert!(is(r#"<abs _1="text"/>"#, "0"));
    assert!(is(r#"<sum _1="true" _2="7 "/>"#, "8"));
    // Too large numbers are cut and wrap, and nothing breaks.
    assert!(is(r#"<sum _1="1e300" _2="1"/>"#, "-2147483648"));
    assert!(is(r#"<abs _1="-2147483648"/>"#, "-2147483648"));
    assert!(is(r#"<minus _1="-2147483648"/>"#, "-2147483648"));
    assert_eq!(Value::Double(-2.5).to_int(), -2);
    assert_eq!(Value::Double(f64::NAN).to_int(), 0);
}

#[test]
fn variables_are_nothing_until_they_are_set() {
    assert!(holds(r#"<equals _1="${five}" _2="5"/>"#));
    assert!(holds(
        r#"<equals><variableValue name="five"/><int value="5"/></equals>"#
    ));
    assert!(holds(
        r#"<equals><variableValue name="total_score"/><int value="0"/></equals>"#
    ));
    let (holds, complaints) = holds_on(Stage::new(), r#"<less _1="${never}" _2="0"/>"#);
    assert!(holds, "nothing is less than anything");
    let words = "Error in checker: The name never is not a valid variable name or property chain for an object";
    assert_eq!(complaints, [words]);
}

fn furnished() -> Stage {
    let mut stage = Stage::new();
    let label = |x: i32, text: &str| {
        let fields = [
            ("x", Value::Int(x)),
            ("y", Value::Int(1)),
            ("text", Value::text(text)),
        ];
        Value::Record(fields.into())
    };
    let labels = Value::list([label(3, "left"), label(9, "right")]);
    stage.add("robot1.display", "Display");
    stage.set("robot1.display", "labels", labels);
    stage.set("robot1.display", "nothing", Value::list([]));
    stage.set("robot1", "at", Value::Point(Point { x: 3, y: 4 }));
    stage.set(
        "robot1",
        "around",
        Value::Rect(Rect {
            x: 1,
            y: 2,
            width: 3,
            height: 4,
        }),
    );
    stage
}

fn state(path: &str, wanted: &str) -> (bool, Vec<String>) {
    let condition =
        format!(r#"<equals><objectState object="{path}"/><string value="{wanted}"/></equals>"#);
    // As the type of the left one, so that a number can be meant.
    holds_on(furnished(), &condition)
}

#[test]
fn paths_go_through_objects_lists_records_points_and_rectangles() {
    for (path, wanted) in [
        ("robot1.display.labels.size", "2"),
        ("robot1.display.labels.isEmpty", "false"),
        ("robot1.display.labels.first.text", "left"),
        ("robot1.display.labels.last.text", "right"),
        ("robot1.display.labels.1.x", "9"),
        ("robot1..display.labels.size.", "2"),
        ("robot1.display.nothing.isEmpty", "true"),
        ("robot1.at.x", "3"),
        ("robot1.at.y", "4"),
        ("robot1.around.x", "1"),
        ("robot1.around.y", "2"),
        ("robot1.around.width", "3"),
        ("robot1.around.height", "4"),
    ] {
        assert_eq!(state(path, wanted), (true, vec![]), "{path}");
    }
}

#[test]
fn a_path_that_leads_nowhere_is_an_error_of_the_checker_that_says_where() {
    for (path, words) in [
        ("robot9.x", "No such object: robot9"),
        (
            "robot1.speed",
            "Object \"robot1\" has no property \"speed\"",
        ),
        (
            "robot1.display.labels.2",
            "Object \"robot1.display.labels\" has no property \"2\"",
        ),
        (
            "robot1.display.nothing.first",
            "Object \"robot1.display.nothing\" has no property \"first\"",
        ),
        (
            "robot1.display.labels.size.x",
            "Unknown type of object \"robot1.display.labels.size\"",
        ),
    ] {
        let told = format!("Error in checker: {words}");
        assert_eq!(state(path, "x"), (false, vec![told]), "{path}");
    }
}

#[test]
fn a_variable_may_hold_an_object_and_its_properties_are_those_of_the_object() {
    let mut run = super::Run::on(
        furnished(),
        r#"<init><setter name="screen"><objectState object="robot1.display"/></setter></init>
        <event id="a" settedUpInitially="true" dropsOnFire="false">
          <condition><equals _1="${screen.labels.size}" _2="2"/></condition><trigger><success/></trigger>
        </event>"#,
    );
    run.ticks(2);
    assert!(
        run.told()
            .contains(&"The task was accomplished in 0.02 sec!")
    );
}

#[test]
fn types_are_names_of_classes_and_undefined_for_what_is_not_there() {
    let mut stage = Stage::new();
    stage.add(
        "robot1.A1",
        "trik::robotModel::twoD::parts::TwoDLightSensor",
    );
    stage.add("robot1.A2", "");
    for (object, class) in [
        (
            "robot1.A1",
            "trik::robotModel::twoD::parts::TwoDLightSensor",
        ),
        ("robot1.A2", "undefined"),
        ("robot1.A3", "undefined"),
    ] {
        for (tag, wanted) in [("equals", true), ("notEqual", false)] {
            let types =
                format!(r#"<{tag}><typeOf objectId="{object}"/><string value="{class}"/></{tag}>"#);
            let turned =
                format!(r#"<{tag}><string value="{class}"/><typeOf objectId="{object}"/></{tag}>"#);
            for condition in [types, turned] {
                let mut copy = Stage::new();
                copy.objects = stage.objects.clone();
                assert_eq!(holds_on(copy, &condition), (wanted, vec![]), "{condition}");
            }
        }
    }
}

#[test]
fn classes_of_old_versions_have_their_new_names() {
    for (old, new) in [
        (
            "trik::robotModel::twoD::parts::TwoDInfraredSensor",
            "twoDModel::robotModel::parts::RangeSensor",
        ),
        (
            "trikKitInterpreter::robotModel::twoD::parts::TwoDLightSensor",
            "trik::robotModel::twoD::parts::TwoDLightSensor",
        ),
        (
            "commonTwoDModel::robotModel::parts::TouchSensor",
            "twoDModel::robotModel::parts::TouchSensor",
        ),
    ] {
        let mut stage = Stage::new();
        stage.add("robot1.A1", new);
        let condition =
            format!(r#"<equals><typeOf objectId="robot1.A1"/><string value="{old}"/></equals>"#);
        assert_eq!(holds_on(stage, &condition), (true, vec![]));
    }
}

#[test]
fn the_distance_of_points_is_a_number() {
    let mut stage = furnished();
    stage.set("robot1", "zero", Value::Point(Point::default()));
    let condition =
        r#"<equals><distance _1="${robot1.at}" _2="${robot1.zero}"/><double value="5"/></equals>"#;
    assert_eq!(holds_on(stage, condition), (true, vec![]));
}

#[test]
fn a_bounding_rectangle_is_around_objects_points_records_and_lists() {
    let mut stage = furnished();
    stage.add("trace", "ObjectsSet");
    stage.place("trace", -5, 6, 70, 80);
    for (object, property, wanted) in [
        ("trace", "x", "-5"),
        ("trace", "width", "70"),
        ("trace", "height", "80"),
        ("robot1.display.labels", "x", "3"),
        ("robot1.display.labels", "width", "7"),
        ("robot1.display.labels", "height", "1"),
        ("robot1.at", "y", "4"),
        ("robot1.display.nothing", "width", "0"),
    ] {
        let mut run = super::Run::on(
            Stage {
                objects: stage.objects.clone(),
                properties: stage.properties.clone(),
                places: stage.places.clone(),
                asked: 0,
            },
            &format!(
                r#"<init><setter name="r"><boundingRect><objectState object="{object}"/></boundingRect></setter></init>
                <event id="a" settedUpInitially="true" dropsOnFire="false">
                <condition><equals _1="${{r.{property}}}" _2="{wanted}"/></condition><trigger><success/></trigger></event>"#
            ),
        );
        run.ticks(2);
        let told = run.told();
        assert!(
            told.contains(&"The task was accomplished in 0.02 sec!"),
            "{object}.{property}: {told:?}"
        );
    }
}

#[test]
fn a_colour_on_the_left_is_compared_by_name_or_number_and_on_the_right_by_number() {
    let mut stage = Stage::new();
    stage.set("robot1", "colour", Value::colour(0x00_8000));
    for (left, right, wanted) in [
        ("${robot1.colour}", "green", true),
        ("${robot1.colour}", "#008000", true),
        ("${robot1.colour}", "#ff008000", true),
        ("${robot1.colour}", "#080", false),
        ("${robot1.colour}", "greenish", false),
        ("#008000", "${robot1.colour}", true),
        ("green", "${robot1.colour}", false),
    ] {
        let copy = Stage {
            objects: stage.objects.clone(),
            properties: stage.properties.clone(),
            ..Stage::default()
        };
        let condition = format!(r#"<equals _1="{left}" _2="{right}"/>"#);
        assert_eq!(holds_on(copy, &condition), (wanted, vec![]), "{condition}");
    }
    assert!(Value::colour(0x00_8888).equals(&Value::text("#088")));
}

#[test]
fn numbers_are_shown_as_qt_shows_them() {
    for (number, text) in [
        (0.0, "0"),
        (19.83, "19.83"),
        (-0.5, "-0.5"),
        (100_000.0, "100000"),
        (1e6, "1e+06"),
        (1_234_567.0, "1234567"),
        (0.0001, "0.0001"),
        (0.00001, "1e-05"),
        (1e308, "1e+308"),
        (f64::INFINITY, "inf"),
        (f64::NAN, "nan"),
    ] {
        assert_eq!(shown(number), text);
    }
}
