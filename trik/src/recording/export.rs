//! `trik export`: a recording as a table.
//!
//! Owns rows and columns. It is written while it is read, so that its length costs no memory.

#[cfg(feature = "parquet")]
mod parquet;

use super::fresh::Fresh;
use super::shared::{Opened, Progress, has_ending, moment, open, seconds};
use crate::error::Error;
use crate::limits;
use crate::output::csv;
use crate::refusal::Refusal;
use clap::Args;
use journal::layout::{Kind, Layout};
use journal::read::{Event, EventKind};
use recorder::pattern::matches;
use std::collections::HashMap;
use std::io::{self, BufWriter, Write};
use std::path::{Path, PathBuf};

/// The options of `trik export`.
#[derive(Args, Clone, Debug)]
pub(crate) struct ExportArgs {
    /// The recording.
    pub file: PathBuf,
    /// Only nodes whose path is matched: * stands for anything, and a group for all below it; may be given several times.
    #[arg(long, value_name = "PATTERN")]
    pub only: Vec<String>,
    /// From this moment on, in seconds from the beginning [default: from the beginning].
    #[arg(long, value_name = "SECONDS", value_parser = moment)]
    pub from: Option<u64>,
    /// Up to this moment and with it [default: to the end].
    #[arg(long, value_name = "SECONDS", value_parser = moment)]
    pub to: Option<u64>,
    /// The table, a new file: CSV or Parquet, by its ending; - is CSV on standard output, as without this option.
    #[arg(long, short, value_name = "OUT.csv|OUT.parquet")]
    pub output: Option<PathBuf>,
    /// As Parquet, whatever the name of the file.
    #[arg(long, requires = "output", conflicts_with = "csv")]
    pub parquet: bool,
    /// As CSV, whatever the name of the file: the older spelling of its ending.
    #[arg(long, hide = true)]
    pub csv: bool,
    /// Overwrite the table if it exists.
    #[arg(long, requires = "output")]
    pub force: bool,
}

/// What the cells of a column have.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Cell {
    /// Whole numbers of so many bits; true: signed ones.
    Whole(i8, bool),
    Single,
    Double,
    Text,
    Bytes,
}

/// Which cells a sample fills.
struct Columns {
    names: Vec<String>,
    #[cfg_attr(not(feature = "parquet"), allow(dead_code, reason = "CSV has texts"))]
    cells: Vec<Cell>,
    #[cfg_attr(not(feature = "parquet"), allow(dead_code, reason = "CSV has none"))]
    units: Vec<String>,
    /// Of each layout of a node that is wanted: the columns of its numbers.
    of_layout: HashMap<usize, Vec<usize>>,
    /// The nodes that are wanted.
    nodes: Vec<bool>,
}

/// Writes it.
///
/// # Errors
/// It is no whole recording, has no such nodes or too many numbers, or the table cannot be written.
pub(crate) fn run(args: &ExportArgs) -> Result<u8, Refusal> {
    let place = (args.output.as_deref()).filter(|path| *path != Path::new("-"));
    let ends = |with: &str| place.is_some_and(|place| has_ending(place, with));
    let is_parquet = args.parquet || (!args.csv && ends("parquet"));
    if place.is_some() && !(is_parquet || args.csv || ends("csv")) {
        let why = "the table is CSV or Parquet: its name ends with .csv or .parquet";
        return Err(Refusal::new(why));
    }
    if is_parquet && (place.is_none() || !cfg!(feature = "parquet")) {
        return Err(Refusal::new(match place {
            Some(_) => {
                "this program was built without Parquet: cargo build -p trik --features parquet makes one with it"
            }
            None => "a table in Parquet is a file: name it with -o",
        }));
    }
    let mut opened = open(&args.file)?;
    let is_wanted =
        |path: &str| args.only.is_empty() || args.only.iter().any(|one| matches(one, path));
    let columns = columns(&opened, &args.file, is_wanted)?;
    let begin = opened.begin_ns();
    opened.seek(begin.saturating_add(args.from.unwrap_or(0)));
    let last = args.to.map_or(u64::MAX, |to| begin.saturating_add(to));
    let Some(place) = place else {
        let out = BufWriter::new(io::stdout().lock());
        let name = Path::new("standard output");
        write(&mut opened, &columns, last, out, &args.file, name)?;
        return Ok(0);
    };
    let fresh = Fresh::new(place, &args.file, args.force)?;
    #[cfg(feature = "parquet")]
    if is_parquet {
        let out = fresh.file()?;
        parquet::write(&mut opened, columns, last, out, (&args.file, place))?;
        fresh.place()?;
        return Ok(0);
    }
    let out = BufWriter::new(fresh.file()?);
    write(&mut opened, &columns, last, out, &args.file, place)?;
    fresh.place()?;
    Ok(0)
}

