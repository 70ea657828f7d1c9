//! Typed registers: the macro that makes them and what their fields can hold.

/// A register of the core, at a fixed offset.
pub(crate) trait Register: Copy {
    /// Bytes from the core's base; for a channel's register, from the channel's.
    const OFFSET: u32;

    /// From what was read.
    fn from_bits(bits: u32) -> Self;

    /// To what is written.
    fn bits(self) -> u32;
}

/// What a field can hold.
pub(crate) trait FieldValue: Copy {
    /// From the field's bits, moved down to bit 0.
    fn from_bits(bits: u32) -> Self;

    /// To the field's bits; those above its width are dropped.
    fn to_bits(self) -> u32;
}

impl FieldValue for bool {
    fn from_bits(bits: u32) -> Self {
        bits != 0
    }

    fn to_bits(self) -> u32 {
        self.into()
    }
}

macro_rules! unsigned_field {
    ($($ty:ty),*) => {$(
        impl FieldValue for $ty {
            fn from_bits(bits: u32) -> Self {
                bits as Self
            }

            fn to_bits(self) -> u32 {
                self.into()
            }
        }
    )*};
}

unsigned_field!(u8, u16, u32);

/// The bits of a field, moved down to bit 0.
pub(crate) const fn mask(high: u32, low: u32) -> u32 {
    u32::MAX >> (31 - (high - low))
}

/// One register: its offset, and its fields as `name / with_name: [high:low] type`.
macro_rules! register {
    (
        $(#[doc = $doc:literal])+
        $name:ident @ $offset:literal {
            $(
                $(#[doc = $field_doc:literal])+
                $field:ident / $with:ident : [$high:literal : $low:literal] $ty:ty
            ),* $(,)?
        }
    ) => {
        $(#[doc = $doc])+
        #[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
        pub(crate) struct $name(pub u32);

        impl $crate::word::Register for $name {
            const OFFSET: u32 = $offset;

            fn from_bits(bits: u32) -> Self {
                Self(bits)
            }

            fn bits(self) -> u32 {
                self.0
            }
        }

        #[allow(dead_code, reason = "every field is named here, whether it is read, written or both")]
        impl $name {
            $(
                $(#[doc = $field_doc])+
                pub(crate) fn $field(self) -> $ty {
                    <$ty as $crate::word::FieldValue>::from_bits(self.0 >> $low & $crate::word::mask($high, $low))
                }

                $(#[doc = $field_doc])+
                #[must_use]
                pub(crate) fn $with(self, value: $ty) -> Self {
                    let mask = $crate::word::mask($high, $low);
                    Self(self.0 & !(mask << $low) | ($crate::word::FieldValue::to_bits(value) & mask) << $low)
                }
            )*
        }
    };
}

pub(crate) use register;
