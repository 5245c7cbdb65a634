//! A world as people see it, as JSON.
//!
//! Owns the names and the digits; `page/app/src/world/types.ts` has the other end. Pure.

use super::{Item, Movable, Moving, Placed, Scene, Sensor, Shape, Wheel};
use crate::geometry::{Point, Pose};
use crate::judge::json;
use serde_json::{Map, Value, json};
use std::fmt::Write as _;

/// To a tenth of a millimetre or of a degree's hundredth; what is no number is 0, which no reader has to fear.
fn rounded(number: f64) -> f64 {
    let rounded = (number * 1e4).round() / 1e4;
    // The sum takes the sign from a zero.
    if rounded.is_finite() {
        rounded + 0.0
    } else {
        0.0
    }
}

fn flat(points: &[Point]) -> Value {
    points
        .iter()
        .flat_map(|at| [rounded(at.x), rounded(at.y)])
        .collect()
}

fn pose(pose: Pose) -> Value {
    json!([
        rounded(pose.at.x),
        rounded(pose.at.y),
        rounded(pose.heading_rad.to_degrees())
    ])
}

fn item(item: &Item) -> Value {
    let mut all = Map::new();
    let mut put = |name: &str, value: Value| drop(all.insert(name.to_owned(), value));
    put("is", item.kind.word().into());
    put("points", flat(&item.points));
    if !item.stroke.is_empty() {
        put("stroke", item.stroke.as_str().into());
        put("width", rounded(item.width_m).into());
    }
    if !item.dashes_m.is_empty() {
        put(
            "dash",
            item.dashes_m.iter().map(|one| rounded(*one)).collect(),
        );
    }
    if !item.fill.is_empty() {
        put("fill", item.fill.as_str().into());
        put("alpha", rounded(item.opacity).into());
    }
    if !item.text.is_empty() {
        put("text", item.text.as_str().into());
    }
    Value::Object(all)
}

fn thing(thing: &Movable) -> Value {
    json!({"is": thing.kind, "size": rounded(thing.size_m), "colour": thing.colour})
}

fn wheel(wheel: &Wheel) -> Value {
    json!({"port": wheel.port, "at": flat(&[wheel.at]), "radius": rounded(wheel.radius_m)})
}

fn sensor(sensor: &Sensor) -> Value {
    json!({
        "is": sensor.kind,
        "port": sensor.port,
        "at": flat(&[sensor.at]),
        "degrees": rounded(sensor.degrees),
        "reach": rounded(sensor.reach_m),
        "beam": rounded(sensor.beam_degrees),
    })
}

fn shape(shape: &Shape) -> Value {
    json!({
        "size": shape.size_m.map(rounded),
        "round": shape.is_round,
        "wheels": shape.wheels.iter().map(wheel).collect::<Value>(),
        "sensors": shape.sensors.iter().map(sensor).collect::<Value>(),
    })
}

/// What stands still, with the devices of the board and the faults that each can have.
pub fn scene(scene: &Scene, devices: &[(&str, &[&str])]) -> String {
    let mark = |mark: &super::Mark| {
        let [red, green, blue] = mark.rgb;
        json!([
            rounded(mark.begin.x),
            rounded(mark.begin.y),
            rounded(mark.end.x),
            rounded(mark.end.y),
            format!("#{red:02x}{green:02x}{blue:02x}")
        ])
    };
    json!({
        "bounds": scene.bounds.map(rounded),
        "floor": scene.floor,
        "items": scene.items.iter().map(item).collect::<Value>(),
        "marks": scene.marks.iter().map(mark).collect::<Value>(),
        "things": scene.things.iter().map(thing).collect::<Value>(),
        "start": pose(scene.start),
        "robots": scene.robots.iter().map(shape).collect::<Value>(),
        "locked": {"world": scene.locks.world, "robot": scene.locks.robot_position},
        "fields": scene.takes_fields,
        "devices": devices.iter().map(|(name, kinds)| json!([name, kinds])).collect::<Value>(),
    })
    .to_string()
}

/// What of the board people see beside its world.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Beside {
    /// Green and red.
    pub led: (bool, bool),
    /// The last words.
    pub said: String,
    /// Devices that are broken, and what is wrong with each.
    pub faults: Vec<(&'static str, String)>,
}

/// A number of `into`, with as many digits as people see.
fn number(into: &mut String, number: f64) {
    json::number(into, rounded(number));
}

