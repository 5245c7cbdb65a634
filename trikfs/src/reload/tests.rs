//! What a reload does about defects of our own.

use super::*;
use crate::scratch::Scratch;

fn reloader(scratch: &Scratch) -> Arc<Reloader> {
    let engine = Engine::start().expect("threads");
    let owner = Owner {
        uid: 0,
        gid: 0,
        config_group: None,
        group: None,
    };
    let mut last_ino = crate::tree::ROOT;
    let tree = Tree::build(Vec::new(), &[], owner, None, &mut last_ino);
    let setup = Setup {
        engine,
        forest: Arc::new(Forest::new(tree)),
        files: Arc::default(),
        loader: Loader::default(),
        base_dir: None,
        cache: scratch.cache(),
        promised: CopyNames::new(),
        owner,
        last_ino,
        ledger: None,
    };
    Reloader::start(setup).expect("a thread")
}

#[test]
fn a_panic_over_a_configuration_is_a_verdict_and_the_next_one_is_applied() {
    let scratch = Scratch::new();
    let reloader = reloader(&scratch);
    // The compiler is told of before it starts, and that is where a panic can be put.
    let inline = "trikfs = { n = { src = '/dev/zero', input_tuple_size = 1, output_tuple_size = 1,
        converter = { code = 'int converter(int i, char *a, int o, char *b) { b[0] = a[0]; return i != o; }' } } }";
    let panicking = |_: &str| panic!("on purpose");
    let problem = reloader
        .apply("robot.lua", inline.into(), &panicking)
        .expect_err("a verdict");
    assert!(problem.to_string().contains("has a defect"), "{problem}");
    assert!(reloader.result_line().contains("has a defect"));
    let good = b"trikfs = { n = { src = '/dev/zero', input_tuple_size = 1 } }";
    assert_eq!(reloader.apply("robot.lua", good.to_vec(), &|_| {}), Ok(1));
    assert_eq!(reloader.result_line(), "config ok: 1 node");
}
