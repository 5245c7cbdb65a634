//! Display and pictures for our scripts.
//!
//! Owns how values of JavaScript become orders and how pictures become values. A failure of the display is given back
//! as a text, because a program goes on without it.

use super::{Own, failed, put};
use crate::display::Unshown;
use crate::js::platform::Shown;
use rquickjs::{Ctx, Object};
use std::rc::Rc;

/// The functions.
///
/// # Errors
/// No memory.
pub fn install<'js>(native: &Object<'js>, own: &Rc<Own>) -> rquickjs::Result<()> {
    let told =
        |done: Result<(), Unshown>| done.err().map_or_else(String::new, |why| why.to_string());
    let o = own.clone();
    put(native, "draw", move |line: String| {
        told(o.platform.show(&o.shared, Shown::Order(&line)))
    })?;
    let o = own.clone();
    put(native, "showFile", move |file: String| {
        told(o.platform.show(&o.shared, Shown::File(&file)))
    })?;
    let o = own.clone();
    put(
        native,
        "showNumbers",
        move |numbers: Vec<i32>, width: i32, height: i32, format: String| {
            let shown = Shown::Numbers(&numbers, width, height, &format);
            told(o.platform.show(&o.shared, shown))
        },
    )?;
    let o = own.clone();
    put(
        native,
        "photo",
        move |ctx: Ctx<'js>, width: u16, height: u16| {
            let seen = o.platform.photo(&o.shared);
            let seen = seen.map_err(|reason| failed(&ctx, reason))?;
            let sized = seen.scaled(width, height);
            Ok::<_, rquickjs::Error>(sized.to_rgb())
        },
    )
}
