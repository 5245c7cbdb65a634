//! World models in small: units, old forms, what is kept, what is refused.

use super::*;
use crate::geometry::point;

fn read(text: &str) -> Opened {
    Field::read(text).unwrap_or_else(|problems| panic!("{problems:?}"))
}

fn refused(text: &str) -> String {
    let problems = Field::read(text).unwrap_err();
    problems[0].to_string()
}

#[test]
fn units_are_those_of_the_settings_and_centimetres_without_them() {
    let wall = |head: &str, settings: &str| {
        let text = format!(
            "<root{head}><world><walls><wall begin=\"10:0\" end=\"20:0\" stroke-width=\"2\"/></walls></world>{settings}</root>"
        );
        let wall = read(&text).field.walls.remove(0);
        (wall.end.x, wall.width)
    };
    let cm = 16.0 / 5.6;
    assert_eq!(wall("", ""), (20.0 * cm, 2.0 * cm));
    let old = read("<root><world/></root>");
    assert!(format!("{:?}", old.problems).contains("<settings/>"));
    assert_eq!(read("<root><world/><settings/></root>").problems, []);
    assert_eq!(wall("", "<settings/>"), (20.0, 2.0));
    assert_eq!(wall(" version=\"20251219\"", ""), (20.0 * cm, 2.0 * cm));
    assert_eq!(
        wall("", "<settings sizeUnit=\"cm\"/>"),
        (20.0 * cm, 2.0 * cm)
    );
    assert_eq!(wall("", "<settings sizeUnit=\"m\"/>").0, 20.0 * cm * 100.0);
    assert_eq!(
        wall("", "<settings sizeUnit=\"mm\"/>").0,
        20.0 * (cm * f64::from(0.1f32))
    );
    assert_eq!(wall("", "<settings sizeUnit=\"px\"/>").0, 20.0);
}

#[test]
fn robots_stand_where_old_and_new_worlds_put_them() {
    let old = read(
        "<root><world/><settings/><robots><robot id=\"trikV62KitRobot\" position=\"-200:10\" direction=\"90\">\
         <startPosition x=\"-175\" y=\"35\" direction=\"0\"/>\
         <wheels left=\"M4###output######\" right=\"M3###output######\"/></robot></robots></root>",
    );
    let robot = old.field.robot().unwrap();
    assert_eq!(
        (robot.position, robot.direction),
        (point(-200.0, 10.0), 90.0)
    );
    assert_eq!(robot.left.map(|port| port.name()), Some("M4"));
    let mut moved = robot.clone();
    moved.direction = 5.0;
    moved.to_start();
    assert_eq!(
        (moved.position, moved.direction),
        (point(-200.0, 10.0), 0.0)
    );
    let new = read(
        "<root version=\"20251219\"><world><robot position=\"3:4\" direction=\"-90\"/></world><settings/>\
         <robots><robot id=\"nxtKitRobot\"/><robot id=\"trikKitRobot\"><sensors>\
         <sensor port=\"A1###input######sensorA1\" type=\"trik::robotModel::parts::TrikTouchSensor\" position=\"60:25\" direction=\"45\"/>\
         <sensor port=\"A2###input###\" type=\"trik::robotModel::parts::TrikTouchSensor\" position=\"1:2\" direction=\"0\"/>\
         </sensors></robot></robots></root>",
    );
    let robot = new.field.robot().unwrap();
    assert_eq!((robot.position, robot.direction), (point(3.0, 4.0), -90.0));
    assert_eq!(robot.sensors[0].kind, SensorKind::Touch);
    assert_eq!(robot.sensors[0].port.map(|port| port.name()), Some("A1"));
    // A port with three parts is none.
    assert_eq!(robot.sensors[1].port, None);
}

