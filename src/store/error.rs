//! Why a file of a store cannot be had.

/// Why a store cannot be opened, or a file of it not be read or written.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
pub enum StoreError {
    /// this program cannot speak with stores
    #[error(
        "{address}: this program was built without object stores; build it with `cargo build --release --features fleet`, or copy the \
         files to this computer"
    )]
    NotBuilt {
        /// what was given
        address: String,
    },
    /// it is no address of a store
    #[error(
        "{address}: expected s3://BUCKET/..., gs://BUCKET/..., az://CONTAINER/... or http(s)://HOST/..., got {came}"
    )]
    Address {
        /// what was given
        address: String,
        /// what is wrong with it
        came: String,
    },
    /// nothing of that name
    #[error("{address}: nothing of that name is there")]
    Nothing {
        /// what was asked for
        address: String,
    },
    /// larger than it may be
    #[error("expected a file of at most {most} bytes, got {bytes}")]
    TooLarge {
        /// its size
        bytes: u64,
        /// what is read at most
        most: u64,
    },
    /// the store or the way to it
    #[error("{address}: {why}")]
    Refused {
        /// what was asked for
        address: String,
        /// the store's reason
        why: String,
    },
}
