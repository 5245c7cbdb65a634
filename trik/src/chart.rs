//! Panels of a picture with axes: a frame, round numbers at its edges, and lines in it.
//!
//! Owns how numbers become places. Where panels stand and what is in them is known to the callers.

use lang_text::svg::{Svg, View};
use std::fmt::{Arguments, Display};

/// A rectangle of the picture, and the numbers at its edges.
pub(crate) struct Panel {
    pub left: f64,
    pub top: f64,
    pub size: (f64, f64),
    pub across: (f64, f64),
    pub upwards: (f64, f64),
}

/// A white sheet with the name and the style of all charts, on which panels are drawn.
pub(crate) fn sheet(title: &str, width: f64, height: f64) -> Svg {
    let mut svg = Svg::new();
    let view = View {
        frame: [0.0, 0.0, width, height],
        digits: 0,
        is_sized: true,
    };
    svg.picture(view)
        .style(&[("font-family", "sans-serif"), ("font-size", "12")])
        .open();
    svg.tag("title").text(title);
    svg.raw(STYLE);
    svg.tag("rect")
        .numbers(0, [("width", width), ("height", height)])
        .with("fill", "#ffffff")
        .close();
    svg
}

impl Panel {
    /// A place in it.
    pub fn point(&self, x: f64, y: f64) -> (f64, f64) {
        let part = |number: f64, (from, to): (f64, f64)| (number - from) / (to - from);
        (
            self.left + part(x, self.across) * self.size.0,
            self.top + (1.0 - part(y, self.upwards)) * self.size.1,
        )
    }

    /// Frame, numbers at the edges, names of the axes.
    pub fn frame(&self, svg: &mut Svg, across: &str, upwards: &str) {
        let (left, top, (width, height)) = (self.left, self.top, self.size);
        for x in ticks(self.across) {
            let (at, _) = self.point(x, 0.0);
            let low = top + height;
            grid(svg, format_args!("M{at:.1} {top}V{low}"));
            text(svg, (at, low + 14.0), "middle", short(x));
        }
        for y in ticks(self.upwards) {
            let (_, at) = self.point(0.0, y);
            grid(svg, format_args!("M{left} {at:.1}h{width}"));
            text(svg, (left - 5.0, at + 4.0), "end", short(y));
        }
        svg.tag("rect")
            .with("x", left)
            .with("y", top)
            .with("width", width)
            .with("height", height)
            .with("class", "f")
            .close();
        svg.tag("text")
            .with("x", left)
            .numbers(1, [("y", top - 7.0)])
            .with("font-weight", "bold")
            .text(upwards);
        text(svg, (left + width, top + height + 28.0), "end", across);
    }

    /// A line through points; angles are not drawn across where they wrap, nor anything across what is no number.
    pub fn line(&self, svg: &mut Svg, points: impl Iterator<Item = (f64, f64)>, is_circle: bool) {
        self.line_of("l", svg, points, is_circle);
    }

    /// The same for a line beside another one, with which it is compared.
    pub fn line_before(&self, svg: &mut Svg, points: impl Iterator<Item = (f64, f64)>) {
        self.line_of("b", svg, points, false);
    }

    fn line_of(
        &self,
        class: &str,
        svg: &mut Svg,
        points: impl Iterator<Item = (f64, f64)>,
        is_circle: bool,
    ) {
        let mut last: Option<f64> = None;
        let steps = points.filter_map(|(x, y)| {
            if !(x.is_finite() && y.is_finite()) {
                last = None;
                return None;
            }
            let wraps =
                last.is_some_and(|last| is_circle && (y - last).abs() > std::f64::consts::PI);
            let sign = if last.is_none() || wraps { 'M' } else { 'L' };
            last = Some(y);
            Some((sign, self.point(x, y)))
        });
        svg.tag("path").with("class", class).path(2, steps).close();
    }
}

fn grid(svg: &mut Svg, path: Arguments<'_>) {
    svg.tag("path").with("class", "g").with("d", path).close();
}

fn text(svg: &mut Svg, (x, y): (f64, f64), anchor: &str, text: impl Display) {
    svg.tag("text")
        .numbers(1, [("x", x), ("y", y)])
        .with("text-anchor", anchor)
        .text(text);
}

/// How its lines look.
const STYLE: &str = "<style>.g{stroke:#e8e8e8;fill:none}.f{stroke:#808080;fill:none}\
    .l{stroke:#0057b8;stroke-width:1.6;fill:none}</style>\n";

/// Least and greatest of numbers, with some air around them; never nothing, and never without an end.
pub(crate) fn range(numbers: impl Iterator<Item = f64>, air: f64) -> (f64, f64) {
    let finite = numbers.filter(|one| one.is_finite());
    let (from, to) = finite.fold((f64::INFINITY, f64::NEG_INFINITY), |(from, to), one| {
        (from.min(one), to.max(one))
    });
    if from > to {
        return (-1.0, 1.0);
    }
    // Halves, so that the widest range has a size.
    let (middle, half) = (from / 2.0 + to / 2.0, to / 2.0 - from / 2.0);
    let least = (middle.abs() * 1e-9).max(1e-6);
    let half = if half < least {
        1.0_f64.max(least)
    } else {
        half * air
    };
    let end = f64::MAX / 4.0;
    ((middle - half).max(-end), (middle + half).min(end))
}

/// Round numbers within a range, about five.
pub(crate) fn ticks((from, to): (f64, f64)) -> Vec<f64> {
    let rough = (to - from) / 5.0;
    let power = 10.0_f64.powf(rough.log10().floor());
    let step = [1.0, 2.0, 5.0, 10.0]
        .into_iter()
        .map(|one| one * power)
        .find(|one| *one >= rough)
        .unwrap_or(rough);
    let first = (from / step).ceil();
    let all = (0..20).map(|at| (first + f64::from(at)) * step);
    all.take_while(|one| *one <= to).collect()
}

/// A number of an axis.
pub(crate) fn short(number: f64) -> String {
    if number != 0.0 && (number.abs() >= 1e6 || number.abs() < 1e-4) {
        return format!("{number:.2e}");
    }
    let text = format!("{number:.6}");
    let text = text.trim_end_matches('0').trim_end_matches('.');
    if text == "-0" {
        "0".into()
    } else {
        text.into()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn axes_have_round_numbers() {
        assert_eq!(ticks((0.0, 10.0)), [0.0, 2.0, 4.0, 6.0, 8.0, 10.0]);
        assert_eq!(short(-0.5), "-0.5");
        assert_eq!(short(0.0), "0");
        assert_eq!(short(1.5e7), "1.50e7");
    }
}
