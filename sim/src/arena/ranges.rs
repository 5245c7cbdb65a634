//! Sensors that look at what is solid: distances by infrared light and sound, a lidar, a touch sensor.
//!
//! Owns the shapes of their beams, which are those of the original: a slice of a pie whose arc is the original's curve and
//! whose length is a whole number of centimetres. Knows no noise.

use lang_diagram::stand_in::PIXELS_IN_CM;

use super::outline::{Bounds, KAPPA, Outline, parts_of, quarter_at, quarter_slope};
use super::solids::Solids;
use crate::geometry::{Point, point};

/// A beam.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Beam {
    /// Across, in degrees.
    pub degrees: f64,
    /// As far as it goes, in whole centimetres.
    pub reach_cm: i32,
}

/// Of a sensor with infrared light.
pub const INFRARED: Beam = Beam {
    degrees: 5.0,
    reach_cm: 80,
};
/// Of one with sound.
pub const SONAR: Beam = Beam {
    degrees: 20.0,
    reach_cm: 300,
};
/// Of a lidar: one of its rays.
pub const LIDAR: Beam = Beam {
    degrees: 1.0,
    reach_cm: 400,
};
/// Rays of a lidar.
pub const LIDAR_RAYS: usize = 360;
/// Height of a touch sensor, and how far before its centre its stick is.
const TOUCH: (f64, f64) = (10.0, 7.5);

/// The distance to the nearest solid thing in a beam, in whole centimetres; the beam's reach if there is none.
pub fn distance(
    solids: &Solids,
    at: Point,
    degrees: f64,
    beam: Beam,
    scratch: &mut Outline,
) -> i32 {
    let mut meets = |cm: i32| {
        slice(
            at,
            degrees,
            beam.degrees,
            f64::from(cm) * PIXELS_IN_CM,
            scratch,
        );
        solids.meets(scratch)
    };
    let (mut low, mut high) = (0, beam.reach_cm);
    if !meets(high) {
        return high;
    }
    while low < high {
        let middle = (low + high) / 2;
        if meets(middle) {
            high = middle;
        } else {
            low = middle + 1;
        }
    }
    high
}

/// Whether a touch sensor is pressed.
pub fn is_touching(solids: &Solids, at: Point, degrees: f64, scratch: &mut Outline) -> bool {
    let (height, ahead) = TOUCH;
    let radius = (height / std::f64::consts::SQRT_2).ceil();
    let (sin, cos) = libm::sincos(degrees.to_radians());
    scratch.clear();
    scratch.add_circle(point(at.x + ahead * cos, at.y + ahead * sin), radius);
    solids.meets(scratch)
}

/// What a lidar says: whole centimetres for each degree clockwise from where it looks, 0 for nothing.
pub fn lidar(solids: &Solids, at: Point, degrees: f64, scratch: &mut Outline, into: &mut Vec<i32>) {
    let reach = f64::from(LIDAR.reach_cm) * PIXELS_IN_CM;
    for ray in 0..LIDAR_RAYS {
        slice(at, degrees + ray as f64, LIDAR.degrees, reach, scratch);
        let nearest = nearest(solids, scratch, at) / PIXELS_IN_CM;
        let is_seen = nearest.is_finite() && nearest <= f64::from(LIDAR.reach_cm);
        into.push(if is_seen { nearest as i32 } else { 0 });
    }
}

/// How far a ray without a width goes, in pixels; nothing within a lidar's reach.
pub fn ray(solids: &Solids, at: Point, degrees: f64) -> Option<f64> {
    let reach = f64::from(LIDAR.reach_cm) * PIXELS_IN_CM;
    let end = at.moved(Point::towards(degrees.to_radians()), reach);
    let mut best = f64::INFINITY;
    solids.each_near(&Bounds::of(&[at, end]), |solid, _| {
        for side in super::outline::sides(solid) {
            if let Some(met) = crossing((at, end), side) {
                best = best.min(met.from(at).length());
            }
        }
        true
    });
    best.is_finite().then_some(best)
}

