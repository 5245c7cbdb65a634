//! The configuration of a replayed tree: the nodes of a recording under their names, each fed by the player.
//!
//! Owns the text. There are no converters in it: what is played is what readers got, so it needs none of them.

use super::recording::Channel;
use recorder::watch::REPLAYED;
use std::collections::BTreeMap;
use std::fmt::Write;
use std::path::Path;

/// A place in the tree of names.
#[derive(Default)]
struct Place<'a> {
    node: Option<&'a Channel>,
    alias: Option<&'a str>,
    below: BTreeMap<&'a str, Place<'a>>,
}

/// The program that describes all these nodes, fed by the socket at `player`.
pub(super) fn configuration(channels: &[Channel], player: &Path) -> String {
    let mut root = Place::default();
    for channel in channels {
        at(&mut root, &channel.path).node = Some(channel);
    }
    for channel in channels {
        for alias in &channel.aliases {
            let place = at(&mut root, alias);
            if place.node.is_none() && place.below.is_empty() {
                place.alias = Some(&channel.path);
            }
        }
    }
    let mut text = format!("{REPLAYED}: every node gives what was recorded.\n");
    let player = quoted(&player.to_string_lossy());
    let _ = writeln!(text, "local player = {player}\ntrikfs = {{");
    write_below(&root, 1, &mut text);
    text.push_str("}\n");
    text
}

fn at<'a, 'b>(root: &'b mut Place<'a>, path: &'a str) -> &'b mut Place<'a> {
    path.split('/')
        .fold(root, |place, name| place.below.entry(name).or_default())
}

fn write_below(place: &Place<'_>, depth: usize, text: &mut String) {
    let indent = "  ".repeat(depth);
    for (name, below) in &place.below {
        let _ = write!(text, "{indent}[{}] = {{", quoted(name));
        if let Some(channel) = below.node {
            describe(channel, text);
            if !below.below.is_empty() {
                let _ = writeln!(text, "\n{indent}  attributes = {{");
                write_below(below, depth + 2, text);
                let _ = write!(text, "{indent}  }},\n{indent}");
            }
        } else if let Some(node) = below.alias {
            let _ = write!(text, " alias = {} ", quoted(node));
        } else {
            text.push('\n');
            write_below(below, depth + 1, text);
            text.push_str(&indent);
        }
        text.push_str("},\n");
    }
}

/// The keys of one node.
fn describe(channel: &Channel, text: &mut String) {
    let name = quoted(&channel.path);
    let _ = write!(
        text,
        " src = played{{ path = player, channel = {name} }}, input_tuple_size = {}, on_event = true,",
        channel.bytes
    );
    let has_format = !channel.format.is_empty() && !channel.format.starts_with("u8 x ");
    let texts = [
        ("format", &channel.format, has_format),
        ("units", &channel.units, !channel.units.is_empty()),
        ("about", &channel.about, !channel.about.is_empty()),
    ];
    for (key, value, is_there) in texts {
        if is_there {
            let _ = write!(text, " {key} = {},", quoted(value));
        }
    }
    if !channel.is_written {
        text.push_str(" mode = 0444,");
    } else if !channel.rest.is_empty() {
        let numbers = channel.rest.replace(' ', ", ");
        let _ = write!(text, " rest = {{ {numbers} }},");
    }
    text.push(' ');
}

/// A text of Lua that stands for exactly these bytes.
fn quoted(text: &str) -> String {
    let mut out = String::from("'");
    for byte in text.bytes() {
        match byte {
            b'\'' | b'\\' => {
                out.push('\\');
                out.push(char::from(byte));
            }
            b' '..=b'~' => out.push(char::from(byte)),
            other => {
                let _ = write!(out, "\\{other:03}");
            }
        }
    }
    out.push('\'');
    out
}

#[cfg(test)]
mod tests {
    use super::*;
    use journal::layout::Layout;

    fn channel(path: &str) -> Channel {
        Channel {
            path: path.to_owned(),
            format: "i32 x".to_owned(),
            units: "cm".to_owned(),
            about: String::new(),
            bytes: 4,
            layout: Layout::Bytes(4),
            is_written: false,
            rest: String::new(),
            aliases: Vec::new(),
        }
    }

    #[test]
    fn nodes_groups_attributes_and_second_names_are_where_they_were() {
        let mut motor = channel("motors/M1");
        motor.is_written = true;
        motor.rest = "0".to_owned();
        motor.aliases = vec!["motors/left".to_owned()];
        let speed = channel("motors/M1/speed");
        let mut plain = channel("it's \u{fc}\\");
        plain.format = "u8 x 4".to_owned();
        plain.units.clear();
        let text = configuration(&[motor, speed, plain], Path::new("/run/p.sock"));
        assert_eq!(
            text,
            r"-- Made for a replay: every node gives what was recorded.
local player = '/run/p.sock'
trikfs = {
  ['it\'s \195\188\\'] = { src = played{ path = player, channel = 'it\'s \195\188\\' }, input_tuple_size = 4, on_event = true, mode = 0444, },
  ['motors'] = {
    ['M1'] = { src = played{ path = player, channel = 'motors/M1' }, input_tuple_size = 4, on_event = true, format = 'i32 x', units = 'cm', rest = { 0 }, 
      attributes = {
        ['speed'] = { src = played{ path = player, channel = 'motors/M1/speed' }, input_tuple_size = 4, on_event = true, format = 'i32 x', units = 'cm', mode = 0444, },
      },
    },
    ['left'] = { alias = 'motors/M1' },
  },
}
"
        );
    }
}
