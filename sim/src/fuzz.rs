//! Fuzz targets as plain functions: any bytes may come in, nothing but time and memory within limits may go.
//!
//! Run by tests, and by anybody's fuzzer.

use lang_diagram::brick::{Brick, Command};
use lang_diagram::ports::{Device, Port, Sort};

use crate::arena::{Arena, Setup};
use crate::field::Field;
use crate::judge::{Texts, lint};

/// Ticks that a strange world is driven through.
const TICKS: usize = 20;

/// Bytes as a world model: what is read must survive being written and read again, and a robot must be able to drive there
/// with all its sensors.
pub fn field(bytes: &[u8]) {
    let Ok(text) = std::str::from_utf8(bytes) else {
        return;
    };
    let _ = lint(Texts {
        world: text,
        ..Texts::default()
    });
    let Ok(opened) = Field::read(text) else {
        return;
    };
    let again = Field::read(&opened.field.write()).expect("what was written is read");
    assert_eq!(again.field.walls, opened.field.walls);
    assert_eq!(again.field.solids, opened.field.solids);
    assert_eq!(again.field.regions, opened.field.regions);
    let mut arena = Arena::new(&opened.field, Setup::default());
    let mut numbers = Vec::new();
    for tick in 0..TICKS {
        for (name, percent) in [("M3", 100), ("M4", 90 - 20 * tick as i32)] {
            if let Some(port) = Port::named(name) {
                arena.robot(0).command(Command::Power { port, percent });
            }
        }
        arena.tick();
        let mut robot = arena.robot(0);
        for port in Port::all() {
            robot.scalar(port);
            // A lidar asks 360 times.
            if port.sort() == Sort::Vector && (tick == 0 || port.device() != Device::Lidar) {
                numbers.clear();
                robot.vector(port, &mut numbers);
            }
        }
        let pose = arena.robots()[0].pose();
        assert!(pose.x.is_finite() && pose.y.is_finite() && pose.degrees.is_finite());
    }
}

#[cfg(test)]
mod tests {
    use super::field;
    use crate::random::Random;

    const SEED: &str = "<root><world><walls><wall id=\"w\" begin=\"10:0\" end=\"20:1e3\" stroke-width=\"2\"/></walls><balls><ball id=\"b\" \
        begin=\"1:2\" rotation=\"30\" diameter=\"9\"/></balls><colorFields><stylus><stylusLine begin=\"1:2\" end=\"3:4\"/></stylus></colorFields>\
        <regions><region id=\"r\" type=\"ellipse\" x=\"1\" y=\"2\" width=\"3\" height=\"4\"/></regions></world><settings sizeUnit=\"cm\"/>\
        <constraints><timelimit value=\"90\"/><event id=\"a\" settedUpInitially=\"true\"><condition><inside objectId=\"robot1\" \
        regionId=\"r\"/></condition><triggers><setState object=\"w\" property=\"x\" _1=\"${robot1.A1.value}\"/><success/></triggers></event>\
        </constraints><robots><robot id=\"trikKitRobot\" position=\"1:2\" direction=\"-90\"><sensors><sensor port=\"A1###input######sensorA1\" \
        type=\"x::TrikInfraredSensor\" position=\"75:25\" direction=\"9\"/></sensors></robot></robots></root>";

    #[test]
    fn mutated_worlds_do_no_harm() {
        let mut random = Random::new(11);
        field(SEED.as_bytes());
        for _ in 0..3000 {
            let mut bytes = SEED.as_bytes().to_vec();
            for _ in 0..=random.bits() % 6 {
                let at = (random.bits() as usize) % bytes.len();
                match random.bits() % 4 {
                    0 => bytes[at] = b"0123456789.:e-<>\"/ a"[(random.bits() % 20) as usize],
                    1 => drop(bytes.remove(at)),
                    2 => bytes.insert(at, b'9'),
                    _ => {
                        let piece: Vec<u8> = bytes[at..].iter().take(40).copied().collect();
                        bytes.splice(at..at, piece);
                    }
                }
            }
            field(&bytes);
        }
    }
}
