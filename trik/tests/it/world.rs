//! A virtual robot in a world of TRIK Studio: the same files and programs, other walls.

use crate::programs::Reachable;
use crate::rig::Home;
use harness::eventually;
use std::sync::Arc;

/// A wall ahead, a black line before it, a distance sensor and a camera at the front.
const WORLD: &str = r##"<root version="20251219"><world>
<walls><wall id="w" begin="300:-100" end="300:150"/></walls>
<colorFields><line id="l" begin="150:-100" end="150:150" stroke="#ff000000" stroke-width="30"/></colorFields>
<regions/><robot position="0:0" direction="0"/></world>
<robots><robot id="trikKitRobot"><sensors>
<sensor port="A1###input###A1###sensorA1" type="trik::robotModel::parts::TrikInfraredSensor" position="62:25" direction="0"/>
<sensor port="A3###input###A3###sensorA3" type="trik::robotModel::parts::TrikLightSensor" position="56:25" direction="0"/>
</sensors><wheels left="M3###output######M3" right="M4###output######M4"/></robot></robots>
<settings realisticPhysics="false" realisticSensors="false" realisticMotors="false"/></root>"##;

/// Drives on the line and stops there. On a busy computer it may pass the line unseen; then it turns back before the wall,
/// and comes again.
const TO_THE_LINE: &str = "
function drive(power) {
  brick.motor(M3).setPower(power);
  brick.motor(M4).setPower(power);
}
drive(20);
while (brick.sensor(A3).read() < 60) {
  var ahead = brick.sensor(A1).read();
  if (ahead < 25) drive(-20);
  else if (ahead > 76) drive(20);
  script.wait(1);
}
brick.stop();
print('on the line');
";

#[test]
fn a_world_of_trik_studio_is_driven_in_through_the_same_files() {
    let Some(home) = Home::new() else { return };
    let home = Arc::new(home);
    let world = home.0.file("world.xml", WORLD);
    let world = world.to_str().expect("UTF-8").to_owned();
    let one = Reachable::beside(&home, &["--field", &world]);
    let robot = &one.robot;
    let begun = robot.pose();
    // 300 - 5 - 62 px to the wall are 82 cm; the sensor reaches 80.
    let far = robot.number("sensors/A1/value");
    assert!(far > 70.0, "{far}");
    let output = one.run("line.js", TO_THE_LINE);
    assert_eq!(output.stdout, "on the line\n", "{}", output.stderr);
    // The light sensor is at 56 px and the line from 135 to 165: some 30 cm.
    let driven_m = robot.pose().away_from(&begun);
    assert!((0.2..0.45).contains(&driven_m), "{driven_m} m");
    let near = robot.number("sensors/A1/value");
    assert!(near < far - 15.0, "{near} cm after {far} cm");
    // Against the wall it goes no further, and the bumper of the record counts.
    robot.drive(60, 60);
    eventually("the wall", || robot.pose().bumps > 0.0);
    robot.drive(0, 0);
    let ahead_m = robot.pose().away_from(&begun);
    assert!(ahead_m < (300.0 - 62.0) / 285.7 + 0.05, "{ahead_m} m");
}

#[test]
fn a_person_stops_the_time_of_a_world_and_changes_its_walls() {
    let Some(home) = Home::new() else { return };
    let home = Arc::new(home);
    let world = home.0.file("world.xml", WORLD);
    let empty = home.0.file(
        "empty.xml",
        "<root version=\"20251219\"><settings/><world/></root>",
    );
    let world = world.to_str().expect("UTF-8").to_owned();
    let one = Reachable::beside(&home, &["--field", &world]);
    let robot = &one.robot;
    let control = robot.devices.join("control/world");
    let order = |words: &str| std::fs::write(&control, format!("{words}\n")).expect("control");
    let error = control.with_extension("error");
    order("fly");
    eventually("a complaint", || {
        std::fs::read_to_string(&error).is_ok_and(|text| text.contains("'fly' is no order"))
    });
    order("pause");
    eventually("a good order", || !error.exists());
    let begun = robot.pose();
    robot.drive(50, 50);
    order("step 20");
    eventually("twenty ticks", || robot.pose().away_from(&begun) > 0.01);
    let there = robot.pose();
    assert!(
        there.away_from(&begun) < 0.06,
        "{} m",
        there.away_from(&begun)
    );
    robot.drive(0, 0);
    order(&format!("field {}", empty.display()));
    eventually("no wall", || robot.number("sensors/A1/value") > 79.0);
}

#[test]
fn a_world_that_is_none_is_refused_before_anything_starts() {
    let Some(home) = Home::new() else { return };
    let broken = home.0.file("broken.xml", "<root><world>");
    let broken = broken.to_str().expect("UTF-8");
    for (file, reason) in [(broken, "broken.xml"), ("/nowhere/w.xml", "/nowhere/w.xml")] {
        let output = home.run(&["up", "--field", file]);
        assert_ne!(output.code(), 0, "{file}");
        assert!(output.stderr.contains(reason), "{}", output.stderr);
    }
}
