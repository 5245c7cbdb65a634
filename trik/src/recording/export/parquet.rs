//! A recording as a table in Parquet: each number in its own type, with its unit in the metadata.
//!
//! Owns the types of columns, and how many rows are in memory. Which rows and columns there are is known to `export`.

use super::{Cell, Columns};
use crate::error::Error;
use crate::limits;
use crate::recording::shared::{Opened, Progress};
use journal::layout::{Layout, Number};
use journal::read::{Event, EventKind};
use parquet::basic::{LogicalType, Repetition, TimeUnit, Type as Physical};
use parquet::data_type::{
    ByteArray, ByteArrayType, DataType, DoubleType, FloatType, Int32Type, Int64Type,
};
use parquet::errors::ParquetError;
use parquet::file::metadata::KeyValue;
use parquet::file::properties::WriterProperties;
use parquet::file::writer::{SerializedFileWriter, SerializedRowGroupWriter};
use parquet::schema::types::Type;
use std::fs::File;
use std::path::Path;
use std::sync::Arc;

/// Columns that every table has: the moment by the clock, in s from the beginning, and last why a node has no value.
const TIME: &str = "time";
const SECONDS: &str = "time_s";
const FAULT: &str = "fault";

/// Values of one type, without those that are not there.
enum Values {
    Small(Vec<i32>),
    Large(Vec<i64>),
    Single(Vec<f32>),
    Double(Vec<f64>),
    Bytes(Vec<ByteArray>),
}

/// One column of the rows that are in memory.
struct Column {
    values: Values,
    /// Of each row up to the last with a value whether it has one.
    levels: Vec<i16>,
}

/// Writes the table.
///
/// # Errors
/// The recording contradicts itself, or the table cannot be written.
pub(super) fn write(
    opened: &mut Opened,
    mut columns: Columns,
    last: u64,
    out: File,
    (file, place): (&Path, &Path),
) -> Result<(), Error> {
    let failed = |why: ParquetError| Error::file(place, why);
    free(&mut columns);
    let columns = &columns;
    let schema = schema(columns).map_err(failed)?;
    let properties = properties(opened, columns);
    let mut out =
        SerializedFileWriter::new(out, Arc::new(schema), Arc::new(properties)).map_err(failed)?;
    let mut rows = Rows::new(columns);
    let mut progress = Progress::new();
    let (begin, end) = (opened.begin_ns(), opened.end_ns());
    while let Some(event) = opened.next().map_err(|why| Error::file(file, why))? {
        if event.unix_ns > last {
            break;
        }
        progress.at(event.unix_ns - begin, end - begin);
        rows.take(opened, columns, &event, begin);
        if rows.times.len() >= rows.most || rows.bytes >= limits::TABLE_GROUP_BYTES {
            rows.write(&mut out).map_err(failed)?;
        }
    }
    if !rows.times.is_empty() {
        rows.write(&mut out).map_err(failed)?;
    }
    out.close().map(drop).map_err(failed)
}

/// A node may have the name of one of our columns too: another one is found for it, which no other node has.
fn free(columns: &mut Columns) {
    for own in [TIME, SECONDS, FAULT] {
        let Some(at) = columns.names.iter().position(|name| name == own) else {
            continue;
        };
        let mut name = format!("{own}_");
        while columns.names.contains(&name) {
            name.push('_');
        }
        columns.names[at] = name;
    }
}

/// Names and types.
fn schema(columns: &Columns) -> Result<Type, ParquetError> {
    let field = |name: &str, physical, logical, repetition| {
        Type::primitive_type_builder(name, physical)
            .with_repetition(repetition)
            .with_logical_type(logical)
            .build()
            .map(Arc::new)
    };
    let nanoseconds = Some(LogicalType::timestamp(true, TimeUnit::NANOS));
    let mut fields = vec![
        field(TIME, Physical::INT64, nanoseconds, Repetition::REQUIRED)?,
        field(SECONDS, Physical::DOUBLE, None, Repetition::REQUIRED)?,
    ];
    for (name, cell) in columns.names.iter().zip(&columns.cells) {
        let (physical, logical) = types(*cell);
        fields.push(field(name, physical, logical, Repetition::OPTIONAL)?);
    }
    let text = Some(LogicalType::String);
    fields.push(field(
        FAULT,
        Physical::BYTE_ARRAY,
        text,
        Repetition::OPTIONAL,
    )?);
    let group = Type::group_type_builder("recording").with_fields(fields);
    group.build()
}

