//! What a run that was seen becomes for rules: places, turns, devices, and what nobody has seen.

use super::super::Texts;
use super::*;
use crate::geometry::point;
use std::f64::consts::FRAC_PI_2;

/// A robot that looks down the map from (100, 0), and rules.
fn task(rules: &str) -> Task {
    let world = format!(
        r#"<root version="20251219"><world><walls/>
<balls><ball id="ball" x="1" y="1"/></balls>
<regions><region id="there" type="rectangle" x="100" y="200" width="50" height="50"/></regions>
<robot position="100:0" direction="90"/></world>
<robots><robot id="trikKitRobot"><sensors>
<sensor port="A1###input######sensorA1" type="TrikInfraredSensor" position="75:25"/></sensors>
<wheels left="M3###output######M3" right="M4###output######M4"/></robot></robots>
<settings/><constraints><timelimit value="1000"/>{rules}</constraints></root>"#
    );
    let texts = Texts {
        world: &world,
        ..Texts::default()
    };
    Task::read(texts).unwrap().0
}

fn rule(id: &str, condition: &str) -> String {
    format!(
        r#"<event id="{id}" settedUpInitially="true"><condition>{condition}</condition><trigger><success/></trigger></event>"#
    )
}

fn equals(path: &str, value: i32) -> String {
    format!(r#"<equals><objectState object="{path}"/><int value="{value}"/></equals>"#)
}

/// Tells the same at each tick up to 300 ms, but for where it is.
struct Repeating(Vec<(Port, i32)>, fn(u32) -> Pose);

impl Witness for Repeating {
    fn tell(&mut self, now: u32, to: &mut Seen<'_>) -> Result<Going, Words> {
        to.place((self.1)(now));
        self.0
            .iter()
            .for_each(|(port, value)| to.port(*port, *value));
        Ok(match now {
            300.. => Going::Ended { with_errors: false },
            _ => Going::On,
        })
    }
}

#[test]
fn a_robot_is_where_it_was_seen_from_where_its_world_has_it_begin() {
    let task = task(&rule(
        "in",
        r#"<inside objectId="robot1" regionId="there"/>"#,
    ));
    assert_eq!(
        needs(&task)
            .all
            .iter()
            .map(|one| one.fact)
            .collect::<Vec<_>>(),
        [Fact::Place]
    );
    let ahead = |now: u32| Pose::new(f64::from(now) / 300.0 * 0.75, 0.0, 0.0);
    let settings = Settings {
        is_recording: true,
        ..Settings::default()
    };
    let outcome = judge_seen(&task, &mut Repeating(Vec::new(), ahead), &settings);
    assert_eq!(
        outcome.verdict,
        Verdict::Accomplished,
        "{:?}",
        outcome.entries
    );
    // It went down the map; the centre is in the region from 175 px on.
    assert!((200..=290).contains(&outcome.ms), "{}", outcome.ms);
    let [_, x, y, degrees] = outcome.trajectory.poses(0).last().unwrap();
    assert!((x - 100.0).abs() < 1e-9 && y > 170.0 && degrees == 90.0);
    let left = |now: u32| Pose {
        at: point(0.0, f64::from(now) / 300.0),
        heading_rad: 0.0,
    };
    let outcome = judge_seen(&task, &mut Repeating(Vec::new(), left), &settings);
    assert_eq!(outcome.verdict, Verdict::Failed);
    // To the left of one who looks down is to the right.
    let [_, x, ..] = outcome.trajectory.poses(0).last().unwrap();
    assert!(x > 300.0, "{x}");
}

#[test]
fn turns_are_counted_and_devices_say_what_they_said() {
    let a1 = Port::named("A1").unwrap();
    let m3 = Port::named("M3").unwrap();
    let all = [
        equals("robot1.A1.value", 31),
        equals("robot1.M3.power", -40),
        equals("robot1.rotation", 90 - 720),
    ];
    let task = task(&rule(
        "all",
        &format!(r#"<conditions glue="and">{}</conditions>"#, all.concat()),
    ));
    let facts: Vec<Fact> = needs(&task).all.iter().map(|one| one.fact).collect();
    assert_eq!(facts, [Fact::Port(a1), Fact::Port(m3), Fact::Place]);
    // Two turns to the left in 240 ms, told as angles from -180 to 180 degrees.
    let turning = |now: u32| {
        let angle = f64::from(now.min(240)) / 240.0 * 8.0 * FRAC_PI_2;
        Pose::new(0.0, 0.0, angle.sin().atan2(angle.cos()))
    };
    let told = vec![(a1, 31), (m3, -40)];
    let settings = Settings::default();
    let outcome = judge_seen(&task, &mut Repeating(told, turning), &settings);
    let entries = &outcome.entries;
    assert_eq!(outcome.verdict, Verdict::Accomplished, "{entries:?}");
}

#[test]
fn what_only_a_simulator_knows_is_named() {
    let rules = [
        equals("ball.x", 1),
        equals("robot1.display.labels.size", 1),
        equals("robot1.marker.isDown", 1),
        equals("trace.size", 1),
        equals("there.x", 1),
        equals("robot1.isRiding", 1),
    ];
    let needs = needs(&task(&rule(
        "x",
        &format!(r#"<conditions glue="and">{}</conditions>"#, rules.concat()),
    )));
    let simulated = needs.all.iter().filter(|one| one.fact == Fact::Simulated);
    let texts: Vec<&str> = simulated.map(|one| &*one.text).collect();
    assert_eq!(
        texts,
        [
            "ball.x",
            "robot1.display.labels.size",
            "robot1.marker.isDown",
            "trace.size"
        ]
    );
    assert_eq!(
        needs.all.len(),
        4 + 4,
        "all motors are asked: {:?}",
        needs.all
    );
    let text = format!(
        r#"<init><setState object="robot1.led" property="color"><string value="red"/></setState></init>{}"#,
        rule("x", &equals("robot1.led.color", 1))
    );
    let needs = super::needs(&task(&text));
    assert_eq!(needs.changes.len(), 1, "{:?}", needs.changes);
    assert_eq!(needs.all[0].fact, Fact::Light);
}
