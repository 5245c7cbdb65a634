//! What is told of recordings that rules judge, in English and Russian.

use journal::error::Error;
use lang_text::problem::Words;
use sim::judge::witness::Need;

/// A rule asks for what no recording has.
pub(super) fn simulated(need: &Need) -> Words {
    let Need { rule, text, .. } = need;
    Words::new(
        format!(
            "{rule} asks {text}, which no recording of a robot has: only a simulated run can be judged by it"
        ),
        format!(
            "{rule} спрашивает {text}, но в записях роботов этого нет: так можно судить только запуск в модели"
        ),
    )
}

/// A rule asks for what a node says that is not in the recording.
pub(super) fn no_node(need: &Need, node: &str) -> Words {
    let Need { rule, text, .. } = need;
    Words::new(
        format!(
            "{rule} asks {text}, and the recording has no node {node}, which would say it: record it with --only {node}"
        ),
        format!(
            "{rule} спрашивает {text}, а в записи нет узла {node}, где это было бы: запишите его, указав --only {node}"
        ),
    )
}

/// A node that is asked says nothing in the run.
pub(super) fn silent(need: &Need, node: &str) -> Words {
    let Need { rule, text, .. } = need;
    Words::new(
        format!(
            "{rule} asks {text}, and node {node} says nothing up to the first second of this part of the recording"
        ),
        format!(
            "{rule} спрашивает {text}, а узел {node} молчит до конца первой секунды этой части записи"
        ),
    )
}

/// A rule asks for a place that is not known.
pub(super) fn unplaced(need: &Need, why: &Words) -> Words {
    let Need { rule, text, .. } = need;
    let [english, russian] = [&why.english, &why.russian];
    Words::new(
        format!("{rule} asks where {text} is, and {english}"),
        format!("{rule} спрашивает, где находится {text}, а {russian}"),
    )
}

/// No node has this name that would say the place.
pub(super) fn no_place(node: &str) -> Words {
    Words::new(
        format!("the recording has no node {node}: --pose names the one that has x, y and heading"),
        format!("в записи нет узла {node}: --pose называет узел, где есть x, y и heading"),
    )
}

/// A node is none that says a place.
pub(super) fn no_place_in(node: &str, units: &str) -> Words {
    Words::new(
        format!(
            "node {node} says no place: that takes the numbers x, y and heading (or theta) in units such as 'mm, deg'; its units are '{units}'"
        ),
        format!(
            "узел {node} не сообщает положения: нужны числа x, y и heading или theta в единицах вроде 'mm, deg', а у него '{units}'"
        ),
    )
}

/// The place was lost.
pub(super) fn place_lost(node: &str, seconds: f64, why: &str) -> Words {
    Words::new(
        format!("From {seconds:.2} s on the place of the robot is unknown: {node} failed: {why}"),
        format!("С {seconds:.2} с неизвестно, где был робот: сбой узла {node}: {why}"),
    )
}

/// A node that rules ask has failed.
pub(super) fn failed(node: &str, seconds: f64, why: &str) -> Words {
    Words::new(
        format!(
            "{node} failed at {seconds:.2} s ({why}); its last value counts until the next sample"
        ),
        format!(
            "{node}: сбой в {seconds:.2} с ({why}); до следующего отсчёта считается прежнее значение"
        ),
    )
}

/// The program that is judged has no end in the recording.
pub(super) fn unended() -> Words {
    Words::new(
        "the recording ends before the program does, so what counts at the end of a program is not done",
        "запись кончается раньше программы, поэтому то, что засчитывается в её конце, не выполнено",
    )
}

/// The recording cannot be read on.
pub(super) fn unreadable(why: &Error) -> Words {
    Words::new(
        format!("The recording cannot be judged: {why}"),
        format!("Запись нельзя проверить: {why}"),
    )
}

/// The recording has no such part.
pub(super) fn nothing(seconds: f64) -> Words {
    Words::new(
        format!("the recording has nothing there: it is {seconds:.1} s long"),
        format!("в этой части записи ничего нет: её длина {seconds:.1} с"),
    )
}

/// Several programs ran.
pub(super) fn several(runs: &[(String, f64)]) -> Words {
    let list: Vec<String> = runs
        .iter()
        .map(|(name, seconds)| format!("{name} {seconds:.1}"))
        .collect();
    let list = list.join(", ");
    Words::new(
        format!(
            "several programs were recorded, and the first is judged; they begin at these seconds: {list}; --from and --to choose another part"
        ),
        format!(
            "в записи несколько программ, проверяется первая; они начинаются на секундах: {list}; --from и --to выберут другую часть"
        ),
    )
}

/// Some events are not in it.
pub(super) fn lost(count: u64) -> Words {
    Words::new(
        format!(
            "{count} events are missing in the recording; what rules should have seen may be among them"
        ),
        format!("в записи недостаёт событий: {count}; среди них могло быть и важное для правил"),
    )
}
