//! Finds or builds the library, and says how to link it. The first of these that applies:
//!
//! 1. `DOCS_RS` is set: nothing, since documentation is not linked;
//! 2. `BELTRAMI_LIB_DIR` is set: the library in that folder;
//! 3. a feature asks for the packaged sources (`vendored`, or one that implies it): CMake;
//! 4. pkg-config knows a library of a fitting version;
//! 5. CMake with the packaged sources.

mod vendored;

#[cfg(feature = "buildtime-bindgen")]
mod bindings;

use std::env;
use std::fmt::Display;
use std::path::{Path, PathBuf};
use std::process::exit;

/// The versions of the library that these bindings speak to: additions come with a minor version.
const VERSIONS: std::ops::Range<&str> = "0.1.0".."0.2.0";

fn main() {
    println!("cargo::rerun-if-changed=build");
    let include = if variable("DOCS_RS").is_some() {
        vendored::sources().join("include")
    } else {
        let installation = link();
        println!("cargo::metadata=root={}", installation.root.display());
        println!("cargo::metadata=include={}", installation.include.display());
        installation.include
    };
    #[cfg(feature = "buildtime-bindgen")]
    bindings::generate(&include);
    #[cfg(not(feature = "buildtime-bindgen"))]
    drop(include);
}

/// Where the library that was linked lies.
struct Installation {
    /// The folder with all of it.
    root: PathBuf,
    /// The folder with `beltrami/beltrami.h`.
    include: PathBuf,
}

fn link() -> Installation {
    if let Some(folder) = variable("BELTRAMI_LIB_DIR") {
        return link_folder(Path::new(&folder));
    }
    if cfg!(feature = "vendored") {
        return vendored::build().unwrap_or_else(|error| fail(error));
    }
    probe().unwrap_or_else(|not_found| {
        vendored::build().unwrap_or_else(|error| {
            fail(format!("pkg-config: {not_found}\nthe packaged sources: {error}"))
        })
    })
}

/// Links the library in `folder`, with the header in `BELTRAMI_INCLUDE_DIR` or `folder/../include`.
fn link_folder(folder: &Path) -> Installation {
    let find = |names: &[&str]| names.iter().map(|name| folder.join(name)).find(|p| p.is_file());
    // On Windows a .lib may be either; the linker knows which.
    let shared =
        find(&["libbeltrami.so", "libbeltrami.dylib", "libbeltrami.dll.a", "beltrami.lib"]);
    let archive = find(&["libbeltrami.a", "beltrami.lib"]);
    println!("cargo::rustc-link-search=native={}", folder.display());
    match (shared, archive) {
        (shared, Some(archive)) if prefers_static() || shared.is_none() => {
            // It is copied into the crate, so a new one makes a new crate.
            println!("cargo::rerun-if-changed={}", archive.display());
            link_static(&[]);
        }
        (Some(_), _) if !wants_static() => println!("cargo::rustc-link-lib=dylib=beltrami"),
        _ => fail(format!("the library is not in BELTRAMI_LIB_DIR, {}", folder.display())),
    }
    let root = folder.parent().unwrap_or(folder).to_owned();
    let include =
        variable("BELTRAMI_INCLUDE_DIR").map_or_else(|| root.join("include"), PathBuf::from);
    Installation { root, include }
}

/// Links what pkg-config finds.
fn probe() -> Result<Installation, pkg_config::Error> {
    let library = pkg_config::Config::new()
        .range_version(VERSIONS)
        .statik(prefers_static())
        .probe("beltrami")?;
    let prefix = pkg_config::get_variable("beltrami", "prefix")?;
    let include = library.include_paths.into_iter().next();
    Ok(Installation {
        include: include.unwrap_or_else(|| Path::new(&prefix).join("include")),
        root: prefix.into(),
    })
}

/// Links the static library, and what it leaves open: the back end's `libraries` and the C++
/// runtime (`CXXSTDLIB` names another one; empty: none).
fn link_static(libraries: &[&str]) {
    println!("cargo::rustc-link-lib=static=beltrami");
    for library in libraries {
        println!("cargo::rustc-link-lib={library}");
    }
    let runtime = variable("CXXSTDLIB").unwrap_or_else(|| default_cxx_runtime().to_owned());
    if !runtime.is_empty() {
        println!("cargo::rustc-link-lib={runtime}");
    }
}

fn default_cxx_runtime() -> &'static str {
    let target = |name: &str| env::var(format!("CARGO_CFG_TARGET_{name}")).unwrap_or_default();
    match (target("OS").as_str(), target("ENV").as_str()) {
        (_, "msvc") => "",
        ("macos" | "ios" | "freebsd" | "openbsd", _) => "c++",
        ("android", _) => "c++_shared",
        _ => "stdc++",
    }
}

/// Whether the static library is taken where there is one: the feature `static` asks for that.
fn prefers_static() -> bool {
    wants_static() || cfg!(feature = "static")
}

/// Whether no other will do.
fn wants_static() -> bool {
    variable("BELTRAMI_STATIC").is_some_and(|value| value != "0")
}

/// An environment variable, at whose change this script runs again.
fn variable(name: &str) -> Option<String> {
    println!("cargo::rerun-if-env-changed={name}");
    env::var(name).ok()
}

/// Ends the build with the ways out.
fn fail(reason: impl Display) -> ! {
    eprintln!(
        "error: beltrami could not be linked.\n\n{reason}\n\n\
         Choose one of:\n\
         - install beltrami so that pkg-config finds it ({} <= version < {});\n\
         - set BELTRAMI_LIB_DIR to the folder of its library (and BELTRAMI_INCLUDE_DIR to that of \
         its header, BELTRAMI_STATIC=1 for the static library);\n\
         - have the packaged sources compiled: that takes CMake 3.22, a C++20 compiler, and the \
         development files of Eigen 3.4 and CGAL 5.5 (Debian: g++ cmake libeigen3-dev \
         libcgal-dev). The feature `vendored` does so whatever is installed.\n",
        VERSIONS.start, VERSIONS.end
    );
    exit(1);
}
