//! The world around a virtual robot, told in files for those who record it.
//!
//! Owns how often that is, and what is left out of a world that is too large for a recording. Which files these are is known to
//! `recorder`, what is in them to the simulator and to the page.

use crate::limits;
use page::world::World;
use recorder::world::{PLACES, SCENE};
use serde_json::Value;
use std::fs;
use std::io;
use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::sync::mpsc::{Receiver, RecvTimeoutError, Sender, channel};
use std::thread::JoinHandle;
use std::time::{Duration, Instant};

/// Where the world of the board there is told.
pub(crate) fn folder(board: &Path) -> PathBuf {
    board.join("world")
}

/// The thread that tells. Dropping it ends that.
pub(super) struct Telling {
    /// None at the end.
    end: Option<Sender<()>>,
    thread: Option<JoinHandle<()>>,
}

impl Telling {
    /// Tells this world in this folder, which is made.
    ///
    /// # Errors
    /// The folder cannot be made, or there are no more threads.
    pub(super) fn start(world: Arc<dyn World>, folder: PathBuf) -> io::Result<Self> {
        fs::create_dir_all(&folder)?;
        let (end, ended) = channel();
        let mut told = Teller::new(world, folder);
        let thread = std::thread::Builder::new().name("telling".to_owned());
        let thread = thread.spawn(move || told.run(&ended))?;
        Ok(Self {
            end: Some(end),
            thread: Some(thread),
        })
    }
}

impl Drop for Telling {
    fn drop(&mut self) {
        self.end = None;
        if let Some(thread) = self.thread.take() {
            // It has failed: there is nothing to wait for.
            let _ = thread.join();
        }
    }
}

/// What was told last.
struct Teller {
    world: Arc<dyn World>,
    folder: PathBuf,
    version: Option<u64>,
    places: String,
    at: Instant,
}

impl Teller {
    fn new(world: Arc<dyn World>, folder: PathBuf) -> Self {
        Self {
            world,
            folder,
            version: None,
            places: String::new(),
            at: Instant::now(),
        }
    }

    fn run(&mut self, ended: &Receiver<()>) {
        let period = Duration::from_millis(limits::TOLD_MS);
        while ended.recv_timeout(period) == Err(RecvTimeoutError::Timeout) {
            self.tell(Instant::now());
        }
    }

    /// What has changed since the last time. Without room on the disk it is tried again.
    fn tell(&mut self, now: Instant) {
        if self.version != Some(self.world.version()) {
            let (version, scene) = self.world.scene();
            let written = match lean(scene) {
                Some(scene) => self.write(SCENE, &scene),
                // That of another world says nothing of this one.
                None => fs::remove_file(self.folder.join(SCENE)).or_else(|why| {
                    match why.kind() == io::ErrorKind::NotFound {
                        true => Ok(()),
                        false => Err(why),
                    }
                }),
            };
            self.version = written.is_ok().then_some(version);
        }
        let places = self.world.state();
        let is_due = now.duration_since(self.at) >= Duration::from_millis(limits::TOLD_AGAIN_MS);
        if places == self.places || (only_time_differs(&places, &self.places) && !is_due) {
            return;
        }
        if self.write(PLACES, &places).is_ok() {
            self.places = places;
            self.at = now;
        }
    }

    /// A reader has the file before or this one.
    fn write(&self, name: &str, text: &str) -> io::Result<()> {
        let begun = self.folder.join("begun");
        fs::write(&begun, text)?;
        fs::rename(begun, self.folder.join(name))
    }
}

/// Time is the first member of what moves.
fn only_time_differs(one: &str, other: &str) -> bool {
    let rest = |text: &str| text.split_once(',').map(|(_, rest)| rest.to_owned());
    rest(one) == rest(other)
}

