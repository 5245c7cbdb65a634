//! What a teacher has locked, put back into a world that a pupil has saved.
//!
//! Owns which part of a field belongs to which lock, and what counts as changed. In the original a lock greys out a part of
//! the editor; here the locked part of the given world takes the place of the pupil's.

use std::fmt::Debug;

use lang_text::problem::Words;
use lang_text::xml::Element;

use super::words;
use super::{Field, Locks, Shape};

/// Differences of saved numbers that are none, in pixels and degrees.
const NEAR: f64 = 0.01;

impl Field {
    /// Puts what is locked in a given field into this one, and tells what of it was another. Rules are always those of the
    /// given field, if it has some: nobody edits them in the editor.
    pub fn hold(&mut self, given: &Self, locks: Locks) -> Vec<Words> {
        let mut changed = Vec::new();
        let mut tell = |is_same: bool, part: (&str, &str)| {
            if !is_same {
                changed.push(words::locked(part.0, part.1));
            }
        };
        if locks.world {
            let [own, theirs] = [&*self, given].map(|field| bare(field.clone()));
            tell(alike(&own.walls, &theirs.walls), words::WALLS);
            tell(alike(&own.solids, &theirs.solids), words::THINGS);
            tell(alike(&own.drawn, &theirs.drawn), words::DRAWINGS);
            let (one, other) = ((&own.images, &own.blobs), (&theirs.images, &theirs.blobs));
            tell(alike(&one, &other), words::PICTURES);
            tell(alike(&own.regions, &theirs.regions), words::REGIONS);
            self.walls.clone_from(&given.walls);
            self.solids.clone_from(&given.solids);
            self.drawn.clone_from(&given.drawn);
            self.images.clone_from(&given.images);
            self.blobs.clone_from(&given.blobs);
            self.regions.clone_from(&given.regions);
            self.comments.clone_from(&given.comments);
            self.trace.clone_from(&given.trace);
            let background = &given.settings.background;
            self.settings.background.clone_from(background);
        }
        if locks.settings {
            let background = self.settings.background.clone();
            let settings = super::Settings {
                background,
                ..given.settings.clone()
            };
            tell(self.settings == settings, words::SETTINGS);
            self.settings = settings;
        }
        if given.constraints.is_some() {
            self.constraints.clone_from(&given.constraints);
        }
        let Some(theirs) = given.robot() else {
            return changed;
        };
        if self.robot().is_none() && (locks.sensors || locks.robot_position) {
            self.robots.push(super::Robot::default());
        }
        let Some(own) = self.robot_mut() else {
            return changed;
        };
        if locks.sensors {
            let bare = |robot: &super::Robot| {
                let mut sensors = robot.sensors.clone();
                sensors.iter_mut().for_each(|one| one.source = nothing());
                sensors.sort_by_key(|one| one.port.map(|port| port.name()));
                sensors
            };
            tell(alike(&bare(own), &bare(theirs)), words::SENSORS);
            own.sensors.clone_from(&theirs.sensors);
        }
        if locks.robot_position {
            // Where the robot stands is where it was when it was saved: that is no change.
            let is_same = alike(&own.start, &theirs.start);
            tell(is_same, words::START);
            (own.position, own.direction) = (theirs.position, theirs.direction);
            own.start.clone_from(&theirs.start);
        }
        if locks.robot_configuration {
            let wheels = [own.left, own.right] == [theirs.left, theirs.right];
            tell(wheels, words::MOTORS);
            (own.left, own.right) = (theirs.left, theirs.right);
            (own.material, own.wheels) = (theirs.material, theirs.wheels);
        }
        changed
    }
}

fn nothing() -> Element<'static> {
    Element::new("")
}

/// A field without the texts it was read from, and with things where they begin.
fn bare(mut field: Field) -> Field {
    field
        .walls
        .iter_mut()
        .for_each(|one| one.source = nothing());
    field
        .images
        .iter_mut()
        .for_each(|one| one.source = nothing());
    field
        .regions
        .iter_mut()
        .for_each(|one| one.source = nothing());
    for solid in &mut field.solids {
        solid.source = nothing();
        // A run of the program may have pushed it.
        (solid.at, solid.rotation) = (solid.start, solid.start_rotation);
    }
    for drawn in &mut field.drawn {
        drawn.source = nothing();
        if let Shape::Stylus(strokes) = &mut drawn.shape {
            strokes.iter_mut().for_each(|one| one.source = nothing());
        }
    }
    field
}

