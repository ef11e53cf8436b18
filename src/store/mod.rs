//! Files in object stores and behind HTTP, by their addresses: `s3://`, `gs://`, `az://`, `http://`, `https://`.
//!
//! With the feature `fleet` alone; without it, opening a store is an error that says so.

#[cfg(not(feature = "fleet"))]
mod absent;
mod address;
mod error;
#[cfg(feature = "fleet")]
mod remote;
mod stored;

#[cfg(not(feature = "fleet"))]
pub use absent::Store;
pub use address::{Address, is_remote};
pub use error::StoreError;
#[cfg(feature = "fleet")]
pub use remote::Store;
pub use stored::Stored;
