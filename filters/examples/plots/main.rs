//! Draws what each filter does: `cargo run -p filters --example plots` writes docs/converters/plots/*.svg.
//!
//! Simulated sensors with noise from a fixed seed, the filters as the shared library has them, and a few lines of SVG.
//! Only operations whose results are the same on every processor are used, so the same bytes come out everywhere, and a
//! test compares them with the files. Owns which files there are; knows no equation.

mod noise;
mod robots;
mod run;
mod signals;
mod svg;

use std::io;
use std::path::{Path, PathBuf};
use svg::Plot;

/// Where the pictures are kept.
fn folder() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../docs/converters/plots")
}

/// All pictures, by the name of the filter.
fn plots() -> Vec<(&'static str, Plot)> {
    let mut plots = signals::plots();
    plots.extend(robots::plots());
    plots
}

fn main() -> io::Result<()> {
    let folder = folder();
    std::fs::create_dir_all(&folder)?;
    for (name, plot) in plots() {
        let path = folder.join(format!("{name}.svg"));
        std::fs::write(&path, plot.svg())?;
        let errors = plot.errors().map(|(raw, filtered)| filtered / raw);
        let better = errors.map(|ratio| format!(", mean square error {ratio:.3} of the raw one"));
        println!("{}{}", path.display(), better.unwrap_or_default());
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;
    use converter::abi::descriptors;
    use std::collections::BTreeSet;

    #[test]
    fn the_pictures_in_the_documents_are_what_this_program_draws() {
        for (name, plot) in plots() {
            let path = folder().join(format!("{name}.svg"));
            let kept = std::fs::read_to_string(&path).unwrap_or_default();
            assert!(
                kept == plot.svg(),
                "{}: differs; run cargo run -p filters --example plots",
                path.display()
            );
        }
    }

    #[test]
    fn every_filter_has_a_picture_and_every_picture_a_filter() {
        let drawn: BTreeSet<String> = plots().iter().map(|(name, _)| (*name).to_owned()).collect();
        let library = descriptors(trikfs_filters::trikfs_library_entry()).unwrap();
        let names = library
            .iter()
            .map(|d| d.name().trim_end_matches("_f32").to_owned());
        // Identity changes nothing that could be seen.
        let named: BTreeSet<String> = names.filter(|name| name != "identity").collect();
        assert_eq!(drawn, named);
        let entries = std::fs::read_dir(folder()).unwrap();
        let files: BTreeSet<String> = entries
            .map(|entry| {
                entry
                    .unwrap()
                    .path()
                    .file_stem()
                    .unwrap()
                    .to_str()
                    .unwrap()
                    .to_owned()
            })
            .collect();
        assert_eq!(files, drawn);
        let page = std::fs::read_to_string(folder().join("../filters.md")).unwrap();
        let command = "\n```sh\ncargo run -p filters --example plots\n```\n";
        assert!(
            page.contains(command),
            "filters.md does not say how they are made"
        );
        for name in &drawn {
            assert!(
                page.contains(&format!("](plots/{name}.svg)")),
                "{name} is not in filters.md"
            );
        }
    }

    #[test]
    fn a_filter_is_nearer_to_the_truth_than_what_went_in() {
        let mut compared = 0;
        for (name, plot) in plots() {
            if let Some((raw, filtered)) = plot.errors() {
                assert!(filtered < raw, "{name}: {filtered} is not below {raw}");
                compared += 1;
            }
        }
        assert!(compared >= 9, "only {compared} plots have a truth");
    }
}
