//! The bindings from the header, by the one set of rules behind the committed ones, too.

use std::env;
use std::fs;
use std::path::{Path, PathBuf};
use std::sync::{Mutex, PoisonError};

use bindgen::callbacks::ParseCallbacks;

/// Writes `OUT_DIR/bindings.rs` from `beltrami/beltrami.h` in the folder `include`.
pub fn generate(include: &Path) {
    let header = include.join("beltrami/beltrami.h");
    println!("cargo::rerun-if-changed={}", header.display());
    let bindings = bindgen::builder()
        .header(header.to_str().expect("the path of the header is not UTF-8"))
        .use_core()
        .rust_target(bindgen::RustTarget::stable(77, 0).expect("it is the oldest one supported"))
        .allowlist_item("(beltrami|BELTRAMI)_.*")
        // Constants: a number that Rust does not know would make an enum undefined behaviour.
        .default_enum_style(bindgen::EnumVariation::Consts)
        .prepend_enum_name(false)
        .derive_default(true)
        // The header's comments are plain ones.
        .clang_arg("-fparse-all-comments")
        .parse_callbacks(Box::<OwnComments>::default())
        .formatter(bindgen::Formatter::Prettyplease)
        .generate()
        .expect("bindgen could not read the header");
    // The layouts are those of 64-bit systems; on others the compiler of Rust has the word alone.
    let text = bindings
        .to_string()
        .replace("\nconst _: () = {", "\n#[cfg(target_pointer_width = \"64\")]\nconst _: () = {");
    let out = PathBuf::from(env::var_os("OUT_DIR").expect("cargo sets OUT_DIR"));
    fs::write(out.join("bindings.rs"), text).expect("OUT_DIR is not writable");
}

/// Leaves to an item the comment that is about it: Clang also hands it that of the item before,
/// where it has none, or the title of a section.
#[derive(Debug, Default)]
struct OwnComments {
    last: Mutex<String>,
}

impl ParseCallbacks for OwnComments {
    fn process_comment(&self, comment: &str) -> Option<String> {
        let mut last = self.last.lock().unwrap_or_else(PoisonError::into_inner);
        if *last == comment || comment.trim_start().starts_with("----") {
            return Some(String::new());
        }
        comment.clone_into(&mut last);
        None
    }
}