/// What stands still, as far as a recording has room for it: first pictures are left out, then everything that cannot be moved.
/// None if not even the rest is short.
fn lean(scene: String) -> Option<String> {
    let most = usize::try_from(recorder::limits::WORLD_SCENE_BYTES_MAX).unwrap_or(usize::MAX);
    if scene.len() <= most {
        return Some(scene);
    }
    let mut value: Value = serde_json::from_str(&scene).ok()?;
    if let Some(items) = value.get_mut("items").and_then(Value::as_array_mut) {
        items.retain(|item| item["is"] != "image");
    }
    let without_pictures = value.to_string();
    if without_pictures.len() <= most {
        return Some(without_pictures);
    }
    for name in ["items", "marks"] {
        value[name] = Value::Array(Vec::new());
    }
    Some(value.to_string()).filter(|bare| bare.len() <= most)
}

#[cfg(test)]
mod tests {
    use super::*;
    use page::world::Refused;
    use serde_json::json;
    use std::sync::Mutex;
    use tempfile::tempdir;

    /// A world that is what the test says.
    struct TestWorld(Mutex<(u64, String, String)>);

    impl World for TestWorld {
        fn scene(&self) -> (u64, String) {
            let said = self.0.lock().unwrap();
            (said.0, said.1.clone())
        }

        fn version(&self) -> u64 {
            self.0.lock().unwrap().0
        }

        fn state(&self) -> String {
            self.0.lock().unwrap().2.clone()
        }

        fn order(&self, _: &str) -> Result<(), Refused> {
            Ok(())
        }
    }

    #[test]
    fn a_robot_that_stands_is_told_of_once_in_a_second() {
        let home = tempdir().unwrap();
        let world = Arc::new(TestWorld(Mutex::new((
            1,
            "S".to_owned(),
            "{\"t\":1,x".to_owned(),
        ))));
        let mut told = Teller::new(world.clone(), home.path().to_owned());
        let read = |name: &str| fs::read_to_string(home.path().join(name)).unwrap();
        let mut now = Instant::now();
        told.tell(now);
        assert_eq!(
            (read(SCENE), read(PLACES)),
            ("S".to_owned(), "{\"t\":1,x".to_owned())
        );
        world.0.lock().unwrap().2 = "{\"t\":2,x".to_owned();
        now += Duration::from_millis(limits::TOLD_MS);
        told.tell(now);
        assert_eq!(read(PLACES), "{\"t\":1,x");
        now += Duration::from_millis(limits::TOLD_AGAIN_MS);
        told.tell(now);
        assert_eq!(read(PLACES), "{\"t\":2,x");
        *world.0.lock().unwrap() = (2, "S2".to_owned(), "{\"t\":2.1,y".to_owned());
        told.tell(now);
        assert_eq!(
            (read(SCENE), read(PLACES)),
            ("S2".to_owned(), "{\"t\":2.1,y".to_owned())
        );
    }

    #[test]
    fn a_world_that_is_too_large_loses_pictures_first_and_then_what_stands() {
        let most = usize::try_from(recorder::limits::WORLD_SCENE_BYTES_MAX).unwrap();
        let picture = json!({"is": "image", "text": "x".repeat(most)});
        let wall = json!({"is": "wall", "points": [0, 0]});
        let scene = |items: Vec<Value>| json!({"items": items, "marks": [], "things": [1]});
        let told = |items: Vec<Value>| -> Value {
            serde_json::from_str(&lean(scene(items).to_string()).unwrap()).unwrap()
        };
        assert_eq!(told(vec![wall.clone()]), scene(vec![wall.clone()]));
        assert_eq!(told(vec![picture, wall.clone()]), scene(vec![wall.clone()]));
        assert_eq!(told(vec![wall; most / 16]), scene(Vec::new()));
        let things = json!({"items": [], "things": "x".repeat(most)});
        assert_eq!(lean(things.to_string()), None);
    }

    #[test]
    fn the_thread_ends_with_its_owner() {
        let home = tempdir().unwrap();
        let world = Arc::new(TestWorld(Mutex::new((1, "S".to_owned(), String::new()))));
        let telling = Telling::start(world.clone(), folder(home.path())).unwrap();
        assert!(folder(home.path()).is_dir());
        drop(telling);
        assert_eq!(Arc::strong_count(&world), 1);
    }
}
