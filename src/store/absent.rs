//! What stands for stores in a program that was built without them.

use super::address::Address;
use super::error::StoreError;
use super::stored::Stored;
use std::fs::File;

/// A store; none can be opened.
#[derive(Debug, Clone)]
pub struct Store {
    address: String,
}

impl Store {
    fn not_built(&self) -> StoreError {
        StoreError::NotBuilt { address: self.address.clone() }
    }

    /// Refuses.
    ///
    /// # Errors
    /// [`StoreError::NotBuilt`], always.
    pub fn open(address: &Address) -> Result<Self, StoreError> {
        Err(Self { address: address.uri_of(&address.name) }.not_built())
    }

    /// Refuses.
    ///
    /// # Errors
    /// [`StoreError::NotBuilt`], always.
    pub fn head(&self, _: &str) -> Result<Option<Stored>, StoreError> {
        Err(self.not_built())
    }

    /// Refuses.
    ///
    /// # Errors
    /// [`StoreError::NotBuilt`], always.
    pub fn list(&self, _: &str) -> Result<Vec<Stored>, StoreError> {
        Err(self.not_built())
    }

    /// Refuses.
    ///
    /// # Errors
    /// [`StoreError::NotBuilt`], always.
    pub fn read(&self, _: &str) -> Result<Option<Vec<u8>>, StoreError> {
        Err(self.not_built())
    }

    /// Refuses.
    ///
    /// # Errors
    /// [`StoreError::NotBuilt`], always.
    pub fn download(&self, _: &str, _: &mut File, _: u64) -> Result<u64, StoreError> {
        Err(self.not_built())
    }

    /// Refuses.
    ///
    /// # Errors
    /// [`StoreError::NotBuilt`], always.
    pub fn write(&self, _: &str, _: Vec<u8>) -> Result<(), StoreError> {
        Err(self.not_built())
    }

    /// Refuses.
    ///
    /// # Errors
    /// [`StoreError::NotBuilt`], always.
    pub fn remove(&self, _: &str) -> Result<(), StoreError> {
        Err(self.not_built())
    }
}
