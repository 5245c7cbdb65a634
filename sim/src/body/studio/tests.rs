//! A robot in a world of TRIK Studio: how it drives, what its connectors carry, and what people order.

use super::*;
use crate::field::{Robot, Sensor, Wall};
use crate::show::field::PIXELS_IN_M;

fn field() -> Field {
    let mut robot = Robot::default();
    for (port, kind) in [("A1", SensorKind::Infrared), ("D1", SensorKind::Sonar)] {
        let mut sensor = Sensor::new(Port::named(port).unwrap(), kind);
        sensor.at = point(62.0, 25.0);
        robot.sensors.push(sensor);
    }
    let mut field = Field::default();
    field.robots.push(robot);
    field
        .walls
        .push(Wall::new(point(200.0, -100.0), point(200.0, 100.0)));
    field
}

fn full(percent: f64) -> Drive {
    let mut drive = Drive::default();
    drive.motors[2] = Power::Duty(percent);
    drive.motors[3] = Power::Duty(percent);
    drive
}

#[test]
fn a_second_straight_is_27_centimetres_and_the_wheels_say_so() {
    let mut body = Studio::new(&Field::default(), 1);
    let before = body.senses().pose;
    for _ in 0..1000 {
        body.step(0.001, &full(100.0));
    }
    let after = body.senses();
    // 76.79 px in a second; the first tick only takes the speed.
    let way = after.pose.at.x - before.at.x;
    assert!((way - 0.2688).abs() < 0.004, "{way}");
    assert_eq!(after.pose.at.y, before.at.y);
    assert!((after.encoders_deg[2] - 550.0).abs() < 6.0);
    assert_eq!(after.encoders_deg[0], 0.0);
}

#[test]
fn sensors_are_what_the_connectors_would_carry() {
    let body = Studio::new(&field(), 1);
    let senses = body.senses();
    assert_eq!(senses.analog[0], Some(sharp_gp2_raw(47.0)));
    assert_eq!(senses.analog[1], None);
    assert_eq!(senses.ultrasonic_m, [Some(0.47), None, None]);
    assert!(!body.has_lidar() && body.range_m(0.0).is_none());
    assert!(senses.battery_v > 11.0);
}

#[test]
fn the_camera_sees_the_floor_before_it() {
    let mut field = field();
    let mut camera = Sensor::new(Port::named("A2").unwrap(), SensorKind::Camera);
    camera.at = point(62.0, 25.0);
    field.robots[0].sensors.push(camera);
    let text = "<root version=\"20251219\"><settings/><world><colorFields><line begin=\"62:-50\" end=\"62:100\" \
                stroke=\"#ff000000\" stroke-width=\"6\"/></colorFields></world></root>";
    let painted = Field::read(text).unwrap().field;
    field.drawn = painted.drawn;
    let body = Studio::new(&field, 1);
    // The line lies across, in the middle of the picture.
    assert_eq!(body.pixel(0.0, 0.0), Some(colour(0, 0, 0)));
    assert_eq!(body.pixel(-0.9, 0.0), Some(colour(0, 0, 0)));
    assert_eq!(body.pixel(0.0, -0.9), Some(colour(255, 255, 255)));
    let blind = Studio::new(&Field::default(), 1);
    assert_eq!(blind.pixel(0.0, 0.0), None);
}

#[test]
fn a_person_orders_time_and_walls() {
    let mut body = Studio::new(&field(), 1);
    let run = |body: &mut Studio| {
        let before = body.senses().pose.at.x;
        for _ in 0..500 {
            body.step(0.001, &full(100.0));
        }
        body.senses().pose.at.x - before
    };
    let usual = run(&mut body);
    assert!((usual - 0.134).abs() < 0.004, "{usual}");
    body.order("pause").unwrap();
    assert_eq!(run(&mut body), 0.0);
    body.order("step 25").unwrap();
    let stepped = run(&mut body);
    assert!((stepped - usual / 2.0).abs() < 0.004, "{stepped}");
    assert_eq!(run(&mut body), 0.0);
    body.order("speed 0.5").unwrap();
    body.order("go").unwrap();
    let slow = run(&mut body);
    assert!((slow - usual / 2.0).abs() < 0.004, "{slow}");
    for words in [
        "",
        "fly",
        "step 0",
        "step 1e9",
        "speed nan",
        "speed 0",
        "field",
        "field /nowhere",
    ] {
        assert!(body.order(words).is_err(), "{words}");
    }
    let mut locked = Studio::new(&field(), 1).locked(Locks {
        world: true,
        ..Locks::default()
    });
    let refused = locked.order("field x.xml").unwrap_err();
    assert_eq!(refused, BadOrder::Locked);
    locked.order("pause").unwrap();
    // The wall is gone in another field.
    let before = body.senses().analog[0];
    assert!(before > Some(sharp_gp2_raw(47.0)));
    let folder = tempfile::tempdir().unwrap();
    let file = folder.path().join("field.xml");
    std::fs::write(
        &file,
        "<root version=\"20251219\"><settings/><world/></root>",
    )
    .unwrap();
    body.order(&format!("field {}", file.display())).unwrap();
    assert_eq!(body.senses().analog[0], Some(sharp_gp2_raw(80.0)));
}

