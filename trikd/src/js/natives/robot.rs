//! The robot for our scripts: ports by handles, and what a failure of the tree says.
//!
//! Owns the handles and the texts of failures. What a port is and which file it has is in `brick`.

use super::{Own, failed, put};
use crate::brick::actuators::Motor;
use crate::brick::sensors::{Camera, Encoder, KEYS, NO_ECHO, Sensor};
use crate::brick::{Brick, Group};
use crate::limits;
use crate::tree::{Access, is_name};
use rquickjs::{Ctx, Error, Object};
use std::cell::RefCell;
use std::collections::HashMap;
use std::io;
use std::path::Path;
use std::rc::Rc;

/// What our scripts get for no handle.
const NONE: i32 = -1;

/// Things of one kind by numbers.
struct Handles<T>(RefCell<Vec<(T, String)>>);

impl<T> Handles<T> {
    fn new() -> Rc<Self> {
        Rc::new(Self(RefCell::default()))
    }

    fn add(&self, thing: Option<T>, place: String) -> i32 {
        let Some(thing) = thing else { return NONE };
        let mut all = self.0.borrow_mut();
        all.push((thing, place));
        i32::try_from(all.len() - 1).unwrap_or(NONE)
    }

    /// Does something with one of them; failures name its place.
    fn with<R>(
        &self,
        ctx: &Ctx<'_>,
        own: &Own,
        handle: usize,
        work: impl FnOnce(&T) -> io::Result<R>,
    ) -> rquickjs::Result<R> {
        own.stand(ctx);
        let all = self.0.borrow();
        let (thing, place) = all.get(handle).ok_or_else(|| failed(ctx, "no such port"))?;
        work(thing).map_err(|error| unreadable(ctx, &own.brick, place, &error))
    }
}

/// The exception for a failure of the tree, with what `fault` says.
pub fn unreadable(ctx: &Ctx<'_>, brick: &Brick, place: &str, error: &io::Error) -> Error {
    if !brick.tree().is_mounted() {
        return failed(ctx, format!("{place}: {error}"));
    }
    let root = brick.tree().root();
    let node = root.join(place);
    let node = if node.is_dir() {
        &node
    } else {
        node.parent().unwrap_or(&node)
    };
    let fault = std::fs::read_to_string(node.join("fault")).unwrap_or_default();
    let fault = fault.trim();
    let hint = if !fault.is_empty() {
        format!(" ({fault})")
    } else if error.kind() == io::ErrorKind::NotFound && !root.join("status").exists() {
        format!(" (is a tree mounted at {}?)", root.display())
    } else if error.kind() == io::ErrorKind::PermissionDenied {
        " (the file log of the tree says why)".to_owned()
    } else {
        String::new()
    };
    failed(ctx, format!("{place}: {error}{hint}"))
}

fn is_waiting(error: &io::Error) -> bool {
    error.kind() == io::ErrorKind::WouldBlock
}

/// The functions over the tree.
///
/// # Errors
/// No memory.
pub fn install<'js>(native: &Object<'js>, own: &Rc<Own>) -> rquickjs::Result<()> {
    motors(native, own)?;
    sensors(native, own)?;
    encoders(native, own)?;
    onboard(native, own)?;
    cameras(native, own)?;
    gamepad(native, own)?;
    files(native, own)?;
    tree(native, own)
}

fn motors<'js>(native: &Object<'js>, own: &Rc<Own>) -> rquickjs::Result<()> {
    let all: Rc<Handles<Motor>> = Handles::new();
    let (o, a) = (own.clone(), all.clone());
    put(native, "motor", move |port: String| {
        a.add(o.brick.motor(&port), motor_place(&o.brick, &port))
    })?;
    let (o, a) = (own.clone(), all.clone());
    put(
        native,
        "motorSet",
        move |ctx: Ctx<'js>, handle: usize, power: f64| {
            a.with(&ctx, &o, handle, |motor| motor.set_power(power))
        },
    )?;
    let (o, a) = (own.clone(), all.clone());
    put(native, "motorGet", move |ctx: Ctx<'js>, handle: usize| {
        a.with(&ctx, &o, handle, Motor::power)
    })?;
    let (o, a) = (own.clone(), all.clone());
    put(native, "motorOff", move |ctx: Ctx<'js>, handle: usize| {
        a.with(&ctx, &o, handle, Motor::power_off)
    })?;
    let (o, a) = (own.clone(), all);
    put(native, "motorBrake", move |ctx: Ctx<'js>, handle: usize| {
        a.with(&ctx, &o, handle, Motor::brake)
    })
}

