//! Generated code: the output of every target is compiled and run by the language's own tools, for the published models,
//! for random ones and for names that hurt, and compared with the reference.

mod agree;
mod hostile;
mod java;
mod models;
mod outcome;
mod tools;
