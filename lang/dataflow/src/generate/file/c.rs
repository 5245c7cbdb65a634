//! A converter in C.
//!
//! Owns where things stand in the file. What the helpers do is in `run.c`.

use super::super::plan::{Field, Plan, sensor_name, shape};
use super::super::step::{Body, Routine, Step};
use super::super::target::Target;
use super::{lines, makes, syntax, title};
use crate::limits;
use crate::machine::POLL_MS;
use lang_expr::reserved::Shape;
use std::fmt::Write;

/// What every converter has, around its own parts.
const RUN: &str = include_str!("run.c");
const FIELDS: &str = "/* fields */\n";
const PROGRAM: &str = "/* the program */\n";

/// How the node's numbers are taken from what the program has.
const SHOWN: &str =
    "static inline int shown(struct state *s, const char *name, struct value value, double *to)
{
    if (value.kind == LIST) {
        s->at = name;
        fail(s, \"this is no number\");
    }
    if (value.kind != LIST && !(fabs(value.number) <= DBL_MAX)) {
        s->at = name;
        fail(s, \"this is no finite number\");
    }
    *to = value.number;
    return value.kind != UNIT;
}

#define WRITE(name) is_there = shown(s, #name, v_##name, &all[at++]) && is_there;

/* Writes what the node shows; 0: one of it has no value yet. */
static int fields(struct state *s, uint8_t *out)
{
    double all[OUTPUTS + 1];
    int at = 0, is_there = 1;
";

pub(super) fn assemble(plan: &Plan<'_>, body: &Body) -> String {
    let (head, rest) = RUN.split_once(FIELDS).unwrap_or((RUN, ""));
    let (helpers, tail) = rest.split_once(PROGRAM).unwrap_or((rest, ""));
    let mut out = format!(
        "/* {}: a program of data flow as a converter. */\n",
        title(plan)
    );
    let _ = writeln!(out, "#define ITEMS {}", plan.longest);
    about(plan, &mut out);
    let _ = writeln!(out, "#define TIMERS {}", plan.timers.len());
    let _ = writeln!(
        out,
        "#define FIRINGS_MAX {}\n#define DELIVERIES_MAX {}\n#define QUEUED_MAX {}\n#define BYTES_MAX {}\n#define INSTANTS_MAX {}\n#define POLL_MS {POLL_MS}",
        limits::FIRINGS_MAX,
        limits::DELIVERIES_MAX,
        limits::QUEUED_CELLS_MAX,
        limits::C_BYTES_MAX,
        limits::CONVERTER_INSTANTS_MAX
    );
    let queues = plan.fields.iter().filter_map(|field| match field {
        Field::Queue(name) => Some(format!(" &s->v_{name},")),
        Field::Number(..) | Field::Value(_) => None,
    });
    let _ = writeln!(out, "#define QUEUES{}\n", queues.collect::<String>());
    out.push_str(head);
    state(plan, &mut out);
    out.push_str(helpers);
    inputs(plan, &mut out);
    outputs(plan, &mut out);
    restart(plan, &mut out);
    table(&body.reactions, "reaction", "struct value token", &mut out);
    table(&body.ticks, "tick", "double due", &mut out);
    function("begin", &body.start, &mut out);
    function("poll", &body.poll, &mut out);
    out.push_str(tail);
    out
}

/// What the node of the converter says, and the numbers that it may change.
fn about(plan: &Plan<'_>, out: &mut String) {
    out.push_str("/*\n * Inputs, and what the node says of them:");
    for &sensor in &plan.inputs {
        let name = sensor_name(sensor);
        let _ = write!(out, " {name}");
    }
    out.push_str(
        "; then u32 interval_us.\n * Their types are i32, or what -DTYPE_NAME=f32 says, and lists have -DCOUNT_NAME=3 items;\n * outputs are f64, in the order of FIELDS, or of '-DFIELDS(FIELD)=FIELD(NAME) FIELD(OTHER)'.\n */\n",
    );
    for &sensor in &plan.inputs {
        let name = sensor_name(sensor);
        let _ = writeln!(out, "#ifndef TYPE_{name}\n#define TYPE_{name} i32\n#endif");
        if let Some(Shape::Numbers(count)) = shape(sensor) {
            let _ = writeln!(
                out,
                "#ifndef COUNT_{name}\n#define COUNT_{name} {count}\n#endif\n#if COUNT_{name} > ITEMS\n#undef ITEMS\n#define ITEMS COUNT_{name}\n#endif"
            );
        }
    }
    let all = plan.outputs.iter().map(|&port| plan.told(port));
    let all: Vec<String> = match plan.outputs.is_empty() {
        true => plan
            .variables()
            .map(|(_, field)| field.to_owned())
            .collect(),
        false => all.collect(),
    };
    let all = all.iter().map(|field| format!(" FIELD({field})"));
    let _ = writeln!(
        out,
        "#ifndef FIELDS\n#define FIELDS(FIELD){}\n#endif",
        all.collect::<String>()
    );
}

fn state(plan: &Plan<'_>, out: &mut String) {
    out.push_str("struct state {\n    double now;\n    double us;\n    double set;\n    double queued;\n    size_t bytes;\n    int firings;\n    const char *fault;\n    const char *at;\n    char text[256];\n    struct queue tokens;\n    struct timer timers[TIMERS + 1];\n");
    for field in &plan.fields {
        let _ = match field {
            Field::Number(name, _) => writeln!(out, "    double v_{name};"),
            Field::Value(name) => writeln!(out, "    struct value v_{name};"),
            Field::Queue(name) => writeln!(out, "    struct queue v_{name};"),
        };
    }
    out.push_str("};\n");
}

fn inputs(plan: &Plan<'_>, out: &mut String) {
    out.push_str(
        "typedef int8_t i8;\ntypedef uint8_t u8;\ntypedef int16_t i16;\ntypedef uint16_t u16;\ntypedef int32_t i32;\ntypedef uint32_t u32;\ntypedef float f32;\ntypedef double f64;\n\n",
    );
    let mut sizes = String::from("sizeof(uint32_t)");
    out.push_str("static void readings(struct state *s, const uint8_t *in)\n{\n");
    for &sensor in &plan.inputs {
        let (name, field) = (sensor_name(sensor), plan.reading(sensor));
        let _ = match shape(sensor) {
            Some(Shape::Numbers(_)) => {
                let _ = write!(sizes, " + COUNT_{name} * sizeof(TYPE_{name})");
                writeln!(
                    out,
                    "    {{\n        TYPE_{name} items[COUNT_{name}];\n        int at;\n        memcpy(items, in, sizeof items);\n        in += sizeof items;\n        s->v_{field}.kind = LIST;\n        s->v_{field}.count = COUNT_{name};\n        for (at = 0; at < COUNT_{name}; at++) {{\n            s->v_{field}.items[at] = items[at];\n            s->v_{field}.kinds[at] = NUMBER;\n        }}\n    }}"
                )
            }
            Some(Shape::Number) | None => {
                let _ = write!(sizes, " + sizeof(TYPE_{name})");
                writeln!(
                    out,
                    "    {{\n        TYPE_{name} number;\n        memcpy(&number, in, sizeof number);\n        in += sizeof number;\n        s->v_{field} = numberValue(number);\n    }}"
                )
            }
        };
    }
    let _ = writeln!(out, "    (void)in;\n}}\n\n#define INPUT_SIZE ({sizes})");
}

fn outputs(plan: &Plan<'_>, out: &mut String) {
    out.push_str("#define ONE_MORE(name) + 1\nenum { OUTPUTS = 0 FIELDS(ONE_MORE) };\n#define OUTPUT_SIZE (sizeof(double) * OUTPUTS)\n\n");
    out.push_str(SHOWN);
    for &port in &plan.outputs {
        let field = plan.told(port);
        let _ = writeln!(
            out,
            "    const struct value v_{field} = numberValue(s->v_{field});"
        );
    }
    for (_, field) in plan.variables() {
        let _ = writeln!(out, "    const struct value v_{field} = s->v_{field};");
    }
    out.push_str("    FIELDS(WRITE)\n");
    for &port in &plan.outputs {
        let _ = writeln!(out, "    (void)v_{};", plan.told(port));
    }
    for (_, field) in plan.variables() {
        let _ = writeln!(out, "    (void)v_{field};");
    }
    out.push_str("    memcpy(out, all, OUTPUT_SIZE);\n    return is_there;\n}\n\n");
}

fn restart(plan: &Plan<'_>, out: &mut String) {
    out.push_str("static void restart(struct state *s)\n{\n");
    for field in &plan.fields {
        match field {
            Field::Number(name, start) if *start != 0.0 => {
                let _ = writeln!(out, "    s->v_{name} = {start:?};");
            }
            Field::Number(..) | Field::Value(_) | Field::Queue(_) => {}
        }
    }
    out.push_str("    (void)s;\n}\n");
}

fn table(all: &[Routine], word: &str, parameter: &str, out: &mut String) {
    let parameter_name = parameter.rsplit(' ').next().unwrap_or(parameter);
    for (at, routine) in all.iter().enumerate() {
        let about = &routine.about;
        let _ = writeln!(
            out,
            "\n/* {about} */\nstatic void {word}{at}(struct state *s, {parameter})\n{{"
        );
        let _ = writeln!(out, "    (void){parameter_name};\n    (void)s;");
        inner(&routine.steps, out);
        out.push_str("}\n");
    }
    let _ = writeln!(
        out,
        "\nstatic const struct {{\n    const char *about;\n    void (*run)(struct state *s, {parameter});\n}} {word}s[] = {{"
    );
    for (at, routine) in all.iter().enumerate() {
        let _ = writeln!(out, "    {{ \"{}\", {word}{at} }},", routine.about);
    }
    out.push_str("    { NULL, NULL }\n};\n");
}

fn function(name: &str, steps: &[Step], out: &mut String) {
    let _ = writeln!(
        out,
        "\nstatic void {name}(struct state *s)\n{{\n    (void)s;"
    );
    inner(steps, out);
    out.push_str("}\n");
}

fn inner(steps: &[Step], out: &mut String) {
    let mut body = String::new();
    if makes(steps) {
        body.push_str("    struct value made;\n");
    }
    lines(syntax(Target::C), steps, 1, &mut body);
    out.push_str(&body);
}
