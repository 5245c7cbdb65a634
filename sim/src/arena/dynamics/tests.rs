//! Realistic physics against the few numbers that the original gave, and in strange worlds.

use lang_diagram::brick::{Brick, Command};
use lang_diagram::ports::Port;

use crate::arena::{Arena, Setup};
use crate::field::{Field, Robot, Solid, SolidKind, Wall};
use crate::geometry::point;

/// A robot at (0, 0) that looks to the right, with realistic physics, M3 at the left and M4 at the right.
fn field() -> Field {
    let mut field = Field::default();
    field.settings.realistic_physics = true;
    field.robots.push(Robot::default());
    field
}

fn power(arena: &mut Arena, left: i32, right: i32) {
    let mut robot = arena.robot(0);
    for (name, percent) in [("M4", left), ("M3", right)] {
        let port = Port::named(name).unwrap();
        robot.command(Command::Power { port, percent });
    }
}

fn encoder(arena: &mut Arena, name: &str) -> i32 {
    arena.robot(0).scalar(Port::named(name).unwrap()).unwrap()
}

/// So many ticks at these powers, and one more for the speeds that were chosen in the last one.
fn drive(arena: &mut Arena, left: i32, right: i32, ticks: u32) {
    power(arena, left, right);
    for _ in 0..ticks {
        arena.tick();
    }
    power(arena, 0, 0);
    arena.tick();
    arena.tick();
}

/// The original gives 68.3 px where ideal physics gives 76.8.
#[test]
fn a_second_straight_is_as_long_as_with_the_original() {
    let mut arena = Arena::new(&field(), Setup::default());
    drive(&mut arena, 100, 100, 100);
    let pose = arena.robots()[0].pose();
    assert!((pose.x - 68.3).abs() < 0.7, "{pose:?}");
    // The left wheel is solved first, so it drifts aside.
    assert!(pose.y.abs() < 0.02 && pose.degrees.abs() < 0.03, "{pose:?}");
    // Both wheels stand: it has stopped dead.
    arena.tick();
    let after = arena.robots()[0].pose();
    assert!((after.x - pose.x).abs() < 1e-3, "{pose:?} {after:?}");
}

/// The original gives -177 degrees where ideal physics gives -200.
#[test]
fn a_second_on_the_spot_turns_as_far_as_with_the_original() {
    let mut arena = Arena::new(&field(), Setup::default());
    drive(&mut arena, -100, 100, 100);
    let pose = arena.robots()[0].pose();
    assert!((pose.degrees + 177.0).abs() < 2.0, "{pose:?}");
}

/// The original gives 2194 where ideal physics gives 1039, because encoders go on counting at a wall.
#[test]
fn encoders_count_at_a_wall() {
    let mut field = field();
    field
        .walls
        .push(Wall::new(point(200.0, -100.0), point(200.0, 100.0)));
    let mut arena = Arena::new(&field, Setup::default());
    drive(&mut arena, 100, 100, 400);
    let counted = encoder(&mut arena, "E3");
    assert!((counted - 2194).abs() <= 11, "{counted}");
    let pose = arena.robots()[0].pose();
    // The body's nose is 49 px before the corner of the square, the wall's face at 195.
    assert!((pose.x + 49.0 - 195.0).abs() < 1.0, "{pose:?}");
}

/// People watch, so things are seen where they were pushed.
fn watched() -> Setup {
    Setup {
        is_watched: true,
        ..Setup::default()
    }
}

#[test]
fn things_are_pushed_and_come_to_rest() {
    let mut field = field();
    for (kind, y) in [(SolidKind::Skittle, 10.0), (SolidKind::Cube, 40.0)] {
        field.solids.push(Solid::new(kind, point(90.0, y)));
    }
    field
        .solids
        .push(Solid::new(SolidKind::Ball, point(400.0, 400.0)));
    let mut arena = Arena::new(&field, watched());
    drive(&mut arena, 100, 100, 200);
    let solids = &arena.field().solids;
    for solid in &solids[..2] {
        assert!(solid.at.x > 120.0, "{:?} at {:?}", solid.kind, solid.at);
    }
    // Where 32 bits have it.
    assert!(solids[2].at.from(point(400.0, 400.0)).length() < 1e-4);
    for _ in 0..500 {
        arena.tick();
    }
    let before: Vec<_> = arena.field().solids.iter().map(|solid| solid.at).collect();
    for _ in 0..10 {
        arena.tick();
    }
    for (solid, before) in arena.field().solids.iter().zip(before) {
        assert!(solid.at.from(before).length() < 0.01);
    }
}

