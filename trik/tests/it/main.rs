//! `trik up` as people use it: a whole virtual robot, a real mount, programs that read and write files.
//!
//! One binary, so that linking happens once. Below is the table of contents.

/// Recordings through another configuration.
mod anew;
mod black_box;
mod bridge;
/// Solutions of tasks, judged.
mod check;
/// Models of robots: what their document shows, files and exit codes.
mod dcml;
/// Paths of robots that are models.
mod dcml_drive;
mod dcml_gen;
mod dcml_plan;
/// `trik dcml sim`: models under actions.
mod dcml_sim;
/// Diagrams in the debugger.
mod debug;
/// Diagrams shown, checked and translated, and run in three languages.
mod diagrams;
/// What documents show of a robot.
mod documents;
/// The robot moves and its sensors see it.
mod drive;
/// How it ends: every way leaves nothing behind and actuators at rest.
mod end;
/// The view of ev3dev: motors, sensors and lights by the files that libraries of ev3dev know.
mod ev3dev;
/// The programs of `examples`, in every language.
mod examples;
/// Devices that fail on purpose.
mod faults;
/// Submissions in a queue.
#[cfg(feature = "nats")]
mod grade;
/// Speed that is held, heading and place.
mod hold;
/// What editors are told of models.
mod lsp;
/// Models in DCML: a body of their own, and nodes that follow it.
mod models;
/// Robots by way of an MQTT broker.
mod mqtt;
/// Programs that come over the network.
mod programs;
/// A running `trik up`.
mod raw;
/// Recordings cut, and made into tables and pictures.
mod recording;
mod replay;
/// Recordings of robots and of replays, compared, and recorders that are killed.
mod rerecord;
mod rig;
/// Programs with text as solutions.
mod scripts;
/// The studio, copied for web servers.
mod site;
mod tasks;
/// What is said to a person, and what is refused.
mod words;
mod world;
