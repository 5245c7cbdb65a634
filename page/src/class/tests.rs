//! The page of a class as viewers see it, over robots that are sockets of these tests and speak the control port.

mod fake;

use super::*;
use crate::client::get;
use crate::guests::Everybody;
use fake::{Fake, Viewer, all, page};
use std::net::{IpAddr, TcpListener};
use std::sync::atomic::{AtomicBool, Ordering};

#[test]
fn each_robot_has_a_card_that_says_what_it_does_or_why_it_is_not_there() {
    let robot = Fake::new();
    let gone = TcpListener::bind("127.0.0.1:0")
        .unwrap()
        .local_addr()
        .unwrap();
    let page = page(&[Some(robot.at), Some(gone), None], Arc::new(Everybody));
    let mut viewer = Viewer::of(&page);
    viewer.until("all are known", |cards| {
        cards[0]["reach"] == "there"
            && cards[1]["reach"] == "absent"
            && cards[2]["reach"] == "absent"
    });
    let why = viewer.cards[1]["why"].as_str().unwrap();
    assert!(why.starts_with("nothing takes programs at "), "{why}");
    assert_eq!(viewer.cards[2]["why"], "nowhere");
    assert_eq!(viewer.cards[0]["page"], "http://127.0.0.1:8000/");
    robot.hang_up();
    viewer.until("it is gone", |cards| cards[0]["reach"] == "absent");
    viewer.until("it is back", |cards| cards[0]["reach"] == "there");
    // A viewer that comes later is told the same.
    let mut other = Viewer::of(&page);
    other.until("all are known", |cards| {
        all(cards, |card| card["reach"].is_string())
    });
}

