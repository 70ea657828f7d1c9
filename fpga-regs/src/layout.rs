//! The tables behind the registers and packets, and the macros that make them.
//!
//! [`word!`](crate::word) writes a field down once and derives from it the accessors that Rust
//! code uses and the [`Field`] table from which the reference page and the SystemVerilog
//! packages are generated. So the three cannot disagree. `registers!` does so for the registers of
//! an agent: a block as it lies in memory, an enum of their offsets, and a [`RegisterInfo`] table.

/// One bit field of a register or packet word.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Field {
    /// Name in lower case with underscores.
    pub name: &'static str,
    /// Highest bit, 0…31.
    pub high: u32,
    /// Lowest bit, 0…`high`.
    pub low: u32,
    /// Whether the bits are two's complement.
    pub signed: bool,
    /// What the field means, from its doc comment.
    pub doc: &'static str,
}

/// How a register answers a write.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Access {
    /// Read only: a write is ignored.
    ReadOnly,
    /// Reads back what was written (but for bits documented otherwise).
    ReadWrite,
    /// A one clears the bit, a zero leaves it.
    WriteOneToClear,
}

/// A register's row in its agent's table.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct RegisterInfo {
    /// Name in upper case, as in the SystemVerilog package.
    pub name: &'static str,
    /// Byte offset from the agent's start.
    pub offset: usize,
    /// How it answers a write.
    pub access: Access,
    /// Value after reset, where it is the same on every device.
    pub reset: Option<u32>,
    /// What it holds.
    pub doc: &'static str,
    /// Its fields; empty when it is one 32-bit number.
    pub fields: &'static [Field],
}

/// A type that a bit field can hold.
pub trait FieldValue: Copy {
    /// Whether the value is two's complement.
    const SIGNED: bool;
    /// Returns the value from bits that stand at bit 0, zero-extended from `width` bits.
    fn from_bits(bits: u32, width: u32) -> Self;
    /// Returns the value's bits, two's complement, not yet cut to the field's width.
    fn to_bits(self) -> u32;
}

macro_rules! unsigned_field {
    ($($ty:ty),*) => {$(
        impl FieldValue for $ty {
            const SIGNED: bool = false;
            #[inline(always)]
            fn from_bits(bits: u32, _width: u32) -> Self { bits as $ty }
            #[inline(always)]
            fn to_bits(self) -> u32 { u32::from(self) }
        }
    )*};
}
unsigned_field!(u8, u16, u32);

macro_rules! signed_field {
    ($($ty:ty),*) => {$(
        impl FieldValue for $ty {
            const SIGNED: bool = true;
            #[inline(always)]
            fn from_bits(bits: u32, width: u32) -> Self {
                (((bits << (32 - width)) as i32) >> (32 - width)) as $ty
            }
            #[inline(always)]
            fn to_bits(self) -> u32 { i32::from(self) as u32 }
        }
    )*};
}
signed_field!(i16, i32);

impl FieldValue for bool {
    const SIGNED: bool = false;
    #[inline(always)]
    fn from_bits(bits: u32, _width: u32) -> Self {
        bits != 0
    }
    #[inline(always)]
    fn to_bits(self) -> u32 {
        u32::from(self)
    }
}

/// Returns the mask, standing at bit 0, of a field from bit `low` to bit `high`.
#[inline(always)]
pub const fn mask(high: u32, low: u32) -> u32 {
    u32::MAX >> (31 - (high - low))
}

/// Makes a newtype over `u32` with typed, range-checked fields and a [`Field`] table.
///
/// A value that does not fit its field is cut to the field's width in release builds and
/// panics in debug builds: it is a mistake in this project, never something from outside.
#[macro_export]
macro_rules! word {
    (
        $(#[doc = $doc:literal])+
        $name:ident {
            $(
                $(#[doc = $field_doc:literal])+
                $field:ident / $with:ident : [$high:literal : $low:literal] $ty:ty
            ),* $(,)?
        }
    ) => {
        $(#[doc = $doc])+
        #[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Hash)]
        #[cfg_attr(feature = "defmt", derive(defmt::Format))]
        #[repr(transparent)]
        pub struct $name(pub u32);

        impl $name {
            /// The fields, lowest declared first, for the generated page and package.
            pub const FIELDS: &'static [$crate::layout::Field] = &[$(
                $crate::layout::Field {
                    name: stringify!($field),
                    high: $high,
                    low: $low,
                    signed: <$ty as $crate::layout::FieldValue>::SIGNED,
                    doc: concat!($($field_doc),+),
                }
            ),*];
            /// What the word means, from its doc comment.
            pub const DOC: &'static str = concat!($($doc),+);

            $(
                $(#[doc = $field_doc])+
                #[inline(always)]
                pub fn $field(self) -> $ty {
                    <$ty as $crate::layout::FieldValue>::from_bits(
                        (self.0 >> $low) & $crate::layout::mask($high, $low),
                        $high - $low + 1,
                    )
                }

                #[doc = concat!("Returns this word with `", stringify!($field), "` set.")]
                #[must_use]
                #[inline(always)]
                pub fn $with(self, value: $ty) -> Self {
                    let mask = $crate::layout::mask($high, $low);
                    let bits = $crate::layout::FieldValue::to_bits(value);
                    debug_assert!(
                        <$ty as $crate::layout::FieldValue>::from_bits(bits & mask, $high - $low + 1) == value,
                        concat!("value out of range for field ", stringify!($field)),
                    );
                    Self(self.0 & !(mask << $low) | (bits & mask) << $low)
                }
            )*
        }
    };
}

/// Makes an agent's registers: the block as it lies in memory, an enum of byte offsets, and the table of both.
///
/// Offsets are checked at compile time; registers follow one another without a gap.
macro_rules! registers {
    (
        $(#[doc = $block_doc:literal])+
        $block:ident
        $(#[doc = $register_doc:literal])+
        $register:ident $table:ident;
        $(
            $(#[doc = $doc:literal])+
            $offset:literal $name:ident $variant:ident $field:ident : $cell:ident $access:ident $reset:expr, $fields:expr;
        )+
    ) => {
        $(#[doc = $block_doc])+
        #[repr(C)]
        pub struct $block {
            $($(#[doc = $doc])+ pub $field: volatile_register::$cell<u32>,)+
        }

        $(const _: () = assert!(core::mem::offset_of!($block, $field) == $offset, concat!("offset of ", stringify!($name)));)+

        $(#[doc = $register_doc])+
        #[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
        #[cfg_attr(feature = "defmt", derive(defmt::Format))]
        #[repr(usize)]
        pub enum $register {
            $($(#[doc = $doc])+ $variant = $offset,)+
        }

        impl $register {
            /// All registers, by rising offset.
            pub const ALL: &'static [$register] = &[$($register::$variant),+];

            /// Returns the register at a byte offset, if there is one.
            pub fn at(offset: usize) -> Option<Self> {
                Self::ALL.iter().copied().find(|register| *register as usize == offset)
            }

            /// Returns the register's row in the table.
            pub fn info(self) -> &'static $crate::layout::RegisterInfo {
                &$table[self as usize / 4]
            }
        }

        /// The register table, by rising offset.
        pub const $table: &[$crate::layout::RegisterInfo] = &[$($crate::layout::RegisterInfo {
            name: stringify!($name),
            offset: $offset,
            access: $crate::layout::Access::$access,
            reset: $reset,
            doc: concat!($($doc),+),
            fields: $fields,
        }),+];
    };
}
