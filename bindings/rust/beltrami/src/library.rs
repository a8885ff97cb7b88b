//! What the program runs with.

use std::ffi::CString;

use beltrami_sys as sys;

use crate::error::static_text;

/// The version of the library at run time: major, minor, patch.
pub fn version() -> (u32, u32, u32) {
    // SAFETY: it takes nothing and cannot fail.
    let number = unsafe { sys::beltrami_version() };
    (number / 1_000_000, number / 1000 % 1000, number % 1000)
}

/// One line on the library at run time: version, solver, licence of what it links.
pub fn build_info() -> &'static str {
    // SAFETY: it takes nothing; the text is static.
    unsafe { static_text(sys::beltrami_build_info()) }
}

/// Whether the library at run time has a feature: `"solver:native"`, `"solver:eigen"`,
/// `"solver:cholmod"`, `"scaffold:own"`, `"scaffold:cgal"`, `"simplifier:native"`,
/// `"simplifier:openmesh"`, `"exact:own"`, `"exact:cgal"`, `"gpl"`, `"lgpl"`.
pub fn has(feature: &str) -> bool {
    // SAFETY: the text is NUL-terminated and lasts for the call.
    CString::new(feature).is_ok_and(|name| unsafe { sys::beltrami_has(name.as_ptr()) } != 0)
}
