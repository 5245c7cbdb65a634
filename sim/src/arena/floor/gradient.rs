//! Gradients of SVG: which colour a place has.
//!
//! Owns their geometry and the way from stop to stop. Knows no outlines.

use super::colour::Tint;
use super::outline::Affine;

/// How a gradient lies in its own coordinates.
#[derive(Clone, Copy, Debug)]
enum Form {
    /// From one point to another.
    Linear([f64; 2], [f64; 2]),
    /// From a focus to a circle around a centre.
    Radial {
        centre: [f64; 2],
        radius: f64,
        focus: [f64; 2],
    },
}

/// A gradient.
#[derive(Clone, Debug)]
pub struct Gradient {
    form: Form,
    spread: usvg::SpreadMethod,
    /// Where, from 0 to 1, and what; there is at least one.
    stops: Vec<(f64, Tint)>,
    /// From its coordinates to the square of the picture, or to the scene.
    place: Affine,
    /// The way back.
    back: Affine,
}

fn byte(value: f64) -> u8 {
    value.round().clamp(0.0, 255.0) as u8
}

impl Gradient {
    /// The gradient of a paint whose path goes to its place by `to`; nothing for other paints, and for those that have no
    /// colours or no size.
    pub fn of(paint: &usvg::Paint, opacity: f32, to: &Affine) -> Option<Self> {
        let pair = |x: f32, y: f32| [f64::from(x), f64::from(y)];
        let (form, base) = match paint {
            usvg::Paint::LinearGradient(one) => {
                let ends = (pair(one.x1(), one.y1()), pair(one.x2(), one.y2()));
                (Form::Linear(ends.0, ends.1), &***one)
            }
            usvg::Paint::RadialGradient(one) => {
                let form = Form::Radial {
                    centre: pair(one.cx(), one.cy()),
                    radius: f64::from(one.r().get()),
                    focus: pair(one.fx(), one.fy()),
                };
                (form, &***one)
            }
            usvg::Paint::Color(_) | usvg::Paint::Pattern(_) => return None,
        };
        let stops = base.stops().iter().map(|stop| {
            let colour = stop.color();
            let tint = Tint {
                rgb: [colour.red, colour.green, colour.blue],
                opacity: byte(f64::from(stop.opacity().get() * opacity) * 255.0),
            };
            (f64::from(stop.offset().get()), tint)
        });
        let stops: Vec<_> = stops.collect();
        let own = base.transform();
        let own = [own.sx, own.ky, own.kx, own.sy, own.tx, own.ty].map(f64::from);
        let place = Affine(own).then(to);
        let gradient = Self {
            form,
            spread: base.spread_method(),
            stops,
            place,
            back: place.inverse()?,
        };
        (!gradient.stops.is_empty()).then_some(gradient)
    }

    /// The same where the square of its picture is at `place`.
    pub fn at(&self, place: &Affine) -> Option<Self> {
        let place = self.place.then(place);
        Some(Self {
            place,
            back: place.inverse()?,
            ..self.clone()
        })
    }

    /// The colour of a place.
    pub fn tint(&self, x: f64, y: f64) -> Tint {
        let (x, y) = self.back.apply(x, y);
        let far = match self.form {
            Form::Linear(from, to) => along(from, to, [x, y]),
            Form::Radial {
                centre,
                radius,
                focus,
            } => outwards(centre, radius, focus, [x, y]),
        };
        self.stop(match self.spread {
            usvg::SpreadMethod::Pad => far.clamp(0.0, 1.0),
            usvg::SpreadMethod::Repeat => far.rem_euclid(1.0),
            usvg::SpreadMethod::Reflect => 1.0 - (far.rem_euclid(2.0) - 1.0).abs(),
        })
    }

    /// The colour of a part of the way.
    fn stop(&self, far: f64) -> Tint {
        let next = self.stops.iter().position(|(offset, _)| *offset > far);
        let next = next.unwrap_or(self.stops.len());
        let before = next.checked_sub(1).and_then(|at| self.stops.get(at));
        match (before, self.stops.get(next)) {
            (Some((low, one)), Some((high, other))) => {
                let share = (far - low) / (high - low);
                let mixed = |one: u8, other: u8| {
                    byte(f64::from(one) + (f64::from(other) - f64::from(one)) * share)
                };
                Tint {
                    rgb: std::array::from_fn(|part| mixed(one.rgb[part], other.rgb[part])),
                    opacity: mixed(one.opacity, other.opacity),
                }
            }
            (Some((_, only)), None) | (None, Some((_, only))) => *only,
            (None, None) => Tint::solid([0; 3]),
        }
    }
}

