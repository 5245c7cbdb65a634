//! How soon thirty robots are at rest after a stop on the page of their class, as a viewer sees it.
//!
//! `cargo bench -p page --bench class`; the robots are sockets of this process that answer at once, so what is measured is the
//! page. The limit is that of people: 100 ms, in which all robots of a class shall be at rest on one network.

#[allow(dead_code, reason = "tests use more of it")]
#[path = "../src/client.rs"]
mod client;
#[allow(dead_code, reason = "tests use more of it")]
#[path = "../src/class/tests/fake.rs"]
mod fake;

use fake::{Fake, Viewer, all, page};
use page::{Guests, class};
use std::net::IpAddr;
use std::sync::Arc;
use std::time::Instant;

const ROBOTS: usize = 30;
const STOPS: usize = 200;
const GOAL_MS: f64 = 100.0;

/// This computer commands.
struct Everybody;

impl Guests for Everybody {
    fn may_look(&self, _: IpAddr) -> bool {
        true
    }

    fn may_drive(&self, _: IpAddr) -> bool {
        true
    }

    fn asks(&self, _: IpAddr) {}
}

fn main() {
    let robots: Vec<_> = (0..ROBOTS).map(|_| Fake::new()).collect();
    let ways: Vec<_> = robots.iter().map(|robot| Some(robot.at)).collect();
    let page = page(&ways, Arc::new(Everybody));
    let mut viewer = Viewer::of(&page);
    viewer.until("they are there", |cards| {
        all(cards, |card| card["reach"] == "there")
    });
    let everybody = format!("{:?}", (0..ROBOTS).collect::<Vec<_>>());
    let mut took = Vec::new();
    for _ in 0..STOPS {
        let run = format!("{{\"do\":\"run\",\"robots\":{everybody},\"name\":\"a.js\"}}");
        viewer.socket.order(&run);
        viewer.until("all run", |cards| all(cards, |card| card["runs"] == "a.js"));
        let begun = Instant::now();
        let stop = format!("{{\"do\":\"stop\",\"robots\":{everybody}}}");
        viewer.socket.order(&stop);
        viewer.until("all rest", |cards| {
            all(cards, |card| card["stop"]["is"] == "rests")
        });
        took.push(begun.elapsed());
    }
    took.sort_unstable();
    println!("{ROBOTS} robots at rest after a stop, as a viewer sees it, {STOPS} stops");
    for (name, took) in [
        ("p50", took[STOPS / 2]),
        ("p99", took[STOPS * 99 / 100]),
        ("most", took[STOPS - 1]),
    ] {
        let ms = took.as_secs_f64() * 1000.0;
        let ratio = ms / GOAL_MS;
        println!("{name:<5} {ms:8.2} ms   {ratio:.3} of the goal, {GOAL_MS} ms");
    }
}
