//! Pictures in SVG: tags around tags, values that cannot leave their place, numbers with the digits that a picture needs.
//!
//! Owns the first tag, the nesting, and how texts and numbers are written: each tag on a line of its own. Knows no picture.

use crate::escape;
use std::fmt::{self, Display, Write};

/// What the first tag says of a picture.
#[derive(Clone, Copy, Debug)]
pub struct View {
    /// Left, top, width and height of what is shown.
    pub frame: [f64; 4],
    /// Digits of these numbers.
    pub digits: usize,
    /// Whether the picture has that width and height of its own, or takes the room that it is given.
    pub is_sized: bool,
}

/// A picture while it is written.
#[derive(Debug, Default)]
pub struct Svg {
    text: String,
    /// Tags that have begun, the innermost last.
    open: Vec<&'static str>,
}

impl Svg {
    /// Nothing yet.
    pub fn new() -> Self {
        Self::default()
    }

    /// Begins the first tag.
    pub fn picture(&mut self, view: View) -> Tag<'_> {
        let View {
            frame: [x, y, width, height],
            digits,
            is_sized,
        } = view;
        let mut tag = self.tag("svg").with("xmlns", "http://www.w3.org/2000/svg");
        if is_sized {
            tag = tag.numbers(digits, [("width", width), ("height", height)]);
        }
        let [x, y, width, height] = [x, y, width, height].map(finite);
        tag.with(
            "viewBox",
            format_args!("{x:.digits$} {y:.digits$} {width:.digits$} {height:.digits$}"),
        )
    }

    /// Begins a tag.
    pub fn tag(&mut self, name: &'static str) -> Tag<'_> {
        self.text.push('<');
        self.text.push_str(name);
        Tag { svg: self, name }
    }

    /// Tags that are part of the program.
    pub fn raw(&mut self, tags: &'static str) {
        self.text.push_str(tags);
    }

    /// Ends the innermost tag that was opened.
    pub fn end(&mut self) {
        if let Some(name) = self.open.pop() {
            self.text.push_str("</");
            self.text.push_str(name);
            self.text.push_str(">\n");
        }
    }

    /// Ends all tags; gives the text.
    pub fn finish(mut self) -> String {
        while !self.open.is_empty() {
            self.end();
        }
        self.text
    }
}

/// A tag whose values are written; one of [`close`](Self::close), [`text`](Self::text) and [`open`](Self::open) ends it.
#[derive(Debug)]
#[must_use = "a tag has no end yet"]
pub struct Tag<'a> {
    svg: &'a mut Svg,
    name: &'static str,
}

impl Tag<'_> {
    /// A value.
    pub fn with(self, name: &'static str, value: impl Display) -> Self {
        self.value(name, |out| {
            let _ = write!(out, "{value}");
        })
    }

    /// Several values that are words.
    pub fn style(self, values: &[(&'static str, &str)]) -> Self {
        values
            .iter()
            .fold(self, |tag, &(name, value)| tag.with(name, value))
    }

    /// Numbers with so many digits; one without an end is 0.
    pub fn numbers<const COUNT: usize>(
        self,
        digits: usize,
        values: [(&'static str, f64); COUNT],
    ) -> Self {
        values.into_iter().fold(self, |tag, (name, value)| {
            tag.with(name, format_args!("{:.digits$}", finite(value)))
        })
    }

    /// Corners of a line, with one digit.
    pub fn points(self, points: impl IntoIterator<Item = (f64, f64)>) -> Self {
        self.value("points", |out| {
            for (index, (x, y)) in points.into_iter().enumerate() {
                let space = if index == 0 { "" } else { " " };
                let _ = write!(out, "{space}{:.1},{:.1}", finite(x), finite(y));
            }
        })
    }

    /// Steps of a pen: `M` goes to a place, `L` draws up to it.
    pub fn path(self, digits: usize, steps: impl IntoIterator<Item = (char, (f64, f64))>) -> Self {
        self.value("d", |out| {
            for (sign, (x, y)) in steps {
                let (x, y) = (finite(x), finite(y));
                let _ = write!(out, "{sign}{x:.digits$} {y:.digits$}");
            }
        })
    }

    /// A surface between corners.
    pub fn outline(self, digits: usize, corners: impl IntoIterator<Item = (f64, f64)>) -> Self {
        self.value("d", |out| {
            let mut sign = 'M';
            for (x, y) in corners {
                let (x, y) = (finite(x), finite(y));
                let _ = write!(out, "{sign}{x:.digits$} {y:.digits$}");
                sign = 'L';
            }
            let _ = out.write_char('Z');
        })
    }

    fn value(self, name: &'static str, write: impl FnOnce(&mut Escaping<'_>)) -> Self {
        let text = &mut self.svg.text;
        text.push(' ');
        text.push_str(name);
        text.push_str("=\"");
        write(&mut Escaping(text));
        text.push('"');
        self
    }

    /// Nothing is in it.
    pub fn close(self) {
        self.svg.text.push_str("/>\n");
    }

    /// A text is in it.
    pub fn text(self, text: impl Display) {
        let out = &mut self.svg.text;
        out.push('>');
        let _ = write!(Escaping(out), "{text}");
        out.push_str("</");
        out.push_str(self.name);
        out.push_str(">\n");
    }

    /// What follows is in it, until [`Svg::end`].
    pub fn open(self) {
        self.svg.text.push_str(">\n");
        self.svg.open.push(self.name);
    }
}

/// Writes signs so that they stand for themselves.
struct Escaping<'a>(&'a mut String);

impl Write for Escaping<'_> {
    fn write_str(&mut self, text: &str) -> fmt::Result {
        escape::push(self.0, text);
        Ok(())
    }
}

