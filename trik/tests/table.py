"""Reads a table of `trik export` in Parquet by pyarrow, compares each value with the table in CSV, and tells what its columns are.

The first argument is the table in Parquet, the second the one in CSV.
"""

import csv
import json
import struct
import sys

import pyarrow.parquet


def same(kind, value, cell):
    """Whether a value is what the cell says; an empty cell is none, or an empty text."""
    if value is None:
        return cell == ""
    if kind == "float":
        return struct.pack("f", value) == struct.pack("f", float(cell))
    if kind == "double":
        return value == float(cell)
    if kind == "binary":
        return value.hex() == cell
    if kind == "string":
        return cell in (value, "'" + value)
    return value == int(cell)


table = pyarrow.parquet.read_table(sys.argv[1])
units = json.loads(table.schema.metadata[b"units"])
begin_ns = int(table.schema.metadata[b"begin_ns"])
with open(sys.argv[2], newline="") as file:
    titles, *rows = csv.reader(file)
assert table.num_rows == len(rows), (table.num_rows, len(rows))
# The moment in UTC is no column of the CSV.
assert table.column_names == ["time", *titles], (table.column_names, titles)
moments = table["time"].cast("int64").to_pylist()
for moment, time_s in zip(moments, table["time_s"].to_pylist()):
    assert abs(moment - begin_ns - time_s * 1e9) < 1000, (moment, time_s)
print(f"time: {table.schema.field('time').type}")
for at, title in enumerate(titles):
    kind = str(table.schema.field(title).type)
    values = table[title].to_pylist()
    for row, (value, cells) in enumerate(zip(values, rows)):
        assert same(kind, value, cells[at]), (title, row, value, cells[at])
    count = sum(value is not None for value in values)
    unit = units.pop(title, "")
    print(f"{title}: {kind} [{unit}] {count} of {len(rows)}")
assert not units, units
