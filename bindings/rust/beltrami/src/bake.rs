//! Bakes: what images show through old UVs, for new ones.

use std::ffi::c_void;
use std::mem::size_of;
use std::panic::resume_unwind;
use std::ptr;

use beltrami_sys as sys;

use crate::context::Context;
use crate::control::{CancelToken, Control, Trampoline};
use crate::error::{Error, ErrorKind};
use crate::mesh::{Positions, Uvs};
use crate::options::Value;
use crate::surface::Integers;
use crate::view::Buffer;

mod sealed {
    #[allow(unknown_lints, unnameable_types)] // so that nobody implements it
    pub trait Sealed {
        /// The `BELTRAMI_SCALAR` number of the type.
        const TYPE: i32;
    }
}

/// Numbers of pixels: `u8` and `u16` in their whole range, `f32` as it is.
pub trait Pixel: sealed::Sealed + Copy + Default {}

macro_rules! pixels {
    ($( $pixel:ty = $number:ident; )*) => { $(
        impl sealed::Sealed for $pixel {
            const TYPE: i32 = sys::$number;
        }
        impl Pixel for $pixel {}
    )* };
}
pixels! {
    u8 = BELTRAMI_U8;
    u16 = BELTRAMI_U16;
    f32 = BELTRAMI_F32;
}

/// An image, borrowed: rows from the top (v = 1) down, one after another.
#[derive(Debug, Clone, Copy)]
pub struct Image<'a, T> {
    pixels: &'a [T],
    width: usize,
    height: usize,
    channels: usize,
}

impl<'a, T: Pixel> Image<'a, T> {
    /// `width * height * channels` numbers; 1 to 4 channels.
    ///
    /// # Errors
    ///
    /// [`InvalidArgument`](ErrorKind::InvalidArgument) where there are others.
    pub fn new(
        pixels: &'a [T],
        width: usize,
        height: usize,
        channels: usize,
    ) -> Result<Image<'a, T>, Error> {
        let wanted = width.checked_mul(height).and_then(|texels| texels.checked_mul(channels));
        if wanted != Some(pixels.len()) {
            return Err(Error::argument(format!(
                "there are {} numbers for an image of {width} x {height} with {channels} channels",
                pixels.len()
            )));
        }
        Ok(Image { pixels, width, height, channels })
    }

    fn raw(&self) -> sys::beltrami_image {
        sys::beltrami_image {
            pixels: self.pixels.as_ptr().cast(),
            width: self.width as u64,
            height: self.height as u64,
            stride: 0,
            type_: T::TYPE,
            channels: u32::try_from(self.channels).unwrap_or(u32::MAX),
        }
    }
}

/// What the channels of an image are, which says how a mean of them is taken.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
#[non_exhaustive]
pub enum PixelKind {
    /// As they are: roughness, heights, linear light.
    #[default]
    Linear,
    /// Colours of sRGB, meant in linear light; a second or fourth channel is linear.
    Srgb,
    /// The same, and a colour counts by that channel, its alpha.
    SrgbAlpha,
    /// Normals in tangent space, which are turned to the axes of the new UVs. Wants positions.
    Normals,
    /// None are read: the share of a grey sky that a place sees, from 0 to 1, past the triangles
    /// themselves or the source. Wants positions, [`rays`](Bake::rays) and one image, whose type
    /// and channels alone count.
    Occlusion,
}

/// What an image shows beyond the unit square.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
#[non_exhaustive]
pub enum Wrap {
    /// Itself again.
    #[default]
    Repeat,
    /// Its outermost texels.
    Clamp,
    /// Itself, mirrored at every other time.
    Mirror,
}

/// How texels are read.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
#[non_exhaustive]
pub enum Filter {
    /// Between texels.
    #[default]
    Linear,
    /// Each place shows its texel.
    Nearest,
}

