//! What integration tests stand on: a scratch folder with fake devices, a mounted tree, users' programs with a deadline.
//!
//! Owns starting and ending all of them, also when a test panics, and the decision to skip a test by name.
//! Knows nothing of what is tested; the program under test is given to it as a path.

pub mod board;
pub mod documents;
pub mod fuzz;
pub mod i2c_bus;
pub mod mount;
pub mod processes;
pub mod tools;
pub mod wait;

pub use board::Board;
pub use i2c_bus::I2cBus;
pub use mount::{Mount, Setting};
pub use tools::{Output, put, run};
pub use wait::{eventually, skip};