fn finite(number: f64) -> f64 {
    if number.is_finite() { number } else { 0.0 }
}

#[cfg(test)]
mod tests {
    use super::*;

    const VIEW: View = View {
        frame: [-1.0, 0.5, 20.0, f64::INFINITY],
        digits: 1,
        is_sized: true,
    };

    #[test]
    fn a_picture_is_what_was_written_with_all_tags_ended() {
        let mut svg = Svg::new();
        svg.picture(VIEW).with("font-size", 14).open();
        svg.tag("g")
            .style(&[("class", "a"), ("fill", "red")])
            .open();
        svg.tag("rect")
            .numbers(0, [("x", 1.6), ("y", f64::NAN)])
            .close();
        svg.end();
        svg.raw("<defs/>\n");
        svg.tag("g").open();
        svg.tag("polyline")
            .points([(0.0, 1.25), (-2.0, 1e3)])
            .close();
        svg.tag("path")
            .path(2, [('M', (0.0, 1.0)), ('L', (f64::INFINITY, 2.125))])
            .close();
        svg.tag("path")
            .outline(0, [(0.0, 0.0), (4.0, 0.0), (0.0, 3.0)])
            .close();
        svg.tag("text").text("say");
        let wanted = "\
<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"20.0\" height=\"0.0\" viewBox=\"-1.0 0.5 20.0 0.0\" font-size=\"14\">
<g class=\"a\" fill=\"red\">
<rect x=\"2\" y=\"0\"/>
</g>
<defs/>
<g>
<polyline points=\"0.0,1.2 -2.0,1000.0\"/>
<path d=\"M0.00 1.00L0.00 2.12\"/>
<path d=\"M0 0L4 0L0 3Z\"/>
<text>say</text>
</g>
</svg>
";
        assert_eq!(svg.finish(), wanted);
    }

    #[test]
    fn no_value_and_no_text_can_leave_its_place() {
        let nasty = "\"/></text><script>alert(1)</script>&\u{0}";
        let mut svg = Svg::new();
        svg.picture(VIEW).with("font-family", nasty).open();
        svg.tag("text").style(&[("fill", nasty)]).text(nasty);
        let text = svg.finish();
        assert!(!text.contains("<script") && !text.contains('\0'), "{text}");
        let root = crate::xml::parse(&text).unwrap();
        let inner = root.child("text").unwrap();
        assert_eq!(inner.attribute("fill"), Some(&*nasty.replace('\0', " ")));
        assert_eq!(root.nodes.len(), 1);
    }

    #[test]
    fn an_end_too_many_ends_nothing() {
        let mut svg = Svg::new();
        svg.end();
        svg.tag("g").open();
        svg.end();
        svg.end();
        assert_eq!(svg.finish(), "<g>\n</g>\n");
    }
}