fn types(cell: Cell) -> (Physical, Option<LogicalType>) {
    match cell {
        Cell::Whole(64, is_signed) => (Physical::INT64, Some(LogicalType::integer(64, is_signed))),
        Cell::Whole(bits, is_signed) => {
            (Physical::INT32, Some(LogicalType::integer(bits, is_signed)))
        }
        Cell::Single => (Physical::FLOAT, None),
        Cell::Double => (Physical::DOUBLE, None),
        Cell::Text => (Physical::BYTE_ARRAY, Some(LogicalType::String)),
        Cell::Bytes => (Physical::BYTE_ARRAY, None),
    }
}

/// Units, as an object in JSON, and when the recording begins.
fn properties(opened: &Opened, columns: &Columns) -> WriterProperties {
    let named = columns.names.iter().zip(&columns.units);
    let units: serde_json::Map<String, serde_json::Value> = named
        .filter(|(_, unit)| !unit.is_empty())
        .map(|(name, unit)| (name.clone(), unit.clone().into()))
        .collect();
    let units = serde_json::Value::Object(units).to_string();
    let about = [
        ("units", units),
        ("begin_ns", opened.begin_ns().to_string()),
    ];
    let about = about.map(|(key, value)| KeyValue::new(key.to_owned(), value));
    WriterProperties::builder()
        .set_created_by(concat!("trik/", env!("CARGO_PKG_VERSION")).to_owned())
        .set_key_value_metadata(Some(about.into()))
        .build()
}

/// Rows that are in memory.
struct Rows {
    times: Vec<i64>,
    seconds: Vec<f64>,
    columns: Vec<Column>,
    /// Bytes of texts and pictures among them.
    bytes: usize,
    /// Rows with which they are written.
    most: usize,
}

impl Rows {
    fn new(columns: &Columns) -> Self {
        let own = columns.cells.iter().chain([&Cell::Text]);
        Self {
            times: Vec::new(),
            seconds: Vec::new(),
            columns: own.map(|cell| Column::new(*cell)).collect(),
            bytes: 0,
            most: (limits::TABLE_CELLS / (columns.names.len() + 1)).clamp(1, limits::TABLE_ROWS),
        }
    }

    fn take(&mut self, opened: &Opened, columns: &Columns, event: &Event, begin: u64) {
        let row = self.times.len();
        match &event.what {
            EventKind::Sample { layout, tuple, .. } => {
                let Some(places) = columns.of_layout.get(layout) else {
                    return;
                };
                match &opened.layouts()[*layout] {
                    known @ Layout::Fields(_) => {
                        for (place, number) in places.iter().zip(known.numbers(tuple)) {
                            self.columns[*place].number(row, number);
                        }
                    }
                    Layout::Bytes(_) => {
                        self.bytes += tuple.len();
                        self.columns[places[0]].bytes(row, tuple.clone());
                    }
                    known @ Layout::Text(_) => {
                        let text = known.show(tuple).into_bytes();
                        self.bytes += text.len();
                        self.columns[places[0]].bytes(row, text);
                    }
                }
            }
            EventKind::Fault {
                node,
                errno,
                reason,
            } if columns.nodes[*node] => {
                let path = &opened.nodes()[*node].path;
                let fault = format!("{path}: errno {errno}: {reason}");
                self.bytes += fault.len();
                if let Some(faults) = self.columns.last_mut() {
                    faults.bytes(row, fault.into_bytes());
                }
            }
            EventKind::Fault { .. } | EventKind::Line(..) => return,
        }
        self.times.push(event.unix_ns.cast_signed());
        self.seconds.push((event.unix_ns - begin) as f64 / 1e9);
    }

    /// Writes them and begins anew.
    fn write(&mut self, out: &mut SerializedFileWriter<File>) -> Result<(), ParquetError> {
        let rows = self.times.len();
        let mut group = out.next_row_group()?;
        put::<Int64Type>(&mut group, &self.times, None)?;
        put::<DoubleType>(&mut group, &self.seconds, None)?;
        for column in &mut self.columns {
            column.levels.resize(rows, 0);
            let levels = Some(&column.levels[..]);
            match &mut column.values {
                Values::Small(values) => put::<Int32Type>(&mut group, values, levels)?,
                Values::Large(values) => put::<Int64Type>(&mut group, values, levels)?,
                Values::Single(values) => put::<FloatType>(&mut group, values, levels)?,
                Values::Double(values) => put::<DoubleType>(&mut group, values, levels)?,
                Values::Bytes(values) => put::<ByteArrayType>(&mut group, values, levels)?,
            }
            column.clear();
        }
        group.close()?;
        self.times.clear();
        self.seconds.clear();
        self.bytes = 0;
        Ok(())
    }
}

