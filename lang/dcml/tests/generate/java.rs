//! A simulator in Java that knows no model: it drives whatever implements the interface of generated classes.
//!
//! Owns the simulator and what it must print; the yardstick is the solver of this crate.

use crate::agree::{COMMONS_MATH, compile_java, write_interface};
use crate::tools::{has_file, run, scratch};
use lang_dcml::generate::{Options, Target, generate};
use lang_dcml::robot::Robot;
use lang_dcml::solve::propagate::Propagator;
use lang_dcml::system::System;

/// `java Simulator CLASS STEPS SECONDS [NAME=NUMBER...]`: prints the state and the outputs in the end, and what is refused.
const SIMULATOR: &str = r#"import trik.dcml.RobotModel;

public class Simulator {
    static boolean has(String[] names, String name) {
        return java.util.Arrays.asList(names).contains(name);
    }

    static void refuses(Runnable what) {
        try {
            what.run();
        } catch (IllegalArgumentException why) {
            System.out.println(why.getMessage());
            return;
        }
        throw new IllegalStateException("not refused");
    }

    public static void main(String[] words) throws Exception {
        RobotModel robot = (RobotModel) Class.forName(words[0]).getDeclaredConstructor().newInstance();
        System.out.println(robot.getModelName());
        for (int at = 3; at < words.length; at++) {
            String[] given = words[at].split("=");
            double number = Double.parseDouble(given[1]);
            if (has(robot.getParameterNames(), given[0])) {
                robot.setParameter(given[0], number);
            } else if (has(robot.getActionNames(), given[0])) {
                robot.setAction(given[0], number);
            } else {
                robot.setState(given[0], number);
            }
        }
        for (int step = Integer.parseInt(words[1]); step > 0; step--) {
            robot.step(Double.parseDouble(words[2]));
        }
        for (String name : robot.getStateNames()) {
            System.out.println(robot.getState(name));
        }
        for (String name : robot.getOutputNames()) {
            System.out.println(robot.getOutput(name));
        }
        for (String name : robot.getParameterNames()) {
            robot.setParameter(name, robot.getParameter(name) + robot.getAction()[0]);
        }
        refuses(() -> robot.setAction("wings", 1.0));
        refuses(() -> robot.setState(new double[0]));
    }
}
"#;

/// A shipped model, its class, its parameters, where it starts, its action, and what is refused of it.
type Case = (
    &'static str,
    &'static str,
    &'static [f64],
    &'static [f64],
    &'static [f64],
    &'static str,
);

const CASES: [Case; 3] = [
    (
        "differential-drive",
        "robotics.models.DifferentialDrive",
        &[0.4, 0.1],
        &[0.5, -0.5, 1.0],
        &[1.0, 3.0],
        "there is no action wings; there are u_l, u_r\nstate has 0 numbers, not 3",
    ),
    (
        "bart",
        "robotics.models.Bart",
        &[0.1, 0.05, 0.03],
        &[1.0, 1.0, 0.25, 0.0, 0.0, -0.5],
        &[3.0, 1.0, 2.0, 2.5],
        "there is no action wings; there are left_f_s, right_f_s, left_r_s, right_r_s\nstate has 0 numbers, not 6",
    ),
    (
        "bicycle",
        "robotics.models.Bicycle",
        &[0.3],
        &[0.0, 0.0, 3.0],
        &[0.5, 0.4],
        "there is no action wings; there are speed, steer\nstate has 0 numbers, not 3",
    ),
];

#[test]
fn one_simulator_drives_all_models() {
    if !needs::tool("javac") || !has_file(COMMONS_MATH) {
        return;
    }
    let folder = scratch("dcml-java-simulator");
    std::fs::create_dir(folder.join("src")).unwrap();
    write_interface(&folder);
    std::fs::write(folder.join("src/Simulator.java"), SIMULATOR).unwrap();
    let models = CASES.map(|(name, class, ..)| {
        let text = lang_dcml::models::named(name).unwrap().text;
        let model = lang_dcml::understand(text).models.remove(0);
        let source = generate(&model, Target::Java, &Options::default()).unwrap();
        let simple = class.rsplit('.').next().unwrap();
        std::fs::write(folder.join(format!("src/{simple}.java")), source).unwrap();
        model
    });
    compile_java(&folder);
    for (model, (_, class, params, state, action, refused)) in models.iter().zip(CASES) {
        let mut robot = Robot::new(model, params).unwrap();
        let mut given = Vec::new();
        let params = model
            .of_kind(lang_dcml::syntax::Kind::Param)
            .map(|one| one.name.as_str())
            .zip(params);
        let names = |parts: &[lang_dcml::robot::Part]| -> Vec<String> {
            parts.iter().map(|one| one.name.clone()).collect()
        };
        given.extend(params.map(|(name, number)| format!("{name}={number}")));
        for (names, numbers) in [
            (names(robot.state_parts()), state),
            (names(robot.action_parts()), action),
        ] {
            given.extend(
                names
                    .iter()
                    .zip(numbers)
                    .map(|(name, number)| format!("{name}={number}")),
            );
        }
        let path = format!("{COMMONS_MATH}:out");
        let mut words = vec!["java", "-cp", &path, "Simulator", class, "200", "0.01"];
        words.extend(given.iter().map(String::as_str));
        let printed = run(&folder, &words);
        let mut lines = printed.lines();
        assert_eq!(lines.next(), Some(model.name.as_str()));
        let mut state = state.to_vec();
        Propagator::new().run(&mut robot, &mut state, action, 2.0, 200);
        let mut outputs = vec![0.0; robot.outputs()];
        robot.output(&state, action, &mut outputs);
        for (at, wanted) in state.iter().chain(&outputs).enumerate() {
            let found: f64 = lines.next().unwrap().parse().unwrap();
            let wraps = at < state.len() && robot.wraps(at);
            let turns = (found - wanted) / std::f64::consts::TAU;
            let turns = if wraps { turns.round() } else { 0.0 };
            let error = found - wanted - turns * std::f64::consts::TAU;
            assert!(error.abs() < 1e-9, "{class}: {at}: {found} {wanted}");
            assert!(!wraps || found.abs() <= std::f64::consts::PI, "{found}");
        }
        assert_eq!(lines.collect::<Vec<_>>().join("\n"), refused, "{class}");
    }
    let _ = std::fs::remove_dir_all(&folder);
}
