//! A solution as a picture: the path seen from above, and what changes with time.
//!
//! Owns the layout.

use super::table::{Column, Table};
use crate::chart::{self, Panel};
use crate::limits;
use lang_text::svg::Svg;

/// Size of the path's panel and of those below it, without their margins, in px.
const PATH: (f64, f64) = (560.0, 400.0);
const PANEL: (f64, f64) = (560.0, 90.0);
const LEFT: f64 = 70.0;
const TOP: f64 = 34.0;
const RIGHT: f64 = 20.0;
const BOTTOM: f64 = 36.0;

/// The picture.
pub(super) fn svg(title: &str, table: &Table) -> String {
    let names = table.columns.iter().skip(1);
    let shown = (table.columns.len() - 1).min(limits::DCML_PANELS_MAX);
    let find = |name: &str| {
        names
            .clone()
            .take(table.configs)
            .position(|one| one.name == name)
    };
    let path = find("x")
        .zip(find("y"))
        .or((table.configs >= 2).then_some((0, 1)));
    let mut top = TOP + 10.0;
    let below_path = top + path.map_or(0.0, |_| PATH.1 + BOTTOM + TOP);
    let each = PANEL.1 + BOTTOM + 16.0;
    let (width, height) = (LEFT + PATH.0 + RIGHT, below_path + each * shown as f64);
    let mut svg = chart::sheet(title, width, height);
    if let Some((x, y)) = path {
        draw_path(&mut svg, table, (x + 1, y + 1), top);
        top = below_path;
    }
    for (at, column) in names.clone().enumerate().take(shown) {
        let panel = Panel {
            left: LEFT,
            top,
            size: PANEL,
            across: range(table, 0),
            upwards: range(table, at + 1),
        };
        let is_last = at + 1 == shown;
        let across = if is_last { "t, s" } else { "" };
        panel.frame(&mut svg, across, &label(column));
        let points = table.rows.iter().map(|row| (row[0], row[at + 1]));
        panel.line(&mut svg, points, column.is_circle);
        top += each;
    }
    svg.finish()
}

/// The path, as long to the side as upwards, with its begin and its end.
fn draw_path(svg: &mut Svg, table: &Table, (x, y): (usize, usize), top: f64) {
    let (across, upwards) = (range(table, x), range(table, y));
    let unit = ((across.1 - across.0) / PATH.0).max((upwards.1 - upwards.0) / PATH.1);
    let around = |(from, to): (f64, f64), size: f64| {
        let (middle, half) = (from / 2.0 + to / 2.0, unit * size / 2.0);
        (middle - half, middle + half)
    };
    let panel = Panel {
        left: LEFT,
        top,
        size: PATH,
        across: around(across, PATH.0),
        upwards: around(upwards, PATH.1),
    };
    let label = |at: usize| label(&table.columns[at]);
    let upwards = format!("{} over {}", label(y), label(x));
    panel.frame(svg, &label(x), &upwards);
    panel.line(svg, table.rows.iter().map(|row| (row[x], row[y])), false);
    let ends = [
        (table.rows.first(), "#2e8b57"),
        (table.rows.last(), "#c0392b"),
    ];
    for (row, colour) in ends {
        if let Some(row) = row.filter(|row| row[x].is_finite() && row[y].is_finite()) {
            let (at, down) = panel.point(row[x], row[y]);
            svg.tag("circle")
                .numbers(2, [("cx", at), ("cy", down)])
                .style(&[("r", "4"), ("fill", colour)])
                .close();
        }
    }
}

/// Least and greatest number of a column with some air.
fn range(table: &Table, column: usize) -> (f64, f64) {
    let air = if column == 0 { 1.0 } else { 1.05 };
    chart::range(table.rows.iter().map(|row| row[column]), air)
}

fn label(column: &Column) -> String {
    let unit = column.unit.as_ref().map(|unit| format!(", {unit}"));
    format!("{}{}", column.name, unit.unwrap_or_default())
}

#[cfg(test)]
mod tests {
    use super::*;

    fn table(names: &[&str], rows: Vec<Vec<f64>>) -> Table {
        let column = |name: &&str| Column {
            name: (*name).to_owned(),
            unit: Some("<m>".into()),
            is_circle: *name == "theta",
        };
        Table {
            columns: names.iter().map(column).collect(),
            configs: names.len() - 1,
            rows,
        }
    }

    #[test]
    fn a_path_has_its_shape_and_angles_their_gaps() {
        let rows = vec![
            vec![0.0, 0.0, 0.0, 3.0],
            vec![1.0, 1.0, 0.0, -3.0],
            vec![2.0, 1.0, 1.0, -2.0],
        ];
        let svg = svg("A & B", &table(&["t", "x", "y", "theta"], rows));
        assert!(svg.contains("<title>A &amp; B</title>"));
        assert!(svg.contains("x, &lt;m&gt;"));
        let lines: Vec<&str> = svg.split("class=\"l\" d=\"").skip(1).collect();
        assert_eq!(lines.len(), 4, "the path and three panels");
        let signs = |line: &str| -> String {
            let path = line.split('"').next().unwrap_or_default();
            path.chars().filter(|sign| sign.is_alphabetic()).collect()
        };
        assert_eq!(signs(lines[0]), "MLL");
        assert_eq!(signs(lines[3]), "MML");
        insta::assert_snapshot!("plot", svg);
    }

    #[test]
    fn strange_numbers_make_no_strange_picture() {
        for rows in [
            vec![vec![0.0, 1e308, -1e308], vec![1.0, -1e308, 1e308]],
            vec![vec![0.0, 5.0, f64::NAN]],
            vec![vec![0.0, 5.0, f64::INFINITY], vec![1.0, 5.0, 1.0]],
            vec![vec![0.0, 1e300, 1e-300], vec![1.0, 1e300, 2e-300]],
        ] {
            let svg = svg("Wide", &table(&["t", "x", "y"], rows));
            let is_whole = !svg.contains("inf") && !svg.contains("NaN") && svg.len() < 20_000;
            assert!(is_whole, "{svg}");
        }
    }
}
