//! `faulty{ src, fail, from, count, short }`: another source that fails on purpose.
//!
//! Owns which errors it can be told to give. In everything else it is what the source within is.

use super::SourceDescription;
use super::kind::{Constructor, Delivery, Kind, Nodes};
use super::rest::Rest;
use crate::fields::Fields;
use crate::problem::Problem;
use crate::value::Value;
use std::path::{Path, PathBuf};

/// Errors that a `faulty` source can be told to give; end of file as well.
const ERRORS: [(&str, i32); 17] = [
    ("EACCES", libc::EACCES),
    ("EAGAIN", libc::EAGAIN),
    ("EBUSY", libc::EBUSY),
    ("EINTR", libc::EINTR),
    ("EINVAL", libc::EINVAL),
    ("EIO", libc::EIO),
    ("ENODATA", libc::ENODATA),
    ("ENODEV", libc::ENODEV),
    ("ENOENT", libc::ENOENT),
    ("ENOMEM", libc::ENOMEM),
    ("ENXIO", libc::ENXIO),
    ("EOF", 0),
    ("EPERM", libc::EPERM),
    ("EPIPE", libc::EPIPE),
    ("EREMOTEIO", libc::EREMOTEIO),
    ("ESHUTDOWN", libc::ESHUTDOWN),
    ("ETIMEDOUT", libc::ETIMEDOUT),
];

/// `faulty{ src = ..., fail = 'EIO', from = 3, count = 1 }`
#[derive(Clone, Debug, PartialEq)]
pub struct FaultyDescription {
    /// What works in between.
    pub source: Box<SourceDescription>,
    /// Linux error number returned by the failing reads; 0 makes them end of file.
    pub errno: i32,
    /// First read that fails, from 1.
    pub from: u32,
    /// How many reads fail; 0 means all that follow.
    pub count: u32,
    /// Every read gives at most this many bytes; 0 means no limit.
    pub short: usize,
}

impl Kind for FaultyDescription {
    const CONSTRUCTORS: &'static [Constructor<Self>] = &[Constructor {
        word: "faulty",
        keys: &["src", "fail", "from", "count", "short"],
        read,
    }];
    const REST: Rest<Self> = Rest::Within;

    fn each_path(&mut self, take: &mut dyn FnMut(&mut PathBuf)) {
        self.source.each_path(take);
    }

    fn needed_paths(&self) -> Vec<&Path> {
        self.source.needed_paths()
    }

    fn delivery(&self, nodes: &dyn Fn(&str) -> Delivery) -> Delivery {
        self.source.delivery(nodes)
    }

    fn takes_writes(&self) -> bool {
        self.source.takes_writes()
    }

    fn keeps_what_is_written(&self) -> bool {
        self.source.keeps_what_is_written()
    }

    fn known_tuple_size(
        &self,
        fields: &Fields<'_>,
        nodes: &mut dyn Nodes,
    ) -> Result<Option<usize>, Problem> {
        self.source.known_tuple_size(fields, nodes)
    }

    fn check_tuple_size(&self, size: usize, fields: &Fields<'_>) -> Result<(), Problem> {
        self.source.check_tuple_size(size, fields)
    }

    fn nodes(&self) -> Vec<&str> {
        self.source.nodes()
    }

    fn written_node(&self) -> Option<&str> {
        self.source.written_node()
    }
}

/// Reads the constructor.
fn read(fields: &Fields<'_>, nodes: &mut dyn Nodes) -> Result<FaultyDescription, Problem> {
    let Some(value) = fields.get("src") else {
        return Err(fields.problem("src", "faulty: src is missing"));
    };
    if fields.table_of(value).and_then(|inner| inner.get(""))
        == Some(&Value::Text(b"faulty".to_vec()))
    {
        return Err(fields.problem("src", "faulty: src is faulty already"));
    }
    let source = Box::new(SourceDescription::read(value, fields, nodes)?);
    let errno = match fields.get("fail") {
        None => None,
        Some(Value::Number(_)) => fields
            .whole("fail", 0, 4095)?
            .and_then(|number| i32::try_from(number).ok()),
        Some(_) => {
            let name = fields.text("fail", 32)?.unwrap_or_default();
            let known = ERRORS.iter().find(|(known, _)| *known == name);
            let Some((_, number)) = known else {
                let hint = crate::nearest::suggestion(name, ERRORS.iter().map(|(known, _)| *known));
                return Err(fields.problem("src", format!("faulty: unknown error '{name}'{hint}")));
            };
            Some(*number)
        }
    };
    let short = fields.whole("short", 0, u32::MAX)?.unwrap_or(0);
    if errno.is_none() && short == 0 {
        return Err(fields.problem(
            "src",
            "faulty: give fail, for example fail = 'EIO', or short",
        ));
    }
    // Without an error only the short reads are wanted: the first failing read never comes.
    let from = if errno.is_some() {
        fields.whole("from", 1, u32::MAX)?.unwrap_or(1)
    } else {
        u32::MAX
    };
    Ok(FaultyDescription {
        source,
        errno: errno.unwrap_or(libc::EIO),
        from,
        count: fields.whole("count", 0, u32::MAX)?.unwrap_or(1),
        short: usize::try_from(short).unwrap_or(usize::MAX),
    })
}
