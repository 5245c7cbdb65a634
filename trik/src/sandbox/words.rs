//! What is told of layers of the sandbox that are missing, in English and Russian.

use super::layer::{Layer, Missing};
use lang_text::problem::{Locale, Words};

/// A line for each missing layer: what it is, what follows, what to do.
pub(crate) fn lacks(missing: &Missing, is_root: bool, locale: Locale) -> Vec<String> {
    let lines = missing.layers.iter().map(|layer| {
        let words = lack(*layer, is_root);
        let place = missing.place.as_ref().filter(|_| *layer == Layer::Mounts);
        let [place, place_ru] = place.map_or_else(Default::default, |place| {
            let place = place.display();
            [format!(" (here: {place})"), format!(" (здесь: {place})")]
        });
        let words = Words::new(
            format!(
                "solutions in Python run without a layer of their sandbox: {}{place}",
                words.in_locale(Locale::English)
            ),
            format!(
                "решения на Python запускаются без слоя песочницы: {}{place_ru}",
                words.in_locale(Locale::Russian)
            ),
        );
        words.in_locale(locale).to_owned()
    });
    lines.collect()
}

/// The head of the lines, where `--require-sandbox` was given.
pub(crate) fn required(locale: Locale) -> String {
    let words = Words::new(
        "nothing was run, because --require-sandbox demands all layers",
        "ничего не запущено: --require-sandbox требует все слои",
    );
    words.in_locale(locale).to_owned()
}

/// What a program is told that is not started.
pub(super) fn refused(missing: &[Layer]) -> String {
    let names: Vec<_> = missing.iter().map(|layer| layer.name()).collect();
    format!(
        "--require-sandbox demands layers that are missing: {}",
        names.join(", ")
    )
}

fn lack(layer: Layer, is_root: bool) -> Words {
    match layer {
        Layer::User if is_root => Words::new(
            "user: their folder, or Python, can be read by root alone, so they run as root, without its rights; let everybody read them (chmod o+rX, also of the folders above), or run trik as a user that is not root",
            "user: их папку или Python может читать только root, и они работают под root без его прав; разрешите чтение всем (chmod o+rX, и для папок выше) или запускайте trik не под root",
        ),
        Layer::User => Words::new(
            "user: this kernel gives no namespace of users, so the layers that need one may be missing too, and their processes count with yours; allow it (sysctl user.max_user_namespaces, kernel.apparmor_restrict_unprivileged_userns=0): they run as your user even then; only if trik runs as root they become nobody",
            "user: ядро не даёт пространства имён пользователей, поэтому могут отсутствовать и слои, которым оно нужно, а их процессы считаются вместе с вашими; разрешите его (sysctl user.max_user_namespaces, kernel.apparmor_restrict_unprivileged_userns=0): они и тогда работают под вашим пользователем; станут nobody, только если trik запускает root",
        ),
        Layer::Processes => Words::new(
            "processes: without a namespace they see other processes, and what they start may outlive them for a moment; allow namespaces (in a container --cap-add SYS_ADMIN, or a seccomp profile that lets unshare pass)",
            "processes: без пространства имён они видят другие процессы, а запущенное ими может ненадолго пережить их; разрешите пространства имён (в контейнере --cap-add SYS_ADMIN или профиль seccomp, пропускающий unshare)",
        ),
        Layer::Mounts => Words::new(
            "mounts: without a namespace they see /proc and /sys of the computer, have no scratch folder, and nothing but `files` and their user keeps them from writing; allow namespaces, and in a container a /proc without masks (--security-opt systempaths=unconfined); if namespaces are there, a folder could not be made read-only, or they lack only the scratch folder, because there is no /dev/shm or the solutions are in it",
            "mounts: без пространства имён они видят /proc и /sys компьютера, у них нет временной папки, и писать им мешают только `files` и права их пользователя; разрешите пространства имён, а в контейнере /proc без масок (--security-opt systempaths=unconfined); если пространства имён есть, какую-то папку не удалось открыть только для чтения или нет только временной папки: нет /dev/shm, или решения лежат в ней",
        ),
        Layer::Network => Words::new(
            "network: without a namespace only the filter of calls keeps them from the network; allow namespaces, or run trik where there is no network",
            "network: без пространства имён от сети их отделяет только фильтр вызовов; разрешите пространства имён или запускайте trik там, где нет сети",
        ),
        Layer::Messages => Words::new(
            "messages: without a namespace they see shared memory of the computer; allow namespaces",
            "messages: без пространства имён они видят разделяемую память компьютера; разрешите пространства имён",
        ),
        Layer::Calls => Words::new(
            "calls: this kernel filters no system calls, so ptrace, mounts and sockets are kept from them by other layers alone; it needs CONFIG_SECCOMP_FILTER (Linux 3.5), on x86-64 or arm64",
            "calls: ядро не фильтрует системные вызовы, и от ptrace, монтирования и сокетов защищают только другие слои; нужен CONFIG_SECCOMP_FILTER (Linux 3.5) на x86-64 или arm64",
        ),
        Layer::Files => Words::new(
            "files: this kernel has no Landlock, so they read what their user may, and `mounts` alone keeps them from writing it; it needs Linux 5.13 with landlock among its modules (lsm=landlock,... at boot)",
            "files: в ядре нет Landlock, и они читают всё, что может их пользователь, а писать им мешает только `mounts`; нужен Linux 5.13 с модулем landlock (lsm=landlock,... при загрузке)",
        ),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn alone(layer: Layer) -> Missing {
        Missing {
            layers: vec![layer],
            place: None,
        }
    }

    #[test]
    fn the_place_that_is_not_as_it_should_be_is_named() {
        let missing = Missing {
            layers: vec![Layer::Mounts, Layer::Files],
            place: Some("/dev/shm".into()),
        };
        let lines = lacks(&missing, true, Locale::English);
        assert!(lines[0].ends_with(" (here: /dev/shm)"), "{lines:?}");
        assert!(!lines[1].contains("/dev/shm"), "{lines:?}");
    }

    #[test]
    fn each_layer_is_named_with_what_to_do() {
        for locale in [Locale::English, Locale::Russian] {
            for (layer, is_root) in Layer::ALL
                .map(|layer| (layer, true))
                .into_iter()
                .chain([(Layer::User, false)])
            {
                let lines = lacks(&alone(layer), is_root, locale);
                let start = format!(": {}: ", layer.name());
                assert!(
                    lines[0].contains(&start) && lines[0].contains("; "),
                    "{lines:?}"
                );
            }
        }
        assert_ne!(
            lacks(&alone(Layer::User), true, Locale::English),
            lacks(&alone(Layer::User), false, Locale::English)
        );
        assert!(refused(&[Layer::Files, Layer::User]).ends_with("files, user"));
    }
}
