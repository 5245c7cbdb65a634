//! Converters with one mistake each, and that the trial sees it.

use super::*;
use crate::vectors;
use std::cell::Cell;
use std::rc::Rc;

fn trial(check: &dyn Fn(&[u8]) -> Result<(), Fault>) -> Trial<'_> {
    Trial {
        input_size: 4,
        output_size: 4,
        tuples: 2000,
        seed: 7,
        recorded: &[],
        check,
    }
}

fn anything(_: &[u8]) -> Result<(), Fault> {
    Ok(())
}

/// A converter of its own for each opening, made by `make`.
fn opens(mut make: impl FnMut() -> Opened) -> impl FnMut() -> Result<Opened, Fault> {
    move || Ok(make())
}

#[test]
fn a_good_converter_passes_and_its_faults_are_counted() {
    let mut open = opens(|| {
        Box::new(|input, output| {
            output.copy_from_slice(input);
            match input[0] {
                0xff => Err("no answer".into()),
                0 => Ok(Conversion::Consumed),
                _ => Ok(Conversion::Produced),
            }
        })
    });
    let report = check_properties(&trial(&anything), &mut open).unwrap();
    let refused = report.faults["no answer"];
    assert!(refused > 10 && report.consumed > 10, "{report:?}");
    assert_eq!(report.produced + report.consumed + refused, 2000);
}

#[test]
fn a_number_that_is_not_finite_is_seen() {
    let mut open = opens(|| {
        Box::new(|input, output| {
            output.copy_from_slice(input);
            Ok(Conversion::Produced)
        })
    });
    let refusal = check_properties(&trial(&finite_f32), &mut open)
        .unwrap_err()
        .to_string();
    assert!(refusal.starts_with("seed 7, tuple "), "{refusal}");
    assert!(refusal.contains("number 0 is "), "{refusal}");
}

#[test]
fn a_state_that_openings_share_is_seen() {
    let sum = Rc::new(Cell::new(0u32));
    let mut open = opens(|| {
        let sum = sum.clone();
        Box::new(move |input, output| {
            sum.set(sum.get().wrapping_add(u32::from(input[0])));
            output.copy_from_slice(&sum.get().to_le_bytes());
            Ok(Conversion::Produced)
        })
    });
    let refusal = check_properties(&trial(&anything), &mut open)
        .unwrap_err()
        .to_string();
    assert!(
        refusal.contains("opened again it gives something else"),
        "{refusal}"
    );
}

#[test]
fn a_state_of_ones_own_is_none() {
    let mut open = opens(|| {
        let mut sum = 0u32;
        Box::new(move |input, output| {
            sum = sum.wrapping_add(u32::from(input[0]));
            output.copy_from_slice(&sum.to_le_bytes());
            Ok(Conversion::Produced)
        })
    });
    check_properties(&trial(&anything), &mut open).unwrap();
}

#[test]
fn a_converter_that_refuses_everything_has_not_been_tried() {
    let mut open = opens(|| Box::new(|_, _| Err("bad checksum".into())));
    assert_eq!(
        check_properties(&trial(&anything), &mut open)
            .unwrap_err()
            .to_string(),
        "seed 7: all 2000 tuples were refused, so nothing was tried: bad checksum"
    );
    let mut open = opens(|| {
        Box::new(|input, output| {
            output.copy_from_slice(input);
            let good = input[0] ^ input[1] ^ input[2] == input[3] && input[0] == 0x55;
            good.then_some(Conversion::Produced)
                .ok_or_else(|| "bad checksum".into())
        })
    });
    let recorded = [0x55, 1, 2, 0x56, 0x55, 8, 8, 0x55];
    let with_recorded = Trial {
        recorded: &recorded,
        ..trial(&anything)
    };
    let report = check_properties(&with_recorded, &mut open).unwrap();
    assert!(
        report.produced > 100 && report.faults["bad checksum"] > 100,
        "{report:?}"
    );
}

#[test]
fn reasons_without_end_are_counted_together() {
    let mut report = Report::default();
    for number in 0..100 {
        report.count(format!("reason {number:02}"));
    }
    assert_eq!(report.faults.len(), TRIAL_REASONS_MAX + 1);
    assert_eq!(report.faults["(others)"], 100 - TRIAL_REASONS_MAX);
}

#[test]
fn a_vector_that_is_not_met_is_named_with_what_came_instead() {
    let run = |text: &str| {
        let vectors = vectors::parse(text).unwrap();
        let mut open = opens(|| {
            Box::new(|input, output| {
                output[0] = input[0] + 1;
                match input[0] {
                    1 => Ok(Conversion::Consumed),
                    2 => Err("two".into()),
                    _ => Ok(Conversion::Produced),
                }
            })
        });
        check_vectors(&vectors, &mut open)
    };
    assert_eq!(run("size 1 1\n03 > 04\n01 > consumed\n02 > fault\n"), Ok(3));
    let refused = |text| run(text).unwrap_err().to_string();
    assert_eq!(refused("size 1 1\n03 > 05"), "line 2: 03 gives 04, not 05");
    assert_eq!(
        refused("size 1 1\n01 > 02"),
        "line 2: 01 gives consumed, not 02"
    );
    assert_eq!(
        refused("size 1 1\n02 > 03"),
        "line 2: 02 gives fault (two), not 03"
    );
    assert_eq!(
        refused("size 1 1\n03 > fault"),
        "line 2: 03 gives 04, not fault"
    );
}
