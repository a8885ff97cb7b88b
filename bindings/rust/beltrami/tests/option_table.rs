//! The options of this crate against the table of the library, which has the last word. The source
//! of the typed ones is written from it: `BELTRAMI_WRITE=1 cargo test --test option_table`.

use std::collections::HashMap;
use std::ffi::{c_char, CStr};
use std::fmt::Write as _;
use std::fs;
use std::mem::size_of;
use std::path::Path;
use std::time::Duration;

use beltrami::{
    Cut, Delaunay, Effort, Energy, ErrorKind, Flatten, Flattener, Injectivity, Method, OptionInfo,
    OptionKind, Options, Pack, PackOptions, PackTurns, Packer, Preset, UnwrapOptions, Unwrapper,
    Weld, OPTIONS,
};
use beltrami_sys as sys;

/// An option as the library describes it.
struct Entry {
    name: &'static str,
    summary: &'static str,
    kind: OptionKind,
    minimum: f64,
    maximum: f64,
    default: f64,
    choices: Vec<&'static str>,
    calls: i32,
}

fn text(raw: *const c_char) -> &'static str {
    // SAFETY: the texts of the table are static.
    unsafe { CStr::from_ptr(raw) }.to_str().unwrap()
}

fn choices(key: i32) -> Vec<&'static str> {
    // SAFETY: any numbers will do.
    let names = (0..).map(|value| unsafe { sys::beltrami_option_choice(key, value) });
    names.take_while(|name| !name.is_null()).map(text).collect()
}

/// Walks the table, as the header says how.
fn table() -> Vec<Entry> {
    let describe = |key| {
        let mut info = sys::beltrami_option_info {
            struct_size: size_of::<sys::beltrami_option_info>() as u32,
            ..Default::default()
        };
        // SAFETY: `info` has the size that it says.
        let status = unsafe { sys::beltrami_option_describe(key, &mut info) };
        (status == sys::BELTRAMI_OK).then_some(info)
    };
    (0..).map_while(describe).map(|info| entry(&info)).collect()
}

fn entry(info: &sys::beltrami_option_info) -> Entry {
    let kind = match info.type_ {
        sys::BELTRAMI_TYPE_CHOICE => OptionKind::Choice,
        sys::BELTRAMI_TYPE_FLOAT => OptionKind::Float,
        sys::BELTRAMI_TYPE_INT if (info.minimum, info.maximum) == (0.0, 1.0) => OptionKind::Switch,
        sys::BELTRAMI_TYPE_INT => OptionKind::Int,
        other => panic!("a type of option that nobody knows: {other}"),
    };
    Entry {
        name: text(info.name),
        summary: text(info.summary),
        kind,
        minimum: info.minimum,
        maximum: info.maximum,
        default: info.default_value,
        choices: choices(info.key),
        calls: info.calls,
    }
}

#[test]
fn every_option_of_the_library_is_here_with_its_range_default_and_choices() {
    let table = table();
    assert_eq!(table.len(), OPTIONS.len());
    for (theirs, ours) in table.iter().zip(OPTIONS) {
        assert_eq!(theirs.name, ours.name);
        assert_eq!(theirs.summary, ours.summary);
        assert_eq!(theirs.kind, ours.kind, "{}", ours.name);
        assert_eq!(theirs.minimum, ours.minimum, "{}", ours.name);
        assert_eq!(theirs.maximum, ours.maximum, "{}", ours.name);
        assert_eq!(theirs.default, ours.default, "{}", ours.name);
        assert_eq!(theirs.choices, ours.choices, "{}", ours.name);
        assert_eq!(theirs.calls & sys::BELTRAMI_CALL_RUN != 0, ours.flattens, "{}", ours.name);
        assert_eq!(theirs.calls & sys::BELTRAMI_CALL_UNWRAP != 0, ours.unwraps, "{}", ours.name);
        assert_eq!(theirs.calls & sys::BELTRAMI_CALL_PACK != 0, ours.packs, "{}", ours.name);
    }
}

