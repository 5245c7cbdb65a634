//! Every limit of this crate: what texts and their problems may grow to.

/// How deep tags may nest in a document.
pub const XML_DEPTH: usize = 64;
/// Tags of one document.
pub const XML_TAGS: usize = 100_000;
/// Attributes of one tag.
pub const XML_ATTRIBUTES: usize = 64;
/// Problems that one reading tells; those beyond that are counted.
pub const PROBLEMS: usize = 200;
/// Problems that are counted.
pub const PROBLEMS_KEPT: usize = 2_000;
/// Bytes of a word that is compared with known ones; a longer one is near to none.
pub const NEAR_BYTES: usize = 200;
/// How deep JSON that is looked at may be nested.
pub const JSON_DEPTH_MAX: usize = 64;