/// The nearest corner of what a slice and solid things have in common: corners of either inside the other, and crossings.
fn nearest(solids: &Solids, slice: &Outline, from: Point) -> f64 {
    use super::outline::{is_inside, sides};
    let corners = slice.corners(0);
    let around = slice.bounds();
    let mut best = f64::INFINITY;
    let mut see = |at: Point| best = best.min(at.from(from).length());
    solids.each_near(&around, |solid, _| {
        for &corner in solid {
            if is_inside(corners, corner) {
                see(corner);
            }
        }
        for &corner in corners {
            if is_inside(solid, corner) {
                see(corner);
            }
        }
        for one in sides(solid) {
            for other in sides(corners) {
                if let Some(at) = crossing(one, other) {
                    see(at);
                }
            }
        }
        true
    });
    best
}

fn crossing(one: (Point, Point), other: (Point, Point)) -> Option<Point> {
    let (along, across) = (one.1.from(one.0), other.1.from(other.0));
    let cross = along.cross(across);
    if cross == 0.0 {
        return None;
    }
    let between = other.0.from(one.0);
    let t = between.cross(across) / cross;
    let u = between.cross(along) / cross;
    let within = 0.0..=1.0;
    (within.contains(&t) && within.contains(&u)).then(|| one.0.moved(along, t))
}

/// A slice of a pie as the original draws it: its point, then the arc.
pub fn slice(at: Point, degrees: f64, width: f64, radius: f64, into: &mut Outline) {
    into.clear();
    if radius <= 0.0 {
        return;
    }
    // The original counts angles against the clock, and begins at the smaller one.
    let begin = -degrees - width / 2.0;
    let mut points = Vec::new();
    std::mem::swap(&mut points, &mut into.spare);
    points.clear();
    points.push(at);
    let end = begin + width;
    let (first, last) = ((begin / 90.0).floor(), (end / 90.0).floor());
    let mut quarter = first;
    while quarter <= last {
        let from = if quarter == first {
            begin / 90.0 - quarter
        } else {
            0.0
        };
        let to = if quarter == last {
            end / 90.0 - quarter
        } else {
            1.0
        };
        if to > from {
            arc(
                at,
                radius,
                quarter,
                (parameter(from), parameter(to)),
                &mut points,
            );
        }
        quarter += 1.0;
    }
    into.add(points.iter().copied());
    into.spare = points;
}

/// The straight parts of a piece of a quarter; its first point only if nothing but the slice's point is before. Quarters go against the clock from the right.
fn arc(at: Point, radius: f64, quarter: f64, (from, to): (f64, f64), points: &mut Vec<Point>) {
    let turned = |(across, along): (f64, f64)| match quarter.rem_euclid(4.0) as u8 {
        0 => (across, along),
        1 => (-along, across),
        2 => (-across, -along),
        _ => (along, -across),
    };
    let place = |t: f64| {
        let (x, y) = turned(quarter_at(t));
        point(at.x + radius * x, at.y - radius * y)
    };
    // The control points count for how finely it is drawn.
    let third = (to - from) / 3.0 * radius;
    let control = |t: f64, third: f64| {
        let (x, y) = turned(quarter_slope(t));
        let end = place(t);
        point(end.x + third * x, end.y - third * y)
    };
    let around = Bounds::of(&[
        place(from),
        control(from, third),
        control(to, -third),
        place(to),
    ]);
    let size = around.high.from(around.low);
    let parts = parts_of(size.x, size.y);
    for part in u32::from(points.len() > 1)..=parts {
        points.push(place(
            from + (to - from) * f64::from(part) / f64::from(parts),
        ));
    }
}

