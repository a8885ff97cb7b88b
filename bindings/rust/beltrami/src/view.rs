//! Views of items in the caller's memory, wherever they lie, checked once and for all.

use std::ffi::c_void;
use std::fmt;
use std::marker::PhantomData;
use std::mem::size_of;
use std::ops::Range;

use beltrami_sys as sys;

use crate::error::Error;

mod sealed {
    /// Keeps [`Scalar`](super::Scalar) to the types that the library knows.
    #[allow(unknown_lints, unnameable_types)] // so that nobody implements it
    pub trait Sealed {
        /// The `BELTRAMI_SCALAR` number of the type.
        const TYPE: i32;
    }
}
pub(crate) use sealed::Sealed;

/// The numbers that the library reads and writes: `f32`, `f64`, `u16`, `u32`, `u64`.
pub trait Scalar: Sealed + Copy + Default + Send + Sync + 'static {}

/// Coordinates: `f32` or `f64`.
pub trait Real: Scalar {}

/// Vertex indices: `u16`, `u32` or `u64`.
pub trait Index: Scalar {}

/// Indices that hold whatever a result has: `u32` or `u64`.
pub trait WideIndex: Index {}

impl WideIndex for u32 {}
impl WideIndex for u64 {}

macro_rules! scalars {
    ($( $scalar:ty: $role:ident = $number:ident; )*) => { $(
        impl Sealed for $scalar {
            const TYPE: i32 = sys::$number;
        }
        impl Scalar for $scalar {}
        impl $role for $scalar {}
    )* };
}
scalars! {
    f32: Real = BELTRAMI_F32;
    f64: Real = BELTRAMI_F64;
    u16: Index = BELTRAMI_U16;
    u32: Index = BELTRAMI_U32;
    u64: Index = BELTRAMI_U64;
}

/// Items of `N` numbers each, at even distances in memory that is borrowed for `'a`.
///
/// Slices of arrays convert by themselves. The constructors check that every item lies in the
/// memory that they are given, so that whoever takes a view need not.
///
/// ```
/// # use beltrami::View;
/// struct Vertex {
///     position: [f32; 3],
///     normal: [f32; 3],
/// }
/// let vertices = [
///     Vertex { position: [0.0, 1.0, 2.0], normal: [0.0, 0.0, 1.0] },
///     Vertex { position: [3.0, 4.0, 5.0], normal: [0.0, 0.0, 1.0] },
/// ];
/// let positions = View::from_field(&vertices, |vertex| &vertex.position)?;
/// assert_eq!(positions.get(1), Some([3.0, 4.0, 5.0]));
/// # Ok::<(), beltrami::Error>(())
/// ```
#[derive(Clone, Copy)]
pub struct View<'a, T, const N: usize> {
    first: *const T,
    /// Bytes from one item to the next; any number where there is no next one.
    stride: usize,
    len: usize,
    memory: PhantomData<&'a [T]>,
}

/// As [`View`], of memory to write to.
pub struct ViewMut<'a, T, const N: usize> {
    first: *mut T,
    stride: usize,
    len: usize,
    memory: PhantomData<&'a mut [T]>,
}

// SAFETY: a view is a shared borrow of plain numbers, as `&[T]` is.
unsafe impl<T: Scalar, const N: usize> Send for View<'_, T, N> {}
// SAFETY: as above.
unsafe impl<T: Scalar, const N: usize> Sync for View<'_, T, N> {}
// SAFETY: an exclusive borrow of plain numbers, as `&mut [T]` is.
unsafe impl<T: Scalar, const N: usize> Send for ViewMut<'_, T, N> {}
// SAFETY: a shared reference to it gives no access to the numbers.
unsafe impl<T: Scalar, const N: usize> Sync for ViewMut<'_, T, N> {}

impl<'a, T: Scalar, const N: usize> View<'a, T, N> {
    /// Items in a row: `x0 y0 z0 x1 y1 z1 ...` for `N` = 3.
    ///
    /// # Errors
    ///
    /// [`InvalidArgument`](crate::ErrorKind::InvalidArgument) where the number of numbers is no
    /// multiple of `N`.
    pub fn from_flat(numbers: &'a [T]) -> Result<Self, Error> {
        let len = flat_len::<N>(numbers.len())?;
        // SAFETY: the numbers are `len` items of N, and borrowed for 'a.
        Ok(unsafe { View::new(numbers.as_ptr(), N * size_of::<T>(), len) })
    }

    /// `len` items of which item `i` is `numbers[offset + i * stride..][..N]`.
    ///
    /// # Errors
    ///
    /// [`InvalidArgument`](crate::ErrorKind::InvalidArgument) where items overlap (`stride < N`)
    /// or do not all lie in `numbers`.
    pub fn strided(
        numbers: &'a [T],
        offset: usize,
        stride: usize,
        len: usize,
    ) -> Result<Self, Error> {
        let covered = strided_range::<N>(numbers.len(), offset, stride, len)?;
        let stride = stride_in_bytes::<T>(stride, len);
        // SAFETY: strided_range made sure that the last item ends within the numbers.
        Ok(unsafe { View::new(numbers[covered].as_ptr(), stride, len) })
    }

