//! `trik class`: a page for the robots of a class, their list, and robots that are found in the network.
//!
//! Owns the options. What is done with several robots at once by other commands is known to `remote::fleet`, the file of a class
//! to `remote::roster`.

mod find;
pub(crate) mod page;

use crate::output::standard;
use crate::refusal::Refusal;
use crate::remote::roster::{Class, class};
use clap::{Args, Subcommand};
use std::fmt::Write as _;
use std::net::IpAddr;

/// What can be done with a class.
#[derive(Subcommand, Clone, Debug, PartialEq, Eq)]
pub(crate) enum ClassCommand {
    /// Serve a page that shows all robots of a class, stops them all, and sends programs to those that are chosen.
    ///
    /// Each robot has a card: whether it is reached, or why not, which program runs and how the last one has ended. A robot that
    /// goes away delays no other one, and is there again by itself.
    ///
    /// Exit status: 0 you have ended it; 1 the address cannot be had; 2 the command line or the file was not understood.
    Page(PageArgs),
    /// Show the robots that a file names, and so whether it is understood.
    ///
    /// Exit status: 0 shown; 2 the file was not understood.
    List(ListArgs),
    /// Find robots in the network, by multicast DNS.
    ///
    /// Prints a line for each that answers, as a file of a class has them. Real robots answer, and virtual ones that others can
    /// reach.
    ///
    /// Exit status: 0 robots were found; 1 none has answered, or this computer cannot ask.
    Find(FindArgs),
}

/// The options of `trik class page`.
#[derive(Args, Clone, Debug, PartialEq, Eq)]
pub(crate) struct PageArgs {
    /// The robots that a file names, a line for each: NAME ADDRESS [GROUP] [page=PORT]; with :GROUP those of that group.
    #[arg(long, value_name = "FILE[:GROUP]", value_parser = class)]
    pub class: Class,
    /// The address to listen on; 0.0.0.0 or :: lets everybody in the network look. Only this computer commands robots.
    #[arg(long, default_value = "127.0.0.1")]
    pub address: IpAddr,
    /// The TCP port; 0 takes a free one [default: 8100, or any free one if that is taken].
    #[arg(long)]
    pub port: Option<u16>,
    /// Open the page in a browser.
    #[arg(long)]
    pub open: bool,
}

/// The options of `trik class list`.
#[derive(Args, Clone, Debug, PartialEq, Eq)]
pub(crate) struct ListArgs {
    /// The robots that a file names; with :GROUP those of that group.
    #[arg(long, value_name = "FILE[:GROUP]", value_parser = class)]
    pub class: Class,
}

/// The options of `trik class find`.
#[derive(Args, Clone, Debug, PartialEq, Eq)]
pub(crate) struct FindArgs {
    /// How long it looks, in seconds.
    #[arg(long, value_name = "SECONDS", default_value_t = 3, value_parser = clap::value_parser!(u8).range(1..=60))]
    pub seconds: u8,
}

/// Does what a command says, and gives the exit code.
///
/// # Errors
/// It could not be done.
pub(crate) fn run(command: &ClassCommand) -> Result<u8, Refusal> {
    match command {
        ClassCommand::Page(args) => page::serve(args),
        ClassCommand::List(args) => standard(list(&args.class).as_bytes()).map(|()| 0),
        ClassCommand::Find(args) => find::find(args),
    }
}

/// A line for each robot, in columns, in the form of the file.
fn list(class: &Class) -> String {
    let letters = |text: &str| text.chars().count();
    let width = |of: fn(&crate::remote::roster::Robot) -> &str| {
        let all = class.robots.iter().map(|robot| letters(of(robot)));
        all.max().unwrap_or(0)
    };
    let (names, places, groups) = (
        width(|one| &one.name),
        width(|one| &one.at),
        width(|one| &one.group),
    );
    let mut text = String::new();
    for robot in &class.robots {
        let page = robot
            .page
            .map_or_else(String::new, |port| format!("page={port}"));
        let (name, at, group) = (&robot.name, &robot.at, &robot.group);
        let line = format!("{name:<names$}  {at:<places$}  {group:<groups$}  {page}");
        // Writing to a text cannot fail.
        let _ = writeln!(text, "{}", line.trim_end());
    }
    text
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::remote::roster::Robot;

    #[test]
    fn the_list_is_a_file_of_a_class_again() {
        let robot = |name: &str, at: &str, group: &str, page| Robot {
            name: name.to_owned(),
            at: at.to_owned(),
            group: group.to_owned(),
            page,
        };
        let class = Class {
            name: "class".to_owned(),
            robots: vec![
                robot("anna", "192.168.77.11", "red", Some(8000)),
                robot("bo", "b", "", None),
            ],
        };
        assert_eq!(
            list(&class),
            "anna  192.168.77.11  red  page=8000\nbo    b\n"
        );
    }
}