fn motor_place(brick: &Brick, port: &str) -> String {
    let motor = format!("{}/{port}", Group::Motors.directory());
    if is_name(port) && brick.tree().has(&motor) {
        motor
    } else {
        format!("{}/{port}", Group::Servos.directory())
    }
}

/// Programs expect a number for a distance without an echo; all other failures are told.
fn read_or_no_echo(sensor: &Sensor) -> io::Result<f64> {
    sensor.read().or_else(|error| match sensor.read_raw() {
        Ok(raw) if raw == NO_ECHO => Ok(NO_ECHO),
        _ => Err(error),
    })
}

fn sensors<'js>(native: &Object<'js>, own: &Rc<Own>) -> rquickjs::Result<()> {
    let all: Rc<Handles<Sensor>> = Handles::new();
    let (o, a) = (own.clone(), all.clone());
    put(native, "sensor", move |port: String| {
        let place = format!("{}/{port}", Group::Sensors.directory());
        a.add(o.brick.sensor(&port), place)
    })?;
    let (o, a) = (own.clone(), all.clone());
    put(native, "sensorRead", move |ctx: Ctx<'js>, handle: usize| {
        a.with(&ctx, &o, handle, read_or_no_echo)
    })?;
    let (o, a) = (own.clone(), all);
    put(native, "sensorRaw", move |ctx: Ctx<'js>, handle: usize| {
        a.with(&ctx, &o, handle, Sensor::read_raw)
    })
}

fn encoders<'js>(native: &Object<'js>, own: &Rc<Own>) -> rquickjs::Result<()> {
    let all: Rc<Handles<Encoder>> = Handles::new();
    let (o, a) = (own.clone(), all.clone());
    put(native, "encoder", move |port: String| {
        let place = format!("{}/{port}", Group::Encoders.directory());
        a.add(o.brick.encoder(&port), place)
    })?;
    let (o, a) = (own.clone(), all.clone());
    put(
        native,
        "encoderRead",
        move |ctx: Ctx<'js>, handle: usize| a.with(&ctx, &o, handle, Encoder::read),
    )?;
    let (o, a) = (own.clone(), all.clone());
    put(native, "encoderRaw", move |ctx: Ctx<'js>, handle: usize| {
        a.with(&ctx, &o, handle, Encoder::read_raw)
    })?;
    let (o, a) = (own.clone(), all);
    put(
        native,
        "encoderReset",
        move |ctx: Ctx<'js>, handle: usize| a.with(&ctx, &o, handle, Encoder::reset),
    )
}

/// What there is once on each robot.
fn onboard<'js>(native: &Object<'js>, own: &Rc<Own>) -> rquickjs::Result<()> {
    let o = own.clone();
    let keys = o.brick.keys();
    put(native, "keyPressed", move |ctx: Ctx<'js>, code: f64| {
        match keys.pressed() {
            Ok(pressed) => Ok(KEYS
                .iter()
                .zip(pressed)
                .any(|((_, other), pressed)| pressed && f64::from(*other) == code)),
            // Nobody has touched a key since the start.
            Err(error) if is_waiting(&error) => Ok(false),
            Err(error) => Err(unreadable(&ctx, &o.brick, "keys", &error)),
        }
    })?;
    let (o, led) = (own.clone(), own.brick.led());
    put(
        native,
        "led",
        move |ctx: Ctx<'js>, green: bool, red: bool| {
            led.set(green, red)
                .map_err(|error| unreadable(&ctx, &o.brick, "led/green", &error))
        },
    )?;
    let (o, battery) = (own.clone(), own.brick.battery());
    put(native, "voltage", move |ctx: Ctx<'js>| {
        battery
            .voltage()
            .map_err(|error| unreadable(&ctx, &o.brick, "battery", &error))
    })?;
    let (o, battery) = (own.clone(), own.brick.battery());
    put(native, "rawVoltage", move |ctx: Ctx<'js>| {
        battery
            .raw()
            .map_err(|error| unreadable(&ctx, &o.brick, "battery", &error))
    })?;
    let o = own.clone();
    put(native, "vector", move |ctx: Ctx<'js>, name: String| {
        vector(&o.brick, &name)
            .read()
            .map_err(|error| unreadable(&ctx, &o.brick, &name, &error))
    })?;
    let o = own.clone();
    put(native, "vectorRaw", move |ctx: Ctx<'js>, name: String| {
        vector(&o.brick, &name)
            .read_raw()
            .map_err(|error| unreadable(&ctx, &o.brick, &name, &error))
    })?;
    let (o, sound) = (own.clone(), own.brick.sound());
    put(native, "playSound", move |ctx: Ctx<'js>, file: String| {
        let path = o.shared.folder.join(&file);
        sound
            .play(&path.to_string_lossy())
            .map_err(|error| unreadable(&ctx, &o.brick, "sound/play", &error))
    })?;
    let (o, sound) = (own.clone(), own.brick.sound());
    put(native, "tone", move |ctx: Ctx<'js>, hz: i32, ms: i32| {
        sound
            .tone(hz, ms)
            .map_err(|error| unreadable(&ctx, &o.brick, "sound/tone", &error))
    })?;
    let (o, sound) = (own.clone(), own.brick.sound());
    put(native, "say", move |ctx: Ctx<'js>, text: String| {
        sound
            .say(&text)
            .map_err(|error| unreadable(&ctx, &o.brick, "sound/say", &error))
    })
}

