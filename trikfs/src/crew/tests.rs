//! Tests of the crew: taking over, spares, the limit, panics.

use super::*;
use std::sync::mpsc::{Receiver, Sender, channel};
use std::time::{Duration, Instant};

const PATIENCE: Duration = Duration::from_secs(60);

/// One job: it says that it has begun, then waits for its end. Without channels it ends the crew.
type Job = Option<(Sender<()>, Receiver<()>)>;

struct Rig {
    crew: Crew,
    jobs: Sender<Job>,
    /// Threads that wait for work at the same time, and the most there ever were.
    waiting: Arc<(AtomicU32, AtomicU32)>,
}

impl Rig {
    fn new(limit: usize) -> Self {
        let (jobs, queue) = channel::<Job>();
        let queue = Mutex::new(queue);
        let waiting = Arc::new((AtomicU32::new(0), AtomicU32::new(0)));
        let counted = Arc::clone(&waiting);
        let role = move |seat: &Seat| {
            let now = counted.0.fetch_add(1, Ordering::SeqCst) + 1;
            counted.1.fetch_max(now, Ordering::SeqCst);
            let job = queue.lock().unwrap().recv().unwrap();
            counted.0.fetch_sub(1, Ordering::SeqCst);
            let Some((begun, end)) = job else {
                return ControlFlow::Break(());
            };
            seat.begin();
            let _ = begun.send(());
            let _ = end.recv();
            seat.end();
            ControlFlow::Continue(())
        };
        let crew = Crew::run("rig", limit, Urgency::Awaited, Arc::new(role)).unwrap();
        Self {
            crew,
            jobs,
            waiting,
        }
    }

    /// Gives out a job; the first channel tells of its beginning, dropping the second one ends it.
    fn job(&self) -> (Receiver<()>, Sender<()>) {
        let (begun, told) = channel();
        let (end, ended) = channel();
        self.jobs.send(Some((begun, ended))).unwrap();
        (told, end)
    }

    fn finish(self) -> Crew {
        self.jobs.send(None).unwrap();
        self.crew.wait();
        assert!(
            self.waiting.1.load(Ordering::SeqCst) <= 1,
            "two threads had the role"
        );
        self.crew
    }
}

fn eventually(what: &str, condition: impl Fn() -> bool) {
    let deadline = Instant::now() + PATIENCE;
    while !condition() {
        assert!(Instant::now() < deadline, "never: {what}");
        std::thread::yield_now();
    }
}

#[test]
fn quick_work_stays_on_one_thread() {
    let rig = Rig::new(4);
    for _ in 0..100 {
        let (begun, end) = rig.job();
        begun.recv_timeout(PATIENCE).unwrap();
        drop(end);
    }
    assert!(rig.crew.threads() <= 1 + rig.crew.late_count() as usize);
    rig.finish();
}

#[test]
fn late_work_does_not_hold_up_the_next() {
    let rig = Rig::new(4);
    let (first_begun, first_end) = rig.job();
    first_begun.recv_timeout(PATIENCE).unwrap();
    let (second_begun, second_end) = rig.job();
    second_begun.recv_timeout(PATIENCE).unwrap();
    assert!(rig.crew.late_count() >= 1);
    assert!(rig.crew.threads() >= 2);
    drop((first_end, second_end));
    let crew = rig.finish();
    eventually("all threads end", || crew.threads() == 0);
}

#[test]
fn a_late_thread_becomes_a_spare_and_is_used_again() {
    let rig = Rig::new(2);
    for _ in 0..5 {
        let (first_begun, first_end) = rig.job();
        first_begun.recv_timeout(PATIENCE).unwrap();
        let (second_begun, second_end) = rig.job();
        second_begun.recv_timeout(PATIENCE).unwrap();
        drop((first_end, second_end));
    }
    assert_eq!(rig.crew.threads(), 2);
    rig.finish();
}

