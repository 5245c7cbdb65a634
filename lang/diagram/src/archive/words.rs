//! What can be wrong with a container, in words.

use crate::limits;
use lang_text::problem::Words;

pub(super) fn empty() -> Words {
    Words::new(
        "the file is empty: save the project again in TRIK Studio",
        "файл пуст: сохраните проект в TRIK Studio ещё раз",
    )
}

pub(super) fn no_save() -> Words {
    Words::new(
        "this is not a project of TRIK Studio (.qrs): it is neither a zip nor a save of an old version",
        "это не проект TRIK Studio (.qrs): ни zip-архив, ни сохранение старой версии",
    )
}

pub(super) fn too_large(bytes: usize) -> Words {
    let limit = limits::SAVE_BYTES >> 20;
    Words::new(
        format!("{bytes} bytes are too large for a project, which may have {limit} MiB"),
        format!("{bytes} байт слишком много для проекта, в котором может быть {limit} МиБ"),
    )
}

pub(super) fn too_many() -> Words {
    Words::new(
        format!(
            "a save may have {} files, this one has more",
            limits::ENTRIES
        ),
        format!(
            "в сохранении может быть {} файлов, здесь больше",
            limits::ENTRIES
        ),
    )
}

pub(super) fn bomb() -> Words {
    let (one, all) = (limits::ENTRY_BYTES >> 20, limits::SAVE_UNPACKED_BYTES >> 20);
    Words::new(
        format!("unpacked it is too large: a file may have {one} MiB, all together {all} MiB"),
        format!(
            "после распаковки слишком велик: в файле может быть {one} МиБ, во всех вместе {all} МиБ"
        ),
    )
}

pub(super) fn overlaps() -> Words {
    Words::new(
        "the files in this zip lie over each other: it was not made by TRIK Studio",
        "файлы в этом zip-архиве наложены друг на друга: его сделал не TRIK Studio",
    )
}

pub(super) fn twice() -> Words {
    Words::new(
        "it is in the save twice, the later one is taken",
        "он есть в сохранении дважды, взят последний",
    )
}

pub(super) fn leads_out() -> Words {
    Words::new(
        "its name leads out of the save, so it is left out",
        "его имя выводит за пределы сохранения, поэтому он пропущен",
    )
}

pub(super) fn damaged() -> Words {
    Words::new(
        "it is damaged: its bytes do not fit their checksum or length; take another copy of the project",
        "он повреждён: содержимое не сходится с контрольной суммой или длиной; возьмите другую копию проекта",
    )
}

pub(super) fn damaged_at(at: usize) -> Words {
    Words::new(
        format!("the save is damaged at byte {at}; take another copy of the project"),
        format!("сохранение повреждено в байте {at}; возьмите другую копию проекта"),
    )
}

pub(super) fn cut_at(at: usize, length: usize) -> Words {
    Words::new(
        format!(
            "the save is cut short: the record at byte {at} goes on after the end at {length}; take another copy of the project"
        ),
        format!(
            "сохранение обрезано: запись в байте {at} продолжается за концом файла ({length}); возьмите другую копию проекта"
        ),
    )
}

pub(super) fn zip_damaged() -> Words {
    Words::new(
        "the zip is cut short or its list of files is damaged; take another copy of the project",
        "zip-архив обрезан или список файлов в нём повреждён; возьмите другую копию проекта",
    )
}

pub(super) fn extensions_64() -> Words {
    Words::new(
        "the zip has 64-bit extensions, which no save needs: it was not made by TRIK Studio",
        "в zip-архиве 64-битные расширения, не нужные ни одному сохранению: его сделал не TRIK Studio",
    )
}

pub(super) fn some_twice() -> Words {
    Words::new(
        "some files are in the save twice, the later ones are taken",
        "некоторые файлы есть в сохранении дважды, взяты последние",
    )
}

pub(super) fn not_packed() -> Words {
    Words::new(
        "it cannot be packed: its name is too long or is there twice",
        "его нельзя упаковать: имя слишком длинное или повторяется",
    )
}

pub(super) fn encrypted() -> Words {
    Words::new(
        "it is encrypted: save the project without a password",
        "он зашифрован: сохраните проект без пароля",
    )
}

pub(super) fn method(number: u16) -> Words {
    Words::new(
        format!("it is packed by method {number}, but saves are only stored (0) or deflated (8)"),
        format!(
            "он сжат методом {number}, а в сохранениях бывает только без сжатия (0) или deflate (8)"
        ),
    )
}
