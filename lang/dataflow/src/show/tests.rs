//! Sentences and pictures of small projects, with friendly and hostile texts.

use super::{Extent, Looks};
use crate::blocks;
use crate::project::{Edge, End, Project};
use crate::text;
use lang_text::problem::Locale;

fn project(source: &str) -> Project {
    text::read(source).unwrap_or_else(|problems| panic!("{problems:?}"))
}

fn sentences(project: &Project, locale: Locale) -> String {
    super::sentences(project, Extent::default(), locale)
}

/// The picture of one diagram, if no other one is drawn.
fn picture(project: &Project, diagram: usize, locale: Locale) -> String {
    super::picture(project, diagram, locale, &mut Looks::default())
}

/// A program in which there is one of all.
const SMALL: &str = "\
diagram \"Wall follower\"
  A: Sensor(VarName = sensorD1)
  F: \"Text programming\"(IO0 = `u = max(0-30, min(30, 2*(I0-20)))`, IO1 = `50 - u`, synch = true)
  C: If(condition = `data < 25`) named \"Near?\"
  call: \"User block\" of \"Avoid\"
  wait1: \"Wait and send\"(time = 100) named \"\"
  wait2: \"Wait and send\"(time = \"\", \"later\" = true) named \"\"
  M: Motors(synch = true, M3Power = 0) named Motors
  X: unknown \"FutureBlock\" named X
  A.OUT -> F.I0
  A.OUT -> C.DATA
  C.TRUE -> call.I0
  C.FALSE -> wait1.CF_IN
  wait1.CF_OUT -> wait2.CF_IN capacity 3
  F.O1 -> M.M3 latest
  call.O0 -> M.M4 fifo 16
  wait2.CF_OUT -> X.4 error
  X.9 -> nowhere
  nowhere -> M.CF_IN

diagram \"Other\"
  S: Stop

subprogram \"Avoid\"
  I: \"Input port\"
  O: \"Output port\"
  I.OUT -> O.DATA
  lost: \"User block\" of id \"qrm:/gone\"
";

#[test]
fn sentences_say_what_blocks_are_and_where_tokens_go() {
    let said = sentences(&project(SMALL), Locale::English);
    insta::assert_snapshot!("sentences", said);
}

#[test]
fn sentences_are_in_russian_too() {
    let said = sentences(&project(SMALL), Locale::Russian);
    insta::assert_snapshot!("sentences_in_russian", said);
}

#[test]
fn properties_that_have_their_defaults_are_said_if_they_are_asked_for() {
    let project = project(
        "diagram a\n W: \"Wait and send\"\n M: Motors(M3Power = 7)\n F: \"Text programming\"(IO0 = 1)\n",
    );
    let full = Extent {
        with_defaults: true,
        from: None,
    };
    assert_eq!(
        super::sentences(&project, full, Locale::English),
        "Program \"a\":\n  W - Wait and send: time = 300, keep = no\n  \
         M - Motors: synchronized = no, M1 = 0, M2 = 0, M3 = 7, M4 = 50\n  \
         F - Text programming: synchronized = yes, IO0 = 1\n"
    );
    let said = sentences(&project, Locale::English);
    assert!(said.contains("  W - Wait and send\n"), "{said}");
    assert!(said.contains("  M - Motors: M3 = 7\n"), "{said}");
}

#[test]
fn diagrams_that_are_not_run_are_said_too_and_one_can_be_asked_for() {
    let project = project(
        "diagram main\n C: \"User block\" of used\n\nsubprogram used\n S: Say\n\n\
         subprogram lonely\n D: \"User block\" of deep\n\nsubprogram deep\n W: \"Wait and send\"(time = 7)\n",
    );
    let said = sentences(&project, Locale::English);
    let heads: Vec<&str> = said.lines().filter(|line| line.ends_with(':')).collect();
    let wanted = [
        "Program \"main\":",
        "Subprogram \"used\":",
        "Subprogram \"lonely\" (not called):",
        "Subprogram \"deep\" (not called):",
    ];
    assert_eq!(heads, wanted, "{said}");
    assert!(said.contains("  W - Wait and send: time = 7\n"), "{said}");
    let extent = Extent {
        with_defaults: true,
        from: Some(2),
    };
    assert_eq!(
        super::sentences(&project, extent, Locale::English),
        "Subprogram \"lonely\" (not called):\n  D - User block: runs \"deep\"\n\n\
         Subprogram \"deep\" (not called):\n  W - Wait and send: time = 7, keep = no\n"
    );
}

