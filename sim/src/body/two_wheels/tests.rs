//! A robot on two wheels: how it drives, what its sensors give, and what people order.

use super::*;
use crate::body::Power;

fn run(robot: &mut TwoWheels, seconds: f64, left: f64, right: f64) {
    let mut drive = Drive::default();
    drive.motors[LEFT] = Power::Duty(left);
    drive.motors[RIGHT] = Power::Duty(right);
    for _ in 0..(seconds * 1000.0) as u32 {
        robot.step(0.001, &drive);
    }
}

/// A quarter of a circle of radius 1 m around (0, 1): each wheel runs on a circle of its own.
#[test]
fn constant_wheel_speeds_make_an_arc() {
    let quarter = FRAC_PI_2;
    let mut turned_rad = [0.0; 4];
    turned_rad[LEFT] = (1.0 - TRACK_M / 2.0) * quarter / WHEEL_RADIUS_M / 1000.0;
    turned_rad[RIGHT] = (1.0 + TRACK_M / 2.0) * quarter / WHEEL_RADIUS_M / 1000.0;
    let mut rolling = two_wheels(Pose::default()).unwrap();
    for _ in 0..1000 {
        rolling.roll(0.001, turned_rad, [0; 6]);
    }
    let end = rolling.pose();
    assert!((end.at.x - 1.0).abs() < 1e-9 && (end.at.y - 1.0).abs() < 1e-9);
    assert!((end.heading_rad - quarter).abs() < 1e-9);
}

#[test]
fn forward_is_forward_and_the_encoders_count_up() {
    let mut robot = TwoWheels::new(World::empty(), Pose::default());
    run(&mut robot, 2.0, 100.0, 100.0);
    let senses = robot.senses();
    assert!(senses.pose.at.x > 0.9, "{:?}", senses.pose);
    assert!(senses.pose.at.y.abs() < 1e-9);
    assert!(senses.encoders_deg[LEFT] > 1900.0);
    // 0.028 m of radius: the way is the angle times the radius.
    let way = senses.encoders_deg[RIGHT].to_radians() * WHEEL_RADIUS_M;
    assert!((way - senses.pose.at.x).abs() < 1e-9);
    assert!(senses.battery_v < 12.21, "the load sags the battery");
}

#[test]
fn a_faster_right_wheel_turns_to_the_left() {
    let mut robot = TwoWheels::new(World::empty(), Pose::default());
    run(&mut robot, 0.5, 10.0, 20.0);
    let senses = robot.senses();
    assert!(senses.pose.heading_rad > 0.1 && senses.rate_dps[2] > 1.0);
    assert!(senses.acceleration_mps2[1] > 0.0, "the centre is left");
}

#[test]
fn a_wall_stops_it_presses_the_bumper_and_is_seen() {
    let mut world = World::empty();
    world.add_wall(point(1.0, -5.0), point(1.0, 5.0));
    let mut robot = TwoWheels::new(world, Pose::default());
    let before = robot.senses();
    assert!((before.ultrasonic_m[0].unwrap() - 0.89).abs() < 1e-9);
    assert_eq!(before.ultrasonic_m[1], None, "there is no wall on the left");
    assert!((before.analog[0].unwrap() - 8697.0 / 91.0).abs() < 1e-9);
    assert!((robot.range_m(0.0).unwrap() - 1.0).abs() < 1e-9);
    assert_eq!(before.analog[2], Some(1000.0));
    assert_eq!(before.bumps, 0);
    run(&mut robot, 5.0, 100.0, 100.0);
    let after = robot.senses();
    assert!((after.pose.at.x - 0.89).abs() < 1e-6, "{:?}", after.pose);
    assert_eq!(after.analog[2], Some(20.0));
    assert_eq!(after.bumps, 1, "it stays there");
    assert!(
        after.encoders_deg[LEFT] > 4000.0,
        "the wheels slip on at the wall"
    );
}

/// Three points of the sensor's table: 511 at 15 cm, 322 at 25 cm, 235 at 35 cm.
#[test]
fn the_sharp_sensor_has_the_three_points_of_its_table() {
    for (cm, raw) in [(15.0, 511.0), (25.0, 322.0), (35.0, 235.0)] {
        assert!((sharp_gp2_raw(cm) - raw).abs() < 1.0, "{cm}");
    }
    assert!(sharp_gp2_raw(3.0) < sharp_gp2_raw(8.0));
}

#[test]
fn a_person_orders_time_and_places() {
    let mut robot = TwoWheels::new(World::room(), Pose::new(0.8, 1.0, 0.0));
    robot.order("pause").unwrap();
    run(&mut robot, 0.5, 100.0, 100.0);
    assert_eq!(robot.senses().pose.at.x, 0.8);
    assert_eq!(robot.senses().rate_dps, [0.0; 3]);
    robot.order("step 20").unwrap();
    run(&mut robot, 0.5, 100.0, 100.0);
    assert!((robot.moving().time_s - 0.2).abs() < 0.0011);
    let stepped = robot.senses().pose.at.x;
    assert!(stepped > 0.8);
    robot.order("go").unwrap();
    robot.order("speed 2").unwrap();
    run(&mut robot, 0.1, 0.0, 0.0);
    assert!((robot.moving().time_s - 0.4).abs() < 0.0021);
    robot.order("robot 2 0.5 -90").unwrap();
    let pose = robot.senses().pose;
    assert_eq!((pose.at, pose.heading_rad), (point(2.0, 0.5), -FRAC_PI_2));
    // Into a wall is beside it, and beyond the walls is nowhere.
    robot.order("robot 2 0.01 -90").unwrap();
    assert!((robot.senses().pose.at.y - RADIUS_M).abs() < 1e-9);
    assert_eq!(robot.order("robot 9 9 0"), Err(BadOrder::Outside));
    assert_eq!(robot.order("field x.xml"), Err(BadOrder::OwnRoom));
    robot.order("reset").unwrap();
    assert_eq!(robot.senses().pose.at, point(0.8, 1.0));
    run(&mut robot, 0.5, 50.0, 50.0);
    assert!(robot.senses().pose.at.x > 0.8, "it drives on from there");
    let (shape, moving) = (robot.shape(), robot.moving());
    assert_eq!(shape.sensors.len(), moving.robots[0].readings.len());
}

#[test]
fn the_camera_sees_floor_line_wall_and_ball() {
    let robot = TwoWheels::new(World::room(), Pose::new(1.0, 0.4, 0.0));
    let line = robot.pixel(0.0, 0.5).unwrap();
    assert!(line.red < 30, "{line:?}");
    assert!(robot.pixel(0.9, 0.9).unwrap().red > 200);
    let robot = TwoWheels::new(World::room(), Pose::new(2.2, 1.0, 0.0));
    let any_red = (-40..40).any(|row| {
        robot
            .pixel(0.0, f64::from(row) / 40.0)
            .is_some_and(|seen| seen.red > 200 && seen.green < 50)
    });
    assert!(any_red, "the ball is ahead");
    assert_eq!(robot.pixel(0.9, -0.9), Some(colour(120, 150, 190)));
}
