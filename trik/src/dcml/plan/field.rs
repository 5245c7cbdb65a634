//! A world of TRIK Studio as obstacles, in metres with y up.
//!
//! Owns the change of units: a world is in pixels with y down and degrees clockwise.

use lang_plan::Fault;
use lang_plan::obstacles::flat::{Point, sine_and_cosine, wrapped};
use lang_plan::obstacles::{Footprint, Obstacles, Pose, Shape};
use sim::field::{Field, ROBOT_SIZE, Solid, SolidKind, Unit};

/// The robot of a world.
pub(super) struct Stand {
    pub pose: Pose,
    pub footprint: Footprint,
}

fn metres(pixels: f64) -> f64 {
    pixels / Unit::Metres.pixels()
}

fn place(x: f64, y: f64) -> Point {
    [metres(x), -metres(y)]
}

/// Radians counter-clockwise from degrees clockwise.
fn heading(degrees: f64) -> f64 {
    wrapped(-degrees.to_radians())
}

/// Walls, and things that a robot could push but should not.
///
/// # Errors
/// A thing of the world is no shape.
pub(super) fn obstacles(field: &Field) -> Result<Obstacles, Fault> {
    let walls = field.walls.iter().map(|wall| {
        let (from, to) = (wall.begin, wall.end);
        Shape::Wall(place(from.x, from.y), place(to.x, to.y), metres(wall.width))
    });
    let solids = field.solids.iter().map(solid);
    Obstacles::new(walls.chain(solids).collect(), None)
}

fn solid(solid: &Solid) -> Shape {
    let at = place(solid.at.x, solid.at.y);
    let half = metres(solid.size) / 2.0;
    if solid.kind != SolidKind::Cube {
        return Shape::Circle(at, half);
    }
    let (sine, cosine) = sine_and_cosine(heading(solid.rotation));
    let corners = [(-1.0, -1.0), (1.0, -1.0), (1.0, 1.0), (-1.0, 1.0)];
    let turned = corners.map(|(x, y)| {
        [
            at[0] + half * (cosine * x - sine * y),
            at[1] + half * (sine * x + cosine * y),
        ]
    });
    Shape::Polygon(turned.to_vec())
}

/// Where the robot of TRIK stands, and the square that it covers.
pub(super) fn stand(field: &Field) -> Option<Stand> {
    let robot = field.robot()?;
    let (middle, half) = (ROBOT_SIZE / 2.0, metres(ROBOT_SIZE / 2.0));
    let square = vec![[-half, -half], [half, -half], [half, half], [-half, half]];
    Some(Stand {
        pose: Pose {
            at: place(robot.position.x + middle, robot.position.y + middle),
            heading: heading(robot.direction),
        },
        footprint: Footprint::polygon(square).ok()?,
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    const WORLD: &str = r#"<root version="20190819"><world><walls><wall id="w" begin="0:0" end="200:100"/></walls>
        <skittles><skittle id="s" x="100" y="-50" markerX="100" markerY="-50" rotation="0" startRotation="0"/></skittles>
        </world><robots><robot id="trikKitRobot" position="75:-125" direction="90"/></robots>
        <settings sizeUnit="pixels"/></root>"#;

    #[test]
    fn pixels_become_metres_and_y_points_up() {
        let field = Field::read(WORLD)
            .map_err(|all| format!("{all:?}"))
            .unwrap()
            .field;
        let all = obstacles(&field).unwrap();
        let pixel = 5.6 / 16.0 / 100.0;
        let near = |a: f64, b: f64| (a - b).abs() < 1e-12;
        match all.shapes() {
            [Shape::Wall(from, to, width), Shape::Circle(at, radius)] => {
                assert_eq!(*from, [0.0, 0.0]);
                assert!(near(to[0], 200.0 * pixel) && near(to[1], -100.0 * pixel));
                assert!(near(*width, 10.0 * pixel));
                assert!(near(at[0], 100.0 * pixel) && near(at[1], 50.0 * pixel));
                assert!(near(*radius, 10.0 * pixel));
            }
            other => panic!("{other:?}"),
        }
        let stand = stand(&field).unwrap();
        assert!(near(stand.pose.at[0], 100.0 * pixel) && near(stand.pose.at[1], 100.0 * pixel));
        assert!(near(stand.pose.heading, -std::f64::consts::FRAC_PI_2));
        assert!(near(stand.footprint.reach(), 25.0 * pixel * 2.0_f64.sqrt()));
    }
}