#[test]
fn a_picture_has_blocks_ports_edges_and_words() {
    insta::assert_snapshot!("picture", picture(&project(SMALL), 0, Locale::English));
}

#[test]
fn a_picture_is_xml_whatever_the_texts_say() {
    for text in [
        "M3",
        "</text><script>alert(1)</script>",
        "\"&<>'\u{0}\u{ffff}\u{202e}",
    ] {
        let mut project = project(SMALL);
        let diagram = &mut project.diagrams[0];
        diagram.name = text.to_owned();
        for block in &mut diagram.blocks {
            block.name = text.to_owned();
            block.id = text.to_owned();
            block.element = text.to_owned();
            block.properties.insert(text.to_owned(), text.to_owned());
            block.properties.insert("IO0".to_owned(), text.to_owned());
        }
        diagram.edges[0].id = text.to_owned();
        let svg = picture(&project, 0, Locale::Russian);
        let root = lang_text::xml::parse(&svg).unwrap_or_else(|error| panic!("{error:?}\n{svg}"));
        assert_eq!(root.name, "svg");
        assert!(!svg.contains("<script"));
        assert_eq!(svg.matches("<rect ").count(), 8);
        // Without a path, the edges that hang loose are nowhere.
        assert_eq!(svg.matches("<polyline").count(), 8);
        let said = sentences(&project, Locale::English);
        assert!(!said.contains(['\u{0}', '\u{202e}']), "{said}");
    }
}

/// All numbers of attributes that begin so.
fn points(svg: &str) -> Vec<(f64, f64)> {
    let lists = svg
        .split("points=\"")
        .skip(1)
        .filter_map(|rest| rest.split('"').next());
    let pairs = lists
        .flat_map(|list| list.split(' '))
        .filter_map(|pair| pair.split_once(','));
    pairs
        .map(|(x, y)| (x.parse().unwrap(), y.parse().unwrap()))
        .collect()
}

#[test]
fn edges_go_from_port_to_port_by_their_inner_corners() {
    let mut project = project(
        "diagram a\n L: Loop at 100, 200\n S: Say at 400, 50\n L.OUT -> S.DATA via 0, 0; 300, 268; 300, 112; 9, 9\n \
         nowhere -> S.CF_IN via 1, 2; 3, 4\n",
    );
    let ways = [
        (202.0, 268.0),
        (300.0, 268.0),
        (300.0, 112.0),
        (402.0, 112.0),
    ];
    let svg = picture(&project, 0, Locale::English);
    assert_eq!(points(&svg)[..4], ways);
    assert_eq!(points(&svg)[4..], [(1.0, 2.0), (410.0, 66.0)]);
    // An end at no port is at its block.
    project.diagrams[0].edges[0].to = Some(End { block: 1, port: 77 });
    assert_eq!(
        points(&picture(&project, 0, Locale::English))[3],
        (450.0, 107.5)
    );
}

/// Edges of the first diagram whose way runs through a block that is not theirs, by their ids.
fn crossing(project: &Project) -> Vec<String> {
    let svg = picture(project, 0, Locale::English);
    let diagram = &project.diagrams[0];
    let ways: Vec<Vec<(f64, f64)>> = svg
        .split("<polyline")
        .skip(1)
        .map(|one| points(one.split("/>").next().unwrap_or_default()))
        .collect();
    assert_eq!(ways.len(), diagram.edges.len());
    let crosses = |(edge, way): &(&Edge, Vec<(f64, f64)>)| {
        let own = [edge.from, edge.to].map(|end| end.map(|end| end.block));
        let others = (0..diagram.blocks.len()).filter(|at| !own.contains(&Some(*at)));
        others.map(|at| &diagram.blocks[at]).any(|block| {
            let (x, y) = block.position;
            let (width, height) = block.row.map_or((100, 100), |row| row.size);
            let area = [(x, y), (x + f64::from(width), y + f64::from(height))];
            way.windows(2)
                .any(|line| super::ways::meets(line[0], line[1], area))
        })
    };
    let all = diagram.edges.iter().zip(ways);
    all.filter(crosses)
        .map(|(edge, _)| edge.id.clone())
        .collect()
}

