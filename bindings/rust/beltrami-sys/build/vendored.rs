//! The library from the sources in this package. Downloads nothing, writes to `OUT_DIR` only.

use std::fs;
use std::panic;
use std::path::{Path, PathBuf};

use crate::Installation;

/// The folder with the sources.
pub fn sources() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("vendor")
}

/// Builds the static library and links it. Fails with the reason where CMake does.
pub fn build() -> Result<Installation, String> {
    let sources = sources();
    println!("cargo::rerun-if-changed={}", sources.display());
    // The crate cmake panics where CMake fails; its output is on the screen by then.
    let out = panic::catch_unwind(|| configure_and_build(&sources))
        .map_err(|_| "CMake failed, see its output above".to_owned())?;
    let root = lay_out(&out, &sources).map_err(|error| error.to_string())?;
    println!("cargo::rustc-link-search=native={}", root.join("lib").display());
    let cache = fs::read_to_string(out.join("build/CMakeCache.txt")).unwrap_or_default();
    let cholmod = cached(&cache, "CHOLMOD_LIBRARY");
    if let Some(folder) = cholmod.and_then(|path| Path::new(path).parent()) {
        println!("cargo::rustc-link-search=native={}", folder.display());
    }
    crate::link_static(if cfg!(feature = "cholmod") { &["cholmod"] } else { &[] });
    Ok(Installation { include: root.join("include"), root })
}

/// Returns the folder in which CMake had its own folder, `build`.
fn configure_and_build(sources: &Path) -> PathBuf {
    let solver = if cfg!(feature = "supernodal") {
        "cholmod"
    } else if cfg!(feature = "cholmod") {
        "cholmod-simplicial"
    } else {
        "native"
    };
    cmake::Config::new(sources)
        // Optimised in every profile: without, a mesh that takes a second takes a minute.
        .profile("Release")
        .define("BUILD_SHARED_LIBS", "OFF")
        .define("BELTRAMI_SOLVER", solver)
        .define("BELTRAMI_BUILD_PROGRAM", "OFF")
        .define("BELTRAMI_BUILD_TESTS", "OFF")
        .define("BELTRAMI_INSTALL", "OFF")
        .build_target("beltrami_static")
        .build()
}

/// Puts the library and the header where `root` promises them: `lib` and `include` under it.
fn lay_out(out: &Path, sources: &Path) -> std::io::Result<PathBuf> {
    let root = out.join("root");
    let (lib, include) = (root.join("lib"), root.join("include/beltrami"));
    fs::create_dir_all(&lib)?;
    fs::create_dir_all(&include)?;
    let header = "beltrami.h";
    fs::copy(sources.join("include/beltrami").join(header), include.join(header))?;
    // Generators for several configurations have a folder for each.
    let built = ["src", "src/Release"].map(|folder| out.join("build").join(folder));
    let library = built
        .iter()
        .flat_map(|folder| ["libbeltrami.a", "beltrami.lib"].map(|name| folder.join(name)))
        .find(|path| path.is_file())
        .ok_or_else(|| std::io::Error::other("CMake built no static library"))?;
    fs::copy(&library, lib.join(library.file_name().expect("it was found by its name")))?;
    Ok(root)
}

/// The value of a variable in CMake's cache.
fn cached<'a>(cache: &'a str, name: &str) -> Option<&'a str> {
    cache.lines().find_map(|line| {
        let value = line.strip_prefix(name)?.strip_prefix(':')?;
        Some(value.split_once('=')?.1)
    })
}
