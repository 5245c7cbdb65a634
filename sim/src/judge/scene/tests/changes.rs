//! What rules change: readings, motors, what is said, shown and drawn, and things of the field.

use super::*;

#[test]
fn rules_give_sensors_readings_and_lock_them() {
    let mut arena = arena();
    // Nothing is read as long as it is not due, and a rule reads nothing itself.
    says(&mut arena, "robot1.A1", "value", "0");
    says(&mut arena, "robot1.A1", "locked", "false");
    for _ in 0..2 {
        arena.tick();
        arena.renew();
    }
    says(&mut arena, "robot1.A1", "value", "74");
    sets(&mut arena, "robot1.A1", "value", Value::Int(5), "5");
    let port = Port::named("A1").unwrap();
    assert_eq!(arena.robot(0).announced(), Some((port, 5)));
    for _ in 0..2 {
        arena.tick();
        arena.renew();
    }
    says(&mut arena, "robot1.A1", "value", "74");
    sets(
        &mut arena,
        "robot1.A1",
        "locked",
        Value::text("true"),
        "true",
    );
    sets(&mut arena, "robot1.A1", "value", Value::text("7"), "7");
    for _ in 0..2 {
        arena.tick();
        arena.renew();
    }
    says(&mut arena, "robot1.A1", "value", "7");
    assert_eq!(arena.robot(0).locked(port), Some(7));
    // A block that waits for it reads it all the same.
    assert_eq!(arena.robot(0).scalar(port), Some(74));
    says(&mut arena, "robot1.A1", "value", "74");
    // What is no number changes nothing, and several numbers cannot be set or shown.
    sets(&mut arena, "robot1.A1", "value", Value::text("far"), "74");
    sets(&mut arena, "robot1.gyroscope", "value", Value::Int(3), "");
    sets(
        &mut arena,
        "robot1.gyroscope",
        "locked",
        Value::Bool(true),
        "true",
    );
    let missing = get(&mut arena, "robot1.gyroscope", "value.0");
    assert_eq!(missing, Err(Missing::Type(1)));
}

#[test]
fn rules_drive_motors_and_what_is_too_much_moves_no_faster() {
    let mut arena = arena();
    sets(&mut arena, "robot1.M3", "power", Value::Double(33.6), "34");
    sets(&mut arena, "robot1.M3", "power", Value::text("250"), "250");
    sets(&mut arena, "robot1.M4", "power", Value::Int(100), "100");
    says(&mut arena, "robot1", "isRiding", "true");
    for _ in 0..12 {
        arena.tick();
    }
    let pose = arena.robots()[0].pose();
    assert!((pose.x - 11.0 * 0.767945).abs() < 1e-4, "{pose:?}");
    assert_eq!(pose.degrees, 0.0);
}

#[test]
fn rules_speak_shine_and_draw() {
    let mut arena = arena();
    sets(
        &mut arena,
        "robot1.shell",
        "lastPhrase",
        Value::text("so"),
        "so",
    );
    sets(
        &mut arena,
        "robot1.led",
        "color",
        Value::text("red"),
        "#ff0000",
    );
    for none in ["off", "nonsense", ""] {
        sets(
            &mut arena,
            "robot1.led",
            "color",
            Value::text(none),
            "#ff0000",
        );
    }
    let faint = Value::text("#80112233");
    sets(&mut arena, "robot1.led", "color", faint, "#80112233");
    sets(
        &mut arena,
        "robot1.display",
        "background",
        Value::text("#0f0"),
        "#00ff00",
    );
    // What is there and only read stays as it is.
    sets(
        &mut arena,
        "robot1.display",
        "smiles",
        Value::Bool(true),
        "false",
    );
    sets(&mut arena, "robot1.marker", "isDown", Value::Int(1), "true");
    assert_eq!(arena.robots()[0].marker().colour, "black");
    sets(
        &mut arena,
        "robot1.marker",
        "isDown",
        Value::text("0"),
        "false",
    );
    let speaker = object(&mut arena, "robot1.speaker");
    assert!(!arena.set_property(speaker, "volume", &Value::Int(1)));
}

#[test]
fn rules_write_on_what_is_on_the_display() {
    let mut arena = arena();
    let (x, y, size) = (5, 6, 20);
    arena.robot(0).command(Command::Label {
        x,
        y,
        size,
        text: "abc",
    });
    let display = object(&mut arena, "robot1.display");
    let label: [Box<str>; 2] = ["labels".into(), "first".into()];
    for (property, value, wanted) in [
        ("text", Value::text("xyz"), "xyz"),
        ("x", Value::Int(50), "50"),
        ("fontSize", Value::text("9"), "9"),
        ("color", Value::text("red"), "#ff0000"),
    ] {
        assert!(arena.set_within(display, &label, property, &value));
        let chain = format!("labels.0.{property}");
        says(&mut arena, "robot1.display", &chain, wanted);
    }
    assert!(!arena.set_within(display, &label, "width", &Value::Int(1)));
    let none: [Box<str>; 2] = ["labels".into(), "1".into()];
    assert!(!arena.set_within(display, &none, "text", &Value::Int(1)));
}

#[test]
fn rules_move_and_paint_things_of_the_field() {
    let mut arena = arena();
    sets(&mut arena, "ball", "x", Value::Double(10.5), "10.5");
    assert_eq!(arena.field().solids[0].at.x, 10.5);
    let ball = object(&mut arena, "ball");
    assert!(!arena.set_property(ball, "mass", &Value::Int(9)));
    // A wall is only drawn elsewhere.
    sets(&mut arena, "wall", "x", Value::Int(100), "100");
    assert_eq!(arena.field().walls[0].begin.x, 400.0);
    let wall = object(&mut arena, "wall");
    assert!(!arena.set_property(wall, "thickness", &Value::Int(9)));
    sets(&mut arena, "pool", "x", Value::Int(150), "150");
    let shape = &arena.field().drawn[0].shape;
    assert_eq!(
        *shape,
        Shape::Ellipse(point(50.0, -100.0), point(150.0, 0.0))
    );
    sets(&mut arena, "pool", "thickness", Value::Int(20), "20");
    sets(&mut arena, "pool", "color", Value::text("blue"), "#0000ff");
    sets(&mut arena, "pool", "filled", Value::Bool(true), "true");
    sets(&mut arena, "pool", "visible", Value::Bool(false), "false");
    sets(&mut arena, "zone", "color", Value::text("blue"), "#0000ff");
    let robot = object(&mut arena, "robot1");
    assert!(arena.set_property(robot, "x", &Value::Int(9)));
    says(&mut arena, "robot1", "x", "0");
}
