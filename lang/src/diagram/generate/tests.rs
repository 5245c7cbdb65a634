//! Tests of names and of small programs in all languages.

use super::names::{Names, Rules};

#[test]
fn names_are_what_the_language_allows() {
    let rules = Rules {
        cyrillic: false,
        caseless: true,
        reserved: &["if"],
    };
    let mut names = Names::new(rules);
    assert_eq!(names.take("if"), "if_2");
    assert_eq!(names.take("IF"), "IF_3");
    assert_eq!(names.take("\u{414}\u{430} 1"), "Da_1");
    assert_eq!(names.take("7;\n--"), "_7____");
    assert_eq!(names.take(""), "_");
}
