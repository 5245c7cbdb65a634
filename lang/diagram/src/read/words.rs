//! What can be wrong with a save as a whole, in words.

use lang_text::problem::Words;

pub(super) fn no_root() -> Words {
    Words::new(
        "the save has no root object (tree/logical/ROOT_ID/...), so nothing says which diagrams there are; save the project again in TRIK Studio",
        "в сохранении нет корневого объекта (tree/logical/ROOT_ID/...), поэтому неизвестно, какие в нём диаграммы; сохраните проект в TRIK Studio ещё раз",
    )
}

pub(super) fn no_text() -> Words {
    Words::new("it is not text in UTF-8", "это не текст в UTF-8")
}

pub(super) fn no_meta() -> Words {
    Words::new(
        "it is missing, so version and kit of the project are not known",
        "его нет, поэтому неизвестны версия и конструктор проекта",
    )
}

pub(super) fn more_problems(rest: usize) -> Words {
    Words::new(
        format!("and at least {rest} problems more"),
        format!("и ещё проблем, не меньше: {rest}"),
    )
}

pub(super) fn same_id() -> Words {
    Words::new(
        "another object of the save has the same id; this one is left out",
        "у другого объекта сохранения тот же идентификатор; этот пропущен",
    )
}

pub(super) fn no_diagram(element: &str) -> Words {
    Words::new(
        format!("'{element}' is no diagram of this language and is left out"),
        format!("'{element}' не диаграмма этого языка и пропущена"),
    )
}

pub(super) fn no_logical() -> Words {
    Words::new(
        "its logical object is missing, so its properties are not known: delete the block and draw it again",
        "её логического объекта нет, поэтому свойства неизвестны: удалите блок и поставьте заново",
    )
}

pub(super) fn not_graphical() -> Words {
    Words::new(
        "the diagram lists a logical object instead of a graphical one; it is left out",
        "в диаграмме на месте графического объекта логический; он пропущен",
    )
}

pub(super) fn in_two_diagrams() -> Words {
    Words::new(
        "it is listed twice; the first place counts",
        "он указан дважды; считается первое место",
    )
}

pub(super) fn lost_child(element: &str) -> Words {
    Words::new(
        format!("the diagram lists this {element}, but its file is not in the save"),
        format!("диаграмма называет этот {element}, но файла нет в сохранении"),
    )
}

pub(super) fn lost_link() -> Words {
    Words::new(
        "it names a link that is no longer in the diagram; that changes nothing",
        "он называет связь, которой уже нет в диаграмме; это ничего не меняет",
    )
}

pub(super) fn lost_end(element: &str) -> Words {
    Words::new(
        format!(
            "it leads to a block ({element}) that is not in the diagram any more: connect it again"
        ),
        format!(
            "она ведёт к блоку ({element}), которого уже нет в диаграмме: подключите её заново"
        ),
    )
}

pub(super) fn invisible(block: &str) -> Words {
    Words::new(
        format!(
            "the block {block} does not list this link, so it is as if it were not there: draw it again"
        ),
        format!(
            "блок {block} не называет эту связь, поэтому её как будто нет: проведите её заново"
        ),
    )
}

pub(super) fn orphans(blocks: usize, links: usize) -> Words {
    let many = |count: usize, word: &str| match count {
        0 => None,
        1 => Some(format!("1 {word}")),
        _ => Some(format!("{count} {word}s")),
    };
    let lost: Vec<String> = [many(blocks, "block"), many(links, "link")]
        .into_iter()
        .flatten()
        .collect();
    let (are, do_) = match blocks + links {
        1 => ("is", "does"),
        _ => ("are", "do"),
    };
    Words::new(
        format!(
            "{} {are} in the file but on no sheet, and {do_} not run: deleted in the editor, or lost by it",
            lost.join(" and ")
        ),
        format!(
            "в файле, но не на диаграммах: блоков {blocks}, связей {links}; они не выполняются: их удалили в редакторе или он их потерял"
        ),
    )
}
