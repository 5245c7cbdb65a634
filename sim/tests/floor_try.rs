//! try
use std::path::Path;
use std::rc::Rc;
use lang::diagram::lower::{World, lower};
use lang::diagram::machine::trace::Deaf;
use lang::diagram::machine::{Machine, Options, STEP_MS};
use lang::diagram::ports::Port;
use lang::diagram::read::read;
use lang::diagram::stand_in::{Placing, StandIn};
use sim::arena::floor::{*, outline::*, picture::*, sensors};
use sim::geometry::point;

#[test]
fn example4() {
    let data = Path::new(concat!(env!("CARGO_MANIFEST_DIR"), "/../../shared/data"));
    let opened = read(&std::fs::read(data.join("examples/4._AlongTheLine.qrs")).unwrap()).unwrap();
    let world = opened.project.world.clone().unwrap();
    let blob = std::fs::read_to_string("/tmp/blob4.xml").unwrap();
    let doc = lang::xml::parse(&blob).unwrap();
    let image = doc.child("blobs").unwrap().child("images").unwrap().child("image").unwrap();
    let text: String = image.nodes.iter().filter_map(|n| match n { lang::xml::Node::Text(t) => Some(t.to_string()), _ => None }).collect();
    let picture = Picture::read("a.svg", &text).unwrap();
    println!("layers {} lacks {:?}", picture.layers.len(), picture.lacks);
    let mut floor = Floor::default();
    floor.add_picture(&picture, &Affine([1000.0, 0.0, 0.0, 631.0, -675.0, -450.0]));
    let lowered = lower(&opened.project, World::default()).unwrap();
    let mut machine = Machine::new(Rc::new(lowered.program), Options::simulated());
    let mut robot = StandIn::new(Placing::of_world(&world));
    let oracle = std::fs::read_to_string(data.join("oracle/example-4._AlongTheLine.json")).unwrap();
    let poses: Vec<Vec<f64>> = oracle.split("\"poses_100ms\":[").nth(1).unwrap().split("]]").next().unwrap().split('[').skip(1)
        .map(|t| t.split([',', ']']).filter(|t| !t.is_empty()).map(|n| n.parse().unwrap()).collect()).collect();
    let mut poses = poses.iter().peekable();
    let mut now = 0;
    let mut window = Window::default();
    let start = std::time::Instant::now();
    let mut worst: f64 = 0.0;
    loop {
        if now > 0 { robot.tick(); }
        for (name, x, y) in [("A2", 57.0, 40.0), ("A1", 56.0, 9.0)] {
            let (s, c) = (robot.pose.degrees / 180.0 * 3.14159265358979323846_f64).sin_cos();
            let (x, y): (f64, f64) = (x - 25.0, y - 25.0);
            let dx = f64::from((x * c - y * s) as f32);
            let dy = f64::from((x * s + y * c) as f32);
            floor.look(point(robot.pose.x + 25.0 + dx, robot.pose.y + 25.0 + dy), robot.pose.degrees, 12, 1.0, &mut window);
            robot.readings.insert(Port::named(name).unwrap(), sensors::light(&window, None));
        }
        machine.step(now, &mut robot, &mut Deaf);
        if let Some(p) = poses.next_if(|p| p[0] == f64::from(now)) {
            let d = (robot.pose.x - p[1]).abs().max((robot.pose.y - p[2]).abs()).max((robot.pose.degrees - p[3]).abs());
            worst = worst.max(d);
            println!("{now} {d:.6} {:?} {:?}", robot.pose, p);
        }
        if poses.peek().is_none() || now > 60_000 { break; }
        now += STEP_MS;
    }
    println!("worst {worst} in {:?}", start.elapsed());
}
