//! The configuration of a robot that moves by a model: its motors and servos, the usual sensors, and the model as odometry.
//!
//! Owns the text. Which ports there are is known to [`crate::robots`], what `dcml` means to the configuration.

use super::{Actuator, Overrides, Port, Rolling};
use crate::robots::Plug;
use std::fmt::Write;

/// The configuration of a robot whose model has this text, with these sensors beside its motors and servos.
pub fn configuration(rolling: &Rolling, text: &str, said: &Overrides, plugs: &[Plug]) -> String {
    let mut lua = format!(
        "-- A robot that moves by the model {}.\nlocal trik = include 'trik.lua'\n\ntrikfs = trik.robot {{\n",
        rolling.robot.name()
    );
    // Writing into a text cannot fail.
    let mut taken: Vec<Port> = Vec::new();
    for (part, actuator) in rolling.robot.action_parts().iter().zip(&rolling.actuators) {
        if taken.contains(&actuator.port) {
            continue;
        }
        taken.push(actuator.port);
        let name = &part.name;
        let port = actuator.port.name();
        let named = match Port::named(name) {
            Some(_) => String::new(),
            None => format!(", name = '{name}'"),
        };
        let _ = match actuator.port {
            Port::Motor(index) => {
                let encoder = format!("E{}", index + 1);
                writeln!(
                    lua,
                    "  {{ port = '{port}', type = 'motor100', encoder = '{encoder}'{named} }},\n  {{ port = '{encoder}', type = 'encoder95'{named} }},"
                )
            }
            Port::Servo(_) => {
                writeln!(
                    lua,
                    "  {{ port = '{port}', type = 'angularServomotor'{named} }},"
                )
            }
        };
    }
    for plug in plugs {
        let is_sensor = ["A", "D"]
            .iter()
            .any(|letter| plug.port.starts_with(letter));
        if is_sensor || plug.port == "lidar" {
            let kind = match plug.kind {
                "" => String::new(),
                kind => format!(", type = '{kind}'"),
            };
            let _ = writeln!(lua, "  {{ port = '{}'{kind} }},", plug.port);
        }
    }
    lua + "}\n" + &pose(rolling, text, said)
}

/// The node that follows the robot by its own model.
fn pose(rolling: &Rolling, text: &str, said: &Overrides) -> String {
    let pairs = |pairs: &[(String, f64)]| -> String {
        let all: Vec<String> = pairs
            .iter()
            .map(|(name, number)| format!("{name} = {number}"))
            .collect();
        all.join(", ")
    };
    let source = |actuator: &Actuator| {
        let node = match actuator.port {
            Port::Motor(index) => format!("d(encoders/E{})", index + 1),
            Port::Servo(index) => format!("servos/S{}", index + 1),
        };
        format!(
            "{{ '{node}', scale = {} }}",
            actuator.factor * 1.0_f64.to_radians()
        )
    };
    let actions: Vec<String> = rolling
        .robot
        .action_parts()
        .iter()
        .zip(&rolling.actuators)
        .map(|(part, actuator)| format!("{} = {}", part.name, source(actuator)))
        .collect();
    let level = (0..).map(|count| "=".repeat(count));
    let level = level
        .into_iter()
        .find(|level| !text.contains(&format!("]{level}]")))
        .unwrap_or_default();
    format!(
        "\ntrikfs.pose = dcml {{\n  params = {{ {} }}, start = {{ {} }},\n  actions = {{ {} }},\n  model = [{level}[\n{text}\n]{level}],\n}}\n",
        pairs(&said.params),
        pairs(&said.start),
        actions.join(", ")
    )
}
