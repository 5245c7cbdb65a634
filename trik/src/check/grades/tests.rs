//! Points, sums and marks of a small class.

use super::*;

fn column(task: &str, weight: f64) -> Column {
    Column {
        task: task.into(),
        field: None,
        weight,
    }
}

fn row(verdict: Verdict, score: f64, message: &str) -> Row {
    Row {
        verdict,
        total_score: Some(score),
        messages: vec![("info".into(), message.into())],
        ..Row::broken("x.qrs".into(), None, String::new())
    }
}

fn grades(source: Source, rows: &[(usize, usize, Row)]) -> Grades {
    let plan = Plan {
        pupils: vec!["anna".into(), "=1+1".into()],
        columns: vec![column("line", 2.0), column("maze", 0.1)],
        places: rows.iter().map(|row| (row.0, row.1)).collect(),
        ..Plan::default()
    };
    let args = GradeArgs {
        points: source,
        pass_mark: Some(4.0),
        ..GradeArgs::default()
    };
    let mut grades = Grades::new(plan, &args, Locale::English);
    for (index, (_, _, row)) in rows.iter().enumerate() {
        grades.add(index, row, None);
    }
    grades.settle();
    grades
}

#[test]
fn a_column_with_points_counts_them_and_one_without_counts_what_is_accomplished() {
    let rows = [
        (0, 0, row(Verdict::Accomplished, 0.0, "well")),
        (0, 1, row(Verdict::Wrong, 0.0, "points: 30")),
        (1, 0, row(Verdict::Wrong, 0.0, "7 of 9")),
        (1, 1, row(Verdict::Accomplished, 0.0, "well")),
    ];
    let points = |source| {
        let grades = grades(source, &rows);
        let cells = [(0, 0), (0, 1), (1, 0), (1, 1)];
        cells.map(|(pupil, column)| grades.cell(pupil, column).and_then(|run| run.points))
    };
    let some = |all: [f64; 4]| all.map(Some);
    assert_eq!(points(Source::Auto), some([1.0, 30.0, 0.0, 0.0]));
    assert_eq!(points(Source::TotalScore), some([0.0; 4]));
    assert_eq!(points(Source::Words), some([0.0, 30.0, 0.0, 0.0]));
    assert_eq!(points(Source::LastNumber), some([0.0, 30.0, 9.0, 0.0]));
    assert_eq!(points(Source::Accomplished), some([1.0, 0.0, 0.0, 1.0]));
    let grades = grades(Source::Auto, &rows);
    assert_eq!((grades.sum(0), grades.has_passed(0)), (5.0, Some(true)));
    assert_eq!((grades.sum(1), grades.has_passed(1)), (0.0, Some(false)));
}

#[test]
fn the_best_of_several_counts_and_what_was_not_judged_has_no_points() {
    let rows = [
        (0, 0, row(Verdict::Structure, 0.0, "")),
        (0, 0, row(Verdict::Wrong, 3.0, "")),
        (0, 0, row(Verdict::ModelTime, 3.0, "")),
        (1, 0, row(Verdict::NotRun, 9.0, "")),
    ];
    let grades = grades(Source::Auto, &rows);
    let found = grades.cell(0, 0).map(|run| (run.verdict, run.points));
    assert_eq!(found, Some((Verdict::Wrong, Some(3.0))));
    let found = grades.cell(1, 0).map(|run| (run.verdict, run.points));
    assert_eq!(found, Some((Verdict::NotRun, None)));
    assert_eq!(
        csv::write(&grades),
        "\u{feff}pupil,line,line: result,maze,maze: result,sum,passed\r\n\
         anna,3,not accomplished,,missing,6,yes\r\n\
         \"'=1+1\",,could not be run,,missing,0,no\r\n"
    );
    let page = html::write(&grades, Path::new("x.html"));
    assert!(page.contains("<th>=1+1</th>") && page.contains("<small>missing</small>"));
}

#[test]
fn a_table_that_fills_in_any_order_is_the_one_of_the_end() {
    let rows = [
        (0, 0, row(Verdict::Wrong, 0.0, "well")),
        (0, 0, row(Verdict::Accomplished, 0.0, "well")),
        (1, 0, row(Verdict::Accomplished, 0.0, "points: 30")),
        (1, 1, row(Verdict::NotRun, 0.0, "")),
    ];
    let whole = grades(Source::Auto, &rows);
    let mut filling = Grades {
        runs: Vec::new(),
        ..whole.clone()
    };
    filling.pointed.clear();
    let mut waiting = filling.runs_of_cells();
    assert_eq!(waiting, [2, 0, 1, 1]);
    let mut changes = Vec::new();
    for index in [1, 0, 3, 2] {
        filling.add(index, &rows[index].2, None);
        changes.push(filling.settle());
        let (_, cell) = filling.place(index).expect("a place");
        waiting[cell] -= 1;
        if index == 1 {
            // What has no points yet counts what is accomplished.
            let row = filling.shown(0, &waiting);
            assert_eq!((row.sum, row.passed), (2.0, Some(false)));
            assert_eq!(row.cells[0].waiting, 1);
            assert_eq!(row.cells[0].mark.as_ref().map(|mark| mark.run), Some(1));
        }
    }
    // Only the points that came last have changed other cells.
    assert_eq!(changes, [false, false, false, true]);
    assert_eq!(csv::write(&filling), csv::write(&whole));
    let row = filling.shown(0, &waiting);
    assert_eq!((row.sum, row.cells[0].waiting), (0.0, 0));
    let mark = filling
        .shown(1, &waiting)
        .cells
        .remove(1)
        .mark
        .expect("a mark");
    assert_eq!((mark.points, mark.ms), (None, None));
    assert_eq!(mark.verdict.english, "could not be run");
}
