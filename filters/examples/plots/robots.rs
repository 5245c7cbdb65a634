//! Pictures of the filters that fuse several values: sensors of a small robot, simulated.

use crate::noise::Noise;
use crate::run::Filter;
use crate::svg::{Plot, Role};
use trikfs_filters::trig::{atan2, sin_cos, wrapped};

/// Points of one line.
type Points = Vec<(f64, f64)>;

/// Degrees of a robot on a seesaw, and its rate in degrees per second.
fn seesaw(t: f64) -> (f64, f64) {
    let (sin, cos) = sin_cos(t * 1.6);
    (25.0 * sin, 25.0 * 1.6 * cos)
}

/// What an accelerometer feels along y and z in counts: the direction of up, noise, and jolts of the motors.
fn accelerations(degrees: f64, noise: &mut Noise) -> (f64, f64) {
    let (sin, cos) = sin_cos(degrees.to_radians());
    let jolt = noise.normal(0.15);
    let y = 4096.0 * (sin + jolt) + noise.normal(100.0);
    (y, 4096.0 * cos + noise.normal(100.0))
}

/// Degrees per second by which the simulated gyroscope is wrong.
const BIAS_DPS: f64 = 2.0;

fn complementary() -> Plot {
    let mut noise = Noise::new(11);
    let params = [("period_ms", 20.0), ("time_constant_ms", 500.0)];
    let mut filter = Filter::<2, 1>::open("complementary", &params);
    let (mut truth, mut raw, mut drift, mut out) =
        (Points::new(), Points::new(), Points::new(), Points::new());
    let mut sum = 0.0;
    for n in 0..300 {
        let t = f64::from(n) * 0.02;
        let (angle, rate) = seesaw(t);
        let (y, z) = accelerations(angle, &mut noise);
        let measured = atan2(y, z).to_degrees();
        let gyroscope = rate + BIAS_DPS + noise.normal(0.5);
        sum += gyroscope * 0.02;
        truth.push((t, angle));
        raw.push((t, measured));
        drift.push((t, sum));
        let values = [gyroscope, measured].map(|value| (value * 1000.0).round() as i32);
        out.extend(filter.step::<i32>(values).map(|[mdeg]| (t, mdeg / 1000.0)));
    }
    Plot::new("complementary: the angle of a seesaw", "deg")
        .line(Role::Raw, "accelerometer", raw)
        .line(Role::Other, "sum of the rates", drift)
        .line(Role::Truth, "truth", truth)
        .line(Role::Filtered, "filtered", out)
}

fn orientation(name: &str, title: &'static str, params: &[(&str, f64)]) -> Plot {
    let mut noise = Noise::new(12);
    let mut filter = Filter::<6, 3>::open(name, params);
    let (mut truth, mut raw, mut out) = (Points::new(), Points::new(), Points::new());
    for n in 0..300 {
        let t = f64::from(n) * 0.02;
        let (angle, rate) = seesaw(t);
        let (y, z) = accelerations(angle, &mut noise);
        let rates = [rate + BIAS_DPS, 0.0, 0.0].map(|rate| (rate + noise.normal(0.5)) * 1000.0);
        let [x_mdps, y_mdps, z_mdps] = rates.map(|rate| rate.round() as i32);
        truth.push((t, angle));
        raw.push((t, atan2(y, z).to_degrees()));
        let values = [
            x_mdps,
            y_mdps,
            z_mdps,
            noise.normal(100.0) as i32,
            y as i32,
            z as i32,
        ];
        out.extend(filter.step::<f32>(values).map(|[roll, _, _]| (t, roll)));
    }
    Plot::new(title, "roll, deg")
        .line(Role::Raw, "accelerometer", raw)
        .line(Role::Truth, "truth", truth)
        .line(Role::Filtered, "filtered", out)
}

