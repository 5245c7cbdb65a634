//! The display: a plain file instead of the frame buffer, and a picture of it for people beside the robot.
//!
//! Owns both files. Nothing is written to the second before the first has changed.

use crate::attributes::Attributes;
use crate::files::Part;
use crate::limits::DISPLAY_MS;
use crate::shared::Shared;
use screen::Pixels;
use screen::limits::{HEIGHT, WIDTH};
use std::fs::File;
use std::io::{self, Read};
use std::path::{Path, PathBuf};
use std::time::{Duration, Instant};

const DEVICE: &str = "dev/fb0";
const PICTURE: &str = "display.ppm";

/// What is on the display.
pub struct Display {
    root: PathBuf,
    has_changed: bool,
    written: Option<Instant>,
}

impl Display {
    /// A dark one.
    pub fn make(attributes: &mut Attributes) -> io::Result<Self> {
        let root = attributes.root().to_owned();
        let dark = Pixels::new(WIDTH, HEIGHT, None);
        std::fs::create_dir_all(root.join("dev"))?;
        std::fs::write(root.join(DEVICE), dark.to_rgb565())?;
        attributes.file(DEVICE)?;
        write(&root, &dark)?;
        Ok(Self {
            root,
            has_changed: false,
            written: None,
        })
    }
}

fn read(root: &Path) -> io::Result<Pixels> {
    let size = 2 * u64::from(WIDTH) * u64::from(HEIGHT);
    let mut bytes = Vec::new();
    let file = File::open(root.join(DEVICE))?;
    file.take(size).read_to_end(&mut bytes)?;
    Ok(Pixels::from_rgb565(WIDTH, HEIGHT, &bytes))
}

/// In one moment: who opens it sees a whole picture.
fn write(root: &Path, pixels: &Pixels) -> io::Result<()> {
    let fresh = root.join(".display");
    std::fs::write(&fresh, pixels.to_ppm())?;
    std::fs::rename(fresh, root.join(PICTURE))
}

impl Part for Display {
    fn run(&mut self, _shared: &Shared) -> f64 {
        let pause = Duration::from_millis(DISPLAY_MS);
        let is_due = self.written.is_none_or(|at| at.elapsed() >= pause);
        if self.has_changed && is_due {
            self.has_changed = false;
            self.written = Some(Instant::now());
            // Without room for the picture there is none.
            if let Ok(pixels) = read(&self.root) {
                let _ = write(&self.root, &pixels);
            }
        }
        // The thread comes by often enough.
        f64::INFINITY
    }

    fn changed(&mut self, name: &str, _attributes: &Attributes) {
        self.has_changed |= name == DEVICE;
    }
}