/// Images for new UVs.
#[derive(Debug, Clone, PartialEq)]
#[non_exhaustive]
pub struct Baked<T> {
    /// The pages, one after another: rows from the top, of as many channels as the images; 0 where
    /// nothing is baked.
    pub pixels: Vec<T>,
    /// Texels that a face covers, at least in part.
    pub texels: u64,
    /// Of these: those that nothing was baked for.
    pub without_source: u64,
    /// Texels of the old images along the side of a new one, in the mean: above 1 is coarser.
    pub old_texels: f64,
}

/// Triangles with two layouts of UVs, and the images of the old one.
///
/// ```
/// use beltrami::{Bake, Image};
///
/// // A square of two triangles is turned by a quarter.
/// let old = [[0.0_f64, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 0.0], [1.0, 1.0], [0.0, 1.0]];
/// let new = old.map(|[u, v]| [1.0 - v, u]);
/// let image = [Image::new(&[1_u8, 2, 3, 4], 2, 2, 1)?];
/// let baked = Bake::new(&image, &old, &new).resolution(2).bake()?;
/// assert_eq!(baked.pixels, [2, 4, 1, 3]);
/// # Ok::<(), beltrami::Error>(())
/// ```
#[derive(Debug, Clone, Copy)]
#[must_use = "call bake"]
pub struct Bake<'a, T> {
    images: &'a [Image<'a, T>],
    old_uvs: Uvs<'a>,
    new_uvs: Uvs<'a>,
    pixels: PixelKind,
    wrap: [Wrap; 2],
    filter: Filter,
    old_pages: Option<Integers<'a>>,
    new_pages: Option<Integers<'a>>,
    positions: Option<Positions<'a>>,
    normals: Option<Positions<'a>>,
    source_positions: Option<Positions<'a>>,
    cage: f64,
    rays: u64,
    resolution: u64,
    gutter: u64,
    page_count: u64,
    threads: i64,
}

