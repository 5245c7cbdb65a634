//! `gpio{ number, direction, active_low }`: one line, a state that can be written unless it goes in.
//!
//! Owns its keys, and which of them a rest needs.

use super::kind::{Constructor, Delivery, Kind, Nodes};
use super::rest::{Form, Rest, position, put_path};
use crate::fields::Fields;
use crate::limits::GPIO_NUMBER_MAX;
use crate::problem::Problem;
use std::path::{Path, PathBuf};

/// Where Linux exports the lines.
const GPIO_LINES: &str = "/sys/class/gpio";

/// Directions of a line that can be written, by their numbers in the form.
const WRITTEN: [GpioDirection; 3] = [GpioDirection::Out, GpioDirection::High, GpioDirection::Low];

/// Which way a GPIO line goes, in the words of its `direction` file.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum GpioDirection {
    /// Read only.
    In,
    /// Written; low at first.
    Out,
    /// Written; high at first.
    High,
    /// Written; low at first.
    Low,
}

/// `gpio{ number = 56, direction = 'in' }`: a tuple is one byte, 0 or 1.
#[derive(Clone, Debug, PartialEq)]
pub struct GpioDescription {
    /// Where lines are exported, `/sys/class/gpio`.
    pub base: PathBuf,
    /// Number of the line.
    pub number: u32,
    /// Which way it goes.
    pub direction: GpioDirection,
    /// 1 stands for the low level.
    pub active_low: bool,
}

impl Kind for GpioDescription {
    const CONSTRUCTORS: &'static [Constructor<Self>] = &[Constructor {
        word: "gpio",
        keys: &["number", "direction", "active_low"],
        read,
    }];
    const REST: Rest<Self> = Rest::Device(Form {
        tag: 6,
        put: |gpio, out| {
            put_path(&gpio.base, out)?;
            out.extend_from_slice(&gpio.number.to_le_bytes());
            out.push(position(&WRITTEN, &gpio.direction)?);
            out.push(gpio.active_low.into());
            Some(())
        },
        take: |bytes| {
            Some(Self {
                base: bytes.path()?,
                number: bytes.u32(GPIO_NUMBER_MAX)?,
                direction: *WRITTEN.get(usize::from(bytes.u8()?))?,
                active_low: bytes.boolean()?,
            })
        },
    });

    fn each_path(&mut self, take: &mut dyn FnMut(&mut PathBuf)) {
        take(&mut self.base);
    }

    fn needed_paths(&self) -> Vec<&Path> {
        vec![&self.base]
    }

    fn delivery(&self, _nodes: &dyn Fn(&str) -> Delivery) -> Delivery {
        Delivery::State
    }

    fn takes_writes(&self) -> bool {
        self.direction != GpioDirection::In
    }

    fn keeps_what_is_written(&self) -> bool {
        true
    }

    fn known_tuple_size(
        &self,
        _fields: &Fields<'_>,
        _nodes: &mut dyn Nodes,
    ) -> Result<Option<usize>, Problem> {
        Ok(Some(1))
    }
}

/// Reads the constructor.
fn read(fields: &Fields<'_>, _nodes: &mut dyn Nodes) -> Result<GpioDescription, Problem> {
    let Some(number) = fields.whole("number", 0, GPIO_NUMBER_MAX)? else {
        return Err(fields.problem("src", "gpio: number is missing"));
    };
    let directions = [
        ("in", GpioDirection::In),
        ("out", GpioDirection::Out),
        ("high", GpioDirection::High),
        ("low", GpioDirection::Low),
    ];
    let direction = fields.choice("gpio", "direction", &directions)?;
    let Some(direction) = direction else {
        return Err(fields.problem(
            "src",
            "gpio: direction is missing: 'in', 'out', 'high' or 'low'",
        ));
    };
    Ok(GpioDescription {
        base: GPIO_LINES.into(),
        number,
        direction,
        active_low: fields.boolean("active_low")?.unwrap_or(false),
    })
}
