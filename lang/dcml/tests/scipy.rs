//! Solutions beside those of SciPy, which is asked now: by python3, and skipped without scipy; or by what TRIK_NUMPY_PYTHON names,
//! which must have it.

use lang_dcml::robot::Robot;
use lang_dcml::solve::run::Course;
use lang_dcml::solve::{Options, Solver};
use lang_dcml::{models, understand};
use std::process::Command;

const SCRIPT: &str = "
import sys
from math import cos, sin, tan
try:
    from scipy.integrate import solve_ivp
except ImportError:
    print('missing')
    sys.exit()
def rate(t, x, u):
    return [u[0] * cos(x[2]), u[0] * sin(x[2]), u[0] / 2 * tan(u[1]), u[0] / 3 * sin(x[2] - x[3])]
for line in sys.argv[1:]:
    n = [float(one) for one in line.split(',')]
    found = solve_ivp(rate, (0, 10), n[2:], method='DOP853', args=(n[:2],), rtol=1e-12, atol=1e-13)
    print(*[repr(float(one)) for one in found.y[:, -1]], sep=',')
";

/// Actions and starts: two and four numbers.
const CASES: [[f64; 6]; 4] = [
    [1.0, 0.3, 0.0, 0.0, 0.0, 0.0],
    [-0.5, 0.6, 1.0, -2.0, 0.5, 0.4],
    [2.0, -0.2, 0.0, 5.0, 3.0, 1.0],
    [0.7, 0.0, -1.0, 1.0, -2.0, -1.0],
];

#[test]
fn a_car_with_a_trailer_ends_where_scipy_says() {
    let named = std::env::var_os("TRIK_NUMPY_PYTHON");
    let python = named.clone().unwrap_or_else(|| "python3".into());
    let line = |case: &[f64; 6]| case.map(|one| one.to_string()).join(",");
    let mut command = Command::new(python);
    let output = command
        .arg("-c")
        .arg(SCRIPT)
        .args(CASES.iter().map(line))
        .output();
    let text = output.map_or_else(
        |_| "missing".to_owned(),
        |output| {
            let errors = String::from_utf8_lossy(&output.stderr);
            assert!(output.status.success(), "{errors}");
            String::from_utf8_lossy(&output.stdout).into_owned()
        },
    );
    if text.trim() == "missing" {
        assert!(named.is_none(), "TRIK_NUMPY_PYTHON has no scipy");
        needs::Need::Tools.missing("no python3 with scipy");
        return;
    }
    let shipped = models::named("trailer").expect("a model");
    let model = &understand(shipped.text).models[0];
    let mut robot = Robot::new(model, &[2.0, 3.0]).expect("a robot");
    assert_eq!(text.lines().count(), CASES.len());
    for (case, line) in CASES.iter().zip(text.lines()) {
        let mut solver = Solver::new(Options::adaptive(1e-11, 1e-12), 4, 2).expect("a solver");
        solver.start(0.0, &case[2..]);
        let mut given = |_: f64, to: &mut [f64]| to.copy_from_slice(&case[..2]);
        let mut course = Course {
            to: 10.0,
            jumps: &[],
            events: &mut [],
        };
        solver
            .run(&mut robot, &mut given, &mut course, |_| ())
            .expect("a solution");
        let expected = line
            .split(',')
            .map(|one| one.parse::<f64>().expect("a number"));
        for (found, expected) in solver.state().iter().zip(expected) {
            let error = (found - expected).abs();
            assert!(error < 1e-8, "{case:?}: {:?}, not {line}", solver.state());
        }
    }
}
