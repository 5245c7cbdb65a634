//! Worlds that are right, and worlds with one mistake each.

use super::*;

/// A world with one of most things, and rules that name them.
const WORLD: &str = r##"<root version="20251219">
<world>
<walls><wall id="wall" begin="0:0" end="100:0"/></walls>
<colorFields><rectangle id="box" begin="0:0" end="90:90" stroke-width="6"/>
<line id="line" begin="0:0" end="90:90" stroke-width="6"/></colorFields>
<regions><region id="finish" type="rectangle" x="200" y="0" width="100" height="100"/>
<region id="ring" type="bound" boundItem="box"/></regions>
</world>
<settings sizeUnit="px"/>
<robots><robot id="trikKitRobot" position="0:0" direction="0"><sensors>
<sensor port="A1###input######sensorA1" type="TrikLightSensor" position="75:25" direction="0"/></sensors>
<wheels left="M4###output######M4" right="M3###output######M3"/></robot></robots>
<constraints>
<timelimit value="30000"/>
<event id="end" settedUpInitially="true"><condition><inside objectId="robot1" regionId="finish"/></condition>
<trigger><success/></trigger></event>
<event id="later"><condition><greater><objectState object="robot1.A1.value"/><int value="5"/></greater></condition>
<trigger><message text="${robot1.x} ${count}"/></trigger></event>
<event id="first" settedUpInitially="true"><condition><timer timeout="100"/></condition>
<triggers><setUp id="later"/><setter name="count"><int value="1"/></setter>
<setState object="box" property="x"><int value="1"/></setState></triggers></event>
</constraints>
</root>"##;

fn lines(world: &str) -> Vec<String> {
    let texts = Texts {
        world,
        ..Texts::default()
    };
    shown(&lint(texts))
}

fn shown(problems: &[Problem]) -> Vec<String> {
    let line = |problem: &Problem| {
        let at = problem.place.position;
        let at = at.map_or_else(String::new, |at| format!("{}:{} ", at.line, at.column));
        format!(
            "{at}{:?}: {}",
            problem.severity,
            problem.said(lang_text::problem::Locale::English)
        )
    };
    problems.iter().map(line).collect()
}

#[test]
fn a_world_without_mistakes_is_told_nothing_of() {
    assert_eq!(lines(WORLD), [] as [&str; 0]);
}

