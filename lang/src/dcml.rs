//! The Differential Constraints Modeling Language: what a robot's state does under an action, as text.
//!
//! Owns the border. Text to a [`syntax`] tree to a checked [`model`] to straight-line [`tape`]s; whoever simulates, plans
//! or drives a robot sees a [`system::System`] only. The language is that of Guarnieri, Magri, Brugali and Gherardi, *A
//! Domain Specific Language for Modeling Differential Constraints of Mobile Robots*.

pub mod fold;
pub mod function;
pub mod generate;
pub mod jacobian;
pub mod lower;
pub mod model;
pub mod robot;
pub mod run;
#[cfg(test)]
mod sketch;
pub mod syntax;
pub mod system;
pub mod tape;
