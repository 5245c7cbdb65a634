#!/usr/bin/env python3
"""A blueprint for Rerun of a recording: what of it is drawn, and how it is called.

    python3 blueprint.py run.mcap              writes run.rbl beside it
    rerun mcap convert run.mcap -o run.rrd --application-id run
    rerun run.rrd run.rbl                      shows the recording with it
    python3 blueprint.py --list run.mcap       says what would be drawn, without Rerun
    python3 blueprint.py --only motors --only 'sensors/D*' run.mcap

Needs the packages `mcap` (1.6) and, to write one, `rerun-sdk` (0.41). Of each node its numbers are curves, with the unit in
the title; pictures are pictures, and lines of the log and of programs are text.
"""

import argparse
import fnmatch
import pathlib
import sys

from mcap.reader import make_reader

# More views than these cannot be told apart on a screen.
VIEWS_MAX = 24
# More numbers than these in a view neither: a lidar has 360.
NUMBERS_MAX = 8
NUMBERS = {"int8", "uint8", "int16", "uint16", "int32", "uint32", "int64", "uint64", "float32", "float64"}
PICTURE = "sensor_msgs/msg/CompressedImage"
LINES = "rcl_interfaces/msg/Log"
ORDER = {"picture": 0, "curves": 1, "text": 2}


def numbers_of(schema):
    """Names of the numbers of a node's type: its first section, after the header and the number of the sample."""
    section = schema.decode("utf-8", "replace").split("=====")[0]
    fields = [line.split("#")[0].split() for line in section.splitlines()]
    pairs = [words for words in fields if len(words) == 2]
    return [name for kind, name in pairs if kind in NUMBERS and name != "sequence"]


def is_wanted(topic, patterns):
    # A node with the name of something else, such as raw, has its topic below this.
    path = topic.lstrip("/").removeprefix("node/")
    groups = ["/".join(path.split("/")[: at + 1]) for at in range(path.count("/") + 1)]
    return not patterns or any(fnmatch.fnmatchcase(name, one) for one in patterns for name in groups)


def plan(file, patterns):
    """What is drawn: (kind, topic, title, name of the type, numbers), in the order of the topics."""
    with open(file, "rb") as opened:
        summary = make_reader(opened).get_summary()
    if summary is None:
        sys.exit(f"{file}: it has no end: trik mend {file} makes it whole")
    views = {}
    counts = summary.statistics.channel_message_counts if summary.statistics else None
    for channel in summary.channels.values():
        # A node that has said nothing would be an empty view.
        if counts is not None and not counts.get(channel.id):
            continue
        schema = summary.schemas.get(channel.schema_id)
        topic = channel.topic
        if schema is None or not is_wanted(topic, patterns):
            continue
        units = channel.metadata.get("units", "")
        title = topic.lstrip("/") + (f", {units}" if units else "")
        if schema.name == PICTURE:
            views[topic] = ("picture", topic, title, schema.name, [])
        elif schema.name == LINES:
            views[topic] = ("text", topic, title, schema.name, [])
        elif "format" in channel.metadata:
            numbers = numbers_of(schema.data)[:NUMBERS_MAX]
            if numbers:
                views[topic] = ("curves", topic, title, schema.name, numbers)
    # What moves first, then words.
    return sorted(views.values(), key=lambda view: (ORDER[view[0]], view[1]))


def within_limit(views):
    """As many as fit, curves last, because there are most of them; and those that do not."""
    urgent = sorted(views, key=lambda view: view[0] == "curves")
    kept = {view[1] for view in urgent[:VIEWS_MAX]}
    return [view for view in views if view[1] in kept], [view for view in views if view[1] not in kept]


def write(views, name, into):
    import rerun as rr
    import rerun.blueprint as rrb
    from rerun.blueprint.encodings import ComponentSourceKind, VisualizerComponentMapping

    def curve(schema, field):
        component = schema.replace("/", ".") + ":message"
        mapping = VisualizerComponentMapping(
            target="Scalars:scalars",
            source_kind=ComponentSourceKind.SourceComponent,
            source_component=component,
            selector=f".{field}",
        )
        return rr.SeriesLines(names=field).visualizer(mappings=[mapping])

    shown = []
    for kind, topic, title, schema, numbers in views:
        if kind == "picture":
            shown.append(rrb.Spatial2DView(name=title, origin=topic))
        elif kind == "text":
            shown.append(rrb.TextLogView(name=title, origin=topic))
        else:
            lines = [curve(schema, field) for field in numbers]
            shown.append(rrb.TimeSeriesView(name=title, origin=topic, overrides={topic: lines}))
    rrb.Blueprint(rrb.Grid(*shown)).save(name, str(into))


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("file", type=pathlib.Path, help="the recording")
    parser.add_argument("-o", "--output", type=pathlib.Path, help="the blueprint [default: FILE.rbl beside it]")
    parser.add_argument("--only", action="append", default=[], metavar="PATTERN", help="only these nodes and groups")
    parser.add_argument("--list", action="store_true", help="say what would be drawn")
    args = parser.parse_args()
    views = plan(args.file, args.only)
    if not views:
        sys.exit(f"{args.file}: there is nothing to draw")
    views, left = within_limit(views)
    if left:
        names = ", ".join(view[1] for view in left)
        print(f"left out, name them with --only: {names}", file=sys.stderr)
    if args.list:
        for kind, topic, title, _, numbers in views:
            print(f"{kind} {topic} [{title}]", *numbers)
        return
    # Rerun gives a blueprint to the recording of this name.
    write(views, args.file.stem, args.output or args.file.with_suffix(".rbl"))


if __name__ == "__main__":
    main()
