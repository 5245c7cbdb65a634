//! Messages of ROS 2 (Jazzy) that say what a robot measures and does, in SI units.
//!
//! Owns their fields, texts and bytes; the source of each is the package that its name begins with. Constants of the packages
//! are left out, as they take no bytes. Which node of a tree is which message is known to the program that writes one.

use super::{TIME, stamp};
use crate::cdr::Writer;
use crate::schema::with_needed;

/// A type of message.
pub trait Message {
    /// The name of its schema.
    const NAME: &'static str;
    /// Its own fields, in ros2msg.
    const FIELDS: &'static str;
    /// The types that these need.
    const NEEDED: &'static [(&'static str, &'static str)];

    /// Its fields, one after the other.
    fn put(&self, out: &mut Writer, unix_ns: u64);
}

/// The text of the schema.
pub fn text_of<M: Message>() -> String {
    with_needed(M::FIELDS, M::NEEDED)
}

/// The message, with its moment in the header.
pub fn encode<M: Message>(message: &M, unix_ns: u64) -> Vec<u8> {
    let mut out = Writer::new();
    message.put(&mut out, unix_ns);
    out.finish()
}

const HEADER: (&str, &str) = super::HEADER[0];
const VECTOR: (&str, &str) = ("geometry_msgs/Vector3", "float64 x\nfloat64 y\nfloat64 z\n");
const QUATERNION: (&str, &str) = (
    "geometry_msgs/Quaternion",
    "float64 x\nfloat64 y\nfloat64 z\nfloat64 w\n",
);

fn header(out: &mut Writer, unix_ns: u64, frame: &str) {
    stamp(out, unix_ns);
    out.string(frame);
}

fn all_f64(out: &mut Writer, all: &[f64]) {
    for one in all {
        out.f64(*one);
    }
}

fn many_f64(out: &mut Writer, all: &[f64]) {
    out.sequence(all, |out, one| {
        out.f64(*one);
    });
}

fn many_f32(out: &mut Writer, all: &[f32]) {
    out.sequence(all, |out, one| {
        out.f32(*one);
    });
}

fn many_texts(out: &mut Writer, all: &[String]) {
    out.sequence(all, |out, one| {
        out.string(one);
    });
}

/// How a distance is measured.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Radiation {
    /// By sound.
    Ultrasound,
    /// By light.
    Infrared,
}

/// The distance to what is in front of a sensor.
#[derive(Clone, Debug, PartialEq)]
pub struct Range {
    /// Where the sensor is.
    pub frame: String,
    /// How it measures.
    pub radiation: Radiation,
    /// Angle of its cone, in rad.
    pub field_of_view: f32,
    /// Least distance that it measures, in m.
    pub min_range: f32,
    /// Greatest distance that it measures, in m.
    pub max_range: f32,
    /// The distance, in m; negative infinity is too near, infinity is nothing.
    pub range: f32,
    /// Variance of the distance; 0 if it is not known.
    pub variance: f32,
}

impl Message for Range {
    const NAME: &'static str = "sensor_msgs/msg/Range";
    const FIELDS: &'static str = "std_msgs/Header header\nuint8 radiation_type\nfloat32 field_of_view\nfloat32 min_range\n\
        float32 max_range\nfloat32 range\nfloat32 variance\n";
    const NEEDED: &'static [(&'static str, &'static str)] = &[HEADER, TIME];

    fn put(&self, out: &mut Writer, unix_ns: u64) {
        header(out, unix_ns, &self.frame);
        out.u8(match self.radiation {
            Radiation::Ultrasound => 0,
            Radiation::Infrared => 1,
        });
        out.f32(self.field_of_view).f32(self.min_range);
        out.f32(self.max_range).f32(self.range).f32(self.variance);
    }
}

/// Turning and acceleration.
#[derive(Clone, Debug, PartialEq)]
pub struct Imu {
    /// Where the sensor is.
    pub frame: String,
    /// Quaternion x, y, z, w; None if it is not known.
    pub orientation: Option<[f64; 4]>,
    /// Around x, y, z, in rad/s.
    pub angular_velocity: [f64; 3],
    /// Along x, y, z, in m/s^2.
    pub linear_acceleration: [f64; 3],
}

impl Message for Imu {
    const NAME: &'static str = "sensor_msgs/msg/Imu";
    const FIELDS: &'static str = "std_msgs/Header header\ngeometry_msgs/Quaternion orientation\n\
        float64[9] orientation_covariance\ngeometry_msgs/Vector3 angular_velocity\n\
        float64[9] angular_velocity_covariance\ngeometry_msgs/Vector3 linear_acceleration\n\
        float64[9] linear_acceleration_covariance\n";
    const NEEDED: &'static [(&'static str, &'static str)] = &[HEADER, TIME, QUATERNION, VECTOR];

