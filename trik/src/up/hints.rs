//! What to try first with each robot, as commands for a shell.
//!
//! Owns the texts; a test runs each of them on its robot.

/// Commands for the directory of the tree, with what they do.
pub(super) fn of(robot: &str) -> &'static [(&'static str, &'static str)] {
    match robot {
        "two-wheels" => &[
            ("cat sensors/D1/value", "how far is the wall, in cm?"),
            ("cat heading/value", "where does it look, in degrees?"),
            (
                "echo 30 > motors/M3/value; echo 30 > motors/M4/value",
                "drive, in percent",
            ),
            ("cat encoders/E3/value", "how far has the wheel turned?"),
            ("echo -30 > motors/M3/value", "turn on the spot"),
            ("echo 300 > motors/left/speed", "hold a speed, in deg/s"),
            ("echo > stop", "bring everything to rest"),
        ],
        "line-follower" => &[
            (
                "cat sensors/floor_left/value",
                "how dark is the floor, in percent?",
            ),
            ("cat camera/line/value", "where is the line, -100 to 100?"),
            (
                "echo 30 > motors/M3/value; echo 30 > motors/M4/value",
                "drive, in percent",
            ),
            ("echo 440 500 > sound/tone/value", "play a tone: Hz, ms"),
            ("echo > stop", "bring everything to rest"),
        ],
        "bare" | "in the world" => &[("cat status", "what is there?")],
        // A model in DCML.
        _ => &[
            (
                "ls motors servos",
                "what drives it, named after the actions?",
            ),
            (
                "cat pose/value",
                "where is it by its model, in metres and radians?",
            ),
            ("grep . pose/params/*", "which numbers has the model?"),
            ("echo > stop", "bring everything to rest"),
        ],
    }
}
