//! Health and values of a tree as the text that Prometheus reads.
//!
//! Owns the names of the series, and what has been counted. A node that has failed has no value: its errno is a series of its
//! own, so that a failure is never taken for a number. Knows no network.

use crate::limits::{ERRNOS_MAX, FIELDS_MAX, STATUS_BYTES_MAX};
use journal::layout::Layout;
use prometheus_client::collector::Collector;
use prometheus_client::encoding::text::encode;
use prometheus_client::encoding::{DescriptorEncoder, EncodeMetric, MetricEncoder};
use prometheus_client::metrics::MetricType;
use prometheus_client::metrics::counter::ConstCounter;
use prometheus_client::metrics::gauge::ConstGauge;
use prometheus_client::registry::Registry;
use recorder::entry::{Entry, Known};
use recorder::errno::LEFT;
use std::collections::BTreeMap;
use std::fmt;
use std::fs::File;
use std::io::Read;
use std::path::Path;

/// The media type of the text.
pub const MEDIA_TYPE: &str = "application/openmetrics-text; version=1.0.0; charset=utf-8";

type Labels = Vec<(&'static str, String)>;

/// What is known of one node.
#[derive(Default)]
struct NodeState {
    units: String,
    fields: Vec<String>,
    layout: Option<Layout>,
    /// Empty if it has none, or has failed.
    values: Vec<f64>,
    errno: i32,
    at_ns: u64,
    samples: u64,
    failures: BTreeMap<i32, u64>,
}

/// What has come of a tree.
#[derive(Default)]
pub struct Numbers {
    nodes: BTreeMap<String, NodeState>,
    missed: u64,
    is_there: bool,
}

impl Numbers {
    /// Takes what has come since the last time.
    pub fn take(&mut self, entries: &[Entry]) {
        for entry in entries {
            match entry {
                Entry::Node(known) => self.know(known),
                Entry::Sample(known, at_ns, tuple) => {
                    self.know(known);
                    let Some(seen) = self.nodes.get_mut(&known.node.path) else {
                        continue;
                    };
                    seen.errno = 0;
                    seen.at_ns = *at_ns;
                    seen.samples += 1;
                    if let Some(layout) = &seen.layout {
                        let numbers = layout.numbers(tuple);
                        seen.values = numbers.iter().map(|number| number.to_f64()).collect();
                    }
                }
                // It was taken out of the configuration.
                Entry::Fault(known, _, LEFT, _) => drop(self.nodes.remove(&known.node.path)),
                Entry::Fault(known, at_ns, errno, _) => {
                    self.know(known);
                    let Some(seen) = self.nodes.get_mut(&known.node.path) else {
                        continue;
                    };
                    seen.errno = *errno;
                    seen.at_ns = *at_ns;
                    seen.values.clear();
                    if seen.failures.len() < ERRNOS_MAX || seen.failures.contains_key(errno) {
                        *seen.failures.entry(*errno).or_default() += 1;
                    }
                }
                Entry::Line(..) | Entry::Attachment(..) | Entry::Facts(..) => {}
            }
        }
    }

    /// Whether the tree is there, and how many samples were overwritten before they were seen.
    pub fn health(&mut self, is_there: bool, missed: u64) {
        self.is_there = is_there;
        self.missed = missed;
        if !is_there {
            for seen in self.nodes.values_mut() {
                seen.values.clear();
            }
        }
    }

    /// A node whose format changes has other fields from now on.
    fn know(&mut self, known: &Known) {
        let node = &known.node;
        if !self.nodes.contains_key(&node.path) {
            self.nodes.insert(node.path.clone(), NodeState::default());
        }
        let Some(seen) = self.nodes.get_mut(&node.path) else {
            return;
        };
        let layout = Layout::parse(&node.format).ok();
        let layout = layout.filter(|layout| layout.names().len() <= FIELDS_MAX);
        if seen.layout != layout {
            seen.fields = layout.as_ref().map_or_else(Vec::new, Layout::names);
            seen.units.clone_from(&node.units);
            seen.layout = layout;
            seen.values.clear();
        }
    }

    /// The text, with what the file `status` of the tree says.
    pub fn text(&self, root: &Path) -> String {
        let mut all = self.series();
        if self.is_there {
            all.extend(status(root));
        }
        let mut registry = Registry::with_prefix("trikfs");
        registry.register_collector(Box::new(Scrape(all)));
        let mut text = String::new();
        // Writing to a string cannot fail.
        let _ = encode(&mut text, &registry);
        text
    }

    fn series(&self) -> Vec<Series> {
        let mut values = Series::new(VALUE);
        let mut errnos = Series::new(ERRNO);
        let mut times = Series::new(LAST_SECONDS);
        let mut samples = Series::new(SAMPLES);
        let mut failures = Series::new(FAILURES);
        for (path, seen) in &self.nodes {
            let node = || vec![("node", path.clone())];
            for (field, value) in seen.fields.iter().zip(&seen.values) {
                let mut labels = node();
                labels.push(("field", field.clone()));
                labels.push(("unit", seen.units.clone()));
                values.add(labels, Number::Real(*value));
            }
            errnos.add(node(), Number::Whole(seen.errno.into()));
            if seen.at_ns > 0 {
                times.add(node(), Number::Real(seconds(seen.at_ns)));
            }
            samples.add(node(), Number::Count(seen.samples));
            for (errno, count) in &seen.failures {
                let mut labels = node();
                labels.push(("errno", errno.to_string()));
                failures.add(labels, Number::Count(*count));
            }
        }
        let mut missed = Series::new(MISSED);
        missed.add(Vec::new(), Number::Count(self.missed));
        let mut up = Series::new(UP);
        up.add(Vec::new(), Number::Whole(self.is_there.into()));
        vec![values, errnos, times, samples, failures, missed, up]
    }
}

/// What a series is called, and what it is.
type About = (&'static str, &'static str);

const VALUE: About = (
    "value",
    "The last value of a field of a node; none while the node fails",
);
const ERRNO: About = (
    "errno",
    "The errno with which a node fails; 0 if it has a value",
);
const LAST_SECONDS: About = (
    "last_seconds",
    "When the last sample or failure of a node was, in seconds since 1970",
);
const SAMPLES: About = ("samples", "Samples of a node");
const FAILURES: About = ("failures", "Failures of a node, by errno");
const MISSED: About = (
    "missed_samples",
    "Samples that were overwritten before they were seen",
);
const UP: About = ("up", "1 if the tree is mounted");
const STATE: About = ("state", "1 for the state that a node or an attribute has");
const RATE: About = ("rate_hertz", "Samples per second of a node or an attribute");

/// A number of a series.
#[derive(Clone, Copy, Debug)]
enum Number {
    Real(f64),
    Whole(i64),
    /// It only grows.
    Count(u64),
}

impl Number {
    fn encode(self, out: MetricEncoder<'_>) -> fmt::Result {
        match self {
            Self::Real(number) => ConstGauge::new(number).encode(out),
            Self::Whole(number) => ConstGauge::new(number).encode(out),
            Self::Count(number) => ConstCounter::new(number).encode(out),
        }
    }
}

/// Numbers of one kind, as they are at the moment.
#[derive(Debug)]
struct Series {
    about: About,
    rows: Vec<(Labels, Number)>,
}

impl Series {
    fn new(about: About) -> Self {
        let rows = Vec::new();
        Self { about, rows }
    }

    fn add(&mut self, labels: Labels, number: Number) {
        self.rows.push((labels, number));
    }
}

/// All of one text.
#[derive(Debug)]
struct Scrape(Vec<Series>);

impl Collector for Scrape {
    fn encode(&self, mut encoder: DescriptorEncoder<'_>) -> fmt::Result {
        for Series { about, rows } in &self.0 {
            let kind = match rows.first() {
                None => continue,
                Some((_, Number::Count(_))) => MetricType::Counter,
                Some((_, Number::Real(_) | Number::Whole(_))) => MetricType::Gauge,
            };
            let (name, help) = about;
            let mut metric = encoder.encode_descriptor(name, help, None, kind)?;
            if let [(labels, number)] = &rows[..]
                && labels.is_empty()
            {
                number.encode(metric)?;
                continue;
            }
            for (labels, number) in rows {
                number.encode(metric.encode_family(&labels.as_slice())?)?;
            }
        }
        Ok(())
    }
}

/// Seconds of a time in ns; a number for a graph needs no more digits.
#[allow(clippy::cast_precision_loss, reason = "a graph has no more digits")]
fn seconds(at_ns: u64) -> f64 {
    at_ns as f64 / 1e9
}

/// Lines of `status` after the first one: name, state, samples per second, fault. Nothing if it cannot be read.
fn status(root: &Path) -> Vec<Series> {
    let mut text = String::new();
    let read = File::open(root.join("status"))
        .and_then(|file| file.take(STATUS_BYTES_MAX).read_to_string(&mut text));
    if read.is_err() {
        return Vec::new();
    }
    let mut states = Series::new(STATE);
    let mut rates = Series::new(RATE);
    for line in text.lines().skip(1) {
        let mut words = line.split(' ');
        let (Some(name), Some(state), Some(rate)) = (words.next(), words.next(), words.next())
        else {
            continue;
        };
        let Some(rate) = rate.strip_suffix("Hz").and_then(|rate| rate.parse().ok()) else {
            continue;
        };
        let name = || ("name", name.to_owned());
        states.add(vec![name(), ("state", state.to_owned())], Number::Whole(1));
        rates.add(vec![name()], Number::Real(rate));
    }
    vec![states, rates]
}

#[cfg(test)]
mod tests {
    use super::*;
    use journal::node::Node;
    use std::sync::Arc;

    #[test]
    fn a_failure_takes_the_value_away() {
        let mut node = Node::sensor("sensors/D1", "u16 distance");
        node.units = "c\"m\n".to_owned();
        let known = Arc::new(Known { number: 1, node });
        let mut numbers = Numbers::default();
        numbers.health(true, 3);
        let sample = Entry::Sample(known.clone(), 2_000_000_000, vec![80, 0].into());
        numbers.take(std::slice::from_ref(&sample));
        let text = numbers.text(Path::new("/nothing"));
        let value = r#"trikfs_value{node="sensors/D1",field="distance",unit="c\"m\n"} 80.0"#;
        assert!(text.contains(value), "{text}");
        assert!(text.contains("trikfs_missed_samples_total 3\n"), "{text}");
        numbers.take(&[Entry::Fault(known, 3_000_000_000, 19, "".into())]);
        let text = numbers.text(Path::new("/nothing"));
        assert!(!text.contains("trikfs_value{"), "{text}");
        for line in [
            r#"trikfs_errno{node="sensors/D1"} 19"#,
            r#"trikfs_failures_total{node="sensors/D1",errno="19"} 1"#,
            r#"trikfs_samples_total{node="sensors/D1"} 1"#,
            r#"trikfs_last_seconds{node="sensors/D1"} 3.0"#,
            "trikfs_up 1",
            "# EOF",
        ] {
            assert!(text.lines().any(|one| one == line), "{line}: {text}");
        }
    }

    #[test]
    fn a_picture_is_no_series_and_a_tree_that_is_gone_has_no_values() {
        let known = |format: &str| {
            let node = Node::sensor("n", format);
            Arc::new(Known { number: 1, node })
        };
        let mut numbers = Numbers::default();
        numbers.health(true, 0);
        let bytes = vec![0; FIELDS_MAX + 1];
        let format = format!("u8 x {}", bytes.len());
        numbers.take(&[Entry::Sample(known(&format), 1, bytes.into())]);
        assert!(
            !numbers
                .text(Path::new("/nothing"))
                .contains("trikfs_value{")
        );
        numbers.take(&[Entry::Sample(known("u8 v"), 1, vec![7].into())]);
        assert!(
            numbers
                .text(Path::new("/nothing"))
                .contains("trikfs_value{")
        );
        numbers.health(false, 0);
        let text = numbers.text(Path::new("/nothing"));
        assert!(!text.contains("trikfs_value{"), "{text}");
        assert!(text.contains("trikfs_up 0\n"), "{text}");
    }
}