fn vector(brick: &Brick, name: &str) -> crate::brick::sensors::Vector {
    crate::brick::sensors::Vector::with(brick.tree(), name, Access::Read)
}

/// Programs read at once after `init()`, and expect three numbers.
fn or_zeros(numbers: Vec<f64>) -> Vec<f64> {
    if numbers.is_empty() {
        vec![0.0; 3]
    } else {
        numbers
    }
}

fn stopped(camera: &Camera) -> io::Result<Vec<f64>> {
    camera.stop();
    Ok(Vec::new())
}

fn cameras<'js>(native: &Object<'js>, own: &Rc<Own>) -> rquickjs::Result<()> {
    let o = own.clone();
    put(native, "hasCamera", move |name: String| {
        o.brick.camera(&name).is_some()
    })?;
    let known: Rc<RefCell<HashMap<String, Camera>>> = Rc::default();
    let o = own.clone();
    let with = move |ctx: &Ctx<'js>, name: &str, work: &dyn Fn(&Camera) -> io::Result<Vec<f64>>| {
        let mut known = known.borrow_mut();
        if !known.contains_key(name) {
            let camera = o.brick.camera(name);
            let camera = camera.ok_or_else(|| failed(ctx, "this robot has no such sensor"))?;
            known.insert(name.to_owned(), camera);
        }
        match work(&known[name]) {
            // There was no picture yet, or no answer.
            Err(error) if is_waiting(&error) => Ok(Vec::new()),
            done => {
                let place = match name {
                    "sound" => "microphones".to_owned(),
                    _ => format!("camera/{name}"),
                };
                done.map_err(|error| unreadable(ctx, &o.brick, &place, &error))
            }
        }
    };
    let nothing = |()| Vec::new();
    let w = with.clone();
    put(
        native,
        "cameraStart",
        move |ctx: Ctx<'js>, name: String, shows: bool| {
            w(&ctx, &name, &|camera| camera.start(shows).map(nothing)).map(drop)
        },
    )?;
    let w = with.clone();
    put(native, "cameraStop", move |ctx: Ctx<'js>, name: String| {
        w(&ctx, &name, &stopped).map(drop)
    })?;
    let w = with.clone();
    put(native, "cameraRead", move |ctx: Ctx<'js>, name: String| {
        w(&ctx, &name, &Camera::read).map(or_zeros)
    })?;
    let w = with.clone();
    put(
        native,
        "cameraDetect",
        move |ctx: Ctx<'js>, name: String| {
            let detect = |camera: &Camera| camera.detect().map(|heard| vec![1.0; heard.into()]);
            w(&ctx, &name, &detect).map(|heard| !heard.is_empty())
        },
    )?;
    let w = with.clone();
    put(
        native,
        "cameraDetected",
        move |ctx: Ctx<'js>, name: String| w(&ctx, &name, &Camera::detected),
    )?;
    put(
        native,
        "cameraLookFor",
        move |ctx: Ctx<'js>, name: String, numbers: Vec<f64>| {
            with(&ctx, &name, &|camera| {
                camera.look_for(&numbers).map(nothing)
            })
            .map(drop)
        },
    )
}

