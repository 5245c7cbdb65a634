//! The world around a virtual robot, which the one who makes it tells in two files: what stands still, and what moves.
//!
//! Owns the names of these files, and how much of them goes into a recording. Knows nothing of what is in them.

use crate::clock::now_ns;
use crate::entry::Entry;
use crate::limits;
use journal::standard::{Level, Log};
use journal::write::Story;
use std::fs::File;
use std::io::Read;
use std::os::unix::fs::MetadataExt;
use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::time::{Duration, Instant};

/// The file of what stands still.
pub const SCENE: &str = "scene.json";
/// The file of what moves. Each time it is another file under this name, so that it is whole whenever it is read.
pub const PLACES: &str = "places.json";
/// What stands still is in a recording as a file of this name.
pub const ATTACHED: &str = "world.json";

/// One of the files.
struct TextFile {
    path: PathBuf,
    /// Its number and its time.
    stamp: Option<(u64, i64, i64)>,
    most: u64,
    text: Option<Arc<[u8]>>,
}

impl TextFile {
    fn new(path: PathBuf, most: u64) -> Self {
        Self {
            path,
            stamp: None,
            most,
            text: None,
        }
    }

    /// What is in it, if that is new. One that is gone, or is too long, says nothing.
    fn news(&mut self) -> Option<Arc<[u8]>> {
        let Ok(found) = self.path.metadata() else {
            (self.stamp, self.text) = (None, None);
            return None;
        };
        let stamp = Some((found.ino(), found.mtime(), found.mtime_nsec()));
        if stamp == self.stamp {
            return None;
        }
        let mut text = Vec::new();
        let file = File::open(&self.path).ok()?;
        let read = file.take(self.most + 1).read_to_end(&mut text).ok()?;
        self.stamp = stamp;
        let is_whole = (1..=self.most).contains(&u64::try_from(read).unwrap_or(u64::MAX));
        let text: Arc<[u8]> = text.into();
        self.text = is_whole.then_some(text);
        self.text.clone()
    }
}

/// A world that is looked at.
pub(crate) struct World {
    scene: TextFile,
    places: TextFile,
    looks_at: Instant,
}

impl World {
    /// That of this folder, which need not be there yet.
    pub(crate) fn new(folder: &Path) -> Self {
        let scene = TextFile::new(folder.join(SCENE), limits::WORLD_SCENE_BYTES_MAX);
        let places = TextFile::new(folder.join(PLACES), limits::WORLD_PLACES_BYTES_MAX);
        Self {
            scene,
            places,
            looks_at: Instant::now(),
        }
    }

    /// Takes what has changed since the last look, at this moment.
    pub(crate) fn look(&mut self, now: Instant, out: &mut Vec<Entry>) {
        if now < self.looks_at {
            return;
        }
        self.looks_at = now + Duration::from_millis(limits::WORLD_MS);
        out.extend(self.scene.news().map(attached));
        if let Some(text) = self.places.news() {
            let size = u64::try_from(text.len()).unwrap_or(u64::MAX);
            let share = Duration::from_millis(size * 1000 / limits::WORLD_BYTES_PER_S);
            self.looks_at = self.looks_at.max(now + share);
            out.push(line(&text));
        }
    }

    /// What a recording that begins now must have first.
    pub(crate) fn beginning(&self) -> impl Iterator<Item = Entry> {
        let scene = self.scene.text.clone().map(attached);
        let places = self.places.text.as_deref().map(line);
        scene.into_iter().chain(places)
    }

    /// All of it is told once more at the next look.
    pub(crate) fn tell_again(&mut self) {
        (self.scene.stamp, self.places.stamp) = (None, None);
    }
}

fn attached(text: Arc<[u8]>) -> Entry {
    Entry::Attachment(now_ns(), ATTACHED.into(), "application/json", text)
}

fn line(text: &[u8]) -> Entry {
    let line = Log {
        level: Level::Info,
        name: "world".to_owned(),
        text: String::from_utf8_lossy(text).into_owned(),
        errno: 0,
    };
    Entry::Line(Story::World, now_ns(), Arc::new(line))
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::fs;
    use tempfile::{TempDir, tempdir};

    /// As the one who makes it does.
    fn tell(folder: &TempDir, name: &str, text: &str) {
        let begun = folder.path().join("begun");
        fs::write(&begun, text).unwrap();
        fs::rename(begun, folder.path().join(name)).unwrap();
    }

    fn said(entries: &[Entry]) -> Vec<String> {
        let text = |entry: &Entry| match entry {
            Entry::Attachment(_, name, _, bytes) => {
                format!("{name}: {}", String::from_utf8_lossy(bytes))
            }
            Entry::Line(story, _, line) => format!("{}: {}", story.topic(), line.text),
            Entry::Node(_) | Entry::Sample(..) | Entry::Fault(..) | Entry::Facts(..) => {
                "another".to_owned()
            }
        };
        entries.iter().map(text).collect()
    }

    fn looked(world: &mut World, at: Instant) -> Vec<String> {
        let mut out = Vec::new();
        world.look(at, &mut out);
        said(&out)
    }

    #[test]
    fn each_file_is_told_when_it_is_another_and_a_recording_begins_with_both() {
        let folder = tempdir().unwrap();
        let mut world = World::new(&folder.path().join("later"));
        assert!(
            looked(&mut world, Instant::now()).is_empty(),
            "nothing is there"
        );
        let mut world = World::new(folder.path());
        tell(&folder, SCENE, "S");
        tell(&folder, PLACES, "1");
        let second = Duration::from_secs(1);
        let mut now = Instant::now();
        assert_eq!(looked(&mut world, now), ["world.json: S", "/world: 1"]);
        now += second;
        assert!(looked(&mut world, now).is_empty(), "nothing is new");
        tell(&folder, PLACES, "2");
        assert_eq!(
            looked(&mut world, now),
            Vec::<String>::new(),
            "it is too soon"
        );
        now += second;
        assert_eq!(looked(&mut world, now), ["/world: 2"]);
        let first: Vec<Entry> = world.beginning().collect();
        assert_eq!(said(&first), ["world.json: S", "/world: 2"]);
        world.tell_again();
        now += second;
        assert_eq!(looked(&mut world, now), ["world.json: S", "/world: 2"]);
    }

    #[test]
    fn what_is_too_long_is_not_told_and_long_lines_come_seldom() {
        let folder = tempdir().unwrap();
        let mut world = World::new(folder.path());
        let long = |most: u64| "x".repeat(usize::try_from(most).unwrap());
        tell(&folder, SCENE, &long(limits::WORLD_SCENE_BYTES_MAX + 1));
        tell(&folder, PLACES, &long(limits::WORLD_PLACES_BYTES_MAX + 1));
        let mut now = Instant::now();
        assert!(looked(&mut world, now).is_empty());
        assert_eq!(world.beginning().count(), 0);
        tell(&folder, PLACES, &long(limits::WORLD_PLACES_BYTES_MAX));
        now += Duration::from_millis(limits::WORLD_MS);
        assert_eq!(looked(&mut world, now).len(), 1);
        tell(&folder, PLACES, "short");
        // 8 KiB are two fifths of what a second has.
        assert!(looked(&mut world, now + Duration::from_millis(399)).is_empty());
        assert_eq!(
            looked(&mut world, now + Duration::from_millis(400)).len(),
            1
        );
    }
}