fn kalman_linear() -> Plot {
    let params = [
        ("period_ms", 10.0),
        ("acceleration", 1500.0),
        ("noise", 0.3),
    ];
    let mut filter = Filter::<1, 2>::open("kalman_linear", &params);
    let (mut truth, mut raw, mut out) = (Points::new(), Points::new(), Points::new());
    let mut before = None;
    for n in 0..300 {
        let t = f64::from(n) * 0.01;
        let (sin, cos) = sin_cos(t * 2.0);
        let position = (200.0 * (1.0 - cos)).floor();
        let last: f64 = before.replace(position).unwrap_or(position);
        if let Some([_, velocity]) = filter.step::<i32>([position as i32]) {
            truth.push((t, 400.0 * sin));
            raw.push((t, (position - last) / 0.01));
            out.push((t, velocity));
        }
    }
    Plot::new(
        "kalman_linear: the speed of a motor from whole degrees of its encoder",
        "deg/s",
    )
    .line(Role::Raw, "differences", raw)
    .line(Role::Truth, "truth", truth)
    .line(Role::Filtered, "velocity", out)
}

fn heading() -> Plot {
    let mut noise = Noise::new(13);
    let params = [
        ("period_ms", 20.0),
        ("bias_ms", 1000.0),
        ("still_mdps", 4000.0),
    ];
    let mut filter = Filter::<6, 1>::open("heading", &params);
    let (mut truth, mut raw, mut out) = (Points::new(), Points::new(), Points::new());
    let (mut heading, mut sum) = (0.0, 0.0);
    for n in 0..400 {
        let t = f64::from(n) * 0.02;
        // It rests for 1.2 s, then turns left and right on a ramp that rises to 30 degrees.
        let is_driving = t > 1.2;
        let rate = if is_driving {
            60.0 * sin_cos(t * 0.9).0
        } else {
            0.0
        };
        let tilt_rate = if t > 2.0 && t < 3.0 { 30.0 } else { 0.0 };
        let tilt = ((t - 2.0) * 30.0).clamp(0.0, 30.0).to_radians();
        heading += rate * 0.02;
        let (sin, cos) = sin_cos(tilt);
        // The sensor is tilted about its x axis: the vertical lies between its y and z.
        let rates =
            [tilt_rate, rate * sin, rate * cos].map(|rate| rate + BIAS_DPS + noise.normal(0.3));
        let up = [0.0, 4096.0 * sin, 4096.0 * cos].map(|part| part + noise.normal(60.0));
        sum += rates[2] * 0.02;
        let [p, q, r] = rates.map(|rate| (rate * 1000.0).round() as i32);
        let [x, y, z] = up.map(|part| part.round() as i32);
        if let Some([mdeg]) = filter.step::<i32>([p, q, r, x, y, z]) {
            truth.push((t, wrapped(heading, 360.0)));
            raw.push((t, wrapped(sum, 360.0)));
            out.push((t, mdeg / 1000.0));
        }
    }
    Plot::new(
        "heading: a robot that drives up a ramp, its gyroscope wrong by 2 deg/s",
        "deg",
    )
    .line(Role::Raw, "sum of the z rates", raw)
    .line(Role::Truth, "truth", truth)
    .line(Role::Filtered, "heading", out)
}

fn odometry() -> Plot {
    let params = [("wheel_diameter_mm", 56.0), ("track_mm", 150.0)];
    let mut filter = Filter::<2, 3>::open("odometry", &params);
    let mm_per_degree = 56.0 * std::f64::consts::PI / 360.0;
    let (mut truth, mut euler, mut out) = (Points::new(), Points::new(), Points::new());
    let (mut x, mut y, mut angle) = (0.0, 0.0, 0.0);
    let (mut left, mut right) = (0.0, 0.0);
    let (mut rough, mut before) = ((0.0, 0.0, 0.0), (0.0, 0.0));
    for n in 0..6001 {
        // A figure of eight in steps of a millisecond; the encoders are read three times in a second.
        let t = f64::from(n) * 0.001;
        if n % 333 == 0 {
            let degrees = (f64::floor(left), f64::floor(right));
            let ways = (
                (degrees.0 - before.0) * mm_per_degree,
                (degrees.1 - before.1) * mm_per_degree,
            );
            before = degrees;
            let way = (ways.0 + ways.1) / 2.0;
            let (sin, cos) = sin_cos(rough.2);
            rough = (
                rough.0 + way * cos,
                rough.1 + way * sin,
                rough.2 + (ways.1 - ways.0) / 150.0,
            );
            euler.push((rough.0, rough.1));
            let pose = filter.step::<f32>([degrees.0 as i32, degrees.1 as i32]);
            out.extend(pose.map(|[x, y, _]| (x, y)));
        }
        if n % 20 == 0 {
            truth.push((x, y));
        }
        let turn = if t < 3.0 { 2.1 } else { -2.1 };
        let ways = (0.2 - turn * 0.075, 0.2 + turn * 0.075);
        left += ways.0 / mm_per_degree;
        right += ways.1 / mm_per_degree;
        let half = turn * 0.0005;
        let (sin, cos) = sin_cos(angle + half);
        (x, y, angle) = (x + 0.2 * cos, y + 0.2 * sin, angle + 2.0 * half);
    }
    let mut plot = Plot::new(
        "odometry: a figure of eight, encoders read three times in a second",
        "y, mm",
    )
    .line(Role::Raw, "Euler steps", euler)
    .line(Role::Truth, "truth", truth)
    .line(Role::Filtered, "odometry", out);
    plot.axes.0 = "x, mm";
    plot.is_map = true;
    plot
}

