//! Where in a text what is wrong with a program is.

use super::super::{Places, read};
use crate::check::check;
use lang_text::problem::Locale;

#[test]
fn what_is_wrong_has_the_place_where_it_stands_in_the_text() {
    let text = "\u{feff}# A sign of three bytes is before it, and signs of two are in it.
diagram \"Main\"
  a: Sensor(VarName = sensorA1)
  f: \"Text programming\"(
    IO0 = `s = '\u{43f}';
      '\u{43f}' + I0`,
    IO1 = \"I0 +\",
  )
  w: \"Wait and send\"(
    time =
      0, keep = true)
  s: Say
  a.OUT -> f.I0
  f.O0 -> s.CF_IN
  a.OUT -> p.COORDS
  p: \"Draw pixel\"
  v: Variable(variable = k) named \"A stop\"
  v.OUT -> nowhere

subprogram \"Lonely\"
  k: Led(ledColor = pink)
";
    for text in [text, &text.replace("  v.OUT -> nowhere\n", "")] {
        let project = read(text).expect("a program");
        let problems = check(&project).problems;
        let places = Places::of(text, &project).locate(&problems);
        let lines = problems.iter().zip(places).map(|(problem, at)| {
            let at = at.map_or("?".to_owned(), |at| format!("{}:{}", at.line, at.column));
            format!("{at} {}\n", problem.in_locale(Locale::English))
        });
        let lines: String = lines.collect();
        match text.contains("nowhere") {
            true => assert!(lines.starts_with("18:3 Main: "), "{lines}"),
            false => insta::assert_snapshot!("places", lines),
        }
    }
}