/// A column for each number of each node; layouts that a node had one after the other share those of the same name.
fn columns(
    opened: &Opened,
    file: &Path,
    is_wanted: impl Fn(&str) -> bool,
) -> Result<Columns, Error> {
    let mut columns = Columns {
        names: Vec::new(),
        cells: Vec::new(),
        units: Vec::new(),
        of_layout: HashMap::new(),
        nodes: Vec::new(),
    };
    let mut known: HashMap<String, usize> = HashMap::new();
    for (number, node) in opened.nodes().iter().enumerate() {
        let is_wanted = is_wanted(&node.path);
        columns.nodes.push(is_wanted);
        if !is_wanted {
            continue;
        }
        for layout in opened.layouts_of(number) {
            let mut cells = Vec::new();
            let layout_of = &opened.layouts()[layout];
            let kinds = kinds(layout_of);
            for (name, cell) in cell_names(&node.path, layout_of).into_iter().zip(kinds) {
                let next = columns.names.len();
                let column = *known.entry(name.clone()).or_insert(next);
                if column == next {
                    columns.names.push(name);
                    columns.cells.push(cell);
                    columns.units.push(node.units.clone());
                } else if columns.cells[column] != cell {
                    // It had another type before: as a text each is what it was.
                    columns.cells[column] = Cell::Text;
                }
                cells.push(column);
            }
            columns.of_layout.insert(layout, cells);
            if columns.names.len() > limits::TABLE_COLUMNS_MAX {
                let most = limits::TABLE_COLUMNS_MAX;
                let why = format!("a table has at most {most} columns: name nodes with --only");
                return Err(Error::file(file, why));
            }
        }
    }
    match columns.nodes.contains(&true) {
        true => Ok(columns),
        false => Err(Error::file(file, "the recording has no such nodes")),
    }
}

/// Bytes without names are one cell, as a text is.
fn cell_names(path: &str, layout: &Layout) -> Vec<String> {
    match layout {
        Layout::Fields(_) => {
            let names = layout.names();
            names.iter().map(|name| format!("{path}.{name}")).collect()
        }
        Layout::Bytes(_) | Layout::Text(_) => vec![path.to_owned()],
    }
}

/// What the cells of a layout have.
fn kinds(layout: &Layout) -> Vec<Cell> {
    match layout {
        Layout::Fields(fields) => fields.iter().map(|field| kind(field.kind)).collect(),
        Layout::Bytes(_) => vec![Cell::Bytes],
        Layout::Text(_) => vec![Cell::Text],
    }
}

fn kind(kind: Kind) -> Cell {
    match kind {
        Kind::I8 => Cell::Whole(8, true),
        Kind::U8 => Cell::Whole(8, false),
        Kind::I16 => Cell::Whole(16, true),
        Kind::U16 => Cell::Whole(16, false),
        Kind::I32 => Cell::Whole(32, true),
        Kind::U32 => Cell::Whole(32, false),
        Kind::I64 => Cell::Whole(64, true),
        Kind::U64 => Cell::Whole(64, false),
        Kind::F32 => Cell::Single,
        Kind::F64 => Cell::Double,
    }
}

fn cells(layout: &Layout, tuple: &[u8]) -> Vec<String> {
    match layout {
        Layout::Fields(_) => {
            let numbers = layout.numbers(tuple);
            numbers.iter().map(ToString::to_string).collect()
        }
        Layout::Bytes(_) => vec![tuple.iter().map(|byte| format!("{byte:02x}")).collect()],
        Layout::Text(_) => vec![csv::text(&layout.show(tuple))],
    }
}

fn write(
    opened: &mut Opened,
    columns: &Columns,
    last: u64,
    mut out: impl Write,
    file: &Path,
    place: &Path,
) -> Result<(), Error> {
    let mut progress = Progress::new();
    let (begin, end) = (opened.begin_ns(), opened.end_ns());
    let titles = columns.names.iter().map(|name| csv::text(name));
    let titles: Vec<String> = titles.collect();
    let mut written = row(&mut out, "time_s", &titles, "fault");
    while written.is_ok() {
        let event = opened.next().map_err(|why| Error::file(file, why))?;
        let Some(event) = event.filter(|event| event.unix_ns <= last) else {
            written = out.flush();
            break;
        };
        progress.at(event.unix_ns - begin, end - begin);
        written = event_row(&mut out, opened, columns, &event, begin);
    }
    match written {
        // A reader of a pipe that has seen enough is no failure.
        Err(error) if error.kind() != io::ErrorKind::BrokenPipe => Err(Error::file(place, error)),
        Ok(()) | Err(_) => Ok(()),
    }
}

fn event_row(
    out: &mut impl Write,
    opened: &Opened,
    columns: &Columns,
    event: &Event,
    begin: u64,
) -> io::Result<()> {
    let time = seconds(event.unix_ns - begin);
    let mut all = vec![String::new(); columns.names.len()];
    match &event.what {
        EventKind::Sample { layout, tuple, .. } => {
            let Some(places) = columns.of_layout.get(layout) else {
                return Ok(());
            };
            let cells = cells(&opened.layouts()[*layout], tuple);
            for (place, cell) in places.iter().zip(cells) {
                all[*place] = cell;
            }
            row(out, &time, &all, "")
        }
        EventKind::Fault {
            node,
            errno,
            reason,
        } if columns.nodes[*node] => {
            let path = &opened.nodes()[*node].path;
            let fault = csv::text(&format!("{path}: errno {errno}: {reason}"));
            row(out, &time, &all, &fault)
        }
        EventKind::Fault { .. } | EventKind::Line(..) => Ok(()),
    }
}

fn row(out: &mut impl Write, time: &str, cells: &[String], fault: &str) -> io::Result<()> {
    out.write_all(time.as_bytes())?;
    for cell in cells {
        write!(out, ",{cell}")?;
    }
    writeln!(out, ",{fault}")
}
