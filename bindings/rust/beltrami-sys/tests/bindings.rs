//! The committed bindings against those that bindgen makes of the header today:
//! `BELTRAMI_WRITE=1 cargo test --features buildtime-bindgen --test bindings` commits the latter.
#![cfg(feature = "buildtime-bindgen")]

use std::path::Path;
use std::{env, fs};

#[test]
fn committed_bindings_are_those_of_the_header() {
    let generated = include_str!(concat!(env!("OUT_DIR"), "/bindings.rs"));
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("src/bindings.rs");
    if env::var_os("BELTRAMI_WRITE").is_some() {
        fs::write(&path, generated).unwrap();
    }
    let committed = fs::read_to_string(&path).unwrap();
    assert!(generated == committed, "src/bindings.rs is not current: ./dev abi writes it anew");
}
