//! Leases without a mount: claims of processes that are made up.

use super::*;
use std::sync::atomic::{AtomicU32, Ordering};

#[derive(Default)]
struct Bell(AtomicU32);

impl Ready for Bell {
    fn ready(&self) {
        self.0.fetch_add(1, Ordering::Relaxed);
    }
}

fn lease() -> Arc<Lease> {
    Lease::new("motor", &Engine::start().expect("an engine"))
}

fn bell() -> (Arc<Bell>, Weak<dyn Ready>) {
    let bell = Arc::new(Bell::default());
    let there: Arc<dyn Ready> = bell.clone();
    let weak = Arc::downgrade(&there);
    (bell, weak)
}

const NOBODY: u32 = u32::MAX;

fn priority(number: u32) -> Wish {
    Wish {
        priority: Some(number),
        ..Wish::default()
    }
}

#[test]
fn a_wish_is_numbers_behind_their_names() {
    let both = Wish {
        priority: Some(5),
        deadman_ms: Some(100),
    };
    assert_eq!(Wish::parse("priority 5 deadman_ms 100\n"), Ok(both));
    assert_eq!(Wish::parse("deadman_ms 100\npriority 5"), Ok(both));
    assert_eq!(Wish::parse(" \n"), Ok(Wish::default()));
    for text in ["x", "priority", "priority x", "priority 1 priority 2", "5"] {
        assert!(
            matches!(Wish::parse(text), Err(Error::Invalid(_))),
            "{text}"
        );
    }
    for text in [
        "priority 101",
        "priority -1",
        "deadman_ms 60001",
        "deadman_ms 99999999999",
    ] {
        assert!(
            matches!(Wish::parse(text), Err(Error::OutOfRange(_))),
            "{text}"
        );
    }
}

#[test]
fn the_first_claim_holds_and_a_higher_priority_takes_over() {
    let lease = lease();
    let ((first, watching), (_, idle)) = (bell(), bell());
    assert_eq!(lease.line(), "\n");
    let holder = lease.claim(NOBODY, false, watching).expect("free");
    assert_eq!(lease.line(), "4294967295 ? priority 0 deadman_ms 0\n");
    assert!(matches!(
        lease.claim(NOBODY, false, idle.clone()),
        Err(Error::Busy(_))
    ));
    let asker = lease.claim(NOBODY, true, idle).expect("waits");
    assert!(!lease.is_held_by(asker));
    for wish in [priority(0), Wish::default()] {
        assert!(matches!(lease.ask(asker, wish), Err(Error::Busy(_))));
    }
    lease.ask(asker, priority(1)).expect("higher");
    assert!(lease.is_held_by(asker) && !lease.is_held_by(holder));
    assert_eq!(first.0.load(Ordering::Relaxed), 1);
    assert!(matches!(
        lease.ask(holder, priority(1)),
        Err(Error::Busy(_))
    ));
    lease.ask(holder, priority(2)).expect("back");
    lease.leave(holder);
    assert_eq!(lease.line(), "\n");
    lease.ask(asker, priority(0)).expect("free");
    assert!(lease.is_held_by(asker));
}

#[test]
fn only_the_holder_and_its_descendants_write_and_who_lost_it_does_not() {
    let lease = lease();
    let (_bell, watcher) = bell();
    let me = std::process::id();
    assert_eq!(lease.admit(NOBODY, None), Ok(0));
    let parent = nix::unistd::getppid().as_raw().cast_unsigned();
    let claim = lease.claim(parent, false, watcher).expect("free");
    let generation = lease.admit(me, None).expect("a child of the holder");
    assert_eq!(lease.admit(me, Some(generation)), Ok(generation));
    assert!(matches!(lease.admit(NOBODY, None), Err(Error::Busy(_))));
    lease.end(claim, NOBODY);
    assert!(lease.is_held_by(claim), "somebody else ended");
    lease.end(claim, parent);
    assert!(!lease.is_held_by(claim));
    assert!(matches!(
        lease.admit(me, Some(generation)),
        Err(Error::Busy(_))
    ));
    lease.admit(NOBODY, None).expect("free for all others");
    lease.leave(claim);
    lease.admit(me, None).expect("no claim is left");
}

#[test]
fn alarms_stay_few_however_often_the_clock_is_set() {
    let lease = lease();
    let (_bell, watcher) = bell();
    let claim = lease.claim(NOBODY, false, watcher).expect("free");
    for round in 0..10_000 {
        let wish = Wish {
            deadman_ms: Some(50_000 + round % 2 * 10_000),
            ..Wish::default()
        };
        lease.ask(claim, wish).expect("held");
    }
    assert!(lock(&lease.state).alarms.len() <= 2);
}
