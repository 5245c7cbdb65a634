//! How fast generated C and Rust compute a derivative, against C as a person writes it: `cargo bench -p lang-dcml --bench
//! generated`.
//!
//! All three are compiled with -O2 into one program, which calls them in turns through pointers; the best of many short rounds
//! counts. Needs gcc and rustc.

use lang_dcml::generate::{Options, Target, generate};
use lang_dcml::model::Model;
use lang_dcml::syntax::Kind;
use std::path::Path;
use std::process::Command;

/// What a person writes.
const BY_HAND: &str = "\
#include <math.h>
void hand_0(const double *x, const double *u, const double *p, double *dx);
void hand_1(const double *x, const double *u, const double *p, double *dx);
void hand_0(const double *x, const double *u, const double *p, double *dx)
{
    const double v = p[1] / 2 * (u[0] + u[1]);
    dx[0] = v * cos(x[2]);
    dx[1] = v * sin(x[2]);
    dx[2] = p[1] / p[0] * (u[1] - u[0]);
}
static void block(double phi, double left, double right, double radius, double half_axis, double k, double *dx)
{
    const double c = cos(phi), s = sin(phi);
    dx[0] = radius / 2 * ((c - k * s) * right + (c + k * s) * left);
    dx[1] = radius / 2 * ((s + k * c) * right + (s - k * c) * left);
    dx[2] = radius / (2 * half_axis) * (right - left);
}
void hand_1(const double *x, const double *u, const double *p, double *dx)
{
    const double k = p[2] / p[0];
    block(x[2], u[0], u[1], p[1], p[0], k, dx);
    block(x[5], u[2], u[3], p[1], p[0], k, dx + 3);
}
";
const MAIN: &str = "\
#define _POSIX_C_SOURCE 199309L
#include <stdio.h>
#include <time.h>
#include <math.h>
typedef void f(const double *, const double *, const double *, double *);
f hand_0, hand_1, c_0, c_1, rust_0, rust_1;
static double seconds(void)
{
    struct timespec now;
    clock_gettime(CLOCK_MONOTONIC, &now);
    return now.tv_sec + now.tv_nsec * 1e-9;
}
static double sum;
static double one(f *call, int states)
{
    double x[6] = {0.1, 0.2, 0.3, 0.4, 0.5, 0.6}, u[4] = {1, 2, 3, 4}, p[3] = {0.4, 0.1, 0.05}, dx[6];
    double start = seconds();
    for (int i = 0; i < 2000; i++) {
        call(x, u, p, dx);
        for (int j = 0; j < states; j++) x[j] += 1e-4 * dx[j];
    }
    double end = seconds();
    sum += x[0];
    return (end - start) / 2000 * 1e9;
}
int main(void)
{
    f *all[2][3] = {{hand_0, c_0, rust_0}, {hand_1, c_1, rust_1}};
    const char *models[2] = {\"DifferentialDrive\", \"Bart\"};
    for (int m = 0; m < 2; m++) {
        double best[3] = {1e9, 1e9, 1e9}, check[3];
        for (int round = 0; round < 5000; round++)
            for (int i = 0; i < 3; i++) {
                sum = 0;
                double time = one(all[m][i], m ? 6 : 3);
                check[i] = sum;
                if (time < best[i]) best[i] = time;
            }
        if (fabs(check[1] - check[0]) > 1e-9 || fabs(check[2] - check[0]) > 1e-9) return 1;
        printf(\"%-18s by hand %6.2f ns   C %6.2f ns, %.3fx   Rust %6.2f ns, %.3fx   goal >= 0.95x\\n\", models[m],
            best[0], best[1], best[0] / best[1], best[2], best[0] / best[2]);
    }
    return 0;
}
";

fn run(folder: &Path, words: &[&str]) {
    let status = Command::new(words[0])
        .args(&words[1..])
        .current_dir(folder)
        .status();
    assert!(
        status.is_ok_and(|status| status.success()),
        "failed: {words:?}"
    );
}

fn text(model: &Model, target: Target) -> String {
    generate(model, target, &Options::default()).expect("the model is small")
}

fn main() {
    let folder = std::env::temp_dir().join(format!("dcml-bench-{}", std::process::id()));
    std::fs::create_dir_all(&folder).expect("a place for the program");
    let write = |name: &str, text: &str| {
        std::fs::write(folder.join(name), text).expect("a place for the program");
    };
    let (mut c, mut rust) = (String::new(), String::new());
    for (at, name) in ["differential-drive", "bart"].into_iter().enumerate() {
        let mut shipped = lang_dcml::models::ALL.iter();
        let shipped = shipped
            .find(|one| one.name == name)
            .expect("the model is shipped");
        let model = lang_dcml::understand(shipped.text).models.remove(0);
        let (states, actions) = (model.states().count(), model.of_kind(Kind::Action).count());
        let params: Vec<_> = model.of_kind(Kind::Param).map(|one| &one.name).collect();
        let count = params.len();
        let name = &model.name;
        c.push_str(&text(&model, Target::C));
        c.push_str(&format!(
            "void c_{at}(const double *x, const double *u, const double *p, double *dx);\n\
             void c_{at}(const double *x, const double *u, const double *p, double *dx)\n\
             {{ {name}_derivative(x, u, (const {name}_params *)p, dx); }}\n"
        ));
        write(&format!("m{at}.rs"), &text(&model, Target::Rust));
        let fields: Vec<String> = params
            .iter()
            .enumerate()
            .map(|(place, name)| format!("{name}: p[{place}]"))
            .collect();
        rust.push_str(&format!(
            "mod m{at};\n#[no_mangle]\npub extern \"C\" fn rust_{at}(x: &[f64; {states}], u: &[f64; {actions}], p: &[f64; {count}], \
             dx: &mut [f64; {states}]) {{\n *dx = m{at}::derivative(x, u, &m{at}::Params {{ {} }});\n}}\n",
            fields.join(", ")
        ));
    }
    write("hand.c", BY_HAND);
    write("main.c", MAIN);
    write("generated.c", &c);
    write("generated.rs", &rust);
    let kind = ["--crate-type", "staticlib", "-C", "opt-level=2"];
    let mut words = vec!["rustc", "--edition", "2021", "-C", "panic=abort"];
    words.extend(kind);
    words.push("generated.rs");
    run(&folder, &words);
    let sources = ["main.c", "hand.c", "generated.c", "libgenerated.a"];
    let mut words = vec!["gcc", "-std=c99", "-O2", "-o", "program"];
    words.extend(sources);
    words.extend(["-lm", "-lpthread", "-ldl"]);
    run(&folder, &words);
    run(&folder, &["./program"]);
    let _ = std::fs::remove_dir_all(&folder);
}
