//! The options of a run, by their own types or by the names that the program `beltrami` has too.

mod table;

use std::fmt;
use std::mem::size_of;
use std::time::Duration;

use beltrami_sys as sys;

use crate::error::Error;
pub use table::{
    Cut, Delaunay, Effort, Energy, Flatten, Injectivity, Method, Pack, PackTurns, Preset, Rectify,
    Stack, Weld, OPTIONS,
};

/// What an option takes.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
#[non_exhaustive]
pub enum OptionKind {
    /// Yes or no.
    Switch,
    /// A whole number.
    Int,
    /// A number.
    Float,
    /// One of [`OptionInfo::choices`].
    Choice,
}

/// An option as a user interface shows it; [`OPTIONS`] lists them all.
#[derive(Debug, Clone, Copy, PartialEq)]
#[non_exhaustive]
pub struct OptionInfo {
    /// The name: `"coarse-faces"`.
    pub name: &'static str,
    /// One sentence on what it does.
    pub summary: &'static str,
    /// What it takes.
    pub kind: OptionKind,
    /// The least value, inclusive; of a choice the number of its first name, 0.
    pub minimum: f64,
    /// The greatest value, inclusive; of a choice the number of its last name.
    pub maximum: f64,
    /// The value that holds where nothing is set; of a choice the number of the name.
    pub default: f64,
    /// The names of a choice.
    pub choices: &'static [&'static str],
    /// Whether it is one of [`Options`], for a [`Flattener`](crate::Flattener).
    pub flattens: bool,
    /// Whether it is one of [`UnwrapOptions`], for an [`Unwrapper`](crate::Unwrapper).
    pub unwraps: bool,
    /// Whether it is one of [`PackOptions`], for a [`Packer`](crate::Packer).
    pub packs: bool,
}

/// A value as the library takes it.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) enum Value {
    Int(i64),
    Float(f64),
}

/// What can be given as the value of an option.
trait IntoValue {
    fn into_value(self) -> Value;
}

impl IntoValue for bool {
    fn into_value(self) -> Value {
        Value::Int(self.into())
    }
}

impl IntoValue for u32 {
    fn into_value(self) -> Value {
        Value::Int(self.into())
    }
}

impl IntoValue for u64 {
    /// Beyond all ranges where it does not fit, so that the library refuses it.
    fn into_value(self) -> Value {
        Value::Int(i64::try_from(self).unwrap_or(i64::MAX))
    }
}

impl IntoValue for f64 {
    fn into_value(self) -> Value {
        Value::Float(self)
    }
}

impl IntoValue for Duration {
    fn into_value(self) -> Value {
        Value::Float(self.as_secs_f64())
    }
}

