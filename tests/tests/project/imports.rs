//! Test of the imports between the files of each crate. Folders import in one direction only, and
//! `docs/architecture.md` lists the few import cycles between files with a reason. An item used through a re-export
//! counts as imported from the file that defines it. The compiler excludes cycles between crates.

use std::collections::{BTreeMap, BTreeSet};
use std::path::{Path, PathBuf};

use eomgen_tests::models::project;
use proc_macro2::{Delimiter, TokenStream, TokenTree};

const MAX_CIRCLES: usize = 8;

type Names = Vec<String>;

/// Imports of a file as paths from the root of its crate, and its re-exports.
#[derive(Default)]
struct File {
    uses: BTreeSet<Names>,
    exports: BTreeMap<String, Names>,
}

/// Files of a crate by module, and the imports of each.
struct Crate {
    files: BTreeMap<Names, File>,
    imports: BTreeMap<Names, BTreeSet<Names>>,
}

fn collect_sources(folder: &Path, found: &mut Vec<PathBuf>) {
    if folder.join("Cargo.toml").is_file() && folder.join("src").is_dir() {
        found.push(folder.join("src"));
    }
    for entry in std::fs::read_dir(folder).expect("a folder").flatten() {
        let name = entry.file_name();
        let skipped = ["target", "src", ".git"].iter().any(|known| name == *known);
        if entry.path().is_dir() && !skipped {
            collect_sources(&entry.path(), found);
        }
    }
}

fn collect_modules(folder: &Path, module: &Names, found: &mut BTreeMap<Names, PathBuf>) {
    for entry in std::fs::read_dir(folder).expect("a folder").flatten() {
        let path = entry.path();
        let name = path.file_stem().unwrap_or_default().to_string_lossy();
        let mut inner = module.clone();
        if !["lib", "main", "mod"].contains(&&*name) {
            inner.push(name.into_owned());
        }
        if path.is_dir() {
            collect_modules(&path, &inner, found);
        } else if path.extension().is_some_and(|kind| kind == "rs") {
            found.insert(inner, path);
        }
    }
}

/// Collects the paths of a `use` tree, such as `a::{b, c as d}`, after `prefix`.
fn collect_paths(tokens: &[TokenTree], prefix: &Names, found: &mut Vec<Names>) {
    let is_comma = |token: &TokenTree| matches!(token, TokenTree::Punct(p) if p.as_char() == ',');
    for branch in tokens.split(is_comma) {
        let mut path = prefix.clone();
        let mut is_whole = true;
        for token in branch {
            match token {
                TokenTree::Ident(name) if name == "as" => break,
                TokenTree::Ident(name) => path.push(name.to_string()),
                TokenTree::Group(group) if group.delimiter() == Delimiter::Brace => {
                    let inner: Vec<TokenTree> = group.stream().into_iter().collect();
                    collect_paths(&inner, &path, found);
                    is_whole = false;
                }
                _ => {}
            }
        }
        if is_whole && path.len() > prefix.len() {
            found.push(path);
        }
    }
}

/// Converts a path written in `module` to a path from the crate's root; `None` if it refers to another crate.
fn resolve(path: &Names, module: &Names) -> Option<Names> {
    let first = path.first()?.as_str();
    let rest = |from: &[String], skipped: usize| [from, &path[skipped..]].concat();
    match first {
        "crate" => Some(rest(&[], 1)),
        "self" => Some(rest(module, 1)),
        "super" => {
            let up = path.iter().take_while(|name| *name == "super").count();
            Some(rest(module.get(..module.len().checked_sub(up)?)?, up))
        }
        _ => Some(rest(module, 0)),
    }
}

fn is_token(tokens: &[TokenTree], place: usize, wanted: &str) -> bool {
    tokens.get(place).is_some_and(|token| match token {
        TokenTree::Ident(name) => name == wanted,
        TokenTree::Punct(mark) => wanted.starts_with(mark.as_char()) && wanted.len() == 1,
        _ => false,
    })
}

fn read(stream: TokenStream, module: &Names, file: &mut File) {
    let tokens: Vec<TokenTree> = stream.into_iter().collect();
    let mut place = 0;
    while place < tokens.len() {
        // Test modules are not checked.
        if is_token(&tokens, place, "#")
            && tokens.get(place + 1).map(ToString::to_string) == Some("[cfg (test)]".into())
        {
            place += 2;
            while place < tokens.len()
                && !is_token(&tokens, place, ";")
                && !matches!(&tokens[place], TokenTree::Group(g) if g.delimiter() == Delimiter::Brace)
            {
                place += 1;
            }
        } else if is_token(&tokens, place, "use") {
            let length = (place..tokens.len()).take_while(|at| !is_token(&tokens, *at, ";"));
            let end = place + length.count();
            let mut paths = Vec::new();
            collect_paths(&tokens[place + 1..end], &Names::new(), &mut paths);
            let is_visible = |token: &TokenTree| {
                let text = token.to_string();
                text == "pub" || text.starts_with("(crate") || text.starts_with("(super")
            };
            let is_export = place > 0 && is_visible(&tokens[place - 1]);
            for path in paths.iter().filter_map(|path| resolve(path, module)) {
                match path.last().cloned() {
                    Some(name) if is_export => drop(file.exports.insert(name, path)),
                    _ => drop(file.uses.insert(path)),
                }
            }
            place = end;
        } else if ["crate", "super", "self"]
            .iter()
            .any(|w| is_token(&tokens, place, w))
            && is_token(&tokens, place + 1, ":")
            && is_token(&tokens, place + 2, ":")
        {
            let mut path = vec![tokens[place].to_string()];
            place += 1;
            while is_token(&tokens, place, ":") && is_token(&tokens, place + 1, ":") {
                if let Some(TokenTree::Ident(name)) = tokens.get(place + 2) {
                    path.push(name.to_string());
                }
                place += 3;
            }
            file.uses.extend(resolve(&path, module));
            place -= 1;
        } else if let TokenTree::Group(group) = &tokens[place] {
            read(group.stream(), module, file);
        }
        place += 1;
    }
}

