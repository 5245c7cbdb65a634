//! Fuzz targets as plain functions: any bytes may come in, nothing but time and memory within limits may go.

pub use crate::dcml::lsp::fuzz as lsp;
