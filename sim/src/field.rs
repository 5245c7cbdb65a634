//! The world model of TRIK Studio: what stands, lies and is drawn on a field, its robots, and the rules of its task.
//!
//! Owns the plain data, all of it in pixels of the scene (x to the right, y down, degrees clockwise), and the XML that it is
//! read from and written to. What is not understood is kept and written again. Knows no physics and no pixels of pictures.
//!
//! The format is that of the world models in saves of TRIK Studio; its numbers may be in pixels, centimetres, millimetres
//! or metres, which `settings` says.

mod attributes;
mod blob;
mod hold;
mod items;
mod read;
mod table;
mod visit;
mod words;
mod write;

pub use blob::Blob;
pub use items::{
    Comment, Drawn, Image, Locks, Material, Pen, ROBOT_SIZE, Region, Robot, Sensor, SensorKind,
    Settings, Shape, Solid, SolidKind, Start, Stroke, Trace, Unit, Wall,
};
pub use read::Opened;
pub use table::{KINDS, Kind};

use std::collections::BTreeMap;

use lang_text::problem::Problem;
use lang_text::xml::Element;

/// A field with everything on it.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Field {
    /// Version of the format, as written.
    pub version: Option<String>,
    /// Unit of the numbers in the text.
    pub unit: Unit,
    /// How it is simulated and what lies under everything.
    pub settings: Settings,
    /// Walls, in order.
    pub walls: Vec<Wall>,
    /// Skittles, then balls, then cubes, in order.
    pub solids: Vec<Solid>,
    /// What is drawn on the floor, in order.
    pub drawn: Vec<Drawn>,
    /// Pictures on the floor, in order, backgrounds of old versions first.
    pub images: Vec<Image>,
    /// Contents of pictures by their `imageId`.
    pub blobs: BTreeMap<String, Blob>,
    /// Regions that rules speak of, in order.
    pub regions: Vec<Region>,
    /// Remarks for people.
    pub comments: Vec<Comment>,
    /// Strokes of a marker that an old version saved.
    pub trace: Vec<Trace>,
    /// Robots of all kits.
    pub robots: Vec<Robot>,
    /// Rules of the task, as they stand.
    pub constraints: Option<Element<'static>>,
    /// What the rest of it was read from.
    pub(crate) document: Option<Element<'static>>,
}

impl Field {
    /// Reads a world model.
    ///
    /// # Errors
    /// Everything for which it cannot be simulated: it is no world model, or numbers in it mean nothing.
    pub fn read(text: &str) -> Result<Opened, Vec<Problem>> {
        read::read(text)
    }

    /// Adds the contents of pictures, which saves keep in a text of their own.
    pub fn add_blobs(&mut self, text: &str) -> Vec<Problem> {
        read::add_blobs(self, text)
    }

    /// The world model as text, in its unit. What has not been changed is written as it was.
    pub fn write(&self) -> String {
        write::write(self)
    }

    /// The robot of TRIK; nothing if the field has only those of other kits.
    pub fn robot(&self) -> Option<&Robot> {
        self.robots.iter().find(|robot| robot.is_trik())
    }

    /// The same, to be changed.
    pub fn robot_mut(&mut self) -> Option<&mut Robot> {
        self.robots.iter_mut().find(|robot| robot.is_trik())
    }
}

#[cfg(test)]
mod facts;
#[cfg(test)]
mod tests;
