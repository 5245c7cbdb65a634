//! A plot of lines as SVG text.

use lang_text::svg::{Svg, Tag, View};

/// Size of the picture and of its margins in pixels.
const SIZE: (f64, f64) = (680.0, 280.0);
const LEFT: f64 = 56.0;
const TOP: f64 = 34.0;
const RIGHT: f64 = 12.0;
const BOTTOM: f64 = 38.0;

/// What a line shows, and so how it is drawn.
#[derive(Clone, Copy, PartialEq, Eq)]
pub enum Role {
    /// What went in.
    Raw,
    /// What came out.
    Filtered,
    /// What is true.
    Truth,
    /// Something to compare with.
    Other,
}

impl Role {
    fn put(self, tag: Tag<'_>) -> Tag<'_> {
        match self {
            Self::Raw => tag.style(&[("stroke", "#b0b0b0"), ("stroke-width", "1")]),
            Self::Filtered => tag.style(&[("stroke", "#0057b8"), ("stroke-width", "2")]),
            Self::Truth => tag.style(&[
                ("stroke", "#2e8b57"),
                ("stroke-width", "1.5"),
                ("stroke-dasharray", "6 3"),
            ]),
            Self::Other => tag.style(&[("stroke", "#d2691e"), ("stroke-width", "1.2")]),
        }
    }
}

/// One line.
pub struct Line {
    /// How it is drawn.
    pub role: Role,
    /// What the legend says.
    pub label: &'static str,
    /// Its points.
    pub points: Vec<(f64, f64)>,
}

/// A plot.
pub struct Plot {
    /// What stands above it.
    pub title: &'static str,
    /// Name and unit of the two axes.
    pub axes: (&'static str, &'static str),
    /// True if a unit is as long to the side as upwards, as on a map.
    pub is_map: bool,
    /// The lines, the last one on top.
    pub lines: Vec<Line>,
}

impl Plot {
    /// An empty plot over time.
    pub fn new(title: &'static str, unit: &'static str) -> Self {
        let axes = ("time, s", unit);
        Self {
            title,
            axes,
            is_map: false,
            lines: Vec::new(),
        }
    }

    /// The plot with one more line.
    pub fn line(mut self, role: Role, label: &'static str, points: Vec<(f64, f64)>) -> Self {
        self.lines.push(Line {
            role,
            label,
            points,
        });
        self
    }

    /// Mean squares by which the raw and the filtered line miss the truth, over the points that both have; absent if one
    /// of the three lines is missing.
    pub fn errors(&self) -> Option<(f64, f64)> {
        let find = |role| self.lines.iter().find(|line| line.role == role);
        let (raw, filtered, truth) = (find(Role::Raw)?, find(Role::Filtered)?, find(Role::Truth)?);
        let squares = |line: &Line| {
            let near = line.points.iter().filter_map(|(x, y)| {
                let (_, true_y) = truth.points.iter().find(|(true_x, _)| true_x == x)?;
                Some((y - true_y) * (y - true_y))
            });
            let squares: Vec<f64> = near.collect();
            squares.iter().sum::<f64>() / squares.len() as f64
        };
        (!self.is_map).then(|| (squares(raw), squares(filtered)))
    }

    /// Least and greatest x and y, with some air above and below.
    fn range(&self) -> [f64; 4] {
        let all = || self.lines.iter().flat_map(|line| &line.points);
        let least = |values: &mut dyn Iterator<Item = f64>| values.fold(f64::MAX, f64::min);
        let greatest = |values: &mut dyn Iterator<Item = f64>| values.fold(f64::MIN, f64::max);
        let (x0, x1) = (
            least(&mut all().map(|p| p.0)),
            greatest(&mut all().map(|p| p.0)),
        );
        let (y0, y1) = (
            least(&mut all().map(|p| p.1)),
            greatest(&mut all().map(|p| p.1)),
        );
        let air = (y1 - y0) * 0.05;
        let (y0, y1) = (y0 - air, y1 + air);
        if !self.is_map {
            return [x0, x1, y0, y1];
        }
        let (width, height) = (SIZE.0 - LEFT - RIGHT, SIZE.1 - TOP - BOTTOM);
        let unit = ((x1 - x0) / width).max((y1 - y0) / height);
        let (x, y) = ((x0 + x1) / 2.0, (y0 + y1) / 2.0);
        let (half_x, half_y) = (unit * width / 2.0, unit * height / 2.0);
        [x - half_x, x + half_x, y - half_y, y + half_y]
    }