/// Whether two things are the same but for roundings of numbers.
fn alike(one: &impl Debug, other: &impl Debug) -> bool {
    let [one, other] = [format!("{one:?}"), format!("{other:?}")];
    let is_part = |c: char| c.is_ascii_alphanumeric() || matches!(c, '.' | '-' | '+' | '#');
    let mut parts = one.split(|c| !is_part(c));
    let mut others = other.split(|c| !is_part(c));
    loop {
        match (parts.next(), others.next()) {
            (None, None) => return true,
            (Some(one), Some(other)) => {
                let near = |(one, other): (f64, f64)| (one - other).abs() < NEAR;
                let both = one.parse().ok().zip(other.parse().ok());
                if one != other && !both.is_some_and(near) {
                    return false;
                }
            }
            _ => return false,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const GIVEN: &str = r##"<root version="20251219"><world>
<walls><wall id="w" begin="10:0" end="20:0"/></walls><balls><ball id="b" x="5" y="5" markerX="5" markerY="5"/></balls>
<regions><region id="r" x="0" y="0"/></regions><robot position="0:0" direction="0"><startPosition x="25" y="25" direction="0"/></robot></world>
<robots><robot id="trikKitRobot"><sensors><sensor port="A1###input###A1###sensorA1" type="trik::robotModel::parts::TrikTouchSensor" position="62:25" direction="0"/></sensors>
<wheels left="M3###output######M3" right="M4###output######M4"/></robot></robots>
<settings realisticPhysics="false"/><constraints><timelimit value="10"/></constraints></root>"##;

    fn field(text: &str) -> Field {
        Field::read(text).unwrap().field
    }

    const ALL: Locks = Locks {
        world: true,
        sensors: true,
        robot_position: true,
        robot_configuration: true,
        settings: true,
    };

    #[test]
    fn what_is_locked_comes_back_and_is_told() {
        let given = field(GIVEN);
        let pupils = GIVEN
            .replace("20:0\"/>", "90:0\"/>")
            .replace("62:25", "10:25")
            .replace("position=\"0:0\"", "position=\"300:0\"")
            .replace("x=\"25\"", "x=\"99\"")
            .replace(
                "left=\"M3###output######M3\"",
                "left=\"M1###output######M1\"",
            )
            .replace("realisticPhysics=\"false\"", "realisticPhysics=\"true\"")
            .replace("value=\"10\"", "value=\"99999\"");
        let mut held = field(&pupils);
        let told = held.hold(&given, ALL);
        let told: Vec<&str> = told.iter().map(|one| &*one.english).collect();
        for part in ["walls", "sensors", "start of", "motors", "settings"] {
            assert!(
                told.iter().any(|one| one.contains(part)),
                "{part}: {told:?}"
            );
        }
        assert_eq!(told.len(), 5, "{told:?}");
        assert_eq!(held.walls, given.walls);
        // But for the text that it was read from.
        let [mut own, theirs] = [&held, &given].map(|field| field.robots[0].clone());
        own.source.clone_from(&theirs.source);
        assert_eq!(own, theirs);
        assert_eq!(
            (held.settings, held.constraints),
            (given.settings, given.constraints)
        );
    }

    #[test]
    fn what_is_not_locked_is_the_pupils_but_rules_never_are() {
        let given = field(GIVEN);
        let pupils = GIVEN
            .replace("62:25", "10:25")
            .replace("value=\"10\"", "value=\"9\"");
        let mut free = field(&pupils);
        assert_eq!(free.hold(&given, Locks::default()), []);
        assert_eq!(free.robots, field(&pupils).robots);
        assert_eq!(free.constraints, given.constraints);
    }

    #[test]
    fn roundings_and_a_run_of_the_program_are_no_change() {
        let given = field(GIVEN);
        let pupils = GIVEN
            .replace("20:0\"/>", "20.000001:0\"/>")
            .replace("x=\"5\" y=\"5\"", "x=\"70\" y=\"8\"")
            .replace("position=\"0:0\"", "position=\"300:0\"");
        let mut held = field(&pupils);
        assert_eq!(held.hold(&given, ALL), []);
        assert_eq!(held.solids, given.solids);
    }
}
