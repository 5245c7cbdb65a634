//! What a planner refuses, and what it does when a robot or a person makes it useless.

use super::*;

#[test]
fn start_and_goal_in_a_wall_are_refused_at_once() {
    let footprint = disc();
    let refused = |obstacles: &Obstacles, problem: &Problem| {
        let mut room = Room::new(obstacles, &footprint, PARTS, RESOLUTION).unwrap();
        plan(
            &mut unicycle(),
            &mut room,
            problem,
            &Options::default(),
            &mut |_| panic!("it searches"),
        )
        .unwrap_err()
    };
    let at_goal = room(vec![Shape::Rectangle([3.2, 2.2], [4.0, 3.0])]);
    assert_eq!(refused(&at_goal, &across()), Refusal::Goal);
    let at_start = room(vec![Shape::Circle([0.5, 0.7], 0.05)]);
    let told = |refusal: Refusal| refusal.told(&["x".to_owned(), "y".to_owned()]);
    assert_eq!(
        told(refused(&at_start, &across())),
        "the start is not free: the robot touches the circle 0.5 0.7 0.05"
    );
    let near = room(vec![
        Shape::Wall([2.0, 0.0], [2.0, 1.0], 0.02),
        Shape::Rectangle([0.5 + 0.15 + RESOLUTION / 4.0, 0.0], [1.0, 1.0]),
    ]);
    let why = told(refused(&near, &across()));
    assert!(
        why.starts_with("the start is not free: the robot is nearer than "),
        "{why}"
    );
    let mut beyond = across();
    beyond.start[1] = -3.0;
    let why = told(refused(&room(vec![]), &beyond));
    assert!(
        why.starts_with("the start is not free: y is -3 there, outside of "),
        "{why}"
    );
    assert!(
        refused(&room(vec![]), &beyond)
            .to_string()
            .contains("part 2 of the place is -3"),
    );
    let mut outside = across();
    outside.goal[0].wanted[0].1 = 9.0;
    assert_eq!(refused(&room(vec![]), &outside), Refusal::Goal);
    // A goal that is free in a corner only is a goal.
    let mostly = room(vec![Shape::Circle([3.5, 2.5], 0.2)]);
    let mut wide = across();
    wide.goal[0].tolerance = 0.45;
    let outcome = search(
        &mut unicycle(),
        &mostly,
        &footprint,
        &wide,
        &Options::default(),
    );
    assert!(outcome.path.is_some());
}

#[test]
fn a_start_in_the_goal_is_a_path_without_pieces() {
    let mut problem = across();
    problem.goal[0].wanted = vec![(0, 0.45), (1, 0.5)];
    let outcome = search(
        &mut unicycle(),
        &gap(),
        &disc(),
        &problem,
        &Options::default(),
    );
    let path = outcome.path.unwrap();
    assert_eq!((path.steps(), outcome.counts.propagations), (0, 0));
    assert_eq!(path.end(), [0.5, 0.5, 0.0]);
}

#[test]
fn what_means_nothing_is_refused() {
    let refused = |change: &dyn Fn(&mut Problem, &mut Options)| {
        let (mut problem, mut options) = (across(), Options::default());
        change(&mut problem, &mut options);
        let told = plan(
            &mut unicycle(),
            &mut Anywhere,
            &problem,
            &options,
            &mut |_| false,
        );
        told.unwrap_err().to_string()
    };
    for bad in [f64::NAN, f64::INFINITY] {
        let range = format!("action 1: 0 .. {bad} is no range");
        assert_eq!(refused(&|one, _| one.actions[0].1 = bad), range);
        assert_eq!(
            refused(&|one, _| one.start[0] = bad),
            "a start has 3 finite numbers"
        );
        assert!(refused(&|one, _| one.axes[0].low = bad).starts_with("axis 1: "));
        assert!(refused(&|one, _| one.axes[0].weight = bad).starts_with("axis 1: "));
        assert_eq!(
            refused(&|one, _| one.goal[0].wanted[0].1 = bad),
            "the goal is no value of an axis"
        );
        assert!(refused(&|one, _| one.goal[0].tolerance = bad).contains("tolerance"));
        assert!(refused(&|one, _| one.step = bad).contains("no step of time"));
        assert!(refused(&|_, how| how.goal_bias = bad).contains("is not from 0 to 1"));
    }
    assert!(refused(&|one, _| one.actions[0] = (1.0, 0.0)).contains("no range"));
    assert!(refused(&|one, _| one.actions[0] = (-1e308, 1e308)).contains("no range"));
    assert!(refused(&|one, _| one.hold = (0, 3)).contains("held for"));
    assert!(refused(&|one, _| one.hold = (4, 3)).contains("held for"));
    assert!(refused(&|one, _| one.axes[0].part = 3).starts_with("axis 1: "));
    assert!(refused(&|one, _| one.axes.clear()).contains("no axis has a weight"));
    assert_eq!(refused(&|one, _| one.goal.clear()), "there is no goal");
    assert!(refused(&|_, how| how.attempts = 0).contains("attempts"));
    assert!(refused(&|_, how| how.nodes = 0).contains("nodes"));
    let no_radius = |_: &mut Problem, how: &mut Options| {
        how.method = Method::Sst {
            selection: 0.0,
            pruning: 0.1,
        };
    };
    assert!(refused(&no_radius).contains("radii"));
    for (states, actions, want) in [(0, 1, Refusal::NoStates), (1, 0, Refusal::NoActions)] {
        let mut robot = Robot {
            states,
            actions,
            slope: |_, _, _| {},
        };
        let told = plan(
            &mut robot,
            &mut Anywhere,
            &across(),
            &Options::default(),
            &mut |_| true,
        );
        assert_eq!(told.unwrap_err(), want);
    }
}

#[test]
fn a_system_that_runs_away_is_a_collision() {
    // Each motion has two steps at least, and the second one ends nowhere.
    let mut wild = Robot {
        states: 3,
        actions: 2,
        slope: |x, u, d| {
            let is_far = x[0] > 0.56;
            d[0] = if is_far { 1.0 / (x[0] - x[0]) } else { 1.0 };
            d[1] = if is_far { (u[0] * 1e3).exp() } else { 0.0 };
            d[2] = if is_far { 1e308 * u[1] } else { 0.0 };
        },
    };
    let options = Options {
        iterations: 500,
        ..Options::default()
    };
    let outcome = search(&mut wild, &gap(), &disc(), &across(), &options);
    assert_eq!(outcome.path, None);
    assert!(outcome.counts.propagations >= 500);
    assert_eq!(outcome.counts.collisions, outcome.counts.propagations);
}

#[test]
fn a_system_that_has_no_numbers_at_the_start_is_refused() {
    let mut wild = Robot {
        states: 3,
        actions: 2,
        slope: |x, _, d| d.fill(1.0 / (x[0] - x[0])),
    };
    let options = Options::default();
    let told = plan(&mut wild, &mut Anywhere, &across(), &options, &mut |_| true);
    assert_eq!(told.unwrap_err(), Refusal::NoNumbers);
}
