//! What rules ask a scene for, before any run.

use super::checking::event;
use super::{Stage, rules};
use crate::{Wish, asked};

#[test]
fn all_that_rules_ask_for_is_told_with_its_rule() {
    let condition = r#"<conditions glue="and"><inside objectId="robot1" regionId="finish"/>
<equals><objectState object="robot1.A1.value"/><int value="5"/></equals>
<not><equals><typeOf objectId="robot1.A1"/><string value="undefined"/></equals></not>
<less><variableValue name="total_score"/><int value="5"/></less></conditions>"#;
    let triggers = r#"<message text="%1"><replace var="%1"><objectState object="robot1.display.labels.size"/></replace></message>
<setState object="robot1.led" property="color"><string value="red"/></setState><success/>"#;
    let text = event(
        r#"id="there" settedUpInitially="true""#,
        condition,
        triggers,
    );
    let rules = rules(&text);
    let mut stage = Stage::new();
    for name in ["robot1.A1", "robot1.led", "robot1.display"] {
        stage.add(name, "Part");
    }
    stage.region("finish", 0, 0, 9, 9);
    let found = asked(&rules, &mut stage);
    let told: Vec<(&str, Vec<&str>, Wish)> = found
        .iter()
        .map(|one| {
            let chain = one.chain.iter().map(|part| &**part).collect();
            (&*one.text, chain, one.wish)
        })
        .collect();
    assert_eq!(
        told,
        [
            ("robot1", vec![], Wish::Place),
            ("finish", vec![], Wish::Place),
            ("robot1.A1.value", vec!["value"], Wish::Property),
            (
                "robot1.display.labels.size",
                vec!["labels", "size"],
                Wish::Property
            ),
            ("robot1.led.color", vec!["color"], Wish::Change),
        ]
    );
    assert!(found[0].rule.contains("there"), "{}", found[0].rule);
    // What is nobody's is the business of lint.
    assert_eq!(asked(&rules, &mut Stage::default()), []);
}
