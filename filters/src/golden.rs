//! Runs every file of `tests/golden/filters` through the Rust trait and through the C ABI of this library, and any bytes
//! through every filter.

use crate::{Fused, LIBRARY_ONLY, Lanes, trikfs_library_entry};
use converter::abi::descriptors;
use converter::vectors::{self, Expected, Vectors};
use converter::{Conversion, Converter, Direction, Fault, OpenInfo};
use proptest::prelude::*;
use std::collections::BTreeSet;
use std::fs;
use std::path::Path;
use std::sync::OnceLock;

/// One conversion, however it is made.
type Convert = Box<dyn FnMut(&[u8], &mut [u8]) -> Result<Conversion, Fault>>;

/// Opens the named filter one way or another.
type Open = fn(&str, &OpenInfo<'_>) -> Result<Convert, Fault>;

/// All files: filter, file name, vectors.
fn files() -> Vec<(String, String, Vectors)> {
    let directory = Path::new(env!("CARGO_MANIFEST_DIR")).join("../tests/golden/filters");
    let mut files = Vec::new();
    for entry in fs::read_dir(directory).unwrap() {
        let path = entry.unwrap().path();
        let file = path.file_name().unwrap().to_str().unwrap().to_owned();
        let filter = file.split('.').next().unwrap().to_owned();
        let text = fs::read_to_string(&path).unwrap();
        files.push((
            filter,
            file.clone(),
            vectors::parse(&text).unwrap_or_else(|reason| panic!("{file}: {reason}")),
        ));
    }
    files
}

/// Checks all files.
fn check(open: Open) {
    for (filter, file, vectors) in files() {
        let info = OpenInfo {
            direction: Direction::Read,
            input_size: vectors.input_size,
            output_size: vectors.output_size,
            node: "golden",
            params: &vectors.params,
            log: &|_| (),
        };
        let mut convert = open(&filter, &info).unwrap_or_else(|fault| panic!("{file}: {fault}"));
        let mut output = vec![0; vectors.output_size];
        for step in &vectors.steps {
            output.fill(0);
            let result = match convert(&step.input, &mut output) {
                Ok(Conversion::Produced) => Expected::Output(output.clone()),
                Ok(Conversion::Consumed) => Expected::Consumed,
                Err(_) => Expected::Fault,
            };
            assert_eq!(result, step.expected, "{file}:{}", step.line);
        }
    }
}

fn open_as<T: Converter + 'static>(info: &OpenInfo<'_>) -> Result<Convert, Fault> {
    let mut converter = T::open(info)?;
    Ok(Box::new(move |input, output| {
        converter.convert(input, output)
    }))
}

fn open_in_rust(filter: &str, info: &OpenInfo<'_>) -> Result<Convert, Fault> {
    use crate::{complementary::Complementary, heading::Heading, odometry::Odometry, pid::Pid};
    use crate::{dead_band::DeadBand, identity::Identity, inverse::Inverse, low_pass::LowPass};
    use crate::{debounce::Debounce, hysteresis::Hysteresis, kalman::Kalman};
    use crate::{kalman_linear::KalmanLinear, speed_hold::SpeedHold};
    use crate::{madgwick::Madgwick, mahony::Mahony};
    use crate::{median3::Median3, moving_average::MovingAverage, rate::Rate, scale::Scale};
    match filter {
        "identity" => open_as::<Identity>(info),
        "median3" => open_as::<Lanes<Median3<i32>>>(info),
        "median3_f32" => open_as::<Lanes<Median3<f32>>>(info),
        "moving_average" => open_as::<Lanes<MovingAverage<i32>>>(info),
        "moving_average_f32" => open_as::<Lanes<MovingAverage<f32>>>(info),
        "low_pass" => open_as::<Lanes<LowPass<i32>>>(info),
        "low_pass_f32" => open_as::<Lanes<LowPass<f32>>>(info),
        "scale" => open_as::<Lanes<Scale<i32>>>(info),
        "scale_f32" => open_as::<Lanes<Scale<f32>>>(info),
        "inverse" => open_as::<Lanes<Inverse<i32>>>(info),
        "inverse_f32" => open_as::<Lanes<Inverse<f32>>>(info),
        "dead_band" => open_as::<Lanes<DeadBand<i32>>>(info),
        "dead_band_f32" => open_as::<Lanes<DeadBand<f32>>>(info),
        "rate" => open_as::<Lanes<Rate<i32>>>(info),
        "rate_f32" => open_as::<Lanes<Rate<f32>>>(info),
        "debounce" => open_as::<Lanes<Debounce<i32>>>(info),
        "debounce_f32" => open_as::<Lanes<Debounce<f32>>>(info),
        "hysteresis" => open_as::<Lanes<Hysteresis<i32>>>(info),
        "hysteresis_f32" => open_as::<Lanes<Hysteresis<f32>>>(info),
        "kalman" => open_as::<Lanes<Kalman<i32>>>(info),
        "kalman_f32" => open_as::<Lanes<Kalman<f32>>>(info),
        "kalman_linear" => open_as::<Fused<KalmanLinear<i32>>>(info),
        "kalman_linear_f32" => open_as::<Fused<KalmanLinear<f32>>>(info),
        "complementary" => open_as::<Fused<Complementary<i32>>>(info),
        "complementary_f32" => open_as::<Fused<Complementary<f32>>>(info),
        "pid" => open_as::<Fused<Pid<i32>>>(info),
        "pid_f32" => open_as::<Fused<Pid<f32>>>(info),
        "speed_hold" => open_as::<Fused<SpeedHold>>(info),
        "odometry" => open_as::<Fused<Odometry>>(info),
        "heading" => open_as::<Fused<Heading>>(info),
        "madgwick" => open_as::<Fused<Madgwick>>(info),
        "mahony" => open_as::<Fused<Mahony>>(info),
        other => panic!("no filter {other}"),
    }
}

