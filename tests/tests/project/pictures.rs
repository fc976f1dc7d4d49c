//! Tests of the pictures in docs/: each is shown on a page. Its command is listed in docs/figures.md or is on the page
//! itself. Screenshots are small, and the texts of the picture in README.md are legible.

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
    let commands = ["`cargo run --release -", "`examples/screenshots/run`"];
    rows.any(|row| commands.iter().any(|command| row.contains(command)))
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

#[test]
fn screenshots_are_small_pictures() {
    for name in ["page.png", "report.png"] {
        let bytes = std::fs::read(project().join("docs").join(name)).expect("a picture");
        assert!(bytes.starts_with(b"\x89PNG\r\n\x1a\n"), "{name}");
        assert!(bytes.len() < 150_000, "{name}: {} bytes", bytes.len());
        let pixels =
            |at: usize| u32::from_be_bytes(bytes[at..at + 4].try_into().expect("a number"));
        let (width, height) = (pixels(16), pixels(20));
        assert!(
            (600..=1280).contains(&width) && height > 600,
            "{name}: {width} px by {height} px"
        );
    }
}

/// Returns the value of an attribute of an element.
fn attribute<'a>(element: &'a str, name: &str) -> &'a str {
    let (_, rest) = element
        .split_once(&format!(" {name}=\""))
        .unwrap_or_else(|| panic!("{name}: {element}"));
    rest.split('"').next().expect("a value")
}

/// Text of a picture with its size and its box, in px: left, right, top and bottom.
struct DrawnText {
    text: String,
    size: f64,
    sides: [f64; 4],
}

/// Returns the texts of an SVG document. Letters are assumed to be 0.6 of their size wide.
fn drawn_texts(svg: &str) -> Vec<DrawnText> {
    let elements = svg.split("<text").skip(1);
    let read = |element: &str| {
        let element = element.split("</text>").next().expect("an element");
        let (head, text) = element.split_once('>').expect("a text");
        let number = |name: &str| attribute(head, name).parse::<f64>().expect(name);
        let (x, y, size) = (number("x"), number("y"), number("font-size"));
        let width = 0.6 * size * text.chars().count() as f64;
        let left = match attribute(head, "text-anchor") {
            "start" => x,
            "middle" => x - width / 2.0,
            _ => x - width,
        };
        DrawnText {
            text: text.to_owned(),
            size,
            sides: [left, left + width, y - 0.8 * size, y + 0.2 * size],
        }
    };
    elements.map(read).collect()
}

#[test]
fn picture_of_the_readme_has_few_legible_texts() {
    /// Width of README.md on a web page, px.
    const PAGE_WIDTH: f64 = 830.0;
    let svg = std::fs::read_to_string(project().join("docs/arm.svg")).expect("a picture");
    let number = |name: &str| attribute(&svg, name).parse::<f64>().expect(name);
    let (width, height) = (number("width"), number("height"));
    let scale = (PAGE_WIDTH / width).min(1.0);
    let texts = drawn_texts(&svg);
    assert!((5..=14).contains(&texts.len()), "{} texts", texts.len());
    assert!(svg.contains("prefers-color-scheme:dark"));
    for (index, one) in texts.iter().enumerate() {
        assert!(one.size * scale >= 11.0, "{}: {} px", one.text, one.size);
        let [left, right, top, bottom] = one.sides;
        let is_inside = left >= 0.0 && right <= width && top >= 0.0 && bottom <= height;
        assert!(is_inside, "{}: {:?}", one.text, one.sides);
        for other in &texts[index + 1..] {
            let [a, b, c, d] = other.sides;
            let is_apart = right <= a || b <= left || bottom <= c || d <= top;
            assert!(is_apart, "{} covers {}", one.text, other.text);
        }
    }
}