    fn put(&self, out: &mut Writer, unix_ns: u64) {
        header(out, unix_ns, &self.frame);
        // A covariance of zeros is one that is not known; -1 first says that there is no such value.
        let mut covariance = [0.0; 9];
        if self.orientation.is_none() {
            covariance[0] = -1.0;
        }
        all_f64(out, &self.orientation.unwrap_or([0.0, 0.0, 0.0, 1.0]));
        all_f64(out, &covariance);
        for vector in [&self.angular_velocity, &self.linear_acceleration] {
            all_f64(out, vector);
            all_f64(out, &[0.0; 9]);
        }
    }
}

/// Motors and encoders. A list has as many numbers as there are names, or none.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct JointState {
    /// Where they are.
    pub frame: String,
    /// Their names.
    pub name: Vec<String>,
    /// In rad.
    pub position: Vec<f64>,
    /// In rad/s.
    pub velocity: Vec<f64>,
    /// In Nm.
    pub effort: Vec<f64>,
}

impl Message for JointState {
    const NAME: &'static str = "sensor_msgs/msg/JointState";
    const FIELDS: &'static str = "std_msgs/Header header\nstring[] name\nfloat64[] position\nfloat64[] velocity\nfloat64[] effort\n";
    const NEEDED: &'static [(&'static str, &'static str)] = &[HEADER, TIME];

    fn put(&self, out: &mut Writer, unix_ns: u64) {
        header(out, unix_ns, &self.frame);
        many_texts(out, &self.name);
        many_f64(out, &self.position);
        many_f64(out, &self.velocity);
        many_f64(out, &self.effort);
    }
}

/// A battery of which the voltage and perhaps the current is measured.
#[derive(Clone, Debug, PartialEq)]
pub struct BatteryState {
    /// Where it is.
    pub frame: String,
    /// In V.
    pub voltage: f32,
    /// In A, negative while it gives current.
    pub current: Option<f32>,
    /// From 0 to 1.
    pub percentage: Option<f32>,
}

impl Message for BatteryState {
    const NAME: &'static str = "sensor_msgs/msg/BatteryState";
    const FIELDS: &'static str = "std_msgs/Header header\nfloat32 voltage\nfloat32 temperature\nfloat32 current\n\
        float32 charge\nfloat32 capacity\nfloat32 design_capacity\nfloat32 percentage\nuint8 power_supply_status\n\
        uint8 power_supply_health\nuint8 power_supply_technology\nbool present\nfloat32[] cell_voltage\n\
        float32[] cell_temperature\nstring location\nstring serial_number\n";
    const NEEDED: &'static [(&'static str, &'static str)] = &[HEADER, TIME];

    fn put(&self, out: &mut Writer, unix_ns: u64) {
        header(out, unix_ns, &self.frame);
        // What is not measured is no number, as the package asks.
        out.f32(self.voltage).f32(f32::NAN);
        out.f32(self.current.unwrap_or(f32::NAN));
        out.f32(f32::NAN).f32(f32::NAN).f32(f32::NAN);
        out.f32(self.percentage.unwrap_or(f32::NAN));
        // Status, health and technology are unknown; it is there.
        out.u8(0).u8(0).u8(0).u8(1);
        many_f32(out, &[]);
        many_f32(out, &[]);
        out.string("").string("");
    }
}

/// A gamepad.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Joy {
    /// Where it is.
    pub frame: String,
    /// From -1 to 1.
    pub axes: Vec<f32>,
    /// 1 if it is pressed.
    pub buttons: Vec<i32>,
}

impl Message for Joy {
    const NAME: &'static str = "sensor_msgs/msg/Joy";
    const FIELDS: &'static str = "std_msgs/Header header\nfloat32[] axes\nint32[] buttons\n";
    const NEEDED: &'static [(&'static str, &'static str)] = &[HEADER, TIME];

    fn put(&self, out: &mut Writer, unix_ns: u64) {
        header(out, unix_ns, &self.frame);
        many_f32(out, &self.axes);
        out.sequence(&self.buttons, |out, one| {
            out.i32(*one);
        });
    }
}

/// Distances all around.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct LaserScan {
    /// Where the scanner is.
    pub frame: String,
    /// Direction of the first distance, in rad.
    pub angle_min: f32,
    /// Direction of the last.
    pub angle_max: f32,
    /// Between two directions.
    pub angle_increment: f32,
    /// Between two measurements, in s.
    pub time_increment: f32,
    /// Between two scans, in s.
    pub scan_time: f32,
    /// Least distance, in m; nearer ones are to be ignored.
    pub range_min: f32,
    /// Greatest distance, in m.
    pub range_max: f32,
    /// The distances, in m.
    pub ranges: Vec<f32>,
    /// How bright each was, or none.
    pub intensities: Vec<f32>,
}

impl Message for LaserScan {
    const NAME: &'static str = "sensor_msgs/msg/LaserScan";
    const FIELDS: &'static str = "std_msgs/Header header\nfloat32 angle_min\nfloat32 angle_max\nfloat32 angle_increment\n\
        float32 time_increment\nfloat32 scan_time\nfloat32 range_min\nfloat32 range_max\nfloat32[] ranges\n\
        float32[] intensities\n";
    const NEEDED: &'static [(&'static str, &'static str)] = &[HEADER, TIME];