#[test]
fn a_hand_carries_the_robot_and_things_and_reset_puts_them_back() {
    let mut field = field();
    let ball = crate::field::Solid::new(crate::field::SolidKind::Ball, point(0.0, 200.0));
    field.solids.push(ball);
    let mut body = Studio::new(&field, 1);
    let begun = body.moving();
    let far = body.senses().ultrasonic_m[0];
    body.order("robot 0.4 0.1 90").unwrap();
    let pose = body.senses().pose;
    assert!((pose.at.x - 0.4).abs() < 1e-9 && (pose.at.y - 0.1).abs() < 1e-9);
    assert!((pose.heading_rad.to_degrees() - 90.0).abs() < 1e-9);
    assert_ne!(body.senses().ultrasonic_m[0], far);
    assert_eq!(body.senses().rate_dps, [0.0; 3], "nobody felt a push");
    body.order("thing 0 0.4 0.45").unwrap();
    let near = body.senses().ultrasonic_m[0].unwrap();
    assert!((0.15..0.2).contains(&near), "{near}");
    assert_eq!(body.order("thing 1 0 0"), Err(BadOrder::NoThing(1)));
    let shown = body.moving();
    assert_eq!(shown.robots[0].readings[1], Some(near));
    for _ in 0..100 {
        body.step(0.001, &full(100.0));
    }
    let turned = body.shafts_deg();
    body.order("reset").unwrap();
    assert_eq!(body.moving().things, begun.things);
    assert_eq!(body.senses().pose, begun.robots[0].pose);
    assert_eq!(body.shafts_deg(), turned, "a hand turns no wheel");
    assert_eq!(body.version(), 0);
}

#[test]
fn another_world_brings_its_own_start() {
    let mut body = Studio::new(&field(), 1);
    let mut other = Field::default();
    other.settings.realistic_physics = true;
    other.robots.push(Robot {
        position: point(100.0, 200.0),
        direction: 90.0,
        ..Robot::default()
    });
    let locks = Locks {
        robot_position: true,
        ..Locks::default()
    };
    body.enter(&other, locks).unwrap();
    let scene = body.scene().unwrap();
    assert!(scene.items.is_empty() && scene.locks.robot_position);
    assert!(body.arena.field().settings.realistic_physics);
    let pose = body.senses().pose;
    assert!((pose.at.x - 125.0 / PIXELS_IN_M).abs() < 1e-9, "{pose:?}");
    assert!((pose.at.y + 225.0 / PIXELS_IN_M).abs() < 1e-9, "{pose:?}");
    assert_eq!(body.version(), 1);
    assert_eq!(body.order("robot 0 0 0"), Err(BadOrder::RobotLocked));
    body.order("reset").unwrap();
    assert_eq!(body.senses().pose, pose);
    let mut locked = Studio::new(&field(), 1).locked(Locks {
        world: true,
        ..Locks::default()
    });
    assert_eq!(locked.enter(&other, locks), Err(BadOrder::Locked));
    assert_eq!(locked.order("thing 0 0 0"), Err(BadOrder::Locked));
    assert!(!locked.scene().unwrap().takes_fields);
}

#[test]
fn the_configuration_has_what_the_world_has() {
    let text = configuration(&field());
    for line in [
        "{ port = 'M4', type = 'powerMotor', name = 'left', encoder = 'E4' },",
        "{ port = 'A1', type = 'sharpGP2', name = 'infrared1' },",
        "{ port = 'D1', type = 'ultrasonic', name = 'sonar1' },",
    ] {
        assert!(text.contains(line), "{line} in {text}");
    }
    assert!(!text.contains("A2") && !text.contains("lidar"));
}
