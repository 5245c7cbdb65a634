//! Devices of every board: lights (class leds), the battery (class power_supply), what the board is (class board-info).

use crate::device::{Attribute, Device, Shown, line, no_such_word, read, read_write, whole_number};
use crate::tree::Tree;
use trikfs::errno::Error;

const LED: [Attribute; 3] = [
    read_write("brightness"),
    read("max_brightness"),
    read_write("trigger"),
];

/// A light of the tree is on or off.
const LED_BRIGHTNESS_MAX: i32 = 1;

/// A light.
pub struct Led {
    tree: Tree,
    /// Its file, for example `led/red/value`.
    file: String,
}

impl Led {
    /// The light behind a file of the tree that takes 0 and 1.
    pub fn new(tree: Tree, file: String) -> Self {
        Self { tree, file }
    }
}

impl Device for Led {
    fn attributes(&self) -> &'static [Attribute] {
        &LED
    }

    fn show(&self, attribute: &str) -> Result<Shown, Error> {
        match attribute {
            "brightness" => line(self.tree.open(&self.file)?.number()?),
            "max_brightness" => line(LED_BRIGHTNESS_MAX),
            "trigger" => line("[none]"),
            _ => Err(Error::NotFound),
        }
    }

    fn store(&self, attribute: &str, text: &str) -> Result<(), Error> {
        match (attribute, text) {
            ("brightness", _) => {
                let brightness = whole_number(attribute, text)?;
                if brightness < 0 {
                    return Err(no_such_word(attribute, text));
                }
                // As the kernel does: more than the greatest is the greatest.
                let brightness = brightness.min(LED_BRIGHTNESS_MAX);
                self.tree.write(&self.file, &brightness.to_string())
            }
            ("trigger", "none") => Ok(()),
            ("trigger", _) => Err(no_such_word(attribute, text)),
            _ => Err(Error::AccessDenied),
        }
    }
}

const BATTERY: [Attribute; 6] = [
    read("scope"),
    read("technology"),
    read("type"),
    read("voltage_max_design"),
    read("voltage_min_design"),
    read("voltage_now"),
];

/// A cell of lithium polymer, full and empty.
const CELL_MAX_UV: f64 = 4_200_000.0;
const CELL_MIN_UV: f64 = 3_000_000.0;

/// The battery.
pub struct Battery {
    tree: Tree,
}

impl Battery {
    /// The node `battery` of the tree.
    pub fn new(tree: Tree) -> Self {
        Self { tree }
    }

    fn number(&self, file: &str) -> Result<f64, Error> {
        self.tree.open(file)?.number()
    }
}

impl Device for Battery {
    fn attributes(&self) -> &'static [Attribute] {
        &BATTERY
    }

    fn show(&self, attribute: &str) -> Result<Shown, Error> {
        let microvolts = |volts: f64| line(volts.round() as i64);
        match attribute {
            "scope" => line("System"),
            "technology" => line("Li-poly"),
            "type" => line("Battery"),
            "voltage_max_design" => microvolts(self.number("battery/cells")? * CELL_MAX_UV),
            "voltage_min_design" => microvolts(self.number("battery/cells")? * CELL_MIN_UV),
            "voltage_now" => microvolts(self.number("battery/value0")? * 1_000_000.0),
            _ => Err(Error::NotFound),
        }
    }

    fn store(&self, _attribute: &str, _text: &str) -> Result<(), Error> {
        Err(Error::AccessDenied)
    }
}

const BOARD: [Attribute; 3] = [read("model"), read("type"), read("uevent")];

/// What the board says it is.
///
/// Programs choose the names of ports and lights by it, so it answers with the model whose names the view has.
pub struct BoardInfo;

impl Device for BoardInfo {
    fn attributes(&self) -> &'static [Attribute] {
        &BOARD
    }

    fn show(&self, attribute: &str) -> Result<Shown, Error> {
        const MODEL: &str = "LEGO MINDSTORMS EV3";
        match attribute {
            "model" => line(MODEL),
            "type" => line("main"),
            "uevent" => line(format!("BOARD_INFO_MODEL={MODEL}\nBOARD_INFO_TYPE=main")),
            _ => Err(Error::NotFound),
        }
    }

    fn store(&self, _attribute: &str, _text: &str) -> Result<(), Error> {
        Err(Error::AccessDenied)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn volts_become_microvolts_and_lights_are_on_or_off() {
        let folder = tempfile::tempdir().unwrap();
        let root = folder.path();
        std::fs::create_dir(root.join("battery")).unwrap();
        let write = |file: &str, text: &str| std::fs::write(root.join(file), text).unwrap();
        write("battery/value0", "12.211");
        write("battery/cells", "3");
        write("light", "1");
        let tree = Tree::new(root.to_owned());
        let battery = Battery::new(tree.clone());
        for (attribute, shows) in [
            ("voltage_now", "12211000"),
            ("voltage_max_design", "12600000"),
            ("voltage_min_design", "9000000"),
        ] {
            assert_eq!(battery.show(attribute), line(shows));
        }
        let led = Led::new(tree, "light".to_owned());
        assert_eq!(led.show("brightness"), line(1));
        led.store("brightness", "0").unwrap();
        assert_eq!(led.show("brightness"), line(0));
        led.store("brightness", "255").unwrap();
        assert_eq!(led.show("brightness"), line(1));
        for (attribute, text) in [
            ("brightness", "-1"),
            ("brightness", ""),
            ("trigger", "timer"),
        ] {
            assert_eq!(
                led.store(attribute, text).unwrap_err().errno(),
                libc::EINVAL
            );
        }
    }
}