/// Sets an option where it is taken, alike by all that take it.
fn use_option(option: &OptionInfo, value: &str) -> Result<(), ErrorKind> {
    let flattens = option.flattens.then(|| {
        let options = Options::new().set(option.name, value).unwrap();
        Flattener::with_options(&options).map(drop).map_err(|error| error.kind)
    });
    let unwraps = option.unwraps.then(|| {
        let options = UnwrapOptions::new().set(option.name, value).unwrap();
        Unwrapper::with_options(&options).map(drop).map_err(|error| error.kind)
    });
    let packs = option.packs.then(|| {
        let options = PackOptions::new().set(option.name, value).unwrap();
        Packer::with_options(&options).map(drop).map_err(|error| error.kind)
    });
    let all: Vec<_> = [flattens, unwraps, packs].into_iter().flatten().collect();
    assert!(all.iter().all(|one| *one == all[0]), "{}", option.name);
    all[0]
}

#[test]
fn options_that_are_not_taken_are_unknown() {
    for option in OPTIONS {
        let value =
            option.choices.first().map_or_else(|| option.default.to_string(), |c| c.to_string());
        let flattens = Options::new().set(option.name, &value).is_ok();
        let unwraps = UnwrapOptions::new().set(option.name, &value).is_ok();
        assert_eq!((flattens, unwraps), (option.flattens, option.unwraps), "{}", option.name);
        let packs = PackOptions::new().set(option.name, &value).is_ok();
        assert_eq!(packs, option.packs, "{}", option.name);
    }
    let error = Options::new().set("weld", "off").unwrap_err();
    assert_eq!(error.to_string(), "there is no option weld: see beltrami::OPTIONS");
}

#[test]
fn options_are_taken_up_to_the_ends_of_their_range_and_refused_beyond() {
    for option in OPTIONS {
        let set = |number: f64| use_option(option, &number.to_string());
        for good in [option.minimum, option.maximum, option.default] {
            assert!(set(good).is_ok(), "{} = {good}", option.name);
        }
        for bad in [option.minimum - 1.0, option.maximum + option.maximum.max(1.0)] {
            assert_eq!(set(bad), Err(ErrorKind::InvalidArgument), "{} = {bad}", option.name);
        }
        for choice in option.choices {
            assert!(use_option(option, choice).is_ok(), "{} = {choice}", option.name);
        }
    }
}

#[test]
fn text_that_is_no_value_is_refused_in_words() {
    let refusal = |name, value| Options::new().set(name, value).unwrap_err().to_string();
    assert_eq!(
        refusal("energy", "sym"),
        "\"sym\" is no value for the option energy: give one of symmetric-dirichlet, symmetric-arap, \
         exponential-dirichlet"
    );
    assert_eq!(
        refusal("threads", "1.5"),
        "\"1.5\" is no value for the option threads: give a whole number from 1 to 1024"
    );
    assert_eq!(
        refusal("refine", "maybe"),
        "\"maybe\" is no value for the option refine: give true or false"
    );
    assert_eq!(
        refusal("tolerance", ""),
        "\"\" is no value for the option tolerance: give a number from 0 to 1"
    );
    assert_eq!(refusal("speed", "9"), "there is no option speed: see beltrami::OPTIONS");
}