/// How far along a line a point is; without a line it is beyond its end.
fn along(from: [f64; 2], to: [f64; 2], at: [f64; 2]) -> f64 {
    let way = [to[0] - from[0], to[1] - from[1]];
    let length = way[0] * way[0] + way[1] * way[1];
    let far = ((at[0] - from[0]) * way[0] + (at[1] - from[1]) * way[1]) / length;
    if far.is_finite() { far } else { 1.0 }
}

/// How far from a focus to a circle a point is.
fn outwards(centre: [f64; 2], radius: f64, focus: [f64; 2], at: [f64; 2]) -> f64 {
    let [fx, fy] = [focus[0] - centre[0], focus[1] - centre[1]];
    let [dx, dy] = [at[0] - focus[0], at[1] - focus[1]];
    // The circle through the point has its centre on the way from the focus, at the same share as its radius:
    // |d + t * f| = t * r, with t to be found.
    let a = fx * fx + fy * fy - radius * radius;
    let b = dx * fx + dy * fy;
    let c = dx * dx + dy * dy;
    if c == 0.0 {
        return 0.0;
    }
    let root = (b * b - a * c).max(0.0).sqrt();
    // A focus within the circle makes `a` negative, and then one share is positive.
    let far = (-b - root) / a;
    if far.is_finite() { far.max(0.0) } else { 1.0 }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn gradient(form: Form, spread: usvg::SpreadMethod) -> Gradient {
        Gradient {
            form,
            spread,
            stops: vec![
                (0.0, Tint::solid([0; 3])),
                (0.5, Tint::solid([100, 0, 0])),
                (1.0, Tint::solid([200, 50, 0])),
            ],
            place: Affine::SAME,
            back: Affine::SAME,
        }
    }

    #[test]
    fn a_linear_gradient_goes_from_stop_to_stop() {
        let form = Form::Linear([0.0, 0.0], [10.0, 0.0]);
        let pad = gradient(form, usvg::SpreadMethod::Pad);
        for (x, red) in [
            (-5.0, 0),
            (0.0, 0),
            (2.5, 50),
            (5.0, 100),
            (7.5, 150),
            (99.0, 200),
        ] {
            assert_eq!(pad.tint(x, 3.0).rgb[0], red, "{x}");
        }
        let repeat = gradient(form, usvg::SpreadMethod::Repeat);
        assert_eq!(repeat.tint(12.5, 0.0).rgb[0], 50);
        let reflect = gradient(form, usvg::SpreadMethod::Reflect);
        assert_eq!(reflect.tint(12.5, 0.0).rgb[0], 150);
        let nothing = Form::Linear([1.0, 1.0], [1.0, 1.0]);
        let nothing = gradient(nothing, usvg::SpreadMethod::Pad);
        assert_eq!(nothing.tint(0.0, 0.0).rgb, [200, 50, 0]);
    }

    #[test]
    fn a_radial_gradient_goes_outwards_from_its_focus() {
        let form = |focus| Form::Radial {
            centre: [0.0, 0.0],
            radius: 10.0,
            focus,
        };
        let even = gradient(form([0.0, 0.0]), usvg::SpreadMethod::Pad);
        for (x, red) in [(0.0, 0), (2.5, 50), (-5.0, 100), (10.0, 200), (30.0, 200)] {
            assert_eq!(even.tint(x, 0.0).rgb[0], red, "{x}");
        }
        let aside = gradient(form([5.0, 0.0]), usvg::SpreadMethod::Pad);
        // From the focus at 5 to the circle at 10 and at -10.
        for (x, red) in [(5.0, 0), (7.5, 100), (10.0, 200), (-2.5, 100), (-10.0, 200)] {
            assert_eq!(aside.tint(x, 0.0).rgb[0], red, "{x}");
        }
    }
}
