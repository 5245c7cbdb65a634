//! The running world of TRIK Studio's simulator.

pub mod floor;