/// Values in brackets.
fn list<T>(into: &mut String, all: impl IntoIterator<Item = T>, put: impl Fn(&mut String, T)) {
    into.push('[');
    for (index, one) in all.into_iter().enumerate() {
        if index > 0 {
            into.push(',');
        }
        put(into, one);
    }
    into.push(']');
}

fn reading(into: &mut String, reading: Option<f64>) {
    json::number(into, reading.map_or(f64::NAN, rounded));
}

fn place(into: &mut String, pose: Pose) {
    let numbers = [pose.at.x, pose.at.y, pose.heading_rad.to_degrees()];
    list(into, numbers, number);
}

fn robot(into: &mut String, robot: &Placed) {
    into.push_str("{\"at\":");
    place(into, robot.pose);
    into.push_str(",\"read\":");
    list(into, robot.readings.iter().copied(), reading);
    into.push_str(",\"rays\":");
    list(into, robot.rays_m.iter().copied(), reading);
    let _ = write!(into, ",\"stuck\":{},\"marker\":", robot.is_stuck);
    json::text(into, &robot.marker);
    into.push('}');
}

/// What moves, written by hand: this is done many times in a second.
pub fn moving(moving: &Moving, beside: &Beside) -> String {
    let mut text = String::with_capacity(512 + 32 * moving.things.len());
    text.push_str("{\"t\":");
    number(&mut text, moving.time_s);
    let _ = write!(text, ",\"paused\":{},\"speed\":", moving.is_paused);
    number(&mut text, moving.speed);
    text.push_str(",\"robots\":");
    list(&mut text, &moving.robots, robot);
    text.push_str(",\"things\":");
    list(&mut text, moving.things.iter().copied(), place);
    let led = match beside.led {
        (false, false) => "",
        (true, false) => "green",
        (false, true) => "red",
        (true, true) => "orange",
    };
    let _ = write!(text, ",\"led\":\"{led}\",\"said\":");
    json::text(&mut text, &beside.said);
    text.push_str(",\"faults\":{");
    for (index, (name, what)) in beside.faults.iter().enumerate() {
        let _ = write!(text, "{}\"{name}\":", if index > 0 { "," } else { "" });
        json::text(&mut text, what);
    }
    text.push_str("}}");
    text
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::geometry::point;

    #[test]
    fn what_moves_is_json_whatever_the_numbers_are() {
        let robot = Placed {
            pose: Pose::new(1.23456, f64::NAN, 1.0),
            readings: vec![Some(0.5), None, Some(f64::INFINITY)],
            rays_m: vec![None],
            is_stuck: true,
            marker: "#\"<".to_owned(),
        };
        let world = Moving {
            time_s: 0.1 + 0.2,
            is_paused: false,
            speed: 2.0,
            robots: vec![robot],
            things: vec![Pose::new(-0.0, -1e-9, 0.0)],
        };
        let beside = Beside {
            led: (true, true),
            said: "\"hello\"\n</script>".to_owned(),
            faults: vec![("A1", "unplug".to_owned()), ("D1", "noise 3".to_owned())],
        };
        let text = moving(&world, &beside);
        let value: Value = serde_json::from_str(&text).unwrap();
        assert_eq!(value["t"], 0.3);
        assert_eq!(value["robots"][0]["at"], json!([1.2346, 0, 57.2958]));
        assert_eq!(value["robots"][0]["read"], json!([0.5, null, 0]));
        assert_eq!(value["robots"][0]["marker"], "#\"<");
        assert_eq!(value["things"], json!([[0, 0, 0]]));
        assert_eq!(value["led"], "orange");
        assert_eq!(value["said"], "\"hello\"\n</script>");
        assert_eq!(value["faults"], json!({"A1": "unplug", "D1": "noise 3"}));
    }

    #[test]
    fn what_stands_still_leaves_out_what_is_not_there() {
        let wall = Item::line(super::super::Kind::Wall, vec![point(0.0, 1.0)], "", 0.0);
        let world = Scene {
            items: vec![wall],
            ..Scene::default()
        };
        let text = scene(&world, &[("A1", &["unplug"])]);
        let value: Value = serde_json::from_str(&text).unwrap();
        assert_eq!(
            value["items"],
            json!([{"is": "wall", "points": [0.0, 1.0]}])
        );
        assert_eq!(value["devices"], json!([["A1", ["unplug"]]]));
    }
}