#[test]
fn typed_and_named_options_are_the_same() {
    let named = |name, value: &str| Options::new().set(name, value).unwrap();
    for &method in Method::ALL {
        assert_eq!(Options::new().method(method), named("method", method.name()));
    }
    for &energy in Energy::ALL {
        assert_eq!(Options::new().energy(energy), named("energy", &energy.to_string()));
    }
    for &flatten in Flatten::ALL {
        assert_eq!(Options::new().flatten(flatten), named("flatten", flatten.name()));
    }
    for &injectivity in Injectivity::ALL {
        assert_eq!(
            Options::new().injectivity(injectivity),
            named("injectivity", injectivity.name())
        );
    }
    for &delaunay in Delaunay::ALL {
        assert_eq!(Options::new().delaunay(delaunay), named("delaunay", delaunay.name()));
    }
    let unwrap = |name, value: &str| UnwrapOptions::new().set(name, value).unwrap();
    for &cut in Cut::ALL {
        assert_eq!(UnwrapOptions::new().cut(cut), unwrap("cut", cut.name()));
    }
    for &preset in Preset::ALL {
        assert_eq!(UnwrapOptions::new().preset(preset), unwrap("preset", preset.name()));
    }
    for &weld in Weld::ALL {
        assert_eq!(UnwrapOptions::new().weld(weld), unwrap("weld", weld.name()));
    }
    for &pack in Pack::ALL {
        assert_eq!(UnwrapOptions::new().pack(pack), unwrap("pack", pack.name()));
    }
    for &effort in Effort::ALL {
        assert_eq!(UnwrapOptions::new().effort(effort), unwrap("effort", effort.name()));
    }
    for &turns in PackTurns::ALL {
        let named = PackOptions::new().set("pack-turns", turns.name()).unwrap();
        assert_eq!(PackOptions::new().pack_turns(turns), named);
    }
    assert_eq!(UnwrapOptions::new().method(Method::Cm), unwrap("method", "cm"));
    assert_eq!(UnwrapOptions::new().share_copies(true), unwrap("share-copies", "true"));
    assert_eq!(Options::new().refine(true), named("refine", "true"));
    assert_eq!(Options::new().threads(2), named("threads", "2"));
    assert_eq!(Options::new().tolerance(0.5), named("tolerance", "0.5"));
    assert_eq!(Options::new().time_limit(Duration::from_millis(250)), named("time-limit", "0.25"));
}

/// The comment before every enumerator of the header, by its name.
fn header_comments() -> HashMap<String, String> {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../../include/beltrami/beltrami.h");
    let header = fs::read_to_string(path).unwrap();
    let mut comments = HashMap::new();
    let mut rest = header.as_str();
    while let Some(start) = rest.find("/*") {
        let (comment, after) = rest[start + 2..].split_once("*/").unwrap();
        let words: Vec<_> = comment.split_whitespace().filter(|word| *word != "*").collect();
        let name: String =
            after.trim_start().chars().take_while(|c| c.is_alphanumeric() || *c == '_').collect();
        if name.starts_with("BELTRAMI_") {
            // Intervals are no links.
            comments.insert(name, words.join(" ").replace('[', "\\[").replace(']', "\\]"));
        }
        rest = after;
    }
    comments
}

/// A documentation comment, broken into lines.
fn docs(indent: &str, words: &str) -> String {
    let mut lines = String::new();
    let mut line = format!("{indent}///");
    for word in words.split_whitespace() {
        if line.len() + word.len() >= 100 {
            writeln!(lines, "{line}").unwrap();
            line = format!("{indent}///");
        }
        write!(line, " {word}").unwrap();
    }
    lines + &line + "\n"
}

fn pascal_case(name: &str) -> String {
    name.split('-').map(|word| word[..1].to_uppercase() + &word[1..]).collect()
}

/// The type that the method of an option takes.
fn rust_type(option: &Entry) -> String {
    match option.kind {
        OptionKind::Choice => pascal_case(option.name),
        OptionKind::Switch => "bool".into(),
        OptionKind::Int if option.maximum <= f64::from(u32::MAX) => "u32".into(),
        OptionKind::Int => "u64".into(),
        _ if option.name == "time-limit" => "Duration".into(),
        _ => "f64".into(),
    }
}

fn default_in_words(option: &Entry) -> String {
    let default = option.default;
    match (option.kind, rust_type(option).as_str()) {
        (OptionKind::Choice, choice) => {
            let name = option.choices[default as usize];
            format!("[`{}`]({choice}::{0})", pascal_case(name))
        }
        (OptionKind::Switch, _) => format!("`{}`", default != 0.0),
        (_, "Duration") if default == 0.0 => "[`Duration::ZERO`]".into(),
        _ => format!("{default}"),
    }
}

/// A bound of a range, as a person writes it.
fn in_words(number: f64) -> String {
    if number < 1e15 {
        number.to_string()
    } else {
        format!("{number:e}")
    }
}