impl Crate {
    fn read(source: &Path) -> Self {
        let mut paths = BTreeMap::new();
        collect_modules(source, &Names::new(), &mut paths);
        let is_test = |module: &Names| {
            let name = module.last().map_or("", String::as_str);
            name == "tests" || name.starts_with("test_")
        };
        let mut files = BTreeMap::new();
        for (module, path) in paths.into_iter().filter(|(module, _)| !is_test(module)) {
            let text = std::fs::read_to_string(&path).expect("a file");
            let stream = text
                .parse()
                .unwrap_or_else(|_| panic!("{}", path.display()));
            let mut file = File::default();
            read(stream, &module, &mut file);
            files.insert(module, file);
        }
        let mut found = Self {
            files,
            imports: BTreeMap::new(),
        };
        for (module, file) in &found.files {
            let uses = file.uses.iter().filter_map(|path| found.file_of(path));
            let others = uses.filter(|other| other != module).collect();
            found.imports.insert(module.clone(), others);
        }
        found
    }

    /// Returns the file that defines the item of a path.
    fn file_of(&self, path: &Names) -> Option<Names> {
        let lengths = (0..=path.len()).rev();
        let module = lengths.map(|length| &path[..length]);
        let module = module
            .into_iter()
            .find(|part| self.files.contains_key(*part))?;
        let file = &self.files[module];
        match path
            .get(module.len())
            .and_then(|name| file.exports.get(name))
        {
            Some(export) if export != path => self.file_of(export),
            // The path refers to the crate's root or to another crate.
            _ if module.is_empty() => None,
            _ => Some(module.to_vec()),
        }
    }

    /// Returns the import cycles: sets of files that import each other, directly or indirectly.
    fn circles(&self) -> BTreeSet<BTreeSet<String>> {
        let reach: BTreeMap<_, _> = (self
            .files
            .keys()
            .map(|file| (file, reachable(&self.imports, file))))
        .filter(|(file, reachable)| reachable.contains(*file))
        .collect();
        let circle = |file: &Names| -> BTreeSet<String> {
            let together = reach.iter().filter(|(other, reachable)| {
                reachable.contains(file) && reach[file].contains(**other)
            });
            together.map(|(other, _)| other.join("/")).collect()
        };
        reach.keys().map(|file| circle(file)).collect()
    }

    /// Returns the folders that import from themselves through other folders.
    fn folders_both_ways(&self) -> Vec<String> {
        let is_folder = |name: &String| self.files.keys().any(|m| m.len() > 1 && m[0] == *name);
        let mut arrows = BTreeMap::<String, BTreeSet<String>>::new();
        for (from, all) in &self.imports {
            for to in all {
                if let (Some(a), Some(b)) = (from.first(), to.first())
                    && a != b
                    && is_folder(a)
                    && is_folder(b)
                {
                    arrows.entry(a.clone()).or_default().insert(b.clone());
                }
            }
        }
        let comes_back = |start: &&String| reachable(&arrows, start).contains(*start);
        arrows.keys().filter(comes_back).cloned().collect()
    }
}

fn reachable<K: Ord + Clone>(arrows: &BTreeMap<K, BTreeSet<K>>, from: &K) -> BTreeSet<K> {
    let mut found = BTreeSet::new();
    let mut waiting = vec![from];
    while let Some(at) = waiting.pop() {
        for next in arrows.get(at).into_iter().flatten() {
            if found.insert(next.clone()) {
                waiting.push(next);
            }
        }
    }
    found
}

fn crates() -> Vec<(String, Crate)> {
    let mut folders = Vec::new();
    collect_sources(project(), &mut folders);
    assert!(folders.len() > 20, "{folders:?}");
    let name = |source: &PathBuf| {
        let inside = source.strip_prefix(project()).unwrap_or(source);
        inside.display().to_string()
    };
    let read = |source: PathBuf| (name(&source), Crate::read(&source));
    folders.into_iter().map(read).collect()
}

#[test]
fn folders_of_a_crate_import_in_one_direction() {
    let mut arrows = 0;
    for (name, read) in crates() {
        arrows += read.imports.values().map(BTreeSet::len).sum::<usize>();
        let back = read.folders_both_ways();
        assert!(back.is_empty(), "{name}: these import each other: {back:?}");
    }
    assert!(arrows > 1000, "only {arrows} imports were found");
}

#[test]
fn import_cycles_are_few_and_documented() {
    let page = std::fs::read_to_string(project().join("docs/architecture.md")).expect("the page");
    let (_, section) = page
        .split_once("### Import cycles between files")
        .expect("a section");
    let section = section.split("\n#").next().unwrap_or(section);
    let items: Vec<&str> = section.split("\n- ").skip(1).collect();
    let mut found = 0;
    for (name, read) in crates() {
        for circle in read.circles() {
            found += 1;
            let is_named = |item: &&&str| {
                item.contains(&name)
                    && circle.iter().all(|file| {
                        let stem = file.rsplit('/').next().unwrap_or(file);
                        item.contains(stem)
                    })
            };
            let named = items.iter().find(is_named);
            assert!(named.is_some(), "{name}: no reason is given for {circle:?}");
        }
    }
    assert_eq!(
        found,
        items.len(),
        "docs/architecture.md lists other circles"
    );
    assert!(found <= MAX_CIRCLES, "{found} circles of files");
}
