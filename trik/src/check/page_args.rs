//! The options of the page of marks.
//!
//! Owns these options. Knows nothing of what they do.

use crate::remote::roster::{Class, class};
use clap::Args;

/// Options of the page of marks.
#[derive(Args, Clone, Debug, Default)]
#[command(next_help_heading = "Options for a class")]
pub(crate) struct MarksPageArgs {
    /// Serve a page to this computer on which the table of the class fills while it is judged: each mark with its verdict,
    /// and at a click the replay of its run. It stays until you end it.
    #[arg(long = "page", conflicts_with_all = ["log", "is_debugging", "platform"])]
    pub is_served: bool,
    /// Open the page in a browser.
    #[arg(long = "open", requires = "is_served")]
    pub opens: bool,
    /// The TCP port of the page; 0 takes a free one [default: 8200, or any free one if that is taken].
    #[arg(long = "page-port", value_name = "PORT", requires = "is_served")]
    pub port: Option<u16>,
    /// With --page: the robots that a file names on the same page, as `trik class page` has them, with a stop for all; with :GROUP
    /// those of that group. This computer commands them.
    #[arg(long = "class", value_name = "FILE[:GROUP]", requires = "is_served", value_parser = class)]
    pub class: Option<Class>,
}