fn pid() -> Plot {
    let params = [
        ("period_ms", 20.0),
        ("kp", 2.0),
        ("ki", 3.0),
        ("kd", 0.1),
        ("filter_ms", 40.0),
    ];
    let mut filter = Filter::<2, 1>::open("pid", &params);
    let (mut wanted, mut power, mut out) = (Points::new(), Points::new(), Points::new());
    let mut noise = Noise::new(14);
    let mut position = 0.0;
    for n in 0..300 {
        let t = f64::from(n) * 0.02;
        let setpoint = if t < 0.5 {
            0
        } else if t < 3.5 {
            60
        } else {
            25
        };
        let measured = (position + noise.normal(0.4)).round();
        let [u] = filter
            .step::<i32>([setpoint, measured as i32])
            .unwrap_or_default();
        // A plant of first order with a gain of 0.9 and a load.
        position += (0.9 * u - 5.0 - position) * 0.02 / 0.4;
        wanted.push((t, f64::from(setpoint)));
        power.push((t, u));
        out.push((t, position));
    }
    Plot::new("pid: a plant of first order under a load", "%")
        .line(Role::Raw, "output", power)
        .line(Role::Other, "setpoint", wanted)
        .line(Role::Filtered, "measured value", out)
}

fn speed_hold() -> Plot {
    let mut filter = Filter::<2, 1>::open("speed_hold", &[("period_ms", 10.0)]);
    let (mut plain, mut held, mut wanted) = (Points::new(), Points::new(), Points::new());
    // Speed with the hold and with a fixed power, and the angle of the first.
    let (mut speed, mut angle, mut plain_speed): (f64, f64, f64) = (0.0, 0.0, 0.0);
    for n in 0..600 {
        let t = f64::from(n) * 0.01;
        let volts = 12.4 - 0.6 * t;
        let load = if t > 3.0 { 60.0 } else { 0.0 };
        let [power] = filter
            .step::<i32>([400, angle.floor() as i32])
            .unwrap_or_default();
        speed += (power * 10.0 * volts / 12.0 - load - speed) * 0.1;
        angle += speed * 0.01;
        plain_speed += (400.0 * volts / 12.0 - load - plain_speed) * 0.1;
        if n % 2 == 0 {
            wanted.push((t, 400.0));
            plain.push((t, plain_speed));
            held.push((t, speed));
        }
    }
    Plot::new(
        "speed_hold: the battery goes from 12.4 to 8.8 V, and a load comes at 3 s",
        "deg/s",
    )
    .line(Role::Raw, "fixed power", plain)
    .line(Role::Truth, "wanted", wanted)
    .line(Role::Filtered, "held", held)
}

/// All of them.
pub fn plots() -> Vec<(&'static str, Plot)> {
    let madgwick = [("period_ms", 20.0), ("beta", 0.1)];
    let mahony = [("period_ms", 20.0), ("kp", 1.0), ("ki", 0.3)];
    vec![
        ("complementary", complementary()),
        (
            "madgwick",
            orientation(
                "madgwick",
                "madgwick, beta 0.1: the roll of a robot on a seesaw",
                &madgwick,
            ),
        ),
        (
            "mahony",
            orientation(
                "mahony",
                "mahony, kp 1, ki 0.3: the roll of a robot on a seesaw",
                &mahony,
            ),
        ),
        ("kalman_linear", kalman_linear()),
        ("heading", heading()),
        ("odometry", odometry()),
        ("pid", pid()),
        ("speed_hold", speed_hold()),
    ]
}