    /// The field of every item that `field` points to: positions in an array of vertices with
    /// normals and colours, vectors of some other crate.
    ///
    /// # Errors
    ///
    /// [`InvalidArgument`](crate::ErrorKind::InvalidArgument) where `field` does not return the
    /// same part of every item.
    pub fn from_field<S>(
        items: &'a [S],
        mut field: impl for<'b> FnMut(&'b S) -> &'b [T; N],
    ) -> Result<Self, Error> {
        let base = items.as_ptr();
        let addresses = items.iter().map(|item| field(item).as_ptr() as usize);
        let offset = field_offset::<S, [T; N]>(base as usize, addresses)?;
        let first = base.cast::<u8>().wrapping_add(offset).cast::<T>();
        // SAFETY: field_offset made sure that at this offset in every item there is what `field`
        // returned a reference to, one that holds for 'a.
        Ok(unsafe { View::new(first, size_of::<S>(), items.len()) })
    }

    /// Number of items.
    pub fn len(&self) -> usize {
        self.len
    }

    /// Whether there are no items.
    pub fn is_empty(&self) -> bool {
        self.len == 0
    }

    /// A copy of item `index`, or `None` past the last.
    pub fn get(&self, index: usize) -> Option<[T; N]> {
        // SAFETY: it is within the length.
        (index < self.len).then(|| unsafe { self.item(index) })
    }

    /// Copies of all items, in their order.
    pub fn iter(&self) -> impl ExactSizeIterator<Item = [T; N]> + DoubleEndedIterator + 'a {
        let view = *self;
        // SAFETY: it is within the length.
        (0..view.len).map(move |index| unsafe { view.item(index) })
    }

    /// # Safety
    ///
    /// `index` is less than the length.
    unsafe fn item(&self, index: usize) -> [T; N] {
        let item = self.first.cast::<u8>().wrapping_add(index * self.stride);
        // SAFETY: every constructor made sure that there are N numbers at each of the `len` places,
        // in memory that is borrowed for 'a.
        unsafe { item.cast::<[T; N]>().read_unaligned() }
    }

    /// # Safety
    ///
    /// From `first` on there are `len` items, `stride` bytes apart, that are borrowed for `'a`.
    pub(crate) unsafe fn new(first: *const T, stride: usize, len: usize) -> Self {
        View { first, stride, len, memory: PhantomData }
    }

    pub(crate) fn erase(self) -> Buffer<'a> {
        Buffer {
            first: self.first.cast(),
            stride: self.stride,
            scalar: T::TYPE,
            len: self.len,
            memory: PhantomData,
        }
    }
}

impl<'a, T: Scalar, const N: usize> ViewMut<'a, T, N> {
    /// As [`View::from_flat`].
    ///
    /// # Errors
    ///
    /// As there.
    pub fn from_flat(numbers: &'a mut [T]) -> Result<Self, Error> {
        let len = flat_len::<N>(numbers.len())?;
        // SAFETY: the numbers are `len` items of N, and borrowed for 'a.
        Ok(unsafe { ViewMut::new(numbers.as_mut_ptr(), N * size_of::<T>(), len) })
    }

    /// As [`View::strided`].
    ///
    /// # Errors
    ///
    /// As there.
    pub fn strided(
        numbers: &'a mut [T],
        offset: usize,
        stride: usize,
        len: usize,
    ) -> Result<Self, Error> {
        let covered = strided_range::<N>(numbers.len(), offset, stride, len)?;
        let stride = stride_in_bytes::<T>(stride, len);
        // SAFETY: strided_range made sure that the last item ends within the numbers.
        Ok(unsafe { ViewMut::new(numbers[covered].as_mut_ptr(), stride, len) })
    }

    /// As [`View::from_field`].
    ///
    /// # Errors
    ///
    /// As there.
    pub fn from_field<S>(
        items: &'a mut [S],
        mut field: impl for<'b> FnMut(&'b mut S) -> &'b mut [T; N],
    ) -> Result<Self, Error> {
        let len = items.len();
        let base = items.as_ptr() as usize;
        let addresses = items.iter_mut().map(|item| field(item).as_ptr() as usize);
        let offset = field_offset::<S, [T; N]>(base, addresses)?;
        let first = items.as_mut_ptr().cast::<u8>().wrapping_add(offset).cast::<T>();
        // SAFETY: field_offset made sure that at this offset in every item there is what `field`
        // returned a reference to, and nobody else can reach the items during 'a.
        Ok(unsafe { ViewMut::new(first, size_of::<S>(), len) })
    }

    /// Number of items.
    pub fn len(&self) -> usize {
        self.len
    }

    /// Whether there are no items.
    pub fn is_empty(&self) -> bool {
        self.len == 0
    }

    /// # Safety
    ///
    /// As of [`View::new`], the borrow being exclusive.
    unsafe fn new(first: *mut T, stride: usize, len: usize) -> Self {
        ViewMut { first, stride, len, memory: PhantomData }
    }

    pub(crate) fn erase(self) -> BufferMut<'a> {
        BufferMut {
            first: self.first.cast(),
            stride: self.stride,
            scalar: T::TYPE,
            len: self.len,
            memory: PhantomData,
        }
    }
}

