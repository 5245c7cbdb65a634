//! The Lua text of the typed accessors of byte arrays: `ba.i16(array, pos)` reads, `ba.i16(array, pos, value)` writes.
//!
//! Each is written out for its type, so that LuaJIT compiles it to a check and a move, and made when it is first used,
//! so that a state holds only those that it needs. Numbers go through a union beside the array because the controller's
//! processor cannot read a number at an odd address. A NaN comes out as a NaN whatever its bits. Pure.

use crate::format::FieldKind;

/// The source of a chunk that makes `ba.NAME`, or None if there is no such type. A name is a type of a format (of at
/// most 32 bits, or f64), with `_be` for most significant byte first.
pub(crate) fn source(name: &str) -> Option<String> {
    let (word, big_endian) = match name.strip_suffix("_be") {
        Some(word) => (word, true),
        None => (name, false),
    };
    let kind = match word {
        "i8" => FieldKind::I8,
        "u8" => FieldKind::U8,
        "i16" => FieldKind::I16,
        "u16" => FieldKind::U16,
        "i32" => FieldKind::I32,
        "u32" => FieldKind::U32,
        "f32" => FieldKind::F32,
        "f64" => FieldKind::F64,
        _ => return None,
    };
    let size = kind.size();
    let swap = big_endian != cfg!(target_endian = "big");
    let moved = |to: &str, from: &str| {
        if !swap {
            return format!("copy({to}, {from}, {size})");
        }
        let (to, from) = if to == "s" {
            ("s.b", from)
        } else {
            (to, "s.b")
        };
        let moves: Vec<String> = (0..size)
            .map(|i| format!("{to}[{i}] = {from}[{}]", size - 1 - i))
            .collect();
        moves.join(" ")
    };
    let float = matches!(kind, FieldKind::F32 | FieldKind::F64);
    // Integers are stored through the signed type of their size: conversion of a negative number to an unsigned type is
    // not the same on all processors.
    let store = match (float, size) {
        (true, _) => word.to_owned(),
        (false, 1) => "b[0]".to_owned(),
        (false, _) => format!("i{}", size * 8),
    };
    let load = match kind {
        FieldKind::U8 => "s.b[0]".to_owned(),
        FieldKind::I8 => "(s.b[0] < 128 and s.b[0] or s.b[0] - 256)".to_owned(),
        // LuaJIT keeps tags and addresses of its values in the bits of negative NaNs, and takes what it finds in memory
        // for its own: bytes of a device could name any table. So such a NaN is never loaded but made anew.
        FieldKind::F32 => "(s.u32 > 0xff800000 and 0/0 or s.f32)".to_owned(),
        FieldKind::F64 => format!(
            "(s.h[{}] >= 0xfff8 and 0/0 or s.f64)",
            if cfg!(target_endian = "big") { 0 } else { 3 }
        ),
        _ => format!("s.{word}"),
    };
    let check = if float {
        "if type(value) ~= 'number' then error('a value is a number, not a ' .. type(value), 2) end"
    } else {
        "if type(value) ~= 'number' or not (value >= -2147483648 and value < 2147483648) then value = wrap(value, 3) end"
    };
    let (read, write) = (moved("s", "p"), moved("p", "s"));
    Some(format!(
        "local sizes, bytes, s, copy, refuse, wrap, type, error, select = ...\n\
         return function(array, pos, ...)\n\
         local length = sizes[array]\n\
         if not length or type(pos) ~= 'number' or not (pos >= 0 and pos + {size} <= length) or pos % 1 ~= 0 then\n\
         return refuse(array, pos, {size}) end\n\
         local p = bytes[array] + pos\n\
         if select('#', ...) == 0 then {read} return {load} end\n\
         local value = ...\n\
         {check}\n\
         s.{store} = value {write}\n\
         end"
    ))
}