impl<'a, T: Pixel> Bake<'a, T> {
    /// The images of the old pages, of as many channels, and the UVs of the corners, three for each
    /// triangle. Old UVs are in units of the image, new ones in the unit square of the page.
    /// Old UVs that are not finite have no source.
    pub fn new(
        images: &'a [Image<'a, T>],
        old_uvs: impl Into<Uvs<'a>>,
        new_uvs: impl Into<Uvs<'a>>,
    ) -> Bake<'a, T> {
        Bake {
            images,
            old_uvs: old_uvs.into(),
            new_uvs: new_uvs.into(),
            pixels: PixelKind::default(),
            wrap: [Wrap::default(); 2],
            filter: Filter::default(),
            old_pages: None,
            new_pages: None,
            positions: None,
            normals: None,
            source_positions: None,
            cage: 0.0,
            rays: 0,
            resolution: 1024,
            gutter: u64::MAX,
            page_count: 1,
            threads: 1,
        }
    }

    /// What the channels are.
    pub fn pixels(mut self, kind: PixelKind) -> Self {
        self.pixels = kind;
        self
    }

    /// What an image shows beyond the unit square, along u and v.
    pub fn wrap(mut self, along_u: Wrap, along_v: Wrap) -> Self {
        self.wrap = [along_u, along_v];
        self
    }

    /// How texels are read.
    pub fn filter(mut self, filter: Filter) -> Self {
        self.filter = filter;
        self
    }

    /// The image of each triangle, counted from 0; the greatest number of the type for none.
    pub fn old_pages(mut self, pages: impl Into<Integers<'a>>) -> Self {
        self.old_pages = Some(pages.into());
        self
    }

    /// The page of each triangle, counted from 0 to `count`; the greatest number of the type for
    /// none.
    pub fn new_pages(mut self, pages: impl Into<Integers<'a>>, count: usize) -> Self {
        self.new_pages = Some(pages.into());
        self.page_count = count as u64;
        self
    }

    /// The position of each corner, for normals and with
    /// [`source_positions`](Self::source_positions).
    pub fn positions(mut self, positions: impl Into<Positions<'a>>) -> Self {
        self.positions = Some(positions.into());
        self
    }

    /// The normal of each corner, for images of normals and with a [`cage`](Self::cage); left out:
    /// that of the triangle.
    pub fn normals(mut self, normals: impl Into<Positions<'a>>) -> Self {
        self.normals = Some(normals.into());
        self
    }

    /// The position of each corner of other triangles of the same shape, in the same place. The old
    /// UVs and pages are then of these, and each texel shows the nearest place of them.
    pub fn source_positions(mut self, positions: impl Into<Positions<'a>>) -> Self {
        self.source_positions = Some(positions.into());
        self
    }

    /// How far rays along the normals look for the source, in its unit; 0 by default. One comes
    /// from as far outside and goes as far inside, and the first triangle that it comes to from
    /// outside is shown. Where it meets none, the nearest place is.
    pub fn cage(mut self, length: f64) -> Self {
        self.cage = length;
        self
    }

    /// Rays from each texel to the sky, 1 to 4,096, for [`PixelKind::Occlusion`].
    pub fn rays(mut self, count: usize) -> Self {
        self.rays = count as u64;
        self
    }

    /// Texels to the side of a page, 1 to 32,768; 1,024 by default.
    pub fn resolution(mut self, texels: usize) -> Self {
        self.resolution = texels as u64;
        self
    }

    /// Texels around charts that continue them; the whole page by default.
    pub fn gutter(mut self, texels: usize) -> Self {
        self.gutter = texels as u64;
        self
    }

    /// Threads to use, the calling one included; the result does not depend on it.
    pub fn threads(mut self, threads: usize) -> Self {
        self.threads = i64::try_from(threads).unwrap_or(i64::MAX);
        self
    }

    /// Bakes.
    ///
    /// # Errors
    ///
    /// [`InvalidArgument`](ErrorKind::InvalidArgument) where lengths do not fit together, numbers
    /// are out of range, or most texels have no source; [`Empty`](ErrorKind::Empty),
    /// [`NonFinite`](ErrorKind::NonFinite) with the corner,
    /// [`OutOfMemory`](ErrorKind::OutOfMemory), [`Internal`](ErrorKind::Internal).
    pub fn bake(&self) -> Result<Baked<T>, Error> {
        self.bake_with(Control::new())
    }

    /// Bakes, watched and ended by `control`.
    ///
    /// # Errors
    ///
    /// As [`bake`](Self::bake), and [`Cancelled`](ErrorKind::Cancelled) by `control`.
    ///
    /// # Panics
    ///
    /// Where the progress closure does, with what it panics with.
    pub fn bake_with(&self, control: Control<'_>) -> Result<Baked<T>, Error> {
        let Control { progress, token } = control;
        if token.is_cancelled() {
            return Err(Error::new(ErrorKind::Cancelled, "the run was cancelled before it began"));
        }
        let images: Vec<_> = self.images.iter().map(Image::raw).collect();
        let job = self.raw(&images, &token)?;
        let channels = self.images.first().map_or(0, |image| image.channels);
        let mut pixels = vec![T::default(); self.room(channels)?];
        let mut out = sys::beltrami_baked {
            struct_size: size_of::<sys::beltrami_baked>() as u32,
            pixels: pixels.as_mut_ptr().cast::<c_void>(),
            ..Default::default()
        };
        let context = Context::new()?;
        context.apply([(sys::BELTRAMI_OPTION_THREADS, Value::Int(self.threads))].into_iter())?;
        let mut trampoline = Trampoline::new(progress);
        let entry = trampoline.entry();
        let user = ptr::from_mut(&mut trampoline).cast();
        // SAFETY: the context is alive; the images and views behind the job are borrowed, with as
        // many items as it says; there is room for the pages; the token lives longer; the trampoline
        // is what `entry` expects as `user`.
        let status = unsafe { sys::beltrami_bake(context.raw(), &job, &mut out, entry, user) };
        if let Some(payload) = trampoline.panic.take() {
            drop(trampoline); // not while a panic is on its way, or another one would abort
            resume_unwind(payload);
        }
        context.check(status)?;
        Ok(Baked {
            pixels,
            texels: out.texels,
            without_source: out.without_source,
            old_texels: out.old_texels,
        })
    }

    /// Numbers of all pages. Fails where the library would refuse them, too.
    fn room(&self, channels: usize) -> Result<usize, Error> {
        let (resolution, pages) = (self.resolution, self.page_count);
        if !(1..=32768).contains(&resolution) || !(1..=1000).contains(&pages) {
            return Err(Error::argument(format!(
                "{pages} pages of {resolution} texels: give 1 to 1000 of 1 to 32768"
            )));
        }
        let texels = resolution * resolution * pages;
        let numbers = usize::try_from(texels).ok().and_then(|texels| texels.checked_mul(channels));
        numbers.ok_or_else(|| Error::new(ErrorKind::OutOfMemory, "the pages are too large"))
    }

    /// The library's description, which holds as long as the borrow and the token.
    fn raw(
        &self,
        images: &[sys::beltrami_image],
        token: &CancelToken,
    ) -> Result<sys::beltrami_bake_job, Error> {
        let corners = self.new_uvs.len();
        let faces = corners / 3;
        let source_corners = self.source_positions.map_or(corners, |positions| positions.len());
        let reads = self.pixels != PixelKind::Occlusion;
        let lengths = [
            (Some(self.new_uvs.len()), 3 * faces),
            (reads.then_some(self.old_uvs.len()), 3 * (source_corners / 3)),
            (self.positions.map(|positions| positions.len()), corners),
            (self.normals.map(|normals| normals.len()), corners),
            (self.source_positions.map(|positions| positions.len()), 3 * (source_corners / 3)),
            (self.old_pages.map(|pages| pages.len()), source_corners / 3),
            (self.new_pages.map(|pages| pages.len()), faces),
        ];
        for (given, wanted) in lengths {
            if given.is_some_and(|given| given != wanted) {
                return Err(Error::argument(format!(
                    "there are {} items where there are to be {wanted}: give three for each \
                     triangle, and a page for each",
                    given.unwrap_or_default()
                )));
            }
        }
        let optional =
            |buffer: Option<Buffer<'_>>| buffer.map_or_else(Default::default, |b| b.raw());
        Ok(sys::beltrami_bake_job {
            struct_size: size_of::<sys::beltrami_bake_job>() as u32,
            images: images.as_ptr(),
            image_count: images.len() as u64,
            pixels: match self.pixels {
                PixelKind::Linear => sys::BELTRAMI_PIXELS_LINEAR,
                PixelKind::Srgb => sys::BELTRAMI_PIXELS_SRGB,
                PixelKind::SrgbAlpha => sys::BELTRAMI_PIXELS_SRGB_ALPHA,
                PixelKind::Normals => sys::BELTRAMI_PIXELS_NORMALS,
                PixelKind::Occlusion => sys::BELTRAMI_PIXELS_OCCLUSION,
            },
            filter: match self.filter {
                Filter::Linear => sys::BELTRAMI_FILTER_LINEAR,
                Filter::Nearest => sys::BELTRAMI_FILTER_NEAREST,
            },
            wrap_u: number_of(self.wrap[0]),
            wrap_v: number_of(self.wrap[1]),
            face_count: faces as u64,
            new_uvs: self.new_uvs.0.raw(),
            new_pages: optional(self.new_pages.map(|pages| pages.0)),
            old_uvs: self.old_uvs.0.raw(),
            old_pages: optional(self.old_pages.map(|pages| pages.0)),
            positions: optional(self.positions.map(|positions| positions.0)),
            normals: optional(self.normals.map(|normals| normals.0)),
            source_face_count: self.source_positions.map_or(0, |_| source_corners as u64 / 3),
            source_positions: optional(self.source_positions.map(|positions| positions.0)),
            resolution: self.resolution,
            gutter: self.gutter,
            page_count: self.page_count,
            cancel: token.number(),
            cage: self.cage,
            rays: self.rays,
            ..Default::default()
        })
    }
}

fn number_of(wrap: Wrap) -> i32 {
    match wrap {
        Wrap::Repeat => sys::BELTRAMI_WRAP_REPEAT,
        Wrap::Clamp => sys::BELTRAMI_WRAP_CLAMP,
        Wrap::Mirror => sys::BELTRAMI_WRAP_MIRROR,
    }
}