#[test]
fn a_ball_rolls_on_and_bounces_from_a_wall() {
    let mut field = field();
    field
        .solids
        .push(Solid::new(SolidKind::Ball, point(80.0, 25.0)));
    field
        .walls
        .push(Wall::new(point(250.0, -100.0), point(250.0, 150.0)));
    let mut arena = Arena::new(&field, watched());
    power(&mut arena, 100, 100);
    let mut farthest: f64 = 0.0;
    for _ in 0..60 {
        arena.tick();
    }
    power(&mut arena, 0, 0);
    for _ in 0..400 {
        arena.tick();
        farthest = farthest.max(arena.field().solids[0].at.x);
    }
    let ball = arena.field().solids[0].at;
    // Its rim at the wall's face, and then back again.
    assert!((farthest + 15.0 - 245.0).abs() < 1.5, "{farthest}");
    assert!(ball.x < farthest - 20.0, "{ball:?}");
}

#[test]
fn robots_push_each_other() {
    // It stands across in the way.
    let other = Robot {
        position: point(70.0, 20.0),
        direction: 90.0,
        ..Robot::default()
    };
    let setup = || Setup {
        others: vec![other.clone()],
        ..Setup::default()
    };
    let mut arena = Arena::new(&field(), setup());
    drive(&mut arena, 100, 100, 200);
    let [first, second] = [0, 1].map(|index| arena.robots()[index].pose());
    let alone = {
        let mut arena = Arena::new(&field(), watched());
        drive(&mut arena, 100, 100, 200);
        arena.robots()[0].pose()
    };
    assert!(first.x < alone.x - 5.0, "{first:?} {alone:?}");
    let apart = (first.x - second.x).hypot(first.y - second.y);
    assert!(apart > 30.0, "{first:?} {second:?}");
}

#[test]
fn the_same_run_is_the_same_again() {
    let run = || {
        let mut field = field();
        for y in [0.0, 20.0, 40.0, 60.0] {
            field
                .solids
                .push(Solid::new(SolidKind::Cube, point(100.0, y)));
        }
        let mut arena = Arena::new(&field, watched());
        drive(&mut arena, 100, 70, 200);
        (arena.robots()[0].pose(), arena.field().solids.clone())
    };
    assert_eq!(run(), run());
}

/// On a PC, on the controller and in a browser.
#[test]
fn a_run_has_the_same_bits_on_every_machine() {
    let mut field = field();
    for (kind, y) in [(SolidKind::Cube, 30.0), (SolidKind::Skittle, 60.0)] {
        field.solids.push(Solid::new(kind, point(120.0, y)));
    }
    let mut arena = Arena::new(&field, watched());
    for (left, right) in [(100, 70), (60, 90), (-80, 80), (100, 100)] {
        drive(&mut arena, left, right, 100);
    }
    let pose = arena.robots()[0].pose();
    let solids = arena.field().solids.iter();
    let places = solids.flat_map(|solid| [solid.at.x, solid.at.y]);
    let numbers = [pose.x, pose.y, pose.degrees].into_iter().chain(places);
    let bits: Vec<u64> = numbers.map(f64::to_bits).collect();
    let known = [
        4_629_955_326_847_511_808,
        13_853_246_978_060_972_288,
        13_862_367_571_187_026_174,
        4_636_585_633_911_930_880,
        13_849_113_619_226_165_248,
        4_639_985_814_028_156_928,
        4_634_703_563_673_567_232,
    ];
    assert_eq!(bits, known);
}

#[test]
fn strange_worlds_do_no_harm() {
    let mut field = field();
    for size in [0.0, -5.0, 1e6, f64::NAN] {
        let mut solid = Solid::new(SolidKind::Ball, point(60.0, 25.0));
        solid.size = size;
        solid.material.mass = 1e308;
        solid.material.friction = -1.0;
        field.solids.push(solid);
    }
    for end in [0.0, 1e6] {
        field
            .walls
            .push(Wall::new(point(0.0, 0.0), point(end, 0.0)));
    }
    field.robots[0].material.mass = 0.0;
    field.robots[0].wheels.mass = -1.0;
    let mut arena = Arena::new(&field, watched());
    drive(&mut arena, 100, -100, 50);
}

/// In its background mode the original reads no place back.
#[test]
fn without_people_things_are_seen_where_they_stood() {
    let mut field = field();
    field
        .solids
        .push(Solid::new(SolidKind::Cube, point(90.0, 25.0)));
    let mut arena = Arena::new(&field, Setup::default());
    drive(&mut arena, 100, 100, 200);
    assert_eq!(arena.field().solids[0].at, point(90.0, 25.0));
    // It is in the way all the same.
    let mut empty = Arena::new(&self::field(), Setup::default());
    drive(&mut empty, 100, 100, 200);
    assert!(arena.robots()[0].pose().x < empty.robots()[0].pose().x - 1.0);
}

#[test]
fn a_robot_that_is_put_elsewhere_drives_on_from_there() {
    let mut arena = Arena::new(&field(), Setup::default());
    drive(&mut arena, 100, 100, 50);
    let pose = lang_diagram::stand_in::Pose {
        x: 300.0,
        y: -40.0,
        degrees: 90.0,
    };
    arena.robot_mut(0).unwrap().put(pose);
    drive(&mut arena, 100, 100, 50);
    let now = arena.robots()[0].pose();
    assert!(now.y > -15.0 && (now.x - 300.0).abs() < 1.0, "{now:?}");
}
