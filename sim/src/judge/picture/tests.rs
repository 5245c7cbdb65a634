//! Pictures and pages of small runs.

use super::*;
use crate::judge::track::{Group, Track};
use crate::judge::trajectory::DeviceChange;
use lang_constraint::{Entry, Level};
use lang_text::problem::Locale;

const WORLD: &str = r##"<root version="20251219">
<settings backgroundColor="#ff00ff00"/>
<world>
<walls><wall id="w" begin="0:0" end="100:0"/></walls>
<skittles><skittle id="s" x="10" y="50" markerX="10" markerY="50" rotation="0" startRotation="0"/></skittles>
<balls/><cubes><cube id="q" x="70" y="50" markerX="10" markerY="50" rotation="45" startRotation="0"/></cubes>
<colorFields>
<line id="l" begin="0:10" end="50:10" stroke="#ff112233" stroke-width="4" stroke-style="dash" fill="#000000" fill-style="none"/>
<ellipse id="e" begin="10:20" end="50:60" stroke="red" stroke-width="4" stroke-style="solid" fill="#80ff0000" fill-style="solid"/>
<cubicBezier id="b" begin="0:0" end="10:10" cp1="5:5" cp2="6:6" stroke="&quot;/&gt;&lt;script&gt;" stroke-width="1" stroke-style="solid" fill="#000000" fill-style="none"/>
</colorFields>
<images/>
<regions><region id="r" type="rectangle" x="200" y="100" width="-50" height="40" filled="true" visible="true" color="#0000ff" text="&lt;b&gt;" textX="0" textY="0"/></regions>
<robot position="0:0" direction="0"/>
</world>
<robots><robot id="trikKitRobot"><sensors/></robot></robots>
</root>"##;

fn field() -> Field {
    Field::read(WORLD).unwrap().field
}

fn drive() -> Trajectory {
    let mut trajectory = Trajectory::default();
    let robot = trajectory.robot("trikKitRobot");
    let change = |ms, property: &str, value| Record::Device {
        robot,
        ms,
        change: Box::new(DeviceChange {
            device: "marker".into(),
            port: "MarkerPort".into(),
            property: property.into(),
            value,
        }),
    };
    for tick in 1..=300u32 {
        if tick == 100 {
            trajectory
                .records
                .push(change(990, "isDown", Value::Bool(true)));
            trajectory
                .records
                .push(change(990, "color", "#0000ff".into()));
        }
        trajectory.records.push(Record::Pose {
            robot,
            ms: tick * 10,
            x: f64::from(tick),
            y: 0.0,
            degrees: 0.0,
        });
    }
    trajectory
}

#[test]
fn a_picture_has_all_that_stands_lies_and_drives() {
    let svg = svg(&field(), &drive(), Locale::English);
    assert!(svg.starts_with("<svg ") && svg.ends_with("</svg>\n"));
    for part in [
        "fill=\"#00ff00ff\"",
        "stroke=\"#112233ff\" stroke-width=\"4.0\"",
        "stroke-dasharray=\"16.0 8.0\"",
        "fill=\"#ff000080\"",
        "stroke=\"#6d4c41\"",
        "rotate(45.0 ",
        "x=\"150.0\" y=\"100.0\" width=\"50.0\" height=\"40.0\"",
        "&lt;b&gt;</text>",
        "2 s</text>",
        "stroke=\"#0000ff\" stroke-width=\"6\"",
    ] {
        assert!(svg.contains(part), "{part}\n{svg}");
    }
    assert!(!svg.contains("<script") && !svg.contains("<b>"), "{svg}");
    assert_eq!(svg.matches("<g transform").count(), 2);
    insta::assert_snapshot!("run", svg);
}

#[test]
fn a_page_has_all_that_was_said_and_nothing_of_it_is_a_tag() {
    let entry = |level, text: &str| Entry {
        level,
        at_ms: 2_000,
        place: String::new(),
        text: text.to_owned(),
    };
    let entries = [
        entry(Level::Error, "</script><script>alert(1)</script> {DATA}"),
        entry(Level::Variables, "{}"),
    ];
    let mut track = Track::default();
    track.note(Group::Variable, "</script>{DATA}", 10, "\u{2028}<b>");
    track.note(Group::Motor, "M3", 20, "60");
    track.round(20);
    let caption = Caption {
        title: "<i>{VERDICT}</i>.qrs",
        verdict: "good",
        is_good: true,
        locale: Locale::Russian,
        track: &track,
    };
    let page = page(&field(), &drive(), &entries, caption);
    assert!(page.contains("&lt;i&gt;{VERDICT}&lt;/i&gt;.qrs"), "{page}");
    assert!(page.contains(r#"[2000,"error","\u003c/script>\u003cscript>alert(1)"#));
    assert!(page.contains("\"end\":3000}") && page.contains("[3000,300.00,0.00,0.00]"));
    assert!(page.contains("<html lang=\"ru\">") && page.contains("id=\"robot0\""));
    assert!(page.contains(r#"["\u003c/script>{DATA}",10,""#), "{page}");
    assert!(page.contains(r#"["M3",20,"60"]"#), "{page}");
    assert_eq!(page.matches("<script").count(), 1);
    // An address stands in it once: the name of SVG.
    assert_eq!(page.matches("://").count(), 1);
}

#[test]
fn pictures_of_nothing_and_of_far_away_things_are_still_pictures() {
    let empty = svg(&Field::default(), &Trajectory::default(), Locale::English);
    assert!(
        empty.contains("viewBox=\"-20.0 -20.0 140.0 140.0\""),
        "{empty}"
    );
    let far = WORLD.replace(
        "begin=\"0:0\" end=\"100:0\"",
        "begin=\"1e300:0\" end=\"0:1e9\"",
    );
    if let Ok(opened) = Field::read(&far) {
        let svg = svg(&opened.field, &drive(), Locale::English);
        assert!(
            !svg.contains("inf") && !svg.contains("NaN") && svg.len() < 20_000,
            "{svg}"
        );
    }
}