#[test]
fn things_are_where_their_centre_or_their_corner_is() {
    let field = read(
        "<root><settings/><world><skittles><skittle id=\"a\" x=\"50\" y=\"-250\" markerX=\"10\"/><skittle id=\"b\" begin=\"250:300\"/></skittles>\
         <balls><ball id=\"a\" begin=\"250:300\"/></balls><cubes><cube begin=\"250:300\" rotation=\"90\" edgeSize=\"20\"/></cubes></world></root>",
    )
    .field;
    let [first, second, ball, cube] = &field.solids[..] else {
        panic!("{:?}", field.solids);
    };
    assert_eq!(
        (first.at, first.start),
        (point(50.0, -250.0), point(10.0, 0.0))
    );
    assert_eq!(second.at, point(260.0, 310.0));
    assert_eq!(ball.at, point(265.0, 315.0));
    // The corner of a cube turns with it.
    assert!((cube.at.x - 240.0).abs() < 1e-9 && (cube.at.y - 310.0).abs() < 1e-9);
    assert_eq!(ball.material.mass, 0.015);
}

#[test]
fn what_is_not_understood_and_not_changed_is_written_as_it_was() {
    let text = "<root version=\"1\" other=\"kept\"><!-- of a teacher --><world><walls><wall id=\"w\" begin=\"1.50:2\" end=\"3:4\" glass=\"yes\"/>\
        <fence/></walls><regions><region id=\"r\" type=\"rectangle\" x=\"1\" y=\"2\" width=\"-5\" height=\"7\"/></regions></world>\
        <settings sizeUnit=\"cm\" gridCellSize=\"50\"/><constraints><!-- why --><timelimit value=\"10\"/></constraints></root>";
    let mut field = read(text).field;
    let same = read(&field.write()).field;
    assert_eq!(same.walls, field.walls);
    assert_eq!(same.regions, field.regions);
    assert_eq!(same.constraints, field.constraints);
    let written = field.write();
    for kept in [
        "other=\"kept\"",
        "of a teacher",
        "begin=\"1.50:2\"",
        "glass=\"yes\"",
        "<fence/>",
        "gridCellSize=\"50\"",
        "<!-- why -->",
        "width=\"-5\"",
    ] {
        assert!(written.contains(kept), "{kept} in {written}");
    }
    field.walls[0].end.x += Unit::Centimetres.pixels();
    field
        .walls
        .push(Wall::new(point(0.0, 0.0), point(10.0, 0.0)));
    field.settings.realistic_physics = true;
    let written = field.write();
    assert!(
        written.contains("begin=\"1.50:2\" end=\"4:4\""),
        "{written}"
    );
    assert!(written.contains("realisticPhysics=\"true\""), "{written}");
    assert_eq!(read(&written).field.walls.len(), 2);
}

#[test]
fn a_field_that_was_made_here_can_be_read() {
    let mut field = Field::default();
    field
        .walls
        .push(Wall::new(point(1.0, 2.0), point(3.0, 4.0)));
    let mut robot = Robot {
        position: point(7.0, 8.0),
        start: Some(Start::new(point(32.0, 33.0), 15.0)),
        ..Robot::default()
    };
    let port = lang_diagram::ports::Port::named("D1").unwrap();
    robot.sensors.push(Sensor::new(port, SensorKind::Sonar));
    field.robots.push(robot);
    field
        .solids
        .push(Solid::new(SolidKind::Ball, point(5.0, 6.0)));
    let again = read(&field.write()).field;
    assert_eq!(again.walls[0].end, point(3.0, 4.0));
    assert_eq!(again.solids[0].at, point(5.0, 6.0));
    let robot = again.robot().unwrap();
    assert_eq!(
        (robot.position, &robot.start),
        (point(7.0, 8.0), &field.robots[0].start)
    );
    assert_eq!(
        robot.sensor(port).map(|one| (one.kind, one.at)),
        Some((SensorKind::Sonar, point(75.0, 25.0)))
    );
}

#[test]
fn same_ids_are_left_out_but_things_without_one_are_not() {
    let opened = read(
        "<root><settings/><world><walls><wall id=\"\"/><wall id=\"\"/><wall id=\"a\"/><wall id=\"a\"/></walls>\
         <regions><region id=\"x\" type=\"moon\"/><region id=\"y\" type=\"bound\" boundItem=\"nothing\"/></regions></world></root>",
    );
    assert_eq!(opened.field.walls.len(), 3);
    assert_eq!(opened.field.regions.len(), 1);
    let told: Vec<String> = opened.problems.iter().map(ToString::to_string).collect();
    assert_eq!(told.len(), 3, "{told:?}");
    assert!(told[0].contains("id 'a'"), "{told:?}");
}