fn open_in_c(filter: &str, info: &OpenInfo<'_>) -> Result<Convert, Fault> {
    let descriptors = descriptors(trikfs_library_entry()).unwrap();
    let descriptor = descriptors.iter().find(|d| d.name() == filter).unwrap();
    let mut instance = descriptor.open(info)?;
    Ok(Box::new(move |input, output| {
        instance.convert(input, output)
    }))
}

#[test]
fn every_vector_holds_through_the_trait() {
    check(open_in_rust);
}

#[test]
fn every_vector_holds_through_the_c_abi() {
    check(open_in_c);
}

#[test]
fn every_filter_has_vectors_and_a_description() {
    let tested: BTreeSet<String> = files().into_iter().map(|(filter, _, _)| filter).collect();
    let descriptors = descriptors(trikfs_library_entry()).unwrap();
    let exported: BTreeSet<String> = descriptors.iter().map(|d| d.name().to_owned()).collect();
    assert_eq!(tested, exported);
    assert!(descriptors.iter().all(|d| !d.description().is_empty()));
    assert!(LIBRARY_ONLY.iter().all(|name| exported.contains(*name)));
}

#[test]
fn a_refused_parameter_names_the_filter_through_the_c_abi() {
    let params = [("alpha".to_owned(), f64::NAN)].into();
    let (direction, node) = (Direction::Read, "golden");
    let info = OpenInfo {
        direction,
        input_size: 4,
        output_size: 4,
        node,
        params: &params,
        log: &|_| (),
    };
    let refused = open_in_c("low_pass", &info).err().unwrap();
    assert_eq!(
        refused.text(),
        "low_pass: alpha must be from 0.000030517578125 to 1, not NaN"
    );
}

/// Opens a filter for so many values in and out, or not if it does not take them.
fn open_any(filter: &str, inputs: usize, outputs: usize) -> Option<Convert> {
    let params = [
        ("window", 3.0),
        ("period_ms", 7.0),
        ("wheel_diameter_mm", 56.0),
        ("track_mm", 150.0),
        ("bias_ms", 10.0),
        ("still_mdps", 1e9),
        ("stall_ms", 20.0),
    ];
    let params = params.map(|(name, value)| (name.to_owned(), value)).into();
    let info = OpenInfo {
        direction: Direction::Read,
        input_size: 4 * inputs,
        output_size: 4 * outputs,
        node: "any",
        params: &params,
        log: &|_| (),
    };
    open_in_c(filter, &info).ok()
}

/// True for a filter that works on each value on its own, as far as sizes tell.
fn has_lanes(filter: &str) -> bool {
    (1..=11).all(|values| open_any(filter, values, values).is_some())
}

/// All sizes, in values, that the filters take which are not on single values.
fn fusing_sizes() -> &'static [(String, usize, usize)] {
    static SIZES: OnceLock<Vec<(String, usize, usize)>> = OnceLock::new();
    SIZES.get_or_init(|| {
        let mut sizes = Vec::new();
        for descriptor in descriptors(trikfs_library_entry()).unwrap() {
            let name = descriptor.name();
            let any = (1..=11).flat_map(|inputs| (1..=8).map(move |outputs| (inputs, outputs)));
            for (inputs, outputs) in any.filter(|_| !has_lanes(name)) {
                if open_any(name, inputs, outputs).is_some() {
                    sizes.push((name.to_owned(), inputs, outputs));
                }
            }
        }
        sizes
    })
}

/// What each tuple becomes; a fault is kept as its text.
fn run_all(
    mut convert: Convert,
    outputs: usize,
    tuples: &[Vec<u8>],
) -> Vec<Result<(Conversion, Vec<u8>), String>> {
    let mut output = vec![0; 4 * outputs];
    let mut one = |tuple: &Vec<u8>| {
        output.fill(0);
        match convert(tuple, &mut output) {
            Ok(conversion) => Ok((conversion, output.clone())),
            Err(fault) => Err(fault.to_string()),
        }
    };
    tuples.iter().map(&mut one).collect()
}