/// What is replaced by what, and the beginning of what is told.
const MISTAKES: &[(&str, &str, &str, &str)] = &[
    (
        "regionId=\"finish\"",
        "regionId=\"finnish\"",
        "15:",
        "No such region: finnish; did you mean 'finish'?",
    ),
    (
        "regionId=\"finish\"",
        "regionId=\"wall\"",
        "15:",
        "wall is not a region",
    ),
    (
        "objectId=\"robot1\"",
        "objectId=\"robto1\"",
        "15:",
        "No such object: robto1; did you mean 'robot1'?",
    ),
    (
        "robot1.A1.value",
        "robot1.A1.vale",
        "17:",
        "Object \"robot1.A1\" has no property \"vale\"; did you mean 'value'?",
    ),
    (
        "robot1.A1.value",
        "robot1.A2.value",
        "17:",
        "nothing is on the port of 'robot1.A2'",
    ),
    (
        "robot1.A1.value",
        "robot1.A1.value.x",
        "17:",
        "Unknown type of object \"robot1.A1.value\"",
    ),
    (
        "robot1.A1.value",
        "robot1.dislay.smiles",
        "17:",
        "Object \"robot1\" has no property \"dislay\"; did you mean 'display'?",
    ),
    (
        "${robot1.x}",
        "${robot1.rotatoin}",
        "18:",
        "Object \"robot1\" has no property \"rotatoin\"; did you mean 'rotation'?",
    ),
    (
        "${count}",
        "${cuont}",
        "18:",
        "The name cuont is not a valid variable",
    ),
    (
        "property=\"x\"",
        "property=\"colour\"",
        "21:",
        "Object box has no property colour; did you mean 'color'?",
    ),
    (
        "<setUp id=\"later\"/>",
        "<setUp id=\"latter\"/>",
        "17:",
        "the event 'later' is never checked",
    ),
    (
        "<success/>",
        "<fail message=\"x\"/>",
        "14:",
        "no rule that can be reached has <success/>",
    ),
    (
        "timeout=\"100\"",
        "timeout=\"40000\"",
        "17:",
        "the event 'later' is never checked",
    ),
    (
        "value=\"30000\"",
        "value=\"30\"",
        "14:",
        "the time limit is 30 ms",
    ),
    (
        "value=\"30000\"",
        "value=\"3000000\"",
        "14:",
        "the time limit is 3000 s",
    ),
    (
        "<timer timeout=\"100\"/>",
        "<tmer timeout=\"100\"/>",
        "19:",
        "Unknown tag \"tmer\". Did you mean \"timer\"?",
    ),
    (
        "boundItem=\"box\"",
        "boundItem=\"bix\"",
        "7:",
        "a region is bound to 'bix'",
    ),
    (
        "boundItem=\"box\"",
        "boundItem=\"line\"",
        "7:",
        "nothing is ever in the region 'ring'",
    ),
    (
        "height=\"100\"",
        "height=\"0\"",
        "6:",
        "nothing is ever in the region 'finish'",
    ),
    (
        "id=\"line\"",
        "id=\"wall\"",
        "5:",
        "the id 'wall' is that of something in 'wall' too",
    ),
    (
        "<colorFields>",
        "<colorFields><lime/>",
        "4:",
        "<lime> in <colorFields> means nothing, and is left out; did you mean 'line'?",
    ),
    (
        "begin=\"0:0\" end=\"100:0\"",
        "beginn=\"0:0\" end=\"100:0\"",
        "3:",
        "the attribute 'beginn' of <wall> means nothing; did you mean 'begin'?",
    ),
    (
        "begin=\"0:0\" end=\"100:0\"",
        "begin=\"a:0\" end=\"100:0\"",
        "3:",
        "<wall> number 1 (id wall): begin=\"a\"",
    ),
    (
        "A1###input",
        "A9###input",
        "11:",
        "the sensor is on no port of TRIK",
    ),
    (
        "TrikLightSensor",
        "TrikLigthSensor",
        "11:",
        "no sensor is of the type 'TrikLigthSensor', so nothing is on its port; did you mean 'TrikLightSensor'?",
    ),
    (
        "<settings sizeUnit=\"px\"",
        "<settings sizeUnit=\"CM\"",
        "9:",
        "sizeUnit=\"CM\" is unknown, and \"px\" is taken; did you mean \"cm\"?",
    ),
    (
        "<settings ",
        "<settings realisticPhysics=\"yes\" ",
        "9:",
        "realisticPhysics=\"yes\" is unknown, and \"false\" is taken; there are true, false",
    ),
    (
        "<settings ",
        "<settings backgroundColor=\"gren\" ",
        "9:",
        "backgroundColor=\"gren\" is no colour, and white is taken",
    ),
    (
        "stroke-width=\"6\"",
        "stroke=\"blakc\" stroke-width=\"6\"",
        "4:",
        "stroke=\"blakc\" is no colour, and black is taken",
    ),
    (
        "stroke-width=\"6\"",
        "stroke-style=\"dahs\" stroke-width=\"6\"",
        "4:",
        "stroke-style=\"dahs\" is unknown, and \"solid\" is taken; did you mean \"dash\"?",
    ),
    (
        "stroke-width=\"6\"",
        "fill-style=\"full\" stroke-width=\"6\"",
        "4:",
        "fill-style=\"full\" is unknown, and \"none\" is taken; there are none, solid",
    ),
    (
        "stroke-width=\"6\"",
        "stroke-width=\"-6\"",
        "4:",
        "stroke-width=\"-6\" is below 0",
    ),
    (
        "<wall id=\"wall\"",
        "<wall id=\"wall\" mass=\"-1\"",
        "3:",
        "mass=\"-1\" is below 0",
    ),
    (
        "<wall id",
        "<ball id=\"b\" x=\"9\" y=\"9\" diameter=\"0\"/><wall id",
        "3:",
        "diameter=\"0\" is not above 0",
    ),
    (
        "<wall id",
        "<ball id=\"b\" x=\"9\"/><wall id",
        "3:",
        "'x' is there and 'y' is not, so 'y' is 0",
    ),
    (
        " y=\"0\" width=\"100\"",
        " width=\"100\"",
        "6:",
        "'x' means nothing without 'y'",
    ),
    (
        " height=\"100\"",
        "",
        "6:",
        "'width' means nothing without 'height'",
    ),
    (
        "boundItem=\"box\"",
        "boundItem=\"box\" stroke=\"red\"",
        "7:",
        "stroke=\"red\" of a region is no whole number",
    ),
    (
        "id=\"ring\"",
        "id=\"finish\"",
        "7:",
        "a region before has the id 'finish' too, and this one takes its place",
    ),
    (
        "<event id=\"later\">",
        "<event id=\"end\">",
        "17:",
        "Duplicate id: \"end\". A rule before has this id too",
    ),
    (
        "<event id=\"later\">",
        "<constraint failMessage=\"x\"><inside objectId=\"robot1\" regionId=\"finish\"/></constraint><event id=\"later\">",
        "17:",
        "every solution fails at once: 'robot1' begins outside the region 'finish'",
    ),
    (
        "<event id=\"later\">",
        "<constraint failMessage=\"x\"><conditions glue=\"and\"><true/><not><inside objectId=\"robot1\" regionId=\"ring\"/></not></conditions></constraint><event id=\"later\">",
        "17:",
        "every solution fails at once: 'robot1' begins in the region 'ring'",
    ),
    (
        "<setter name=\"count\">",
        "<setter name=\"totalscore\"><int value=\"1\"/></setter><setter name=\"count\">",
        "20:",
        "the variable 'totalscore' is not the score",
    ),
    (
        "trikKitRobot",
        "ev3KitUsbRobot",
        "",
        "no robot of this world is one of TRIK",
    ),
];