#[test]
fn pictures_are_found_by_their_ids_and_missed_by_name() {
    let mut field = read(
        "<root><settings/><world><images><image id=\"i\" imageId=\"p\" rect=\"-10:-20:100:50\" position=\"5:6\" isBackground=\"true\"/>\
         <image id=\"j\" imageId=\"q\" rect=\"0:0:1:1\" position=\"0:0\"/></images></world></root>",
    )
    .field;
    assert_eq!(
        (field.images[0].at, field.images[0].size),
        (point(-5.0, -14.0), point(100.0, 50.0))
    );
    assert!(field.images[0].is_background);
    let problems = field.add_blobs(
        "<blobs><images><image imageId=\"p\" path=\"a.png\">iVBORw0KGgo=</image></images></blobs>",
    );
    assert_eq!(field.blobs["p"].text, "iVBORw0KGgo=");
    assert_eq!(problems.len(), 1);
    assert!(problems[0].to_string().contains("'q'"), "{}", problems[0]);
    let problems = field.add_blobs(
        "<blobs><images><image imageId=\"q\" path=\"a.png\">bm9uZQ==</image></images></blobs>",
    );
    assert!(
        problems[0].to_string().contains("is no picture"),
        "{problems:?}"
    );
}

#[test]
fn a_world_may_have_its_images_with_it() {
    let images = "<blobs><images><image imageId=\"p\" path=\"a.png\">/9j/</image></images></blobs>";
    let world = "<world><images><image id=\"i\" imageId=\"p\" rect=\"0:0:1:1\"/></images></world>";
    for text in [
        format!("<root><settings/>{world}{images}</root>"),
        format!("<model><root><settings/>{world}</root>{images}</model>"),
    ] {
        let mut field = read(&text).field;
        assert_eq!(field.blobs["p"].text, "/9j/");
        assert_eq!(field.add_blobs(""), []);
        assert!(field.write().contains("<settings/>"));
    }
}

#[test]
fn numbers_that_no_field_has_are_refused_with_their_place() {
    for bad in ["NaN", "1e308", "inf", "-1e7"] {
        let told = refused(&format!(
            "<root><settings/><world><walls><wall/><wall id=\"w2\" begin=\"0:{bad}\" end=\"1:1\"/></walls></world></root>"
        ));
        assert!(
            told.contains("<wall> number 2 (id w2)") && told.contains("begin"),
            "{told}"
        );
    }
    let odd = read(
        "<root><settings/><world><walls><wall begin=\"12,5:1\" end=\"5\"/></walls></world></root>",
    );
    assert_eq!(odd.field.walls[0].begin, point(0.0, 1.0));
    assert_eq!(odd.problems.len(), 2, "{:?}", odd.problems);
    assert!(refused("<html/>").contains("no world model"));
    assert!(!refused("<root><world>").is_empty());
    assert!(!refused("").is_empty());
}

#[test]
fn more_things_than_anybody_needs_are_refused_in_time() {
    let walls = "<wall begin=\"0:0\" end=\"1:1\"/>".repeat(30_000);
    let told = refused(&format!(
        "<root><settings/><world><walls>{walls}</walls></world></root>"
    ));
    assert!(told.contains("more than 20000"), "{told}");
}

#[test]
fn heaps_that_realistic_physics_cannot_move_in_time_are_refused() {
    let world = |count: usize, realistic: bool| {
        let cubes: String = (0..count)
            .map(|index| format!("<cube id=\"c{index}\" x=\"0\" y=\"0\"/>"))
            .collect();
        format!(
            "<root version=\"20251219\"><world><cubes>{cubes}</cubes></world><settings realisticPhysics=\"{realistic}\"/></root>"
        )
    };
    let told = refused(&world(201, true));
    assert!(told.contains("201 balls, skittles and cubes"), "{told}");
    assert!(Field::read(&world(200, true)).is_ok());
    assert!(Field::read(&world(201, false)).is_ok());
}
