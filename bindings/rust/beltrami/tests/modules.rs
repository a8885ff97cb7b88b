//! The modules of the crate depend on each other in one direction.

use std::collections::{BTreeMap, BTreeSet};
use std::fs;
use std::path::{Path, PathBuf};

/// The modules that each module names.
type Graph = BTreeMap<String, BTreeSet<String>>;

/// The Rust files in a folder and below.
fn rust_files(folder: &Path) -> Vec<PathBuf> {
    let entries = fs::read_dir(folder).unwrap().map(|entry| entry.unwrap().path());
    let files = |path: PathBuf| if path.is_dir() { rust_files(&path) } else { vec![path] };
    entries.flat_map(files).filter(|path| path.extension().is_some_and(|end| end == "rs")).collect()
}

/// The identifier that a text begins with.
fn identifier(text: &str) -> &str {
    let end = text.find(|c: char| !c.is_alphanumeric() && c != '_').unwrap_or(text.len());
    &text[..end]
}

fn without_comments(source: &str) -> impl Iterator<Item = &str> {
    source.lines().filter(|line| !line.trim_start().starts_with("//"))
}

/// What comes directly after `crate::` in the code, whatever it is: a module or a re-export.
fn names_in_the_crate(source: &str) -> BTreeSet<String> {
    let paths = without_comments(source).flat_map(|line| line.split("crate::").skip(1));
    paths
        .map(|path| {
            let name = identifier(path);
            assert!(!name.is_empty(), "a `use` of several modules, crate::{path}: write one each");
            name.to_string()
        })
        .collect()
}

/// Which module each name is of that the root of the crate exports.
fn exports(root: &str) -> BTreeMap<String, String> {
    let code: String = without_comments(root).collect();
    let mut homes = BTreeMap::new();
    for export in code.split("pub use ").skip(1).filter_map(|text| text.split(';').next()) {
        let (module, names) = export.split_once("::").unwrap();
        for name in names.trim_matches(['{', '}', ' ']).split(',') {
            homes.insert(name.trim().to_string(), module.to_string());
        }
    }
    homes
}

/// The modules in this crate; those inside another one count as that.
fn modules() -> Graph {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("src");
    let homes = exports(&fs::read_to_string(folder.join("lib.rs")).unwrap());
    let mut graph = Graph::new();
    for path in rust_files(&folder) {
        let inside = path.strip_prefix(&folder).unwrap().with_extension("");
        let module = inside.iter().next().unwrap().to_str().unwrap().to_string();
        if module == "lib" {
            continue;
        }
        let names = names_in_the_crate(&fs::read_to_string(&path).unwrap());
        let named = names.into_iter().map(|name| homes.get(&name).cloned().unwrap_or(name));
        let others: BTreeSet<String> = named.filter(|name| *name != module).collect();
        graph.entry(module).or_default().extend(others);
    }
    graph
}

/// What is left when modules that need none that is left go, one after the other: the circles, and
/// what needs them.
fn circles(mut graph: Graph) -> Graph {
    loop {
        let left: BTreeSet<String> = graph.keys().cloned().collect();
        graph.retain(|_, needs| needs.iter().any(|need| left.contains(need)));
        if graph.len() == left.len() {
            return graph;
        }
    }
}

#[test]
fn modules_form_no_circle() {
    let modules = modules();
    for (module, needs) in &modules {
        for need in needs {
            assert!(modules.contains_key(need), "{module} names crate::{need}, which is no module");
        }
    }
    assert!(modules["flattener"].contains("parameterization"), "the files were read");
    assert_eq!(circles(modules), Graph::new());
}

#[test]
fn a_circle_is_seen() {
    let graph = |arrows: &[(&str, &str)]| {
        let mut graph = Graph::new();
        for (from, to) in arrows {
            graph.entry(from.to_string()).or_default().insert(to.to_string());
            graph.entry(to.to_string()).or_default();
        }
        graph
    };
    let chain = graph(&[("a", "b"), ("b", "c"), ("a", "c")]);
    assert_eq!(circles(chain), Graph::new());
    let circle = graph(&[("a", "b"), ("b", "c"), ("c", "b")]);
    assert_eq!(circles(circle).keys().collect::<Vec<_>>(), ["a", "b", "c"]);
    let names = names_in_the_crate("//! crate::text\nuse crate::x::Y;");
    assert_eq!(names.into_iter().collect::<Vec<_>>(), ["x"]);
    assert_eq!(exports("pub use a::{B, C};\npub use d::E;")["C"], "a");
}
