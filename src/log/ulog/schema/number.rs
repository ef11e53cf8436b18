//! Numbers as a ULog holds them.

/// Type of a field.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[expect(missing_docs, reason = "each name says it")]
pub enum NumberType {
    I8,
    U8,
    I16,
    U16,
    I32,
    U32,
    I64,
    U64,
    F32,
    F64,
    Bool,
    Char,
}

impl NumberType {
    /// By its name in a definition: `uint8_t`, `float`.
    pub(in crate::log::ulog) fn of(name: &str) -> Option<Self> {
        Some(match name {
            "int8_t" => Self::I8,
            "uint8_t" => Self::U8,
            "int16_t" => Self::I16,
            "uint16_t" => Self::U16,
            "int32_t" => Self::I32,
            "uint32_t" => Self::U32,
            "int64_t" => Self::I64,
            "uint64_t" => Self::U64,
            "float" => Self::F32,
            "double" => Self::F64,
            "bool" => Self::Bool,
            "char" => Self::Char,
            _ => return None,
        })
    }

    /// Bytes of one.
    pub(in crate::log::ulog) fn bytes(self) -> usize {
        match self {
            Self::I8 | Self::U8 | Self::Bool | Self::Char => 1,
            Self::I16 | Self::U16 => 2,
            Self::I32 | Self::U32 | Self::F32 => 4,
            Self::I64 | Self::U64 | Self::F64 => 8,
        }
    }

    /// It is a number with a fraction.
    pub(in crate::log::ulog) fn is_float(self) -> bool {
        matches!(self, Self::F32 | Self::F64)
    }

    /// The value at an offset of a message; NaN where it ends before.
    #[inline]
    pub(in crate::log::ulog) fn read(self, bytes: &[u8], offset: usize) -> f64 {
        match self {
            Self::I8 => array(bytes, offset).map_or(f64::NAN, |b| i8::from_le_bytes(b).into()),
            Self::U8 | Self::Bool | Self::Char => {
                array(bytes, offset).map_or(f64::NAN, |b| u8::from_le_bytes(b).into())
            }
            Self::I16 => array(bytes, offset).map_or(f64::NAN, |b| i16::from_le_bytes(b).into()),
            Self::U16 => array(bytes, offset).map_or(f64::NAN, |b| u16::from_le_bytes(b).into()),
            Self::I32 => array(bytes, offset).map_or(f64::NAN, |b| i32::from_le_bytes(b).into()),
            Self::U32 => array(bytes, offset).map_or(f64::NAN, |b| u32::from_le_bytes(b).into()),
            Self::I64 => array(bytes, offset).map_or(f64::NAN, |b| i64::from_le_bytes(b) as f64),
            Self::U64 => array(bytes, offset).map_or(f64::NAN, |b| u64::from_le_bytes(b) as f64),
            Self::F32 => array(bytes, offset).map_or(f64::NAN, |b| f32::from_le_bytes(b).into()),
            Self::F64 => array(bytes, offset).map_or(f64::NAN, f64::from_le_bytes),
        }
    }
}

/// Bytes at an offset; `None` where the message ends before.
#[inline]
pub(in crate::log::ulog) fn array<const N: usize>(bytes: &[u8], offset: usize) -> Option<[u8; N]> {
    bytes.get(offset..)?.first_chunk::<N>().copied()
}
