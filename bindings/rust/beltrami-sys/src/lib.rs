#![doc = include_str!("../README.md")]
#![no_std]
// The names and the comments are the header's: what explains itself there has none.
#![allow(missing_docs, non_camel_case_types, rustdoc::broken_intra_doc_links)]
#![allow(clippy::undocumented_unsafe_blocks)] // bindgen's own are

#[cfg(not(feature = "buildtime-bindgen"))]
#[rustfmt::skip]
mod bindings;
#[cfg(feature = "buildtime-bindgen")]
mod bindings {
    include!(concat!(env!("OUT_DIR"), "/bindings.rs"));
}
pub use bindings::*;

/// "No element" in element fields: all bits set. (bindgen passes over the header's macro.)
pub const BELTRAMI_NO_ELEMENT: u64 = u64::MAX;

/// Makes a context for the ABI that these bindings were generated from: the header's macro of this
/// name.
///
/// # Safety
///
/// `out` is null, which is refused, or valid for a write.
///
/// # Errors
///
/// `BELTRAMI_E_ABI_MISMATCH` where the library has another ABI, `BELTRAMI_E_INVALID_ARGUMENT`
/// where `out` is null, `BELTRAMI_E_OUT_OF_MEMORY`.
#[inline]
pub unsafe fn beltrami_create(out: *mut *mut beltrami_context) -> beltrami_status {
    // SAFETY: the caller's promise is the one that the function asks for.
    unsafe { beltrami_create_(BELTRAMI_ABI, out) }
}
