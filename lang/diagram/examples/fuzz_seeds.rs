//! Writes small saves for the fuzz target `reader` into a folder: zips, saves of the old container, and the files of a
//! save without a container.
//!
//! Owns which projects these are: few blocks each, one thing in each. Real saves have hundreds of kilobytes, so that a
//! fuzzer tries one input in a second where it tries hundreds of these.

use std::path::Path;

use lang_diagram::archive::{self, Entry};
use lang_diagram::sketch::Sketch;

/// Versions between the steps by which old saves are brought to the present.
const VERSIONS: [&str; 9] = [
    "3.0.0-a2", "3.0.0-a5", "3.0.0", "3.0.1", "3.0.2", "3.1.2", "3.2.0", "3.3.0", "2020.4",
];
/// A world with a wall and a sensor.
const WORLD: &str = "<root><world><walls><wall id=\"w\" begin=\"0:0\" end=\"50:0\"/></walls></world><robots>\
    <robot id=\"trikKitRobot\" position=\"0:0\" direction=\"0\"><sensors><sensor port=\"A1###input######sensorA1\" \
    type=\"sonar\" position=\"1:2\" direction=\"0\"/></sensors></robot></robots></root>";

fn main() {
    let Some(folder) = std::env::args().nth(1) else {
        eprintln!("usage: fuzz_seeds FOLDER");
        std::process::exit(2);
    };
    for (name, sketch) in sketches() {
        let written = sketch
            .qrs()
            .map_err(|problem| problem.to_string())
            .and_then(|bytes| {
                keep(Path::new(&folder), &name, &bytes).map_err(|error| error.to_string())
            });
        if let Err(reason) = written {
            eprintln!("{folder}: {name}: {reason}");
            std::process::exit(1);
        }
    }
}

/// One save in all its forms.
fn keep(folder: &Path, name: &str, zip: &[u8]) -> std::io::Result<()> {
    let opened = archive::open(zip, &mut Vec::new());
    let entries = opened
        .map_err(|problem| std::io::Error::other(problem.to_string()))?
        .entries;
    if !name.starts_with("old") {
        std::fs::write(folder.join(format!("{name}.zip")), zip)?;
        std::fs::write(folder.join(format!("{name}.stream")), stream(&entries))?;
    }
    std::fs::write(folder.join(format!("{name}.files")), files(&entries))
}

/// What the target takes for the files of a save: names and texts in turns, with zero bytes between. Without what has
/// no meaning, as half of a document is.
fn files(entries: &[Entry]) -> Vec<u8> {
    let files = entries.iter().filter(|entry| !entry.is_folder());
    let short = |bytes: &[u8]| {
        let text = String::from_utf8_lossy(bytes).replace("00000000-0000-4000-8000-0000000000", "");
        let lines: Vec<&str> = text.lines().map(str::trim).collect();
        lines.concat()
    };
    let parts: Vec<String> = files
        .flat_map(|entry| [short(entry.name.as_bytes()), short(&entry.bytes)])
        .collect();
    parts.join("\0").into_bytes()
}

/// A save in the old container, not compressed: bytes that are changed stay what they are.
fn stream(entries: &[Entry]) -> Vec<u8> {
    let mut out = Vec::new();
    for entry in entries.iter().filter(|entry| !entry.is_folder()) {
        let name: Vec<u8> = format!("/{}", entry.name)
            .encode_utf16()
            .flat_map(u16::to_be_bytes)
            .collect();
        let length = entry.bytes.len() as u16;
        // A zlib stream of one stored block.
        let mut packed = u32::from(length).to_be_bytes().to_vec();
        packed.extend([0x78, 0x01, 1]);
        packed.extend(length.to_le_bytes());
        packed.extend((!length).to_le_bytes());
        packed.extend(&entry.bytes);
        packed.extend(adler(&entry.bytes).to_be_bytes());
        for part in [name, packed] {
            out.extend((part.len() as u32).to_be_bytes());
            out.extend(part);
        }
    }
    out
}

/// The checksum of zlib, RFC 1950.
fn adler(bytes: &[u8]) -> u32 {
    let (mut low, mut high) = (1_u32, 0_u32);
    for &byte in bytes {
        low = (low + u32::from(byte)) % 65_521;
        high = (high + low) % 65_521;
    }
    high << 16 | low
}

/// Projects of few blocks, each for one thing.
fn sketches() -> Vec<(String, Sketch)> {
    let one = |kind: &str, properties: &[(&str, &str)]| {
        let mut sketch = Sketch::new();
        sketch.block(kind, properties);
        sketch
    };
    let mut all = vec![
        ("empty".to_owned(), Sketch::new()),
        (
            "motor".to_owned(),
            one(
                "TrikV6EnginesForward",
                &[("Ports", "M3, M4"), ("Power", "x")],
            ),
        ),
        ("linked".to_owned(), linked()),
        ("called".to_owned(), called()),
    ];
    let mut world = Sketch::new();
    world.world(WORLD);
    all.push(("world".to_owned(), world));
    for version in VERSIONS {
        let mut old = one(
            "TrikWaitForButton",
            &[("Port", "JA1"), ("Button", "Left"), ("Text", "Hi!")],
        );
        old.block("TrikSay", &[("Text", "sensorA1 gyroscope")]);
        old.diagram_property("worldModel", WORLD);
        old.meta("RobotsMetamodelVersion", version);
        all.push((format!("old-{version}"), old));
    }
    all
}

/// Two blocks, a loop, and a link without an end.
fn linked() -> Sketch {
    let mut sketch = Sketch::new();
    let start = sketch.block("InitialNode", &[]);
    let repeat = sketch.block("Loop", &[("Iterations", "3")]);
    sketch.link(start, repeat);
    sketch.guarded(repeat, repeat, "iteration");
    sketch.connect(Some(repeat), None, "");
    sketch
}

/// A subprogram with a parameter, and its call.
fn called() -> Sketch {
    let mut sketch = Sketch::new();
    let sheet = sketch.subprogram("drive", &[("speed", "int", "50")]);
    sketch.draw_on(sketch.main());
    sketch.call(sheet, &["x + 1"]);
    sketch
}