impl<'a, T: Scalar, const N: usize> From<&'a [[T; N]]> for View<'a, T, N> {
    fn from(items: &'a [[T; N]]) -> Self {
        // SAFETY: the items are borrowed for 'a.
        unsafe { View::new(items.as_ptr().cast(), size_of::<[T; N]>(), items.len()) }
    }
}

impl<'a, T: Scalar, const N: usize> From<&'a mut [[T; N]]> for ViewMut<'a, T, N> {
    fn from(items: &'a mut [[T; N]]) -> Self {
        // SAFETY: the items are borrowed for 'a.
        unsafe { ViewMut::new(items.as_mut_ptr().cast(), size_of::<[T; N]>(), items.len()) }
    }
}

impl<T: Scalar + fmt::Debug, const N: usize> fmt::Debug for View<'_, T, N> {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        formatter.debug_list().entries(self.iter()).finish()
    }
}

impl<T, const N: usize> fmt::Debug for ViewMut<'_, T, N> {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        formatter.debug_struct("ViewMut").field("len", &self.len).finish_non_exhaustive()
    }
}

/// A view whose type of number is known at run time only.
#[derive(Clone, Copy)]
pub(crate) struct Buffer<'a> {
    first: *const c_void,
    stride: usize,
    scalar: i32,
    pub(crate) len: usize,
    memory: PhantomData<&'a [u8]>,
}

// SAFETY: it comes from a View, which is Send and Sync.
unsafe impl Send for Buffer<'_> {}
// SAFETY: as above.
unsafe impl Sync for Buffer<'_> {}

impl Buffer<'_> {
    /// The library's description, valid for as long as the borrow lasts.
    pub(crate) fn raw(&self) -> sys::beltrami_buffer {
        sys::beltrami_buffer {
            data: self.first,
            stride: self.stride as u64,
            type_: self.scalar,
            reserved: 0,
        }
    }
}

/// A mutable view whose type of number is known at run time only.
pub(crate) struct BufferMut<'a> {
    pub(crate) first: *mut c_void,
    pub(crate) stride: usize,
    pub(crate) scalar: i32,
    pub(crate) len: usize,
    memory: PhantomData<&'a mut [u8]>,
}

// SAFETY: it comes from a ViewMut, which is Send and Sync.
unsafe impl Send for BufferMut<'_> {}
// SAFETY: as above.
unsafe impl Sync for BufferMut<'_> {}

fn flat_len<const N: usize>(numbers: usize) -> Result<usize, Error> {
    if numbers % N == 0 {
        return Ok(numbers / N);
    }
    Err(Error::argument(format!("{numbers} numbers are no whole number of items of {N}")))
}

/// The numbers from the first to the last item. Fails where they are not all there.
fn strided_range<const N: usize>(
    numbers: usize,
    offset: usize,
    stride: usize,
    len: usize,
) -> Result<Range<usize>, Error> {
    if stride < N {
        return Err(Error::argument(format!("a stride of {stride} numbers is less than {N}")));
    }
    if len == 0 {
        return Ok(0..0);
    }
    (len - 1)
        .checked_mul(stride)
        .and_then(|last| last.checked_add(offset)?.checked_add(N))
        .filter(|&end| end <= numbers)
        .map(|end| offset..end)
        .ok_or_else(|| {
            Error::argument(format!(
                "{len} items from number {offset} on, {stride} numbers apart, are not within \
                 {numbers} numbers"
            ))
        })
}

/// The bytes from one of `len` items to the next; 0, which the library takes for packed, where there
/// is no next one, and `stride` may be any number.
fn stride_in_bytes<T>(stride: usize, len: usize) -> usize {
    if len > 1 {
        stride * size_of::<T>() // two items lie in memory, so the number of bytes is one
    } else {
        0
    }
}

/// Where in an `S` its field `F` lies, if it is the same place in every item of a slice at `base`
/// whose fields have the `addresses`. 0 for no items.
fn field_offset<S, F>(base: usize, addresses: impl Iterator<Item = usize>) -> Result<usize, Error> {
    let mut offset = None;
    for (index, address) in addresses.enumerate() {
        let found = address.wrapping_sub(base + index * size_of::<S>());
        let inside = found.checked_add(size_of::<F>()).is_some_and(|end| end <= size_of::<S>());
        if !inside || found != *offset.get_or_insert(found) {
            return Err(Error::argument(format!(
                "the closure does not return the same part of every item: see item {index}"
            )));
        }
    }
    Ok(offset.unwrap_or(0))
}