#[test]
fn each_mistake_is_found_at_its_place() {
    for (right, wrong, line, wanted) in MISTAKES {
        assert!(WORLD.contains(right), "{right}");
        let told = lines(&WORLD.replacen(right, wrong, 1));
        assert!(
            told.iter()
                .any(|one| one.starts_with(line) && one.contains(wanted)),
            "{wrong}: {wanted}\n{}",
            told.join("\n")
        );
    }
}

#[test]
fn a_start_that_rules_may_change_is_left_alone_and_a_mistake_is_told_once() {
    let world = WORLD.replacen(
        "<event id=\"later\">",
        "<constraint failMessage=\"x\"><inside objectId=\"robot1\" regionId=\"finish\"/></constraint><event id=\"later\">",
        1,
    );
    // The region is moved to the robot before the first check.
    let moved = world.replace("object=\"box\" property", "object=\"finish\" property");
    for (world, count) in [(&world, 1), (&moved, 0)] {
        let told = lines(world);
        let told: Vec<_> = told
            .iter()
            .filter(|one| one.contains("fails at once"))
            .collect();
        assert_eq!(told.len(), count, "{told:?}");
    }
    // A tag that is misspelt is one mistake and has one line.
    let told = lines(&WORLD.replace("<success/>", "<sucess/>"));
    let told: Vec<_> = told.iter().filter(|one| one.contains("ucess")).collect();
    assert!(
        told.len() == 1 && told[0].contains("Did you mean \"success\"?"),
        "{told:?}"
    );
}

#[test]
fn rubbish_is_told_and_nothing_panics() {
    for world in [
        "",
        " ",
        "<",
        "<root/>",
        "<root><world/></root>",
        "\u{feff}<root>",
        "text",
        "<a><b/></a>",
    ] {
        let _ = lines(world);
    }
    // Every tail and every head of a world.
    for at in 0..WORLD.len() {
        if WORLD.is_char_boundary(at) && at % 7 == 0 {
            let _ = lines(&WORLD[..at]);
            let _ = lines(&WORLD[at..]);
        }
    }
}

/// Whether the original told an error of a project or a field when it ran it, as its record says; or nothing at all, where
/// it leaves out rules that it cannot read without a word.
fn is_refused(data: &std::path::Path, name: &str) -> bool {
    let name = name.rsplit_once('.').map_or(name, |(name, _)| name);
    let record = data.join("synthetic/oracle").join(format!("{name}.json"));
    let text = std::fs::read_to_string(record).unwrap_or_default();
    text.contains("\"report\": []")
        || text.contains("Error in checker: ")
        || text.contains("Error while ")
}

#[test]
fn worlds_of_others_have_errors_only_where_the_original_tells_some() {
    let Some(data) = needs::data() else { return };
    // No XML or no world, which the original refuses in other words; and a limit of time below 0, which only we refuse.
    let others = [
        "f_broken.xml",
        "w_broken.qrs",
        "w_root_only.qrs",
        "c_timelimit_negative.qrs",
    ];
    let (mut count, mut with_errors) = (0, 0);
    for folder in [
        "fields",
        "grading",
        "worlds",
        "synthetic/fields",
        "synthetic/projects",
        "examples",
        "course",
    ] {
        for entry in std::fs::read_dir(data.join(folder)).unwrap() {
            let path = entry.unwrap().path();
            let name = path.file_name().unwrap().to_string_lossy().into_owned();
            let bytes = std::fs::read(&path).unwrap();
            let found = match path.extension().and_then(|ending| ending.to_str()) {
                Some("xml") => lines(&String::from_utf8(bytes).unwrap()),
                Some("qrs") => {
                    let project = lang_diagram::read::read(&bytes).unwrap().project;
                    let Some(world) = &project.world else {
                        continue;
                    };
                    shown(&lint(Texts {
                        world,
                        blobs: project.blobs.as_deref(),
                        templates: Some(&project.templates),
                    }))
                }
                _ => continue,
            };
            count += 1;
            let errors: Vec<_> = found
                .iter()
                .filter(|line| line.contains("Error: "))
                .collect();
            if !errors.is_empty() {
                with_errors += 1;
                let is_known = is_refused(&data, &name) || others.contains(&&*name);
                assert!(is_known, "{name}: {errors:#?}");
            }
        }
    }
    assert!(count > 300 && with_errors > 40, "{count} {with_errors}");
}