fn gamepad<'js>(native: &Object<'js>, own: &Rc<Own>) -> rquickjs::Result<()> {
    let pads = Rc::new(own.brick.gamepad());
    let index = |number: f64| {
        [1, 2, 3, 4, 5]
            .into_iter()
            .find(|index| f64::from(*index) == number)
            .map_or(0, |index: u8| usize::from(index))
    };
    let p = pads.clone();
    put(native, "pad", move |number: f64| {
        p.pad(index(number)).map(|(x, y)| vec![x, y])
    })?;
    let p = pads.clone();
    put(native, "wheel", move || p.wheel())?;
    let p = pads.clone();
    put(native, "button", move |number: f64| p.button(index(number)))?;
    put(native, "gamepadConnected", move || pads.is_connected())
}

/// What is the same for all nodes.
fn tree<'js>(native: &Object<'js>, own: &Rc<Own>) -> rquickjs::Result<()> {
    let o = own.clone();
    put(native, "has", move |name: String| o.brick.tree().has(&name))?;
    let o = own.clone();
    put(native, "isReady", move |name: String| {
        let value = o
            .brick
            .tree()
            .node(&format!("{name}/value"), Access::ReadNow);
        value.number().is_ok()
    })?;
    let o = own.clone();
    put(native, "isNode", move |path: String| {
        let plain = Path::new(&path).components().count() <= 3 && path.split('/').all(is_name);
        plain && o.brick.tree().has(&path)
    })?;
    let o = own.clone();
    put(native, "isFile", move |path: String| {
        path.split('/').all(is_name) && o.brick.tree().is_file(&path)
    })?;
    let o = own.clone();
    put(native, "numbers", move |ctx: Ctx<'js>, path: String| {
        let mut numbers = vec![0.0; limits::VALUE_BYTES / 2];
        let file = o.brick.tree().node(&path, Access::Read);
        let count = file
            .numbers(&mut numbers)
            .map_err(|error| unreadable(&ctx, &o.brick, &path, &error))?;
        numbers.truncate(count);
        Ok::<_, Error>(numbers)
    })?;
    let o = own.clone();
    put(native, "ports", move |group: String| {
        let groups = [
            Group::Motors,
            Group::Servos,
            Group::Sensors,
            Group::Encoders,
        ];
        let group = groups.into_iter().find(|other| other.directory() == group);
        group.map_or_else(Vec::new, |group| o.brick.ports(group))
    })?;
    let o = own.clone();
    put(native, "mark", move |ctx: Ctx<'js>, color: String| {
        let file = o.brick.tree().node("marker/value", Access::Write);
        file.write(&color)
            .map_err(|error| unreadable(&ctx, &o.brick, "marker", &error))
    })?;
    let o = own.clone();
    put(native, "stop", move |ctx: Ctx<'js>| {
        o.brick
            .stop()
            .map_err(|error| unreadable(&ctx, &o.brick, "stop", &error))
    })
}

/// Files that are written, and files in which positions mean something.
fn files<'js>(native: &Object<'js>, own: &Rc<Own>) -> rquickjs::Result<()> {
    let o = own.clone();
    put(
        native,
        "write",
        move |ctx: Ctx<'js>, path: String, text: String| {
            let file = o.brick.tree().node(&path, Access::Write);
            file.write(&text)
                .map_err(|error| unreadable(&ctx, &o.brick, &path, &error))
        },
    )?;
    let o = own.clone();
    put(
        native,
        "readAt",
        move |ctx: Ctx<'js>, path: String, position: f64, count: usize| {
            let mut bytes = vec![0; count.min(limits::TRANSFER_BYTES)];
            let file = o.brick.tree().node(&path, Access::Read);
            let read = file.bytes_at(&mut bytes, position as u64);
            let size = read.map_err(|error| unreadable(&ctx, &o.brick, &path, &error))?;
            bytes.truncate(size);
            Ok::<_, Error>(bytes)
        },
    )?;
    let o = own.clone();
    put(
        native,
        "writeAt",
        move |ctx: Ctx<'js>, path: String, position: f64, bytes: Vec<u8>| {
            let file = o.brick.tree().node(&path, Access::Write);
            file.write_at(&bytes, position as u64)
                .map_err(|error| unreadable(&ctx, &o.brick, &path, &error))
        },
    )
}