    /// The picture.
    pub fn svg(&self) -> String {
        let [x0, x1, y0, y1] = self.range();
        let (width, height) = (SIZE.0 - LEFT - RIGHT, SIZE.1 - TOP - BOTTOM);
        let x_at = |x: f64| LEFT + (x - x0) / (x1 - x0) * width;
        let y_at = |y: f64| TOP + (y1 - y) / (y1 - y0) * height;
        let mut svg = Svg::new();
        let view = View {
            frame: [0.0, 0.0, SIZE.0, SIZE.1],
            digits: 0,
            is_sized: true,
        };
        svg.picture(view)
            .style(&[("font-family", "sans-serif"), ("font-size", "12")])
            .open();
        svg.tag("title").text(self.title);
        svg.tag("rect")
            .numbers(0, [("width", SIZE.0), ("height", SIZE.1)])
            .with("fill", "#ffffff")
            .close();
        let grid = |svg: &mut Svg, path: std::fmt::Arguments<'_>| {
            svg.tag("path")
                .with("d", path)
                .with("stroke", "#eeeeee")
                .close();
        };
        let text = |svg: &mut Svg, x: f64, y: f64, anchor: &str, text: &dyn std::fmt::Display| {
            svg.tag("text")
                .numbers(1, [("x", x), ("y", y)])
                .with("text-anchor", anchor)
                .text(text);
        };
        for x in ticks(x0, x1) {
            let at = x_at(x);
            let (top, low) = (TOP, TOP + height);
            grid(&mut svg, format_args!("M{at:.1} {top}V{low}"));
            text(&mut svg, at, low + 15.0, "middle", &x);
        }
        for y in ticks(y0, y1) {
            let at = y_at(y);
            let right = LEFT + width;
            grid(&mut svg, format_args!("M{LEFT} {at:.1}H{right}"));
            text(&mut svg, LEFT - 5.0, at + 4.0, "end", &y);
        }
        let (middle, low) = (LEFT + width / 2.0, SIZE.1 - 6.0);
        text(&mut svg, middle, low, "middle", &self.axes.0);
        let label = |svg: &mut Svg, x: f64, label: &str| {
            svg.tag("text").with("x", x).with("y", 16).text(label);
        };
        label(&mut svg, 6.0, self.axes.1);
        for (index, line) in self.lines.iter().enumerate() {
            let points = line.points.iter().map(|(x, y)| (x_at(*x), y_at(*y)));
            let tag = svg.tag("polyline").with("fill", "none");
            line.role.put(tag).points(points).close();
            let at = LEFT + 70.0 + 180.0 * index as f64;
            let tag = svg.tag("path").with("d", format_args!("M{at} 12h22"));
            line.role.put(tag).close();
            label(&mut svg, at + 27.0, line.label);
        }
        svg.finish()
    }
}

/// Round numbers between two others, about five.
fn ticks(from: f64, to: f64) -> Vec<f64> {
    let mut step = 1e-6;
    // 1, 2, 5, 10, ...: multiplied, because powers are not the same on every processor.
    let mut factors = [2.0, 2.5, 2.0].iter().cycle();
    while (to - from) / step > 7.0 {
        step *= factors.next().unwrap_or(&2.0);
    }
    let first = (from / step).ceil() as i64;
    let last = (to / step).floor() as i64;
    (first..=last)
        .map(|n| (n as f64 * step * 1e6).round() / 1e6)
        .collect()
}
