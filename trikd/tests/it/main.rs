//! `trikd` as clients and programs use it: raw bytes on real sockets.