/// The summary, with values as they are written in Rust.
fn summary_in_rust(option: &Entry) -> String {
    let summary = option.summary;
    match summary.split_once(' ') {
        _ if option.kind == OptionKind::Switch => {
            summary.replacen("1 ", "`true` ", 1).replacen("; 0 ", "; `false` ", 1)
        }
        Some((choice, rest)) if option.choices.contains(&choice) => {
            format!("[`{}`]({}::{0}) {rest}", pascal_case(choice), pascal_case(option.name))
        }
        _ => summary.to_owned(),
    }
}

/// The types that have a method for it.
fn builders(option: &Entry) -> Vec<&'static str> {
    let calls = [
        (sys::BELTRAMI_CALL_RUN, "Options"),
        (sys::BELTRAMI_CALL_UNWRAP, "UnwrapOptions"),
        (sys::BELTRAMI_CALL_PACK, "PackOptions"),
    ];
    let taken = calls.into_iter().filter(|(call, _)| option.calls & call != 0);
    taken.map(|(_, builder)| builder).collect()
}

fn render_choice(option: &Entry, comments: &HashMap<String, String>) -> String {
    let constant =
        |name: &str| format!("BELTRAMI_{}_{}", option.name, name).to_uppercase().replace('-', "_");
    let mut source = String::from("choice! {\n");
    let method = option.name.replace('-', "_");
    let builder = builders(option)[0];
    source += &docs("    ", &format!("{} See [`{builder}::{method}`].", summary_in_rust(option)));
    writeln!(source, "    {} {{", pascal_case(option.name)).unwrap();
    for name in &option.choices {
        let words = comments.get(&constant(name)).cloned();
        source += &docs("        ", &words.unwrap_or_else(|| format!("{}.", pascal_case(name))));
        writeln!(source, "        {} = {name:?},", pascal_case(name)).unwrap();
    }
    source + "    }\n}\n\n"
}

fn render_option(key: usize, option: &Entry) -> String {
    let mut source = docs("    ", &summary_in_rust(option));
    source += "    ///\n";
    if matches!(option.kind, OptionKind::Int | OptionKind::Float) {
        source +=
            &docs("    ", &format!("From {} to {}.", option.minimum, in_words(option.maximum)));
        source += "    ///\n";
    }
    source += &docs("    ", &format!("Default: {}.", default_in_words(option)));
    let choices = match option.kind {
        OptionKind::Choice => format!("{}::NAMES", pascal_case(option.name)),
        _ => "&[]".into(),
    };
    let (method, taken) = (option.name.replace('-', "_"), rust_type(option));
    // Whole literals are of 32 bits where nothing says otherwise.
    let whole = option.maximum <= f64::from(i32::MAX);
    let maximum = if whole { option.maximum.to_string() } else { format!("{:?}", option.maximum) };
    let builders = builders(option).join(" ");
    writeln!(source, "    {method}({taken}) of [{builders}] = {key} {:?}", option.name).unwrap();
    writeln!(source, "        {:?}", option.summary).unwrap();
    writeln!(
        source,
        "        {:?}({choices}), {}..={maximum}, default {}, calls {};",
        option.kind, option.minimum, option.default, option.calls
    )
    .unwrap();
    source
}

fn render(table: &[Entry], comments: &HashMap<String, String>) -> String {
    let mut source = String::from(
        "// The options of the library, written by tests/option_table.rs from its table and header.\n\n\
         use std::time::Duration;\n\n\
         use super::{choice, options, Options, PackOptions, UnwrapOptions};\n\n",
    );
    for option in table.iter().filter(|option| option.kind == OptionKind::Choice) {
        source += &render_choice(option, comments);
    }
    source += "options! {\n";
    let options = table.iter().enumerate().map(|(key, option)| render_option(key, option));
    source += &options.collect::<Vec<_>>().join("\n");
    source + "}\n"
}

#[test]
fn the_source_of_the_options_is_what_the_library_says() {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("src/options/table.rs");
    let source = render(&table(), &header_comments());
    if std::env::var_os("BELTRAMI_WRITE").is_some() {
        fs::write(&path, &source).unwrap();
    }
    let committed = fs::read_to_string(&path).unwrap();
    assert!(source == committed, "options/table.rs is not current: ./dev abi writes it anew");
}