#[test]
fn edges_run_around_blocks_that_are_not_theirs() {
    // Straight, it would run through B; and its own block lies on the way of an edge that leads back.
    let row = "diagram a\n A: Say at 0, 0\n B: Say at 200, 0\n C: Say at 400, 0\n A.CF_OUT -> C.CF_IN\n C.CF_OUT -> A.CF_IN\n";
    let way = points(&picture(&project(row), 0, Locale::English));
    assert!(way.len() > 8, "{way:?}");
    assert_eq!(crossing(&project(row)), Vec::<String>::new());
    assert_eq!(
        picture(&project(row), 0, Locale::English),
        picture(&project(row), 0, Locale::English)
    );
    let mut random = needs::Random::new(7);
    for _ in 0..20 {
        use std::fmt::Write as _;
        let count = 4 + random.below(30);
        let mut source = "diagram a\n".to_owned();
        for at in 0..count {
            let _ = writeln!(source, "b{at}: Motors");
        }
        for _ in 0..2 * count {
            let (from, to) = (random.below(count), random.below(count));
            let _ = writeln!(source, "b{from}.CF_OUT -> b{to}.M{}", 1 + random.below(4));
        }
        assert_eq!(
            crossing(&project(&source)),
            Vec::<String>::new(),
            "{source}"
        );
    }
}

#[test]
fn a_large_picture_looks_only_so_far_for_ways() {
    use std::fmt::Write as _;
    let mut random = needs::Random::new(8);
    let count = crate::limits::PICTURE_BLOCKS_MAX / 4;
    let mut source = "diagram a\n".to_owned();
    for at in 0..count {
        // Some lie upon others.
        let (x, y) = (random.below(5000), random.below(5000));
        let _ = writeln!(source, "b{at}: Motors at {x}, {y}");
    }
    for _ in 0..2 * count {
        let (from, to) = (random.below(count), random.below(count));
        let _ = writeln!(source, "b{from}.CF_OUT -> b{to}.M1");
    }
    let svg = picture(&project(&source), 0, Locale::English);
    assert_eq!(svg.matches("<polyline").count(), 2 * count);
}

#[test]
fn pictures_that_are_drawn_together_share_what_may_be_looked_at() {
    let row = project(
        "diagram a\n A: Say at 0, 0\n B: Say at 200, 0\n C: Say at 400, 0\n A.CF_OUT -> C.CF_IN\n",
    );
    let mut looks = Looks::default();
    let draw = |looks: &mut Looks| super::picture(&row, 0, Locale::English, looks);
    let around = draw(&mut looks);
    let cost = crate::limits::ROUTE_LOOKS_MAX - looks.left();
    assert_eq!(draw(&mut looks), around);
    assert_eq!(looks.left(), crate::limits::ROUTE_LOOKS_MAX - 2 * cost);
    let mut few = Looks::at_most(cost + 1);
    assert_eq!(draw(&mut few), around);
    assert_eq!(points(&draw(&mut few)).len(), 2);
}

#[test]
fn places_that_are_none_are_drawn_somewhere() {
    let mut project = project(SMALL);
    let diagram = &mut project.diagrams[0];
    diagram.blocks[1].position = (f64::NAN, f64::INFINITY);
    diagram.edges[0].path = vec![(f64::NAN, 1e300); 10_000];
    diagram.edges[1].to = Some(End {
        block: 1000,
        port: i32::MIN,
    });
    let wild: Vec<Edge> = diagram.edges.clone();
    diagram.edges.extend(wild);
    let svg = picture(&project, 0, Locale::English);
    assert!(!svg.contains("NaN") && !svg.contains("inf"), "{svg}");
    assert!(svg.len() < 60_000, "{}", svg.len());
    assert!(sentences(&project, Locale::English).contains("A.OUT -> nowhere"));
}

#[test]
fn nothing_has_a_picture_too() {
    for at in 0..2 {
        let svg = picture(&project("diagram a"), at, Locale::English);
        assert!(lang_text::xml::parse(&svg).is_ok(), "{svg}");
    }
    assert_eq!(sentences(&Project::default(), Locale::English), "");
}

#[test]
fn what_is_too_much_is_counted() {
    use std::fmt::Write as _;
    let mut source = "diagram a\n".to_owned();
    for at in 0..crate::limits::PICTURE_BLOCKS_MAX + 7 {
        let _ = writeln!(source, "a{at}: If");
    }
    let svg = picture(&project(&source), 0, Locale::English);
    assert_eq!(
        svg.matches("<rect ").count(),
        crate::limits::PICTURE_BLOCKS_MAX
    );
    assert!(svg.contains(">+ 7</text>"));
}

#[test]
fn every_row_has_a_picture_with_all_its_ports() {
    for row in blocks::table() {
        let project = project(&format!("diagram a\nx: \"{}\"", row.shown));
        let svg = picture(&project, 0, Locale::Russian);
        assert_eq!(
            svg.matches("<circle").count(),
            row.ports.len(),
            "{}",
            row.element
        );
        assert!(svg.contains(row.russian));
    }
}
