//! Points, segments and rays on the plane, in metres; x to the right, y up, angles counter-clockwise from x.

/// A point or a direction.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Point {
    /// To the right, in metres.
    pub x: f64,
    /// Up on the map, in metres.
    pub y: f64,
}

/// A point from its coordinates.
pub const fn point(x: f64, y: f64) -> Point {
    Point { x, y }
}

impl Point {
    /// The direction of an angle in radians.
    pub fn towards(angle_rad: f64) -> Self {
        point(libm::cos(angle_rad), libm::sin(angle_rad))
    }

    /// `self` moved by `distance` in the direction of `other`.
    pub fn moved(self, direction: Self, distance: f64) -> Self {
        point(
            self.x + direction.x * distance,
            self.y + direction.y * distance,
        )
    }

    /// From `origin` to here.
    pub fn from(self, origin: Self) -> Self {
        point(self.x - origin.x, self.y - origin.y)
    }

    /// Scalar product.
    pub fn dot(self, other: Self) -> f64 {
        self.x * other.x + self.y * other.y
    }

    /// The third coordinate of the vector product.
    pub fn cross(self, other: Self) -> f64 {
        self.x * other.y - self.y * other.x
    }

    /// Length of the vector.
    pub fn length(self) -> f64 {
        libm::hypot(self.x, self.y)
    }
}

/// Where something is and where it looks.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Pose {
    /// Where.
    pub at: Point,
    /// Counter-clockwise from the x axis, in radians.
    pub heading_rad: f64,
}

impl Pose {
    /// A pose from its numbers.
    pub fn new(x: f64, y: f64, heading_rad: f64) -> Self {
        Self {
            at: point(x, y),
            heading_rad,
        }
    }

    /// A place of the body on the map: `forward` ahead of the centre and `left` of it.
    pub fn place(&self, forward: f64, left: f64) -> Point {
        let ahead = Point::towards(self.heading_rad);
        self.at
            .moved(ahead, forward)
            .moved(point(-ahead.y, ahead.x), left)
    }
}

/// A straight piece from one point to another.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Segment {
    /// One end.
    pub from: Point,
    /// The other.
    pub to: Point,
}

impl Segment {
    /// From one point to another.
    pub const fn new(from: Point, to: Point) -> Self {
        Self { from, to }
    }

    /// The point of the segment that is nearest to `other`.
    pub fn nearest(&self, other: Point) -> Point {
        let along = self.to.from(self.from);
        let square = along.dot(along);
        if square == 0.0 {
            return self.from;
        }
        let share = (other.from(self.from).dot(along) / square).clamp(0.0, 1.0);
        self.from.moved(along, share)
    }

    /// How far a ray from `origin` in the unit direction `towards` goes before it meets the segment.
    pub fn met_by(&self, origin: Point, towards: Point) -> Option<f64> {
        let along = self.to.from(self.from);
        let across = towards.cross(along);
        if across.abs() < 1e-12 {
            return None;
        }
        let start = self.from.from(origin);
        let distance = start.cross(along) / across;
        let share = start.cross(towards) / across;
        (distance >= 0.0 && (0.0..=1.0).contains(&share)).then_some(distance)
    }
}

/// How far a ray goes before it meets a circle; nothing if it starts inside.
pub fn circle_met_by(centre: Point, radius: f64, origin: Point, towards: Point) -> Option<f64> {
    let to_centre = centre.from(origin);
    let along = to_centre.dot(towards);
    let beside = to_centre.cross(towards).abs();
    if along <= 0.0 || beside > radius || to_centre.length() <= radius {
        return None;
    }
    Some(along - (radius * radius - beside * beside).sqrt())
}

#[cfg(test)]
mod tests {
    use super::*;

    /// 3-4-5: the wall x = 3 is met after 5 m in the direction (0.6, 0.8).
    #[test]
    fn a_ray_meets_a_wall_where_paper_says() {
        let wall = Segment::new(point(3.0, -1.0), point(3.0, 10.0));
        let distance = wall.met_by(point(0.0, 0.0), point(0.6, 0.8)).unwrap();
        assert!((distance - 5.0).abs() < 1e-12);
        assert_eq!(wall.met_by(point(0.0, 0.0), point(-0.6, 0.8)), None);
        // Parallel, and past the end.
        assert_eq!(wall.met_by(point(0.0, 0.0), point(0.0, 1.0)), None);
        let short = Segment::new(point(3.0, -1.0), point(3.0, 3.9));
        assert_eq!(short.met_by(point(0.0, 0.0), point(0.6, 0.8)), None);
    }

    #[test]
    fn a_ray_meets_a_circle_on_its_near_side() {
        let met = circle_met_by(point(2.0, 0.0), 0.5, point(0.0, 0.0), point(1.0, 0.0));
        assert!((met.unwrap() - 1.5).abs() < 1e-12);
        let beside = circle_met_by(point(2.0, 0.6), 0.5, point(0.0, 0.0), point(1.0, 0.0));
        assert_eq!(beside, None);
    }

    #[test]
    fn the_nearest_point_of_a_segment_may_be_its_end() {
        let wall = Segment::new(point(0.0, 0.0), point(2.0, 0.0));
        assert_eq!(wall.nearest(point(1.0, 3.0)), point(1.0, 0.0));
        assert_eq!(wall.nearest(point(5.0, 3.0)), point(2.0, 0.0));
    }

    #[test]
    fn left_of_a_body_that_looks_up_is_minus_x() {
        let pose = Pose::new(1.0, 1.0, std::f64::consts::FRAC_PI_2);
        let place = pose.place(0.5, 0.25);
        assert!((place.x - 0.75).abs() < 1e-12 && (place.y - 1.5).abs() < 1e-12);
    }
}
