//! Takes every device path of a checked configuration below a folder: the shipped configuration on a virtual board.
//!
//! Owns where they stand in a configuration; each kind of source shows its own. Libraries, included files and recordings
//! are not among them.

use crate::description::{Config, NodeDescription, SetupAction, SetupStep};
use std::path::{Path, PathBuf};

/// `/dev/i2c-2` becomes `ROOT/dev/i2c-2`, everywhere in the configuration.
pub(crate) fn take_below(config: &mut Config, root: &Path) {
    let mut take = |path: &mut PathBuf| *path = below(root, path);
    for node in &mut config.nodes {
        of_node(node, &mut take);
    }
    for action in &mut config.setup {
        of_action(action, &mut take);
    }
}

/// The path below the root. `..` stays what it is: the configuration and the root belong to the same person.
fn below(root: &Path, path: &Path) -> PathBuf {
    root.join(path.strip_prefix("/").unwrap_or(path))
}

fn of_node(node: &mut NodeDescription, take: &mut dyn FnMut(&mut PathBuf)) {
    node.source.each_path(take);
    for attribute in &mut node.attributes {
        of_node(attribute, take);
    }
}

fn of_action(action: &mut SetupAction, take: &mut dyn FnMut(&mut PathBuf)) {
    match &mut action.step {
        SetupStep::Write { path, .. } => take(path),
        SetupStep::Run { program, .. } => take(program),
        SetupStep::Send { to, .. } => to.each_path(take),
    }
    if let Some(path) = &mut action.unless {
        take(path);
    }
}

#[cfg(test)]
mod tests {
    use crate::load::Loader;

    #[test]
    fn every_device_path_is_taken_below_the_root_and_no_other() {
        let source = "
            setup = {
              { path = '/sys/class/gpio/export', write = '94', unless = '/sys/class/gpio/gpio94' },
              { run = { '/sbin/modprobe', '/etc/x' } },
              { to = i2c{ '/dev/i2c-2', address = 9, register = 1, transfer = 'byte' }, write = '1' },
            }
            trikfs = {
              a = { src = '/dev/a', input_tuple_size = 1, attributes = {
                    b = { src = attribute{ '/sys/b' }, input_tuple_size = 1 } } },
              c = { src = { fifo{ '/run/c' }, faulty{ src = evdev{ '/dev/d', axes = { 'ABS_X' } }, fail = 'EIO' } },
                    input_tuple_size = { 1, 4 } },
              e = { src = i2c{ '/dev/i2c-1', address = 9, register = 1, transfer = 'byte' } },
              f = { src = replay{ '/var/f.rec' }, input_tuple_size = 1 },
              g = { src = 'trikfs:a' },
              h = { src = iio{ name = 'mma8451', channels = { 'accel_x' } } },
              i = { src = pwm{ chip = '/sys/class/pwm/pwmchip2', channel = 0, period_ns = 20000000 } },
              j = { src = gpio{ number = 56, direction = 'in' } },
              k = { src = lines{ path = '/run/out', input = '/run/in', start = { '/etc/start', '/k' }, stop = { '/etc/stop' } },
                    input_tuple_size = 8 },
              l = { src = packets{ path = '/dev/ttyS1', start = 'a', length = { at = 1, bytes = 1, add = 2 }, checksum = 'none' },
                    input_tuple_size = 8 },
            }";
        let loader = Loader {
            device_root: Some("/tmp/board".into()),
            ..Loader::default()
        };
        let config = loader.load("robot.lua", None, source.as_bytes());
        let config = config.unwrap_or_else(|problem| panic!("{problem}")).config;
        let shown = format!("{config:#?}");
        let mut paths: Vec<&str> = shown
            .split('"')
            .filter(|text| text.starts_with('/'))
            .collect();
        paths.sort_unstable();
        let expected = [
            "/etc/x",
            "/k",
            "/tmp/board/dev",
            "/tmp/board/dev/a",
            "/tmp/board/dev/d",
            "/tmp/board/dev/i2c-1",
            "/tmp/board/dev/i2c-2",
            "/tmp/board/dev/ttyS1",
            "/tmp/board/etc/start",
            "/tmp/board/etc/stop",
            "/tmp/board/run/c",
            "/tmp/board/run/in",
            "/tmp/board/run/out",
            "/tmp/board/sbin/modprobe",
            "/tmp/board/sys/b",
            "/tmp/board/sys/bus/iio/devices",
            "/tmp/board/sys/class/gpio",
            "/tmp/board/sys/class/gpio/export",
            "/tmp/board/sys/class/gpio/gpio94",
            "/tmp/board/sys/class/pwm/pwmchip2",
            "/var/f.rec",
        ];
        assert_eq!(paths, expected);
    }
}