#[test]
fn at_the_limit_the_first_late_thread_to_finish_takes_the_role() {
    let rig = Rig::new(2);
    let (first_begun, first_end) = rig.job();
    let (second_begun, second_end) = rig.job();
    let (third_begun, third_end) = rig.job();
    first_begun.recv_timeout(PATIENCE).unwrap();
    second_begun.recv_timeout(PATIENCE).unwrap();
    eventually("both are late", || rig.crew.late_count() == 2);
    assert!(third_begun.try_recv().is_err());
    drop(second_end);
    third_begun.recv_timeout(PATIENCE).unwrap();
    assert_eq!(rig.crew.threads(), 2);
    drop((first_end, third_end));
    rig.finish();
}

#[test]
fn a_crew_of_one_is_not_watched_and_goes_on() {
    let (alone, watched) = (Rig::new(1), Rig::new(2));
    let (begun, end) = alone.job();
    begun.recv_timeout(PATIENCE).unwrap();
    let (other_begun, other_end) = watched.job();
    other_begun.recv_timeout(PATIENCE).unwrap();
    eventually("who began later is late", || watched.crew.late_count() == 1);
    assert_eq!(alone.crew.late_count(), 0);
    drop((end, other_end));
    let (begun, end) = alone.job();
    begun.recv_timeout(PATIENCE).unwrap();
    assert_eq!(alone.crew.threads(), 1);
    drop(end);
    alone.finish();
    watched.finish();
}

#[test]
fn the_end_does_not_wait_for_late_threads() {
    let rig = Rig::new(2);
    let (begun, end) = rig.job();
    begun.recv_timeout(PATIENCE).unwrap();
    let crew = rig.finish();
    eventually("only the late thread is left", || crew.threads() == 1);
    drop(end);
    eventually("the late thread ends", || crew.threads() == 0);
}

#[test]
fn a_panic_while_waiting_reaches_who_waits_for_the_crew() {
    let crew = Crew::run(
        "panics",
        2,
        Urgency::Awaited,
        Arc::new(|_| panic!("on purpose, in a test")),
    )
    .unwrap();
    let caught = catch_unwind(AssertUnwindSafe(|| crew.wait()));
    assert_eq!(
        *caught.unwrap_err().downcast::<&str>().unwrap(),
        "on purpose, in a test"
    );
}

#[test]
fn a_panic_during_work_costs_that_work() {
    let cycles = AtomicU32::new(0);
    let role = move |seat: &Seat| {
        if cycles.fetch_add(1, Ordering::SeqCst) == 3 {
            return ControlFlow::Break(());
        }
        seat.begin();
        panic!("on purpose, in a test");
    };
    Crew::run("panics", 2, Urgency::Awaited, Arc::new(role))
        .unwrap()
        .wait();
}

/// A crew in which the first gives way and then waits for its end. True if the watchdog took no part.
fn gives_way_in_time() -> bool {
    let (begun, told) = channel();
    let (end, ended) = channel::<()>();
    let ended = Mutex::new(ended);
    let turns = AtomicU32::new(0);
    let role = move |seat: &Seat| {
        let turn = turns.fetch_add(1, Ordering::SeqCst);
        if turn == 2 {
            return ControlFlow::Break(());
        }
        seat.begin();
        if turn == 0 {
            give_way();
            give_way();
        }
        let _ = begun.send(std::thread::current().id());
        if turn == 0 {
            let _ = ended.lock().unwrap().recv();
        }
        seat.end();
        ControlFlow::Continue(())
    };
    let crew = Crew::run("giver", 4, Urgency::Awaited, Arc::new(role)).unwrap();
    let first = told.recv_timeout(PATIENCE).expect("the first");
    let second = told.recv_timeout(PATIENCE).expect("the second");
    assert_ne!(first, second);
    crew.wait();
    assert!(crew.late_count() <= 1, "relieved twice");
    assert!(crew.threads() <= 3, "{} threads", crew.threads());
    drop(end);
    crew.late_count() == 0
}

#[test]
fn who_gives_way_is_replaced_without_the_watchdog() {
    // On a loaded machine the watchdog may come between the beginning of work and the giving way.
    assert!((0..50).any(|_| gives_way_in_time()));
}

#[test]
fn a_thread_without_a_role_gives_nothing_away() {
    give_way();
    let lock = Mutex::new(7);
    assert_eq!(*lock_patiently(&lock), 7);
}
