//! Sensor variables of this language: those of all expressions, and each colour of the camera by itself.
//!
//! Owns the names of the colours, which the other language does not have, and their numbers, which follow those of all
//! others. Knows no readings.

use lang_diagram::ports::Port;
use lang_expr::reserved::{SENSORS, SensorIndex, Shape};
use lang_expr::{Compat, Kit, Names};

/// How exactly the oddities of expressions are kept: not at all, because no program of this language was ever saved.
const COMPAT: Compat = Compat::Fixed;

/// Sensors that are one number of a port: their names, and which number it is.
static PARTS: [(&str, &str, u8); 3] = [
    ("colorSensorR", "ColorSensorPort", 0),
    ("colorSensorG", "ColorSensorPort", 1),
    ("colorSensorB", "ColorSensorPort", 2),
];

/// All names, in the order of their numbers.
pub(crate) fn names() -> impl Iterator<Item = &'static str> {
    let shared = (0..SENSORS.len()).map(|at| SENSORS[at].name);
    shared.chain(PARTS.iter().map(|(name, ..)| *name))
}

/// The sensor of a name.
pub(crate) fn find(name: &str) -> Option<SensorIndex> {
    let at = names().position(|known| known == name)?;
    SensorIndex::try_from(at).ok()
}

/// The name of a sensor.
pub(crate) fn name(sensor: SensorIndex) -> &'static str {
    names().nth(usize::from(sensor)).unwrap_or_default()
}

/// What a sensor gives.
pub(crate) fn shape(sensor: SensorIndex) -> Option<Shape> {
    match SENSORS.get(usize::from(sensor)) {
        Some(shared) => Some(shared.shape),
        None => part(sensor).map(|_| Shape::Number),
    }
}

/// The port and the place of its number, of a sensor that is only one of several.
pub(crate) fn part(sensor: SensorIndex) -> Option<(Port, u8)> {
    let at = usize::from(sensor).checked_sub(SENSORS.len())?;
    let (_, port, place) = PARTS.get(at)?;
    Some((Port::named(port)?, *place))
}

/// The names that expressions of this language begin with.
pub(crate) fn names_of(kit: Kit) -> Names {
    let mut all = Names::new(kit, COMPAT);
    for (name, ..) in &PARTS {
        if let Some(sensor) = find(name) {
            all.add_sensor(name, sensor);
        }
    }
    all
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn each_sensor_has_a_name_of_its_own_and_what_it_reads() {
        let kit = Kit::default();
        let (shared, own) = (Names::new(kit, COMPAT), names_of(kit));
        for (number, one) in (0..).zip(names()) {
            assert_eq!((find(one), name(number)), (Some(number), one));
            let is_part = part(number).is_some();
            assert!(is_part || Port::shown_by(one).is_some(), "{one}");
            assert_eq!(shared.find(one).is_none(), is_part, "{one}");
            let known = own.find(one).and_then(|slot| own.kind(slot));
            assert!(
                matches!(known, Some(lang_expr::Kind::Sensor(sensor)) if *sensor == number),
                "{one}"
            );
        }
        let last = SENSORS.len() + PARTS.len();
        assert_eq!(names().count(), last);
        assert_eq!(shape(last as SensorIndex), None);
        assert_eq!(name(last as SensorIndex), "");
    }
}
