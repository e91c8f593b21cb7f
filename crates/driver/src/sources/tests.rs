//! What paths and folders give.
#![expect(clippy::disallowed_methods, reason = "tests write files")]

use super::*;
use tempfile::TempDir;

/// A folder with empty files.
fn folder(files: &[&str]) -> TempDir {
    let folder = tempfile::tempdir().unwrap();
    for file in files {
        let path = folder.path().join(file);
        fs::create_dir_all(path.parent().unwrap()).unwrap();
        fs::write(path, "").unwrap();
    }
    folder
}

/// The names of the files read, below the folder, or the codes of what is wrong.
fn found(folder: &Path, paths: &[&str]) -> Result<Vec<String>, Vec<Code>> {
    let (mut map, mut diagnostics) = (SourceMap::new(), Diagnostics::new());
    let paths: Vec<PathBuf> = paths.iter().map(|path| folder.join(path)).collect();
    let sources = Sources::load(&mut map, &paths, &Levels::default(), &mut diagnostics);
    let base = format!("{}/", folder.display());
    match sources {
        Some(sources) => {
            let names = sources.files().iter().map(|&file| map.file(file).name());
            Ok(names.map(|name| name.replace(&base, "")).collect())
        }
        None => Err(diagnostics.iter().map(|d| d.code).collect()),
    }
}

#[test]
fn folders_stand_for_the_sources_below_them_in_the_order_of_names() {
    let folder = folder(&[
        "b.st",
        "a/z.ST",
        "a/y.iecst",
        "c.md",
        ".hidden.st",
        ".git/x.st",
    ]);
    let all = ["a/y.iecst", "a/z.ST", "b.st"].map(str::to_owned);
    assert_eq!(found(folder.path(), &[""]), Ok(all.to_vec()));
    let [y, z, b] = all;
    assert_eq!(
        found(folder.path(), &["b.st", "a"]),
        Ok(vec![b.clone(), y.clone(), z.clone()])
    );
    // Named twice, in one way or another, and read once.
    let twice = found(folder.path(), &["a/z.ST", "a/../a", "b.st", "b.st"]);
    assert_eq!(twice, Ok(vec![z, y.replace("a/", "a/../a/"), b]));
}

#[test]
fn what_is_no_program_is_refused() {
    let folder = folder(&[
        "a.st",
        "b.scl",
        "c.txt",
        "d",
        "docs/e.txt",
        "f.L5X",
        "g.L5X",
    ]);
    for (paths, codes) in [
        (&["b.scl"][..], &[Code::E6050][..]),
        (&["c.txt", "d"], &[Code::E6050, Code::E6050]),
        (&["docs"], &[Code::E6052]),
        (&["a.st", "docs"], &[Code::E6052]),
        (&["missing.st", "none"], &[Code::E0001, Code::E0001]),
        (&["a.st", "f.L5X"], &[Code::E6051]),
        (&["f.L5X", "a.st"], &[Code::E6051]),
        (&["f.L5X", "g.L5X"], &[Code::E6051]),
        (&[], &[Code::E6052]),
    ] {
        assert_eq!(
            found(folder.path(), paths),
            Err(codes.to_vec()),
            "{paths:?}"
        );
    }
    assert_eq!(
        found(folder.path(), &["f.L5X"]),
        Ok(vec!["f.L5X".to_owned()])
    );
}

#[test]
fn programs_in_a_folder_that_are_not_read_give_a_warning() {
    let folder = folder(&["a.st", "b.scl"]);
    let (mut map, mut found) = (SourceMap::new(), Diagnostics::new());
    let paths = [folder.path().to_owned()];
    let mut levels = Levels::default();
    assert!(Sources::load(&mut map, &paths, &levels, &mut found).is_some());
    assert!(found.iter().all(|d| d.code == Code::E6053) && found.len() == 1);
    levels.set_others(crate::Level::Error);
    assert!(Sources::load(&mut map, &paths, &levels, &mut found).is_none());
}

#[test]
#[cfg(unix)]
fn links_that_lead_back_are_followed_once() {
    let folder = folder(&["a/b.st"]);
    std::os::unix::fs::symlink(folder.path(), folder.path().join("a/loop")).unwrap();
    let names = found(folder.path(), &[""]);
    assert_eq!(names, Ok(vec!["a/b.st".to_owned()]));
}

#[test]
fn folders_that_nest_too_deep_are_refused() {
    let path = vec!["x"; 66].join("/") + "/a.st";
    let folder = folder(&[&path]);
    assert_eq!(found(folder.path(), &[""]), Err(vec![Code::E6054]));
}
