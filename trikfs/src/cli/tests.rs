//! The words of the command line; what they do is tested where it is done.

use super::*;
use clap::CommandFactory;
use clap::error::ErrorKind;

fn parse(line: &[&str]) -> Result<Command, clap::Error> {
    Cli::try_parse_from(std::iter::once(&"trikfs").chain(line)).map(|cli| cli.command)
}

fn mount_args(line: &[&str]) -> MountArgs {
    match parse(line) {
        Ok(Command::Mount(args)) => args,
        Ok(_) => panic!("another command"),
        Err(error) => panic!("{error}"),
    }
}

#[test]
fn the_definition_is_consistent() {
    Cli::command().debug_assert();
}

/// What `--help` says of a command and of those below it that a person is shown.
#[cfg(feature = "manual")]
fn help(command: &mut clap::Command) -> String {
    let mut text = format!("{}\n", command.render_long_help());
    for one in command.get_subcommands_mut() {
        if !one.is_hide_set() && one.get_name() != "help" {
            text.push_str(&format!("\n==== {}\n\n", one.get_name()));
            text.push_str(&help(one));
        }
    }
    text
}

#[cfg(feature = "manual")]
#[test]
fn help_has_these_words() {
    let mut command = Cli::command().term_width(100);
    command.build();
    // The second transport is there only with its feature.
    let words: String = help(&mut command)
        .split_inclusive('\n')
        .filter(|line| !line.trim_start().starts_with("- fuser:"))
        .collect();
    insta::assert_snapshot!("help", words);
}

#[test]
fn mount_takes_all_its_options() {
    let args = mount_args(&[
        "mount",
        "--config",
        "r.lua",
        "--include",
        "a",
        "--include",
        "b",
        "--allow-other",
        "--no-sample-bus",
        "--background",
        "--config-group",
        "12",
        "--group",
        "13",
        "--cache",
        "c",
        "--transport",
        "native",
        "/trikfs",
    ]);
    assert_eq!(args.tree.config, Some("r.lua".into()));
    assert_eq!(args.tree.search.include, ["a", "b"].map(PathBuf::from));
    assert_eq!(args.tree.search.cache, Some("c".into()));
    assert_eq!(args.tree.config_group, Some(12));
    assert_eq!(args.tree.group, Some(13));
    assert!(args.allow_other && args.background && !args.detached);
    assert!(args.tree.no_sample_bus && !args.tree.raw);
    assert!(mount_args(&["mount", "--raw", "/trikfs"]).tree.raw);
    assert_eq!(args.mountpoint, PathBuf::from("/trikfs"));
}

#[test]
fn what_the_guardian_passes_on_means_the_same() {
    let args = mount_args(&[
        "mount",
        "--config=-odd name.lua",
        "--include=--x",
        "--config-group=7",
        "--group=8",
        "--no-sample-bus",
        "--cache=c",
        "m",
    ]);
    let plain = mount_args(&["mount", "m"]);
    for tree in [args.tree, plain.tree] {
        let mut line = vec![OsString::from("trikfs"), "mount".into()];
        line.extend(tree.to_arguments());
        line.extend(["--".into(), "-m".into()]);
        match Cli::try_parse_from(line).map(|cli| cli.command) {
            Ok(Command::Mount(again)) => assert_eq!(again.tree, tree),
            _ => panic!("not understood: {tree:?}"),
        }
    }
}

#[test]
fn paths_are_made_absolute_once() {
    let tree = mount_args(&["mount", "--config=r.lua", "--include=/i", "--cache=c", "m"])
        .tree
        .absolute()
        .expect("absolute");
    let here = std::env::current_dir().expect("a directory");
    assert_eq!(tree.config, Some(here.join("r.lua")));
    assert_eq!(tree.search.include, [PathBuf::from("/i")]);
    assert_eq!(tree.clone().absolute().expect("absolute"), tree);
}

#[test]
fn what_is_not_understood_exits_with_2_and_help_with_0() {
    let code = |line: &[&str]| parse(line).err().map(|error| error.exit_code());
    assert_eq!(code(&["mount"]), Some(2));
    assert_eq!(
        code(&["mount", "--transport", "carrier-pigeon", "m"]),
        Some(2)
    );
    assert_eq!(
        code(&["mount", "--config-group", "no such group", "m"]),
        Some(2)
    );
    assert_eq!(code(&["fly"]), Some(2));
    assert_eq!(code(&[]), Some(2));
    assert_eq!(code(&["--help"]), Some(0));
    assert_eq!(code(&["--version"]), Some(0));
}

#[test]
fn the_help_shows_every_command_but_serve_and_how_to_begin() {
    let help = parse(&["--help"])
        .err()
        .map(|error| (error.kind(), error.to_string()));
    let Some((ErrorKind::DisplayHelp, help)) = help else {
        panic!("no help")
    };
    for word in ["Examples:", "Exit status:"] {
        assert!(help.contains(word), "{word} is missing:\n{help}");
    }
    let mut count = 0;
    for one in Cli::command().get_subcommands() {
        let line = format!("\n  {} ", one.get_name());
        assert_eq!(
            help.contains(&line),
            !one.is_hide_set(),
            "{line}, in:\n{help}"
        );
        count += 1;
    }
    assert!(count > 6, "{help}");
    assert!(!help.contains("serve  "), "{help}");
}

#[test]
fn every_command_that_is_shown_is_documented_and_has_a_page_in_the_package() {
    let document = include_str!("../../../docs/user/cli.md");
    let package = include_str!("../../../cross/install/test/deb.sh");
    for one in Cli::command().get_subcommands() {
        let name = one.get_name();
        if !one.is_hide_set() {
            assert!(document.contains(&format!("| `trikfs {name} ")), "{name}");
            assert!(package.contains(&format!(" trikfs-{name} ")), "{name}");
        }
    }
}

#[test]
fn a_group_is_a_name_or_a_number() {
    assert_eq!(group_id("0"), Ok(0));
    assert_eq!(group_id("root"), Ok(0));
    assert_eq!(
        group_id("no such group"),
        Err("there is no such group".to_owned())
    );
}