/// What each tuple of `values` values becomes.
fn run(
    filter: &str,
    values: usize,
    tuples: &[Vec<u8>],
) -> Vec<Result<(Conversion, Vec<u8>), String>> {
    run_all(open_any(filter, values, values).unwrap(), values, tuples)
}

/// True if this result stands where the filter gives floats and one of them is no finite number.
fn is_no_number(filter: &str, bytes: &[u8]) -> bool {
    let gives_floats =
        filter.ends_with("_f32") || ["madgwick", "mahony", "odometry"].contains(&filter);
    let (values, _) = bytes.as_chunks::<4>();
    gives_floats
        && values
            .iter()
            .any(|value| !f32::from_le_bytes(*value).is_finite())
}

#[test]
fn filters_on_values_and_filters_that_fuse_are_told_apart_by_their_sizes() {
    let fusing: BTreeSet<&str> = fusing_sizes()
        .iter()
        .map(|(name, ..)| name.as_str())
        .collect();
    let names = descriptors(trikfs_library_entry()).unwrap();
    assert!(
        names
            .iter()
            .all(|d| has_lanes(d.name()) != fusing.contains(d.name()))
    );
    let lanes = names.iter().filter(|d| has_lanes(d.name())).count();
    assert_eq!((lanes, names.len() - lanes), (21, 11));
}

/// A value that is often an extreme and sometimes no number.
fn value() -> impl Strategy<Value = [u8; 4]> {
    prop_oneof![
        any::<[u8; 4]>(),
        any::<f32>().prop_map(f32::to_le_bytes),
        prop_oneof![Just(i32::MIN), Just(i32::MAX), Just(0), -100..100].prop_map(i32::to_le_bytes),
    ]
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(200))]

    #[test]
    fn no_bytes_make_a_filter_panic_and_values_do_not_touch(
        tuples in prop::collection::vec((value(), value()), 1..40)
    ) {
        let both: Vec<Vec<u8>> = tuples.iter().map(|(a, b)| [*a, *b].concat()).collect();
        let first: Vec<Vec<u8>> = tuples.iter().map(|(a, _)| a.to_vec()).collect();
        for descriptor in descriptors(trikfs_library_entry()).unwrap() {
            let name = descriptor.name();
            if fusing_sizes().iter().any(|(fusing, ..)| fusing == name) {
                continue;
            }
            let together = run(name, 2, &both);
            let alone = run(name, 1, &first);
            for result in together.iter().chain(&alone) {
                let panicked = matches!(result, Err(text) if text.contains("panicked"));
                prop_assert!(!panicked, "{name}: {result:?}");
            }
            // A fault of either value makes both start over, so only runs without one can be compared.
            if together.iter().all(Result::is_ok) {
                for (pair, single) in together.iter().flatten().zip(alone.iter().flatten()) {
                    prop_assert_eq!((pair.0, &pair.1[..4]), (single.0, &single.1[..]), "{}", name);
                }
            }
        }
    }

    #[test]
    fn no_bytes_make_a_fusing_filter_panic_or_give_no_number(
        values in prop::collection::vec(value(), 11..150)
    ) {
        for (name, inputs, outputs) in fusing_sizes() {
            let convert = open_any(name, *inputs, *outputs).unwrap();
            let tuples: Vec<Vec<u8>> = values.chunks_exact(*inputs).map(|tuple| tuple.concat()).collect();
            for result in run_all(convert, *outputs, &tuples) {
                match result {
                    Ok((_, bytes)) => prop_assert!(!is_no_number(name, &bytes), "{}: {:?}", name, bytes),
                    Err(text) => {
                        prop_assert!(!text.contains("panicked"), "{}: {}", name, text);
                        prop_assert!(text.starts_with(name.trim_end_matches("_f32")), "{}: {}", name, text);
                    }
                }
            }
        }
    }

    #[test]
    fn calming_filters_stay_within_the_values_that_they_saw(values in prop::collection::vec(any::<i32>(), 1..60)) {
        let (least, greatest) = (values.iter().min().unwrap(), values.iter().max().unwrap());
        let tuples: Vec<Vec<u8>> = values.iter().map(|value| value.to_le_bytes().to_vec()).collect();
        for name in ["median3", "moving_average", "low_pass", "kalman", "debounce"] {
            for (_, output) in run(name, 1, &tuples).into_iter().flatten() {
                let output = i32::from_le_bytes(output.try_into().unwrap());
                prop_assert!((least..=greatest).contains(&&output), "{}: {}", name, output);
            }
        }
    }
}