/// Defines the type of a choice option.
macro_rules! choice {
    ($(#[$doc:meta])* $type:ident { $( $(#[$variant_doc:meta])* $variant:ident = $name:literal, )* }) => {
        $(#[$doc])*
        #[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
        #[non_exhaustive]
        pub enum $type {
            $( $(#[$variant_doc])* $variant, )*
        }

        impl $type {
            /// All of them, in the order of their numbers.
            pub const ALL: &'static [$type] = &[$( $type::$variant ),*];

            const NAMES: &'static [&'static str] = &[$( $name ),*];

            /// The name that the program `beltrami` has for it.
            pub fn name(self) -> &'static str {
                $type::NAMES[self as usize]
            }
        }

        impl std::fmt::Display for $type {
            fn fmt(&self, formatter: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
                formatter.pad(self.name())
            }
        }

        impl crate::options::IntoValue for $type {
            fn into_value(self) -> crate::options::Value {
                crate::options::Value::Int(self as i64)
            }
        }
    };
}

/// Defines the method of one builder that sets an option.
macro_rules! setter {
    ($builder:ident [$(#[doc = $doc:literal])*] $option:ident $type:ty, $key:literal) => {
        impl $builder {
            $(#[doc = $doc])*
            pub fn $option(self, value: $type) -> Self {
                self.with($key, crate::options::IntoValue::into_value(value))
            }
        }
    };
}

/// Defines the methods of builders that set an option.
macro_rules! setters {
    ([$($builder:ident)*] $doc:tt $option:ident $type:ty, $key:literal) => {
        $( crate::options::setter!($builder $doc $option $type, $key); )*
    };
}

/// Defines `OPTIONS` and the methods of the builders that set one.
macro_rules! options {
    ($( $(#[doc = $doc:literal])*
        $option:ident($type:ty) of $builders:tt = $key:literal $name:literal $summary:literal
            $kind:ident($choices:expr), $minimum:literal..=$maximum:literal, default $default:literal,
            calls $calls:literal;
    )*) => {
        /// All options, in the order of the library's table: what a user interface or a command
        /// line is made from, with [`Options::set`], [`UnwrapOptions::set`] and
        /// [`PackOptions::set`].
        pub const OPTIONS: &[crate::OptionInfo] = &[$(
            crate::OptionInfo {
                name: $name,
                summary: $summary,
                kind: crate::OptionKind::$kind,
                minimum: $minimum as f64,
                maximum: $maximum as f64,
                default: $default as f64,
                choices: $choices,
                flattens: $calls & beltrami_sys::BELTRAMI_CALL_RUN != 0,
                unwraps: $calls & beltrami_sys::BELTRAMI_CALL_UNWRAP != 0,
                packs: $calls & beltrami_sys::BELTRAMI_CALL_PACK != 0,
            },
        )*];

        $( crate::options::setters!($builders [$(#[doc = $doc])*] $option $type, $key); )*
    };
}
use {choice, options, setter, setters};

/// Defines a builder of options.
macro_rules! builder {
    ($(#[$doc:meta])* $builder:ident, $is_taken:ident) => {
        $(#[$doc])*
        #[derive(Clone, PartialEq)]
        #[must_use = "builders return what they build"]
        pub struct $builder(Values);

        impl $builder {
            /// All options as the library has them.
            pub fn new() -> Self {
                $builder(Values([None; OPTIONS.len()]))
            }

            /// Sets an option by its name, to a number, a choice's name, or for a switch `true` or
            /// `false`: what a command line or a settings file has.
            ///
            /// # Errors
            ///
            /// [`InvalidArgument`](crate::ErrorKind::InvalidArgument) for an unknown name, and for
            /// text that is no value of the option. Numbers are compared with its range when the
            /// options are used.
            pub fn set(mut self, name: &str, value: &str) -> Result<Self, Error> {
                self.0.set(name, value, |option| option.$is_taken)?;
                Ok(self)
            }

            fn with(mut self, key: usize, value: Value) -> Self {
                self.0.0[key] = Some(value);
                self
            }

            /// Keys and values of all options that the library has.
            pub(crate) fn values(&self) -> impl Iterator<Item = (i32, Value)> + '_ {
                self.0.all()
            }
        }

        impl Default for $builder {
            fn default() -> Self {
                $builder::new()
            }
        }

        impl fmt::Debug for $builder {
            fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
                self.0.fmt(formatter)
            }
        }
    };
}

builder! {
    /// The options of a run. What is not set is as the library has it.
    ///
    /// ```
    /// # use beltrami::{Energy, Flatten, Flattener, Options};
    /// let options =
    ///     Options::new().energy(Energy::SymmetricArap).flatten(Flatten::Metric).threads(4);
    /// assert_eq!(options, Options::new().set("energy", "symmetric-arap")?
    ///     .set("flatten", "metric")?.set("threads", "4")?);
    /// # Flattener::with_options(&options)?;
    /// # Ok::<(), beltrami::Error>(())
    /// ```
    Options, flattens
}

builder! {
    /// The options of unwrapping. What is not set is as the library has it.
    ///
    /// ```
    /// # use beltrami::{Cut, UnwrapOptions, Unwrapper};
    /// let options = UnwrapOptions::new().cut(Cut::Islands).hard_angle(60.0).threads(4);
    /// assert_eq!(options, UnwrapOptions::new().set("cut", "islands")?
    ///     .set("hard-angle", "60")?.set("threads", "4")?);
    /// # Unwrapper::with_options(&options)?;
    /// # Ok::<(), beltrami::Error>(())
    /// ```
    UnwrapOptions, unwraps
}

builder! {
    /// The options of packing. What is not set is as the library has it.
    ///
    /// ```
    /// # use beltrami::{PackOptions, PackTurns, Packer};
    /// let options = PackOptions::new().resolution(2048).pack_turns(PackTurns::Quarter);
    /// assert_eq!(options, PackOptions::new().set("resolution", "2048")?
    ///     .set("pack-turns", "quarter")?);
    /// # Packer::with_options(&options)?;
    /// # Ok::<(), beltrami::Error>(())
    /// ```
    PackOptions, packs
}

/// Values of options by key; `None` for the default.
#[derive(Clone, PartialEq)]
struct Values([Option<Value>; OPTIONS.len()]);

impl Values {
    fn set(
        &mut self,
        name: &str,
        value: &str,
        is_taken: impl Fn(&OptionInfo) -> bool,
    ) -> Result<(), Error> {
        let known = |option: &OptionInfo| option.name == name && is_taken(option);
        let key = OPTIONS.iter().position(known).ok_or_else(|| {
            Error::argument(format!("there is no option {name}: see beltrami::OPTIONS"))
        })?;
        let option = &OPTIONS[key];
        let number = option.parse(value).ok_or_else(|| {
            let takes = option.takes();
            Error::argument(format!("{value:?} is no value for the option {name}: {takes}"))
        })?;
        self.0[key] = Some(number);
        Ok(())
    }

    /// First all defaults, so that a preset that is set holds for what is not.
    fn all(&self) -> impl Iterator<Item = (i32, Value)> + '_ {
        let defaults = (0..).zip(&self.0).filter_map(|(key, _)| Some((key, default(key)?)));
        defaults.chain((0..).zip(&self.0).filter_map(|(key, value)| Some((key, (*value)?))))
    }
}

impl fmt::Debug for Values {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        let set = OPTIONS
            .iter()
            .zip(&self.0)
            .filter_map(|(option, value)| Some((option.name, value.as_ref()?)));
        formatter.debug_map().entries(set).finish()
    }
}

/// The default of the library at run time, which may be newer or older than the table here.
fn default(key: i32) -> Option<Value> {
    let mut info = sys::beltrami_option_info {
        struct_size: size_of::<sys::beltrami_option_info>() as u32,
        ..Default::default()
    };
    // SAFETY: `info` has the size that it says.
    if unsafe { sys::beltrami_option_describe(key, &mut info) } != sys::BELTRAMI_OK {
        return None;
    }
    Some(match info.type_ {
        sys::BELTRAMI_TYPE_FLOAT => Value::Float(info.default_value),
        _ => Value::Int(info.default_value as i64),
    })
}

impl OptionInfo {
    /// The value that a text stands for, whatever the range.
    fn parse(&self, text: &str) -> Option<Value> {
        let names: &[&str] = match self.kind {
            OptionKind::Float => return text.parse().ok().map(Value::Float),
            OptionKind::Switch => &["false", "true"],
            OptionKind::Int | OptionKind::Choice => self.choices,
        };
        let number = match names.iter().position(|name| *name == text) {
            Some(position) => position as i64,
            None => text.parse().ok()?,
        };
        Some(Value::Int(number))
    }

    /// What a value may be, in words.
    fn takes(&self) -> String {
        match self.kind {
            OptionKind::Choice => format!("give one of {}", self.choices.join(", ")),
            OptionKind::Switch => "give true or false".to_owned(),
            OptionKind::Int => {
                format!("give a whole number from {} to {}", self.minimum, self.maximum)
            }
            // With an exponent where there would be hundreds of zeros.
            OptionKind::Float if self.maximum > 1e15 => {
                format!("give a number from {} to {:e}", self.minimum, self.maximum)
            }
            OptionKind::Float => format!("give a number from {} to {}", self.minimum, self.maximum),
        }
    }
}
