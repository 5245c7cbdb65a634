//! The golden vectors of the shipped filters, through mounted pipes: the library and the Lua versions alike.

use crate::mount_on;
use converter::vectors::{self, Expected, Vectors};
use harness::{Board, Mount};
use std::fmt::Write as _;
use std::fs::File;
use std::io::{Read, Write};
use trikfs_filters::LIBRARY_ONLY;

/// Name of a file of vectors without its ending, and what it holds.
fn golden() -> Vec<(String, Vectors)> {
    let dir = concat!(env!("CARGO_MANIFEST_DIR"), "/golden/filters");
    let mut all: Vec<_> = std::fs::read_dir(dir)
        .unwrap()
        .map(|entry| {
            let path = entry.unwrap().path();
            let text = std::fs::read_to_string(&path).unwrap();
            let parsed = vectors::parse(&text)
                .unwrap_or_else(|reason| panic!("{}: {reason}", path.display()));
            (
                path.file_stem().unwrap().to_str().unwrap().to_owned(),
                parsed,
            )
        })
        .collect();
    all.sort_by(|a, b| a.0.cmp(&b.0));
    assert!(all.len() > 20, "the vectors are missing");
    all
}

/// A node for each file of vectors, with a pipe of its own.
fn check(takes_part: impl Fn(&str) -> bool, converter: impl Fn(&str, &str) -> String) {
    let board = Board::new();
    let mut golden = golden();
    golden.retain(|(name, _)| takes_part(name.split('.').next().unwrap_or(name)));
    let mut config = "trikfs = {}\n".to_owned();
    for (number, (name, vectors)) in golden.iter().enumerate() {
        board.fifo(&format!("in{number}"));
        let filter = name.split('.').next().unwrap_or(name);
        let params: Vec<String> = vectors
            .params
            .iter()
            .map(|(name, value)| format!("{name} = {value:?}"))
            .collect();
        let params = params.join(", ");
        let _ = writeln!(
            config,
            "trikfs.n{number} = {{ src = '$DIR/in{number}', input_tuple_size = {}, output_tuple_size = {}, params = {{ {params} }}, converter = {} }}",
            vectors.input_size,
            vectors.output_size,
            converter(filter, &params)
        );
    }
    let Some(m) = mount_on(board, &config) else {
        return;
    };
    for (number, (name, vectors)) in golden.iter().enumerate() {
        run(&m, number, name, vectors);
    }
}

fn run(m: &Mount, number: usize, name: &str, vectors: &Vectors) {
    let mut file: File = m.open(&format!("n{number}/device"));
    let mut pipe = m.board().feed(&format!("in{number}"));
    for step in &vectors.steps {
        pipe.write_all(&step.input).unwrap();
        let mut got = vec![0; vectors.output_size];
        let place = format!("{name}.txt:{}", step.line);
        match &step.expected {
            Expected::Consumed => {}
            Expected::Output(bytes) => {
                file.read_exact(&mut got).unwrap_or_else(|error| {
                    panic!("{place}: {error}: {}", m.text(&format!("n{number}/fault")))
                });
                assert_eq!(&got, bytes, "{place}");
            }
            Expected::Fault => {
                let error = file.read(&mut got).expect_err(&place);
                assert_eq!(error.raw_os_error(), Some(libc::EIO), "{place}");
                assert!(
                    m.text(&format!("n{number}/fault"))
                        .starts_with("converter: "),
                    "{place}"
                );
            }
        }
    }
}

#[test]
fn the_library_agrees_with_the_golden_vectors() {
    let all = |_: &str| true;
    check(all, |filter, _| format!("'libtrikfs_filters.so#{filter}'"));
}

#[test]
fn the_lua_filters_agree_with_the_golden_vectors() {
    let has_lua = |filter: &str| !LIBRARY_ONLY.contains(&filter);
    check(has_lua, |filter, params| {
        format!("filter.{filter}{{ {params} }}")
    });
}
