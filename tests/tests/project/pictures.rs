//! Tests of the pictures in docs/: each is shown on a page. Its command is listed in docs/figures.md or is on the page
//! itself.

use std::path::{Path, PathBuf};

use eomgen_tests::models::project;
use eomgen_tests::pages::{files_in, is_recipe, links, name_in_project, pages};

/// Figures whose file name in docs/ differs from the name in the printed command.
const RENAMED: [(&str, &str); 1] = [("tour/trajectory.svg", "docs/tour.svg")];

/// Returns the pictures of docs/.
fn pictures() -> Vec<PathBuf> {
    let mut files = files_in(&project().join("docs"));
    files.retain(|path| {
        path.extension()
            .is_some_and(|end| end == "svg" || end == "png")
    });
    files
}

/// Returns the paths of the pictures that a page shows.
fn shown_on(page: &str, text: &str) -> Vec<PathBuf> {
    let page = project().join(page);
    let folder = page.parent().expect("a folder");
    let pictures = links(text)
        .into_iter()
        .filter(|(_, is_picture)| *is_picture);
    pictures.map(|(target, _)| folder.join(target)).collect()
}

/// Returns true if docs/figures.md lists the command of a picture.
fn is_listed(picture: &Path, table: &str) -> bool {
    let name = picture.file_name().expect("a name").to_string_lossy();
    let name = format!("`{name}`");
    let mut rows = table.lines().filter(|line| line.contains(&name));
    rows.any(|row| row.contains("`cargo run --release -"))
}

/// Asserts that the pictures of a page equal the pictures that its commands wrote to a folder. Returns the names of the
/// compared pictures.
pub fn assert_match(page: &str, text: &str, folder: &Path) -> Vec<String> {
    let written = files_in(folder);
    let mut compared = Vec::new();
    for picture in shown_on(page, text) {
        let name = picture.file_name().expect("a name");
        let renamed = RENAMED.iter().find(|(_, kept)| picture.ends_with(kept));
        let written = written.iter().find(|path| match renamed {
            Some((left, _)) => path.ends_with(left),
            None => path.file_name() == Some(name),
        });
        let Some(written) = written else { continue };
        let [kept, left] = [&picture, written].map(|path| std::fs::read(path).expect("a file"));
        assert!(
            kept == left,
            "{page}: {} differs from the figure of its command",
            picture.display()
        );
        compared.push(name_in_project(&picture));
    }
    compared
}

/// Asserts that [`assert_match`] has compared every picture whose command is only on its page. The pictures of recipes
/// have a separate test.
pub fn assert_all_compared(compared: &[String]) {
    let table = std::fs::read_to_string(project().join("docs/figures.md")).expect("a page");
    let unlisted = pictures()
        .into_iter()
        .filter(|path| !is_listed(path, &table));
    let written = unlisted.map(|path| name_in_project(&path));
    let written = written.filter(|name| !is_recipe(name));
    for kept in written.chain(RENAMED.map(|(_, kept)| kept.to_owned())) {
        assert!(compared.contains(&kept), "no command writes {kept}");
    }
}

#[test]
fn pictures_of_docs_are_shown() {
    let shown: Vec<PathBuf> = pages()
        .iter()
        .flat_map(|(page, text)| shown_on(page, text))
        .collect();
    for picture in pictures() {
        assert!(
            shown.contains(&picture),
            "no page shows {}",
            picture.display()
        );
    }
}
