//! Every limit of the virtual board.

/// One step of the physics, in simulated time.
pub const STEP_S: f64 = 0.001;
/// How fast a servo turns, in radians per second: 60 degrees in 0.12 s.
pub const SERVO_RAD_S: f64 = 8.7;
/// Simulated time that one look at the clock makes up for; what is beyond it (a PC that slept) is left out.
pub const MAX_CATCH_UP_S: f64 = 2.0;
/// Fastest and slowest world, as factors of real time.
pub const MAX_SPEED: f64 = 100.0;
/// See [`MAX_SPEED`].
pub const MIN_SPEED: f64 = 0.01;
/// Steps of a room that one step of its board does at most, beside those that its speed asks for.
pub const PACE_STEPS: u32 = 100;
/// Farthest place where a hand puts something, in metres either way, and the greatest number of degrees.
pub const PLACE_M: f64 = 1000.0;
/// How long a text of what moves serves everybody who looks, in milliseconds.
pub const SHOWN_MS: u64 = 8;
/// Rays of a lidar that people are shown.
pub const RAYS_SHOWN: u32 = 36;
/// Strokes of markers that a scene has; of more the newest.
pub const STROKES_SHOWN: usize = 20_000;
/// The board looks after its files at least so often.
pub const TICK_MS: u16 = 20;
/// Clients of one bus; more are accepted and closed at once.
pub const MAX_CONNECTIONS: usize = 128;
/// Bytes of one transaction in each direction.
pub const MAX_TRANSFER_BYTES: usize = 8192;
/// Longest delay that a fault adds to one transaction, sample or line.
pub const MAX_SLOW_MS: u32 = 60_000;
/// Most that a weak battery lacks.
pub const MAX_SAG_V: f64 = 12.0;
/// Largest amplitude of noise that a fault adds.
pub const MAX_NOISE: f64 = 1e6;
/// Bytes that are read from one attribute, fault or other plain file.
pub const MAX_TEXT_BYTES: usize = 4096;
/// Longest line that is understood in a FIFO.
pub const MAX_LINE_BYTES: usize = 256;
/// GPIO numbers of the processor: 9 banks of 16.
pub const GPIO_COUNT: u32 = 144;
/// What a FIFO holds before samples are dropped, in bytes: one page, the least that Linux gives.
pub const FIFO_BYTES: i32 = 4096;
/// Sayings of the loudspeaker that wait for somebody who asks for them.
pub const SAYINGS_MAX: usize = 64;
/// Real milliseconds between two pictures of the display.
pub const DISPLAY_MS: u64 = 100;
/// Points of a picture of the camera, as the real one has.
pub const PHOTO_WIDTH: u16 = 320;
/// See [`PHOTO_WIDTH`].
pub const PHOTO_HEIGHT: u16 = 240;
/// Of its JPEG files, 1 to 100.
pub const PHOTO_QUALITY: u8 = 70;
/// What the FIFO of pictures holds, in bytes: one picture at any time.
pub const PHOTO_FIFO_BYTES: i32 = 64 << 10;
/// Values of one text of JSON: an hour of ticks of one robot has 2.2 million.
pub const JSON_VALUES: usize = 4_000_000;
/// Longest run that is judged, in milliseconds of model time.
pub const RUN_MS_MAX: u32 = 3_600_000;
/// Records of one trajectory: an hour of one robot, and as much for its devices.
pub const RECORDS: usize = 800_000;
/// Robots of one trajectory.
pub const ROBOTS: usize = 16;
/// Farthest place of a recorded pose, in pixels.
pub const FAR_PX: f64 = 1e7;
/// Lines and curves of one outline on a floor.
pub const OUTLINE_STEPS: usize = 200_000;
/// Dashes of one line on a floor; a line of more is drawn whole.
pub const DASHES: f64 = 10_000.0;
/// Lines and curves of everything on one floor, markers apart.
pub const FLOOR_STEPS: usize = 1_000_000;
/// Farthest place on a floor, in pixels either way, for which lines and pictures are drawn.
pub const SCENE_EDGE: f64 = 1e6;
/// Bytes of an SVG on a floor.
pub const SVG_BYTES: usize = 4 << 20;
/// Bytes of another picture on a floor.
pub const PICTURE_BYTES: usize = 4 << 20;
/// Lines and areas of one SVG.
pub const PICTURE_LAYERS: usize = 20_000;
/// Groups within groups of one SVG.
pub const PICTURE_DEPTH: u32 = 64;
/// Pieces of what markers leave; more are not kept.
pub const TRACE_STROKES: usize = 200_000;
/// Cells of the floor's table that list one thing; a larger thing is looked at from everywhere.
pub const CELLS_OF_THING: i64 = 256;
/// Largest number in a world model, in units of its text and in pixels.
pub const FIELD_NUMBER: f64 = 1e6;
/// Walls, solids, drawn things, regions and the like of one field, strokes and sensors included.
pub const FIELD_THINGS: usize = 20_000;
/// Balls, skittles and cubes that realistic physics moves: 300 in a heap are slower than real time.
pub const FIELD_PUSHED: usize = 200;
/// Bytes of a world model that a running world reads.
pub const FIELD_BYTES: u64 = 32 << 20;
/// Single steps of one order.
pub const STEPS_ORDERED: u32 = 1000;
/// Robots of one field; there is one for each kit.
pub const FIELD_ROBOTS: usize = 16;
/// Sensors of one robot.
pub const FIELD_SENSORS: usize = 64;
/// Messages of other robots that wait for one.
pub const MAIL_MAX: usize = 10_000;
/// Bytes of all changes of motors, readings, variables and blocks that an animated page holds, about.
pub const TRACK_BYTES: usize = 1 << 20;
/// Motors, readings, variables and threads whose changes a page holds.
pub const TRACK_COLUMNS: usize = 200;
/// Characters of a name or a value there.
pub const TRACK_CHARS: usize = 60;
/// Poses of one robot that an animated page holds.
pub const PAGE_POSES: usize = 6_000;
/// Remarks on pictures and colours of one floor.
pub const FLOOR_PROBLEMS: usize = 50;
/// Things on one virtual display.
pub const SCREEN_OBJECTS: usize = 20_000;
/// Characters of a text on it, and of what a robot says.
pub const SCREEN_TEXT: usize = 4096;
/// Texts that a program printed in a run that are kept for people.
pub const PRINTED_LINES: usize = 200;
/// Bytes of pictures on the floor that a drawing of a run holds.
pub const DRAWING_BYTES: usize = 8 << 20;
/// Things on a display that one record tells.
pub const OBJECTS_TOLD: usize = 200;
/// Things that a person does beside the robot in one run.
pub const DEEDS: usize = 100_000;
/// Threads of a diagram that an explanation tells of.
pub const RUNNING_MAX: usize = 32;
/// Characters of a name in it.
pub const RUNNING_CHARS_MAX: usize = 200;
/// Readings of an arena that wait for a program; those that none hears of are not kept for ever.
pub const ANNOUNCED_MAX: usize = 64;
/// Largest of what materials have.
pub const MATERIAL_MAX: f64 = 1e4;
/// Least mass of what can be pushed.
pub const MASS_MIN: f64 = 1e-6;
/// Places beyond this, in pixels, are none: the solver counts in 32 bits and is right within some kilometres.
pub const PLACE_MAX: f64 = 1e6;
/// Outlines with a smaller area, in square pixels, are no bodies.
pub const AREA_MIN: f64 = 1e-3;
/// Marks of time on the way of a robot in a picture.
pub const MARKS_MAX: usize = 40;
/// Pulses that come in in a second.
pub const PULSES_HZ_MAX: u32 = 100_000;
