//! Where included files, shared libraries and compiled code are looked for.
//!
//! Owns the order. Opens nothing but directories, to see whether they are there.

use crate::check::SearchPaths;
use crate::convert::shared::{Cache, CacheError};
use crate::failure::Failure;
use std::path::{Path, PathBuf};

/// The search path of this run: `include` in front of the usual places, which depend on where this program is:
/// `../share/trikfs/lua` and `../lib/trikfs` beside its own directory, that directory itself, then /usr.
/// A program in the build directory it was made in also finds the source tree.
///
/// # Errors
/// The cache directory cannot be used.
pub(crate) fn search_paths(
    include: Vec<PathBuf>,
    cache_dir: Option<&Path>,
    device_root: Option<PathBuf>,
) -> Result<SearchPaths, CacheError> {
    let program = std::env::current_exe().ok();
    let dirs = Dirs::beside(program.as_deref().and_then(Path::parent), include);
    Ok(SearchPaths {
        include_dirs: dirs.include,
        library_dirs: dirs.library,
        cache: Cache::open(cache_dir)?,
        device_root,
    })
}

/// The file that a configuration would get with `include`, for a program that has this crate in it.
///
/// # Errors
/// No directory of the search path has it.
pub fn find_shipped(name: &Path, include: Vec<PathBuf>) -> Result<PathBuf, Failure> {
    let program = std::env::current_exe().ok();
    let dirs = Dirs::beside(program.as_deref().and_then(Path::parent), include).include;
    let found = dirs.iter().map(|dir| dir.join(name));
    found.clone().find(|path| path.is_file()).ok_or_else(|| {
        let dirs: Vec<_> = dirs.iter().map(|dir| dir.display().to_string()).collect();
        Failure::Refused(format!(
            "there is no {} in {}",
            name.display(),
            dirs.join(", ")
        ))
    })
}

/// Directories in the order in which they are searched.
struct Dirs {
    /// For `include` and `replay`; the first that has the name wins.
    include: Vec<PathBuf>,
    /// For shared libraries, after the directory of the configuration file.
    library: Vec<PathBuf>,
}

impl Dirs {
    fn beside(program_dir: Option<&Path>, include: Vec<PathBuf>) -> Self {
        let prefix = program_dir.and_then(Path::parent);
        let mut include_dirs = include;
        include_dirs.push("/etc/trikfs".into());
        include_dirs.extend(prefix.map(|prefix| prefix.join("share/trikfs/lua")));
        include_dirs.push("/usr/share/trikfs/lua".into());
        let mut library_dirs: Vec<PathBuf> = prefix
            .map(|prefix| prefix.join("lib/trikfs"))
            .into_iter()
            .collect();
        library_dirs.extend(["/usr/lib/trikfs", "/usr/local/lib/trikfs"].map(PathBuf::from));
        if let Some(dir) = program_dir {
            library_dirs.push(dir.to_owned());
            if let Some(build) = Build::of(dir) {
                // Where cargo leaves the libraries of dependencies, and where the build script leaves its own.
                library_dirs.extend([
                    build.profile_dir.join("deps"),
                    build.profile_dir.clone(),
                    build.out_dir,
                ]);
                include_dirs.push(build.lua_dir);
            }
        }
        Self {
            include: without_repeats(include_dirs),
            library: without_repeats(library_dirs),
        }
    }
}

/// Facts of the build, which hold only on the machine and in the directory where it was made.
struct Build {
    profile_dir: PathBuf,
    out_dir: PathBuf,
    lua_dir: PathBuf,
}

impl Build {
    /// Nothing for an installed program: what somebody puts where it once was built must not reach it.
    fn of(program_dir: &Path) -> Option<Self> {
        let out_dir = Path::new(env!("OUT_DIR"));
        // PROFILE/build/trikfs-HASH/out
        let profile_dir = out_dir.ancestors().nth(3)?;
        let workspace = Path::new(env!("CARGO_MANIFEST_DIR")).parent()?;
        program_dir.starts_with(profile_dir).then(|| Self {
            profile_dir: profile_dir.to_owned(),
            out_dir: out_dir.to_owned(),
            lua_dir: workspace.join("config/lua"),
        })
    }
}

fn without_repeats(mut dirs: Vec<PathBuf>) -> Vec<PathBuf> {
    let mut seen = std::collections::HashSet::new();
    dirs.retain(|dir| seen.insert(dir.clone()));
    dirs
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_installed_program_looks_beside_itself_and_in_usr() {
        let dirs = Dirs::beside(
            Some(Path::new("/opt/robot/bin")),
            vec!["/home/me/robot".into()],
        );
        let expected = [
            "/home/me/robot",
            "/etc/trikfs",
            "/opt/robot/share/trikfs/lua",
            "/usr/share/trikfs/lua",
        ];
        assert_eq!(dirs.include, expected.map(PathBuf::from));
        let expected = [
            "/opt/robot/lib/trikfs",
            "/usr/lib/trikfs",
            "/usr/local/lib/trikfs",
            "/opt/robot/bin",
        ];
        assert_eq!(dirs.library, expected.map(PathBuf::from));
    }

    #[test]
    fn a_program_in_usr_bin_names_no_directory_twice() {
        let dirs = Dirs::beside(Some(Path::new("/usr/bin")), vec![]);
        assert_eq!(
            dirs.include,
            ["/etc/trikfs", "/usr/share/trikfs/lua"].map(PathBuf::from)
        );
        assert_eq!(
            dirs.library,
            ["/usr/lib/trikfs", "/usr/local/lib/trikfs", "/usr/bin"].map(PathBuf::from)
        );
    }

    #[test]
    fn a_shipped_file_is_found_or_the_places_are_named() {
        let found = find_shipped(Path::new("hello.lua"), vec!["/here".into()]).expect("found");
        assert!(
            found.is_absolute() && found.ends_with("hello.lua"),
            "{found:?}"
        );
        let refusal = find_shipped(Path::new("none.lua"), vec!["/here".into()]).expect_err("none");
        let refusal = refusal.to_string();
        assert!(
            refusal.starts_with("there is no none.lua in /here, /etc/trikfs, "),
            "{refusal}"
        );
    }

    #[test]
    fn a_program_in_its_build_directory_finds_the_source_tree() {
        let program = std::env::current_exe().expect("a program");
        let dirs = Dirs::beside(program.parent(), vec![]);
        assert!(
            dirs.include
                .iter()
                .any(|dir| dir.join("hello.lua").is_file()),
            "{:?}",
            dirs.include
        );
        assert!(
            dirs.library
                .iter()
                .any(|dir| dir.join("libhello.so").is_file()),
            "{:?}",
            dirs.library
        );
    }
}