/// The next column of a group.
fn put<T: DataType>(
    group: &mut SerializedRowGroupWriter<'_, File>,
    values: &[T::T],
    levels: Option<&[i16]>,
) -> Result<(), ParquetError> {
    if let Some(mut column) = group.next_column()? {
        column.typed::<T>().write_batch(values, levels, None)?;
        column.close()?;
    }
    Ok(())
}

impl Column {
    fn new(cell: Cell) -> Self {
        let values = match cell {
            Cell::Whole(64, _) => Values::Large(Vec::new()),
            Cell::Whole(..) => Values::Small(Vec::new()),
            Cell::Single => Values::Single(Vec::new()),
            Cell::Double => Values::Double(Vec::new()),
            Cell::Text | Cell::Bytes => Values::Bytes(Vec::new()),
        };
        Self {
            values,
            levels: Vec::new(),
        }
    }

    fn clear(&mut self) {
        self.levels.clear();
        match &mut self.values {
            Values::Small(values) => values.clear(),
            Values::Large(values) => values.clear(),
            Values::Single(values) => values.clear(),
            Values::Double(values) => values.clear(),
            Values::Bytes(values) => values.clear(),
        }
    }

    fn fill(&mut self, row: usize) {
        self.levels.resize(row, 0);
        self.levels.push(1);
    }

    fn number(&mut self, row: usize, number: Number) {
        self.fill(row);
        match (&mut self.values, number) {
            (Values::Small(values), Number::Signed(number)) => {
                values.push(i32::try_from(number).unwrap_or_default());
            }
            (Values::Small(values), Number::Unsigned(number)) => {
                values.push(u32::try_from(number).unwrap_or_default().cast_signed());
            }
            (Values::Large(values), Number::Signed(number)) => values.push(number),
            (Values::Large(values), Number::Unsigned(number)) => values.push(number.cast_signed()),
            (Values::Single(values), Number::Single(number)) => values.push(number),
            (Values::Double(values), number) => values.push(number.to_f64()),
            (Values::Bytes(values), number) => {
                values.push(number.to_string().into_bytes().into());
            }
            // A column has numbers of one type, or is one of texts.
            (Values::Small(_) | Values::Large(_) | Values::Single(_), _) => {
                self.levels.pop();
            }
        }
    }

