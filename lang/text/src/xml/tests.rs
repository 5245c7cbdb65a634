//! Documents that are read, refused and written.

use super::*;
use crate::limits;

fn refused(text: &str) -> String {
    parse(text).expect_err("it is refused").to_string()
}

#[test]
fn names_with_colons_and_all_references_are_read() {
    let root = parse("<a><qReal::Id key='x' value=\"&lt;&gt;&amp;&quot;&apos;&#xa;&#65;\"/>t&amp;u<![CDATA[<v>]]></a>").unwrap();
    let id = root.child("qReal::Id").unwrap();
    assert_eq!(id.attribute("value"), Some("<>&\"'\nA"));
    assert_eq!(root.nodes[1], Node::Text("t&u<v>".into()));
}

#[test]
fn space_declarations_and_remarks_stand_anywhere() {
    let text = "\u{feff}<?xml version='1.0'?>\n<!-- a --><a  b = '1'\n c=\"'\" ><d />\n</a >\n<!-- b -->\n";
    let root = parse(text).unwrap();
    assert_eq!(root.attribute("b"), Some("1"));
    assert_eq!(root.attribute("c"), Some("'"));
    assert_eq!(root.nodes.len(), 1);
}

#[test]
fn lines_of_any_system_end_alike_in_values() {
    let root = parse("<a b=\"1\r\n2\n3\r4&#xd;5\"/>").unwrap();
    assert_eq!(root.attribute("b"), Some("1\n2\n3\n4\r5"));
}

#[test]
fn text_of_pieces_is_one_text() {
    let root = parse("<a> \r\n&amp;<![CDATA[ & ]]>b\r<!-- c -->d </a>").unwrap();
    let texts = [
        Node::Text(" \n& & b\n".into()),
        Node::Comment(" c ".into()),
        Node::Text("d ".into()),
    ];
    assert_eq!(root.nodes, texts);
}

#[test]
fn what_is_written_is_read_as_the_same() {
    let text = "<a x=\"&lt;&amp;&quot;&#xa;&#xd;&#x9;\">\n  <!-- why -->\n  <b>text &amp; <c/>more</b>\n  <d/>\n</a>\n";
    let root = parse(text).unwrap();
    let written = write(&root, 2);
    assert_eq!(parse(&written).unwrap(), root);
    assert_eq!(written, text);
}

#[test]
fn hostile_documents_are_refused_with_place_and_reason() {
    let bomb = "<!DOCTYPE a [<!ENTITY b \"bb\"><!ENTITY c \"&b;&b;\">]>\n<a>&c;</a>";
    assert!(refused(bomb).starts_with("1:1 a document type (<!DOCTYPE>) is not read"));
    assert!(refused("<a>\n &c;</a>").contains("'&c' stands for nothing here"));
    assert!(refused("<a b='&c;'/>").contains("'&c' stands for nothing here"));
    assert!(refused("<a b='&'/>").contains("stands for nothing"));
    assert!(refused("<a>1 & 2</a>").starts_with("1:6 '& 2"));
    assert!(refused("<!DOCTYPE a").contains("a document type"));
    assert!(refused("<!DOCTYPE>").contains("a document type"));
    assert!(refused("<a b='&#0;'/>").contains("stands for nothing"));
    assert!(refused("<a b='&#x1f;'/>").contains("stands for nothing"));
    assert!(refused("<a b='&#xd800;'/>").contains("stands for nothing"));
    let deep = "<a>".repeat(limits::XML_DEPTH + 1);
    assert!(refused(&deep).contains("tags are nested deeper than 64"));
    let wide = format!("<a>{}</a>", "<b/>".repeat(limits::XML_TAGS));
    assert!(refused(&wide).contains("more than 100000 tags"));
    let attributes: String = (0..=limits::XML_ATTRIBUTES)
        .map(|at| format!(" a{at}=''"))
        .collect();
    assert!(refused(&format!("<a{attributes}/>")).contains("more than 64 attributes"));
    assert!(refused("<a b='1' b='2'/>").contains("'b' is there twice"));
    assert!(refused("<a><b>\n</a>").starts_with("2:1 </a> stands where </b> should"));
    assert!(refused("</a>").contains("did not begin"));
    assert!(refused("<a/></a>").contains("did not begin"));
    for strange in ["<>", "< a/>", "<a/b>", "<a =''/>", "<!a/>", "<a></a b>"] {
        let reason = refused(strange);
        assert!(reason.contains("this is not XML"), "{strange}: {reason}");
    }
    for bare in ["<a b/>", "<a b=1/>", "<a b>"] {
        assert!(
            refused(bare).contains("'b' needs a value in quotes"),
            "{bare}"
        );
    }
    assert!(refused("<a b='<'/>").contains("write &lt;"));
    for cut in [
        "<",
        "<a",
        "<a ",
        "<a b",
        "<a b=",
        "<a b='",
        "<a b='1",
        "<a b='1'",
        "</",
        "<!--",
        "<![CDATA[",
        "<?x",
    ] {
        refused(cut);
    }
    assert!(refused("<a>").contains("cut short"));
    assert!(refused("").contains("cut short"));
    assert!(refused("<a/><b/>").contains("second document"));
    assert!(refused("<a/>b").contains("outside"));
    assert!(refused("\u{440}\n<a/>").contains("outside"));
}

#[test]
fn values_are_found_changed_and_taken() {
    let mut root = parse("<a b='1' c='2'><d/><e f='3'/></a>").unwrap();
    root.set("b", "4");
    root.set("g", "5");
    assert_eq!(root.take("c").as_deref(), Some("2"));
    root.child_mut("e").set("f", "6");
    root.child_mut("h");
    assert_eq!(
        write(&root, 0),
        "<a b=\"4\" g=\"5\">\n<d/>\n<e f=\"6\"/>\n<h/>\n</a>\n"
    );
}
