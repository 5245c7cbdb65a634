//! Solutions in Python that want to write where there is no Landlock to refuse it.

use super::{TRIES, board, check, is_whole, trik};
use std::fs;
use std::os::unix::fs::PermissionsExt;

#[test]
fn a_solution_writes_nothing_but_its_scratch_folder_without_landlock_too() {
    let board = board();
    if !is_whole(&board) {
        return;
    }
    board.file("class/beside.txt", "beside");
    for (name, mode) in [("class", 0o777), ("class/beside.txt", 0o666)] {
        let mode = fs::Permissions::from_mode(mode);
        fs::set_permissions(board.path(name), mode).expect("its mode");
    }
    let program = format!(
        "{TRIES}
import tempfile
for deed in (
    lambda: open('class/new.txt', 'w'),
    lambda: open('class/beside.txt', 'a'),
    lambda: os.remove('class/beside.txt'),
    lambda: os.rename('class/beside.txt', 'class/other.txt'),
    lambda: os.link('class/beside.txt', 'class/other.txt'),
    lambda: os.mkdir('class/folder'),
    lambda: open('/tmp/trik-was-here', 'w'),
    lambda: open('/var/tmp/trik-was-here', 'w'),
):
    print(number(deed))
places = {{}}
for line in open('/proc/self/mountinfo'):
    place, options = line.split()[4:6]
    places[place] = options.split(',')
# What is below /proc of the computer is covered by one of its own.
print([place for place in places if 'ro' not in places[place] and not place.startswith('/proc/')])
with tempfile.TemporaryFile() as file: print(file.write(b'scratch'))
print(open(os.devnull, 'r+').write('x'))
"
    );
    let output = check(&board, &program, &["--without-layer=files"]);
    let lines = output.stdout.lines();
    let told: Vec<_> = lines
        .filter_map(|line| line.strip_prefix("print: "))
        .collect();
    // EROFS.
    let wanted = [["30"; 8].as_slice(), &["['/dev/shm']", "7", "1"]].concat();
    assert_eq!(told, wanted, "{}{}", output.stdout, output.stderr);
    let beside = fs::read_to_string(board.path("class/beside.txt"));
    assert_eq!(beside.expect("a file"), "beside");
}

#[test]
fn a_solution_in_the_folder_of_scratch_files_is_told_where_something_is_missing() {
    let board = board();
    if !is_whole(&board) {
        return;
    }
    let folder = tempfile::tempdir_in("/dev/shm").expect("a folder");
    let everybody = fs::Permissions::from_mode(0o755);
    fs::set_permissions(folder.path(), everybody).expect("its mode");
    let program = folder.path().join("a.py");
    fs::write(&program, "print(1)").expect("a program");
    let program = program.to_str().expect("a name");
    let output = trik(&board, &["check", program, "--field", "far.xml"]);
    let line = "trik: solutions in Python run without a layer of their sandbox: mounts: ";
    assert!(
        output.stderr.starts_with(line) && output.stderr.ends_with(" (here: /dev/shm)\n"),
        "{}",
        output.stderr
    );
}