    fn put(&self, out: &mut Writer, unix_ns: u64) {
        header(out, unix_ns, &self.frame);
        out.f32(self.angle_min).f32(self.angle_max);
        out.f32(self.angle_increment).f32(self.time_increment);
        out.f32(self.scan_time);
        out.f32(self.range_min).f32(self.range_max);
        many_f32(out, &self.ranges);
        many_f32(out, &self.intensities);
    }
}

/// A picture as the camera gave it.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct CompressedImage {
    /// Where the camera is.
    pub frame: String,
    /// `jpeg` or `png`.
    pub format: String,
    /// The file.
    pub data: Vec<u8>,
}

impl Message for CompressedImage {
    const NAME: &'static str = "sensor_msgs/msg/CompressedImage";
    const FIELDS: &'static str = "std_msgs/Header header\nstring format\nuint8[] data\n";
    const NEEDED: &'static [(&'static str, &'static str)] = &[HEADER, TIME];

    fn put(&self, out: &mut Writer, unix_ns: u64) {
        header(out, unix_ns, &self.frame);
        out.string(&self.format);
        out.u32(u32::try_from(self.data.len()).unwrap_or(u32::MAX));
        out.bytes(&self.data);
    }
}

/// Where a robot thinks it is, and how it moves.
#[derive(Clone, Debug, PartialEq)]
pub struct Odometry {
    /// In which frame the pose is.
    pub frame: String,
    /// The frame of the robot, in which the velocities are.
    pub child_frame: String,
    /// x, y, z in m.
    pub position: [f64; 3],
    /// Quaternion x, y, z, w.
    pub orientation: [f64; 4],
    /// Along x, y, z, in m/s.
    pub linear: [f64; 3],
    /// Around x, y, z, in rad/s.
    pub angular: [f64; 3],
}

impl Message for Odometry {
    const NAME: &'static str = "nav_msgs/msg/Odometry";
    const FIELDS: &'static str = "std_msgs/Header header\nstring child_frame_id\n\
        geometry_msgs/PoseWithCovariance pose\ngeometry_msgs/TwistWithCovariance twist\n";
    const NEEDED: &'static [(&'static str, &'static str)] = &[
        HEADER,
        TIME,
        (
            "geometry_msgs/PoseWithCovariance",
            "geometry_msgs/Pose pose\nfloat64[36] covariance\n",
        ),
        (
            "geometry_msgs/Pose",
            "geometry_msgs/Point position\ngeometry_msgs/Quaternion orientation\n",
        ),
        ("geometry_msgs/Point", "float64 x\nfloat64 y\nfloat64 z\n"),
        QUATERNION,
        (
            "geometry_msgs/TwistWithCovariance",
            "geometry_msgs/Twist twist\nfloat64[36] covariance\n",
        ),
        (
            "geometry_msgs/Twist",
            "geometry_msgs/Vector3 linear\ngeometry_msgs/Vector3 angular\n",
        ),
        VECTOR,
    ];

    fn put(&self, out: &mut Writer, unix_ns: u64) {
        header(out, unix_ns, &self.frame);
        out.string(&self.child_frame);
        all_f64(out, &self.position);
        all_f64(out, &self.orientation);
        all_f64(out, &[0.0; 36]);
        all_f64(out, &self.linear);
        all_f64(out, &self.angular);
        all_f64(out, &[0.0; 36]);
    }
}

/// Where one frame is in another.
#[derive(Clone, Debug, PartialEq)]
pub struct Transform {
    /// The frame that is known.
    pub frame: String,
    /// The frame that is in it.
    pub child_frame: String,
    /// x, y, z in m.
    pub translation: [f64; 3],
    /// Quaternion x, y, z, w.
    pub rotation: [f64; 4],
}

/// Where frames are, all at the same moment.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Transforms(pub Vec<Transform>);

impl Message for Transforms {
    const NAME: &'static str = "tf2_msgs/msg/TFMessage";
    const FIELDS: &'static str = "geometry_msgs/TransformStamped[] transforms\n";
    const NEEDED: &'static [(&'static str, &'static str)] = &[
        (
            "geometry_msgs/TransformStamped",
            "std_msgs/Header header\nstring child_frame_id\ngeometry_msgs/Transform transform\n",
        ),
        HEADER,
        TIME,
        (
            "geometry_msgs/Transform",
            "geometry_msgs/Vector3 translation\ngeometry_msgs/Quaternion rotation\n",
        ),
        VECTOR,
        QUATERNION,
    ];

    fn put(&self, out: &mut Writer, unix_ns: u64) {
        out.sequence(&self.0, |out, one| {
            header(out, unix_ns, &one.frame);
            out.string(&one.child_frame);
            all_f64(out, &one.translation);
            all_f64(out, &one.rotation);
        });
    }
}

#[cfg(test)]
mod tests;
