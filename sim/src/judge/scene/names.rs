//! What there is to ask an arena for: names of objects, of their properties and of classes.
//!
//! Owns the words alone. Which object has which property is known where properties are read: here each word is tried.

use lang_constraint::{Catalogue, Object};
use lang_diagram::ports::Port;

use super::{PARTS, SceneObject, is_plugged_in, long_name, property, short_name};
use crate::arena::Arena;

/// All words for properties of objects. Reading a property that is not among them is refused in tests.
pub(super) const PROPERTIES: &[&str] = &[
    "x",
    "y",
    "pos",
    "rotation",
    "isRiding",
    "power",
    "value",
    "locked",
    "smiles",
    "sadSmiles",
    "background",
    "objects",
    "labels",
    "ellipses",
    "arcs",
    "rectangles",
    "segments",
    "pixels",
    "lastPhrase",
    "color",
    "isDown",
    "objectName",
    "fixedValue",
    "callsCount",
    "lastValue",
    "size",
    "isEmpty",
    "visible",
    "enabled",
    "z",
    "opacity",
    "scale",
    "mass",
    "friction",
    "restitution",
    "linearDamping",
    "angularDamping",
    "thickness",
    "filled",
];

/// All classes. An object of another one is refused in tests.
pub(super) const CLASSES: &[&str] = &[
    "twoDModel::model::RobotModel",
    "twoDModel::robotModel::parts::Motor",
    "twoDModel::robotModel::parts::EncoderSensor",
    "twoDModel::robotModel::parts::Button",
    "twoDModel::robotModel::parts::Accelerometer",
    "twoDModel::robotModel::parts::Lidar",
    "twoDModel::robotModel::parts::Marker",
    "twoDModel::robotModel::parts::RangeSensor",
    "twoDModel::robotModel::parts::TouchSensor",
    "trik::robotModel::twoD::parts::ColorSensor",
    "trik::robotModel::twoD::parts::Display",
    "trik::robotModel::twoD::parts::GyroscopeSensor",
    "trik::robotModel::twoD::parts::LineSensor",
    "trik::robotModel::twoD::parts::ObjectSensor",
    "trik::robotModel::twoD::parts::Shell",
    "trik::robotModel::twoD::parts::TwoDLed",
    "trik::robotModel::twoD::parts::TwoDLightSensor",
    "trik::robotModel::twoD::parts::TwoDNetworkCommunicator",
    "trik::robotModel::twoD::parts::TwoDSpeaker",
    "kitBase::robotModel::robotParts::Random",
    "twoDModel::items::WallItem",
    "twoDModel::items::SkittleItem",
    "twoDModel::items::BallItem",
    "twoDModel::items::CubeItem",
    "twoDModel::items::LineItem",
    "twoDModel::items::RectangleItem",
    "twoDModel::items::EllipseItem",
    "twoDModel::items::CurveItem",
    "twoDModel::items::StylusItem",
    "twoDModel::items::EllipseRegion",
    "twoDModel::items::BoundRegion",
    "twoDModel::items::RectangularRegion",
    "utils::ObjectsSetBase",
];

impl Catalogue for Arena {
    fn names(&self) -> Vec<String> {
        let mut names = vec!["trace".to_owned()];
        for (index, robot) in self.robots().iter().enumerate() {
            let name = format!("robot{}", index + 1);
            let parts = PARTS.iter().map(|(part, ..)| format!("{name}.{part}"));
            names.extend(parts);
            let plugged = Port::all().filter(|port| is_plugged_in(robot, *port));
            names.extend(plugged.map(|port| format!("{name}.{}", short_name(port.name()))));
            let aliases = robot.description().aliases.iter();
            names.extend(aliases.map(|(alias, _)| format!("{name}.{alias}")));
            names.push(name);
        }
        let field = self.field();
        names.extend(field.regions.iter().map(|one| one.id.clone()));
        names.extend(field.solids.iter().map(|one| one.id.clone()));
        names.extend(field.walls.iter().map(|one| one.id.clone()));
        names.extend(field.drawn.iter().map(|one| one.id.clone()));
        names.retain(|name| !name.is_empty());
        names
    }

    fn properties(&mut self, object: Object) -> Vec<&'static str> {
        let Some(thing) = SceneObject::of(object) else {
            return Vec::new();
        };
        let has = |name: &&&'static str| property(self, thing, name).is_some();
        PROPERTIES.iter().filter(has).copied().collect()
    }

    fn classes(&self) -> &'static [&'static str] {
        CLASSES
    }

    fn may_come(&self, name: &str) -> bool {
        let Some((robot, port)) = name.split_once('.') else {
            return false;
        };
        let number = robot.strip_prefix("robot").and_then(|one| one.parse().ok());
        let index = number.and_then(|number: usize| number.checked_sub(1));
        let Some(robot) = index.and_then(|index| self.robots().get(index)) else {
            return false;
        };
        let mut ports = Port::all().filter(|one| one.name() == long_name(port));
        ports.any(|port| !is_plugged_in(robot, port))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::arena::Setup;
    use crate::field::Field;
    use lang_constraint::Scene as _;

    /// One thing of each kind.
    const WORLD: &str = r#"<root version="20251219"><world>
<walls><wall id="wall" begin="0:0" end="9:0"/></walls>
<skittles><skittle id="can" x="1" y="1"/></skittles><balls><ball id="ball" x="1" y="1"/></balls>
<cubes><cube id="cube" x="1" y="1"/></cubes>
<colorFields><line id="line" begin="0:0" end="9:9"/><rectangle id="box" begin="0:0" end="9:9"/>
<ellipse id="oval" begin="0:0" end="9:9"/><stylus id="hand"/>
<cubicBezier id="bow" begin="0:0" cp1="1:1" cp2="2:2" end="9:9"/></colorFields>
<regions><region id="here" type="rectangle" x="0" y="0" width="9" height="9"/>
<region id="round" type="ellipse"/><region id="ring" type="bound" boundItem="box"/></regions></world>
<settings/><robots><robot id="trikKitRobot"><sensors>
<sensor port="A1###input######sensorA1" type="TrikLightSensor" position="75:25"/></sensors></robot></robots></root>"#;

    #[test]
    fn every_name_is_found_and_every_word_for_a_property_and_a_class_is_of_something() {
        let field = Field::read(WORLD).expect("a world").field;
        let mut arena = Arena::new(&field, Setup::default());
        let (mut words, mut classes) = (Vec::new(), Vec::new());
        for name in arena.names() {
            let found = arena.find(&name).unwrap_or_else(|| panic!("no {name}"));
            words.extend(arena.properties(found));
            classes.extend(arena.type_of(found));
        }
        for word in PROPERTIES {
            assert!(words.contains(word), "nothing has '{word}'");
        }
        // Those of the camera and the lidar need a robot of their own, as other kinds of sensors do.
        let of_others = [
            "Lidar",
            "LineSensor",
            "ColorSensor",
            "ObjectSensor",
            "RangeSensor",
            "TouchSensor",
        ];
        for class in CLASSES {
            let is_of_others = of_others.iter().any(|other| class.ends_with(other));
            assert!(
                is_of_others || classes.contains(class),
                "nothing is a {class}"
            );
        }
        assert!(arena.may_come("robot1.A2") && arena.may_come("robot1.lidar"));
        assert!(!arena.may_come("robot1.A1") && !arena.may_come("robot1.A9"));
        assert!(!arena.may_come("robot2.A2") && !arena.may_come("wall.A2"));
    }
}