#[test]
fn a_file_goes_to_the_chosen_ones_and_what_becomes_of_it_is_told_for_each() {
    let robots = [Fake::new(), Fake::new(), Fake::new()];
    let ways: Vec<_> = robots.iter().map(|robot| Some(robot.at)).collect();
    let page = page(&[&ways[..], &[None]].concat(), Arc::new(Everybody));
    let mut viewer = Viewer::of(&page);
    viewer.until("they are there", |cards| {
        all(&cards[..3], |card| card["reach"] == "there")
    });
    viewer.send("[0,2,3]", "a.js", true);
    viewer.until("two run it", |cards| {
        cards[0]["runs"] == "a.js"
            && cards[2]["runs"] == "a.js"
            && cards[3]["sending"]["is"] == "failed"
    });
    assert_eq!(viewer.cards[0]["sending"]["is"], "runs");
    assert_eq!(
        viewer.cards[3]["sending"]["why"],
        "the robot is not reached"
    );
    assert_eq!(robots[0].heard(), ["file:a.js", "run:a.js"]);
    assert!(robots[1].heard().is_empty());
    viewer.send("[1]", "full.js", true);
    viewer.until("it is refused", |cards| {
        cards[1]["sending"]["is"] == "failed"
    });
    assert_eq!(
        viewer.cards[1]["sending"]["why"],
        "the upload failed: the disk is full"
    );
    viewer.send("[1]", "b.js", false);
    viewer.until("it is there", |cards| cards[1]["sending"]["is"] == "sent");
    viewer
        .socket
        .order(r#"{"do":"run","robots":[1],"name":"bad.js"}"#);
    viewer.until("it does not run", |cards| {
        cards[1]["sending"]["name"] == "bad.js" && cards[1]["sending"]["is"] == "failed"
    });
    let why = viewer.cards[1]["sending"]["why"].as_str().unwrap();
    assert!(why.contains("it is bad"), "{why}");
}

#[test]
fn a_stop_reaches_all_and_waits_for_one_that_is_gone() {
    let robots = [Fake::new(), Fake::new()];
    let page = page(
        &[Some(robots[0].at), Some(robots[1].at)],
        Arc::new(Everybody),
    );
    let mut viewer = Viewer::of(&page);
    viewer.until("they are there", |cards| {
        all(cards, |card| card["reach"] == "there")
    });
    viewer
        .socket
        .order(r#"{"do":"run","robots":[0,1],"name":"a.js"}"#);
    viewer.until("both run", |cards| {
        all(cards, |card| card["runs"] == "a.js")
    });
    // One hangs: it is connected and answers nothing, which delays nobody.
    robots[1].state.is_deaf.store(true, Ordering::Relaxed);
    viewer.socket.order(r#"{"do":"stop","robots":[0,1]}"#);
    viewer.until("one rests", |cards| {
        cards[0]["stop"]["is"] == "rests" && cards[0]["runs"].is_null()
    });
    assert_eq!(viewer.cards[1]["stop"]["is"], "asked");
    robots[1].hang_up();
    viewer.until("it is gone", |cards| cards[1]["reach"] == "absent");
    assert_eq!(viewer.cards[1]["stop"]["is"], "asked");
    robots[1].state.is_deaf.store(false, Ordering::Relaxed);
    viewer.until("it is back and rests", |cards| {
        cards[1]["stop"]["is"] == "rests"
    });
    assert!(robots[1].heard().contains(&"stop".to_owned()));
    // What begins again is not at rest.
    viewer
        .socket
        .order(r#"{"do":"run","robots":[0],"name":"a.js"}"#);
    viewer.until("it runs", |cards| cards[0]["runs"] == "a.js");
    assert!(viewer.cards[0]["stop"].is_null());
}

#[test]
fn a_robot_that_says_that_something_does_not_rest_is_not_at_rest() {
    let robot = Fake::new();
    let page = page(&[Some(robot.at)], Arc::new(Everybody));
    let mut viewer = Viewer::of(&page);
    viewer.until("it is there", |cards| cards[0]["reach"] == "there");
    for start in EXPLAINED {
        let why = format!("{start}x");
        robot.state.unrest.lock().unwrap().clone_from(&why);
        viewer.socket.order(r#"{"do":"stop","robots":[0]}"#);
        viewer.until(&why, |cards| {
            cards[0]["stop"]["is"] == "failed" && cards[0]["stop"]["why"] == why
        });
    }
    robot.state.unrest.lock().unwrap().clear();
    viewer.socket.order(r#"{"do":"stop","robots":[0]}"#);
    viewer.until("it rests", |cards| cards[0]["stop"]["is"] == "rests");
}

#[test]
fn a_card_has_the_battery_and_who_commands_and_keeps_the_battery_with_its_age() {
    let robots = [Fake::new(), Fake::new()];
    let told = "battery 11.87 V, 2 s ago\ncontrol 10.0.0.1:5\ndebugger 10.0.0.2:6 is in control\n";
    told.clone_into(&mut robots[0].state.more.lock().unwrap());
    let page = page(
        &[Some(robots[0].at), Some(robots[1].at)],
        Arc::new(Everybody),
    );
    let mut viewer = Viewer::of(&page);
    viewer.until("it is told", |cards| {
        cards[0]["battery"]["text"] == "11.87 V"
    });
    assert_eq!(viewer.cards[0]["commander"], "10.0.0.1");
    assert_eq!(viewer.cards[0]["debugger"], "10.0.0.2");
    assert!(viewer.cards[0]["battery"]["ageMs"].as_u64().unwrap() >= 2000);
    // One without a battery has none.
    viewer.until("the other is there", |cards| cards[1]["reach"] == "there");
    assert!(viewer.cards[1]["battery"].is_null());
    robots[0].state.is_deaf.store(true, Ordering::Relaxed);
    robots[0].hang_up();
    viewer.until("it is gone", |cards| cards[0]["reach"] == "absent");
    assert_eq!(viewer.cards[0]["battery"]["text"], "11.87 V");
    assert!(viewer.cards[0]["commander"].is_null() && viewer.cards[0]["debugger"].is_null());
}

#[test]
fn a_file_that_is_on_its_way_is_not_run_before_it_is_there() {
    let robot = Fake::new();
    let page = page(&[Some(robot.at)], Arc::new(Everybody));
    let mut viewer = Viewer::of(&page);
    viewer.until("it is there", |cards| cards[0]["reach"] == "there");
    robot.state.is_deaf.store(true, Ordering::Relaxed);
    viewer.send("[0]", "a.js", false);
    viewer.until("it is on its way", |cards| {
        cards[0]["sending"]["is"] == "sending"
    });
    let run = r#"{"do":"run","robots":[0],"name":"a.js"}"#;
    viewer.socket.order(run);
    let why = viewer.socket.until("\"refused\"");
    assert!(why.contains("files are on their way"), "{why}");
}

/// Others look; whether this computer may do something is told.
struct Sometimes(AtomicBool);

impl Guests for Sometimes {
    fn may_look(&self, _: IpAddr) -> bool {
        true
    }

    fn may_drive(&self, _: IpAddr) -> bool {
        self.0.load(Ordering::Relaxed)
    }

    fn asks(&self, _: IpAddr) {}
}

#[test]
fn those_who_only_look_take_no_place_from_who_commands() {
    let guests = Arc::new(Sometimes(AtomicBool::new(false)));
    let page = page(&[None], guests.clone());
    let all: Vec<_> = (0..limits::BROWSERS_MAX)
        .map(|_| Viewer::of(&page))
        .collect();
    let (head, _) = Viewer::knock(&page);
    assert!(head.starts_with("HTTP/1.1 503 "), "{head}");
    guests.0.store(true, Ordering::Relaxed);
    drop(Viewer::of(&page));
    drop(all);
}

/// Others look, and may do nothing.
struct Looks;

impl Guests for Looks {
    fn may_look(&self, _: IpAddr) -> bool {
        true
    }

    fn may_drive(&self, _: IpAddr) -> bool {
        false
    }

    fn asks(&self, _: IpAddr) {}
}

#[test]
fn a_computer_that_may_only_look_commands_nothing() {
    let robot = Fake::new();
    let page = page(&[Some(robot.at)], Arc::new(Looks));
    let mut viewer = Viewer::of(&page);
    viewer.until("it is there", |cards| cards[0]["reach"] == "there");
    viewer.socket.order(r#"{"do":"stop","robots":[0]}"#);
    let why = viewer.socket.until("\"refused\"");
    assert!(why.contains("this computer may only look"), "{why}");
    viewer.send("[0]", "a.js", true);
    viewer.socket.until("\"refused\"");
    assert!(robot.heard().is_empty());
}

#[test]
fn nothing_is_given_to_pages_of_others() {
    let page = page(&[None], Arc::new(Everybody));
    let at = page.address();
    assert!(get(at, "/", "").starts_with("HTTP/1.1 307 "));
    for (path, headers) in [
        ("/socket/class", ""),
        ("/socket/class", "Cookie: trik=guessed\r\n"),
        ("/class", "Origin: http://evil.example\r\n"),
    ] {
        let answer = get(at, path, headers);
        assert!(answer.starts_with("HTTP/1.1 403 "), "{path}: {answer}");
        assert!(!answer.contains("set-cookie"), "{answer}");
    }
    let answer = get(at, "/class", "");
    assert!(
        answer.contains("content-security-policy: default-src 'none'"),
        "{answer}"
    );
    // Those of one robot are not here.
    assert!(get(at, "/programs", "").starts_with("HTTP/1.1 404 "));
}