/// Where on the curve of a quarter an angle is, as a share of a right angle.
///
/// The original looks for the cosine in two steps of Newton's method, from there for the sine in two more, and takes the
/// mean. In the slope for the sine one sign is wrong there, which moves the ends of arcs by hundredths of a degree; so it
/// is here, because readings depend on it.
fn parameter(share: f64) -> f64 {
    if share <= 1e-12 {
        return 0.0;
    }
    if share >= 1.0 - 1e-12 {
        return 1.0;
    }
    let (sin, cos) = libm::sincos((share * 90.0).to_radians());
    let mut by_cos = share;
    for _ in 0..2 {
        let value = ((2.0 - 3.0 * KAPPA) * by_cos + 3.0 * (KAPPA - 1.0)) * by_cos * by_cos + 1.0;
        let slope = ((6.0 - 9.0 * KAPPA) * by_cos + 6.0 * (KAPPA - 1.0)) * by_cos;
        by_cos -= (value - cos) / slope;
    }
    let mut by_sin = by_cos;
    for _ in 0..2 {
        let inner = (3.0 * KAPPA - 2.0) * by_sin - 6.0 * KAPPA + 3.0;
        let value = (inner * by_sin + 3.0 * KAPPA) * by_sin;
        let slope = ((9.0 * KAPPA - 6.0) * by_sin + 12.0 * KAPPA - 6.0) * by_sin + 3.0 * KAPPA;
        by_sin -= (value - sin) / slope;
    }
    f64::midpoint(by_cos, by_sin)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::field::{Field, Wall};

    fn wall_at(x: f64) -> Solids {
        Solids::of(&Field {
            walls: vec![Wall::new(point(x, -1000.0), point(x, 1000.0))],
            ..Field::default()
        })
    }

    #[test]
    fn the_recorded_distances_to_a_wall() {
        // The face of the wall is 133 px before the sensor: 46.55 cm.
        let solids = wall_at(200.0);
        let at = point(62.0, 25.0);
        let mut scratch = Outline::default();
        assert_eq!(distance(&solids, at, 0.0, INFRARED, &mut scratch), 47);
        assert_eq!(distance(&solids, at, 0.0, SONAR, &mut scratch), 47);
        assert_eq!(distance(&solids, at, 180.0, INFRARED, &mut scratch), 80);
        assert_eq!(distance(&solids, at, 180.0, SONAR, &mut scratch), 300);
    }

    #[test]
    fn nothing_is_nearer_than_a_centimetre() {
        let solids = wall_at(0.0);
        let mut scratch = Outline::default();
        assert_eq!(
            distance(&solids, point(0.0, 0.0), 0.0, SONAR, &mut scratch),
            1
        );
    }

    #[test]
    fn a_lidar_sees_the_wall_in_the_directions_where_it_is() {
        let solids = wall_at(105.0);
        let mut scratch = Outline::default();
        let mut seen = Vec::new();
        lidar(&solids, point(0.0, 0.0), 0.0, &mut scratch, &mut seen);
        assert_eq!(seen.len(), LIDAR_RAYS);
        assert_eq!(seen[0], 35);
        assert_eq!(seen[90], 0);
        assert_eq!(seen[180], 0);
        // 60 degrees: twice as far, and the near side of the ray is half a degree closer.
        assert!((68..=70).contains(&seen[60]), "{}", seen[60]);
    }

    #[test]
    fn a_touch_sensor_feels_before_its_stick() {
        let solids = wall_at(105.0);
        let mut scratch = Outline::default();
        let mut feels = |x: f64| is_touching(&solids, point(x, 0.0), 0.0, &mut scratch);
        // Radius 8 around a point 7.5 px ahead, face at 100.
        assert!(!feels(84.4));
        assert!(feels(84.6));
    }

    #[test]
    fn arcs_are_where_circles_are() {
        let mut outline = Outline::default();
        for degrees in [0.0, 10.0, 85.0, 123.4, -300.0, 720.5] {
            slice(point(3.0, 4.0), degrees, 20.0, 857.0, &mut outline);
            let corners = outline.corners(0);
            assert_eq!(corners[0], point(3.0, 4.0));
            for corner in &corners[1..] {
                let radius = corner.from(corners[0]).length();
                assert!((radius - 857.0).abs() < 857.0 * 0.0003, "{radius}");
            }
            let towards = Point::towards(f64::to_radians(degrees));
            let middle = corners[0].moved(towards, 400.0);
            assert!(outline.contains(middle), "{degrees}");
        }
    }
}
