//! A file in a store.

/// A file in a store.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Stored {
    /// below the address of its store, parts by `/`
    pub name: String,
    /// its size
    pub bytes: u64,
    /// when it was changed last, nanoseconds since 1970 UTC; 0 where that is not known
    pub modified_ns: u64,
    /// the store's word for this version of it
    pub tag: Option<String>,
}