    fn bytes(&mut self, row: usize, bytes: Vec<u8>) {
        if let Values::Bytes(values) = &mut self.values {
            self.levels.resize(row, 0);
            self.levels.push(1);
            values.push(bytes.into());
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use journal::node::Node;
    use journal::write::Writer;
    use parquet::file::reader::{FileReader, SerializedFileReader};
    use parquet::record::RowAccessor;
    use std::io::BufWriter;

    #[test]
    fn a_table_has_numbers_in_their_types_and_units_beside_them() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("run.mcap");
        let file = BufWriter::new(File::create_new(&path).unwrap());
        let mut recording = Writer::new(file, "test").unwrap();
        let mut node = Node::sensor("a", "i16 x, u64 big, f32 y");
        node.units = "cm".to_owned();
        let node = recording.add(&node).unwrap();
        let text = recording.add(&Node::sensor("time", "text 4")).unwrap();
        let mut tuple = (-7_i16).to_le_bytes().to_vec();
        tuple.extend(u64::MAX.to_le_bytes());
        tuple.extend(1.5_f32.to_le_bytes());
        recording.sample(node, 1_000_000_000, &tuple).unwrap();
        recording.sample(text, 1_500_000_000, b"=hi\0").unwrap();
        recording.fault(node, 2_000_000_000, 19, "gone").unwrap();
        recording.finish().unwrap();
        let mut opened = crate::recording::shared::open(&path).unwrap();
        let columns = super::super::columns(&opened, &path, |_| true).unwrap();
        let place = folder.path().join("run.parquet");
        let out = File::create_new(&place).unwrap();
        opened.seek(0);
        write(&mut opened, columns, u64::MAX, out, (&path, &place)).unwrap();
        let reader = SerializedFileReader::new(File::open(&place).unwrap()).unwrap();
        let about = reader.metadata().file_metadata();
        let names: Vec<&str> = (about.schema_descr().columns().iter())
            .map(|column| column.name())
            .collect();
        assert_eq!(
            names,
            ["time", "time_s", "a.x", "a.big", "a.y", "time_", "fault"]
        );
        let known = about.key_value_metadata().unwrap();
        let units = known.iter().find(|one| one.key == "units").unwrap();
        assert_eq!(
            units.value.as_deref(),
            Some(r#"{"a.big":"cm","a.x":"cm","a.y":"cm"}"#)
        );
        let rows: Vec<_> = reader
            .get_row_iter(None)
            .unwrap()
            .map(Result::unwrap)
            .collect();
        assert_eq!(rows.len(), 3);
        assert_eq!(rows[0].get_short(2).unwrap(), -7);
        assert_eq!(rows[0].get_ulong(3).unwrap(), u64::MAX);
        assert_eq!(rows[0].get_float(4).unwrap(), 1.5);
        assert_eq!(rows[1].get_double(1).unwrap(), 0.5);
        assert_eq!(rows[1].get_string(5).unwrap(), "=hi");
        assert_eq!(rows[2].get_string(6).unwrap(), "a: errno 19: gone");
    }

    /// The same recording as both tables, by the command itself.
    fn export(folder: &Path, name: &str) -> std::path::PathBuf {
        let place = folder.join(name);
        let args = super::super::ExportArgs {
            file: folder.join("run.mcap"),
            only: Vec::new(),
            from: None,
            to: None,
            output: Some(place.clone()),
            parquet: false,
            csv: false,
            force: false,
        };
        assert_eq!(super::super::run(&args), Ok(0));
        place
    }

    #[test]
    fn pyarrow_reads_the_values_that_are_in_the_csv() {
        let Some(python) = std::env::var_os("TRIK_ARROW_PYTHON") else {
            needs::Need::Extra.missing("TRIK_ARROW_PYTHON is not set");
            return;
        };
        let folder = tempfile::tempdir().unwrap();
        let file = BufWriter::new(File::create_new(folder.path().join("run.mcap")).unwrap());
        let mut recording = Writer::new(file, "test").unwrap();
        let mut node = Node::sensor("sensors/A1", "i16 x, u64 big, f32 y, f64 z, >u32 up");
        node.units = "cm".to_owned();
        let node = recording.add(&node).unwrap();
        let says = recording.add(&Node::sensor("says", "text 7")).unwrap();
        let blob = recording.add(&Node::sensor("blob", "u8 x 3")).unwrap();
        for at in 0..200_u32 {
            let unix_ns = 1_700_000_000_123_456_789 + u64::from(at) * 20_000_001;
            let third = f64::from(at) / 3.0;
            let mut tuple = (100 - at.cast_signed() as i16).to_le_bytes().to_vec();
            tuple.extend((u64::MAX - u64::from(at)).to_le_bytes());
            tuple.extend((third as f32).to_le_bytes());
            tuple.extend((-third * 1e-9).to_le_bytes());
            tuple.extend((u32::MAX - at).to_be_bytes());
            recording.sample(node, unix_ns, &tuple).unwrap();
            if at.is_multiple_of(50) {
                recording.sample(says, unix_ns + 1, b"=1,\"a\"\0").unwrap();
                recording.sample(blob, unix_ns + 2, &[0, 254, 7]).unwrap();
                (recording.fault(node, unix_ns + 3, 19, "device: gone, \"quite\"")).unwrap();
            }
        }
        recording.finish().unwrap();
        let script = concat!(env!("CARGO_MANIFEST_DIR"), "/tests/table.py");
        let output = std::process::Command::new(python)
            .arg(script)
            .arg(export(folder.path(), "run.parquet"))
            .arg(export(folder.path(), "run.csv"))
            .output()
            .unwrap();
        assert!(
            output.status.success(),
            "{}",
            String::from_utf8_lossy(&output.stderr)
        );
        let told = "time: timestamp[ns, tz=UTC]
time_s: double [] 212 of 212
sensors/A1.x: int16 [cm] 200 of 212
sensors/A1.big: uint64 [cm] 200 of 212
sensors/A1.y: float [cm] 200 of 212
sensors/A1.z: double [cm] 200 of 212
sensors/A1.up: uint32 [cm] 200 of 212
says: string [] 4 of 212
blob: binary [] 4 of 212
fault: string [] 4 of 212
";
        assert_eq!(String::from_utf8_lossy(&output.stdout), told);
    }
}
