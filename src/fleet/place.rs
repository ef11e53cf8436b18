//! Where the files of a fleet's tables are: a folder of this computer, or one in a store.

use std::io;
use std::path::{Path, PathBuf};

use crate::files::write_whole;
use crate::store::{Address, Store, StoreError, is_remote};
use crate::text;

/// A folder, here or in a store. Names of files are relative to it, with `/` between their parts.
#[derive(Debug, Clone)]
pub(super) enum Place {
    Folder(PathBuf),
    Store(Store, Address),
}

impl Place {
    /// The place of a path or an address.
    pub(super) fn open(given: &Path) -> Result<Self, StoreError> {
        match given.to_str().filter(|given| is_remote(given)) {
            None => Ok(Self::Folder(given.to_owned())),
            Some(given) => {
                let address = Address::of(given)?;
                Ok(Self::Store(Store::open(&address)?, address))
            }
        }
    }

    /// As messages call it.
    pub(super) fn name(&self) -> String {
        match self {
            Self::Folder(path) => text::path(path),
            Self::Store(_, address) => address.uri_of(&address.name),
        }
    }

    /// A file of it as messages call it.
    pub(super) fn name_of(&self, name: &str) -> String {
        format!("{}/{name}", self.name())
    }

    /// Names of the files in one of its folders, in order; none where it is not there.
    pub(super) fn names(&self, folder: &str) -> io::Result<Vec<String>> {
        let mut names = match self {
            Self::Folder(path) => match std::fs::read_dir(path.join(folder)) {
                Err(error) if error.kind() == io::ErrorKind::NotFound => Vec::new(),
                // what we write has names of plain letters
                entries => {
                    entries?.flatten().filter_map(|entry| entry.file_name().into_string().ok()).collect()
                }
            },
            Self::Store(store, address) => {
                let head = format!("{}/", within(address, folder));
                let found = store.list(head.trim_end_matches('/')).map_err(io::Error::other)?;
                let own = found.iter().filter_map(|stored| stored.name.strip_prefix(&head));
                own.filter(|name| !name.contains('/')).map(str::to_owned).collect()
            }
        };
        names.sort();
        Ok(names)
    }

    /// The bytes of a file.
    pub(super) fn read(&self, name: &str) -> io::Result<Vec<u8>> {
        match self {
            Self::Folder(path) => std::fs::read(path.join(name)),
            Self::Store(store, address) => {
                let found = store.read(&within(address, name)).map_err(io::Error::other)?;
                found.ok_or_else(|| io::ErrorKind::NotFound.into())
            }
        }
    }

    /// Writes a file whole, and the folders on the way to it.
    pub(super) fn write(&self, name: &str, bytes: Vec<u8>) -> io::Result<()> {
        match self {
            Self::Folder(path) => {
                let path = path.join(name);
                path.parent().map_or(Ok(()), std::fs::create_dir_all)?;
                write_whole(&path, &bytes)
            }
            Self::Store(store, address) => {
                store.write(&within(address, name), bytes).map_err(io::Error::other)
            }
        }
    }

    /// Removes a file.
    pub(super) fn remove(&self, name: &str) -> io::Result<()> {
        match self {
            Self::Folder(path) => std::fs::remove_file(path.join(name)),
            Self::Store(store, address) => store.remove(&within(address, name)).map_err(io::Error::other),
        }
    }
}

/// Name in the store of a file of the folder that an address names.
fn within(address: &Address, name: &str) -> String {
    if address.name.is_empty() { name.to_owned() } else { format!("{}/{name}", address.name) }
}
