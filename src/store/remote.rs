//! A store, spoken with by the crate `object_store`. Calls wait until the store has answered.

use std::fs::File;
use std::io::Write;
use std::sync::Arc;
use std::time::Duration;

use super::address::Address;
use super::error::StoreError;
use super::stored::Stored;
use futures_util::TryStreamExt;
use object_store::aws::AmazonS3Builder;
use object_store::azure::MicrosoftAzureBuilder;
use object_store::gcp::GoogleCloudStorageBuilder;
use object_store::http::HttpBuilder;
use object_store::path::Path;
use object_store::{
    ClientOptions, Error, ObjectMeta, ObjectStore, ObjectStoreExt, ObjectStoreScheme, RetryConfig,
};
use tokio::runtime::{Builder, Runtime};
use url::Url;

/// Requests that fail are made again so often, and no longer than so long. A store that is down must not hold a run for
/// minutes at each log, and one that is only busy must not lose logs.
const RETRIES: usize = 6;
/// See [`RETRIES`].
const RETRY: Duration = Duration::from_secs(60);
/// Threads that carry the bytes of all requests.
const CARRIERS: usize = 2;

/// All files of a bucket, container or host. Clones share their connections.
#[derive(Debug, Clone)]
pub struct Store {
    inner: Arc<dyn ObjectStore>,
    runtime: Arc<Runtime>,
    root: String,
}

impl Store {
    /// The store of an address. Keys, endpoint and region are taken from the variables that the stores' own programs read:
    /// `AWS_ACCESS_KEY_ID`, `AWS_ENDPOINT`, `GOOGLE_SERVICE_ACCOUNT`, `AZURE_STORAGE_ACCOUNT_NAME` and their like.
    ///
    /// # Errors
    /// [`StoreError`] where it is no address, or what the variables say is not enough.
    pub fn open(address: &Address) -> Result<Self, StoreError> {
        // the first of the process decides how TLS computes; a second one changes nothing
        let _ = rustls::crypto::ring::default_provider().install_default();
        let refused = |why: &dyn std::fmt::Display| StoreError::Refused {
            address: address.root.clone(),
            why: why.to_string(),
        };
        let url = Url::parse(&address.uri_of(&address.name)).map_err(|error| refused(&error))?;
        let (scheme, _) = ObjectStoreScheme::parse(&url).map_err(|error| refused(&error))?;
        let retry = RetryConfig { max_retries: RETRIES, retry_timeout: RETRY, ..RetryConfig::default() };
        let whole = url.as_str();
        let built: Result<Arc<dyn ObjectStore>, Error> = match scheme {
            ObjectStoreScheme::AmazonS3 => {
                let built = AmazonS3Builder::from_env().with_url(whole).with_retry(retry).build();
                built.map(|store| Arc::new(store) as _)
            }
            ObjectStoreScheme::GoogleCloudStorage => {
                let built = GoogleCloudStorageBuilder::from_env().with_url(whole).with_retry(retry).build();
                built.map(|store| Arc::new(store) as _)
            }
            ObjectStoreScheme::MicrosoftAzure => {
                let built = MicrosoftAzureBuilder::from_env().with_url(whole).with_retry(retry).build();
                built.map(|store| Arc::new(store) as _)
            }
            _ => {
                let plain = ClientOptions::new().with_allow_http(url.scheme() == "http");
                let host = &url[..url::Position::BeforePath];
                let built =
                    HttpBuilder::new().with_url(host).with_client_options(plain).with_retry(retry).build();
                built.map(|store| Arc::new(store) as _)
            }
        };
        Self::of(built.map_err(|error| refused(&error))?, &address.root)
    }

    /// A store that is there already, under an address.
    ///
    /// # Errors
    /// [`StoreError::Refused`] where the system gives no threads.
    pub fn of(inner: Arc<dyn ObjectStore>, root: &str) -> Result<Self, StoreError> {
        let runtime = Builder::new_multi_thread().worker_threads(CARRIERS).enable_all().build();
        let runtime = runtime
            .map_err(|error| StoreError::Refused { address: root.to_owned(), why: error.to_string() })?;
        Ok(Self { inner, runtime: Arc::new(runtime), root: root.to_owned() })
    }

    /// A file by its name; `None` where nothing of that name is there.
    ///
    /// # Errors
    /// [`StoreError`] where the store does not say.
    pub fn head(&self, name: &str) -> Result<Option<Stored>, StoreError> {
        let path = self.path(name)?;
        let found = self.runtime.block_on(self.inner.head(&path));
        self.unless_missing(name, found.map(|meta| stored(&meta)))
    }

    /// All files below a folder, in the order of their names.
    ///
    /// # Errors
    /// [`StoreError`] where the store does not list them: a plain web server has no lists.
    pub fn list(&self, folder: &str) -> Result<Vec<Stored>, StoreError> {
        let path = self.path(folder)?;
        let below = (!folder.is_empty()).then_some(&path);
        let all: Result<Vec<ObjectMeta>, Error> = self.runtime.block_on(self.inner.list(below).try_collect());
        let mut all: Vec<Stored> =
            self.unless_missing(folder, all)?.unwrap_or_default().iter().map(stored).collect();
        all.sort_by(|a, b| a.name.cmp(&b.name));
        Ok(all)
    }

    /// The bytes of a file; `None` where nothing of that name is there.
    ///
    /// # Errors
    /// [`StoreError`] where they do not come.
    pub fn read(&self, name: &str) -> Result<Option<Vec<u8>>, StoreError> {
        let path = self.path(name)?;
        let bytes = self.runtime.block_on(async { self.inner.get(&path).await?.bytes().await });
        self.unless_missing(name, bytes.map(Into::into))
    }

    /// Writes the bytes of a file to `to`, piece by piece, and says how many they were.
    ///
    /// # Errors
    /// [`StoreError`] where they do not come, are more than `most`, or cannot be written.
    pub fn download(&self, name: &str, to: &mut File, most: u64) -> Result<u64, StoreError> {
        let path = self.path(name)?;
        let refused = |why: String| StoreError::Refused { address: self.uri(name), why };
        let written = self.runtime.block_on(async {
            let found = self.inner.get(&path).await.map_err(|error| refused(with_causes(&error)))?;
            let mut pieces = found.into_stream();
            let mut bytes = 0_u64;
            while let Some(piece) = pieces.try_next().await.map_err(|error| refused(with_causes(&error)))? {
                bytes += piece.len() as u64;
                if bytes > most {
                    return Err(StoreError::TooLarge { bytes, most });
                }
                to.write_all(&piece).map_err(|error| refused(error.to_string()))?;
            }
            Ok(bytes)
        })?;
        to.flush().map_err(|error| refused(error.to_string()))?;
        Ok(written)
    }

    /// Writes a file whole: a reader sees all of it or nothing.
    ///
    /// # Errors
    /// [`StoreError`] where the store does not take it.
    pub fn write(&self, name: &str, bytes: Vec<u8>) -> Result<(), StoreError> {
        let path = self.path(name)?;
        let put = self.runtime.block_on(self.inner.put(&path, bytes.into()));
        put.map(drop).map_err(|error| self.refused(name, &error))
    }

    /// Removes a file; one that is not there is removed.
    ///
    /// # Errors
    /// [`StoreError`] where the store refuses.
    pub fn remove(&self, name: &str) -> Result<(), StoreError> {
        let path = self.path(name)?;
        let removed = self.runtime.block_on(self.inner.delete(&path));
        self.unless_missing(name, removed).map(drop)
    }

    fn uri(&self, name: &str) -> String {
        format!("{}/{name}", self.root)
    }

    fn path(&self, name: &str) -> Result<Path, StoreError> {
        Path::parse(name)
            .map_err(|error| StoreError::Refused { address: self.uri(name), why: error.to_string() })
    }

    fn refused(&self, name: &str, error: &Error) -> StoreError {
        StoreError::Refused { address: self.uri(name), why: with_causes(error) }
    }

    fn unless_missing<T>(&self, name: &str, found: Result<T, Error>) -> Result<Option<T>, StoreError> {
        match found {
            Ok(found) => Ok(Some(found)),
            Err(Error::NotFound { .. }) => Ok(None),
            Err(error) => Err(self.refused(name, &error)),
        }
    }
}

/// An error with its causes that it does not say itself: that a certificate does not hold stands at the end of the chain.
fn with_causes(error: &(dyn std::error::Error + 'static)) -> String {
    let mut said = error.to_string();
    for cause in std::iter::successors(error.source(), |cause| cause.source()) {
        let cause = cause.to_string();
        if !said.contains(&cause) {
            said = format!("{said}: {cause}");
        }
    }
    said
}

fn stored(meta: &ObjectMeta) -> Stored {
    Stored {
        name: meta.location.to_string(),
        bytes: meta.size,
        modified_ns: meta
            .last_modified
            .timestamp_nanos_opt()
            .and_then(|ns| u64::try_from(ns).ok())
            .unwrap_or(0),
        tag: meta.e_tag.clone(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use object_store::memory::InMemory;

    #[test]
    fn an_error_is_told_with_what_caused_it() {
        let cause =
            std::io::Error::other(rustls::Error::InvalidCertificate(rustls::CertificateError::UnknownIssuer));
        let error = Error::Generic { store: "HTTP", source: Box::new(cause) };
        let said = with_causes(&error);
        assert!(said.ends_with("invalid peer certificate: UnknownIssuer"), "{said}");
        assert_eq!(said.matches("certificate").count(), 1, "{said}");
    }

    #[test]
    fn what_is_written_is_listed_read_and_removed() {
        let store = Store::of(Arc::new(InMemory::new()), "s3://flights").unwrap();
        store.write("logs/b.ulg", b"two".to_vec()).unwrap();
        store.write("logs/deep/a.ulg", b"one".to_vec()).unwrap();
        store.write("other/c.ulg", b"no".to_vec()).unwrap();
        let names = |folder| store.list(folder).unwrap().into_iter().map(|of| of.name).collect::<Vec<_>>();
        assert_eq!(names("logs"), ["logs/b.ulg", "logs/deep/a.ulg"]);
        assert_eq!(names("").len(), 3);
        assert_eq!(store.head("logs/b.ulg").unwrap().unwrap().bytes, 3);
        assert_eq!((store.head("none").unwrap(), store.read("none").unwrap()), (None, None));
        assert_eq!(store.read("logs/b.ulg").unwrap().unwrap(), b"two");
        let mut file = tempfile::tempfile().unwrap();
        assert_eq!(store.download("logs/b.ulg", &mut file, 3), Ok(3));
        assert_eq!(
            store.download("logs/b.ulg", &mut file, 2),
            Err(StoreError::TooLarge { bytes: 3, most: 2 })
        );
        let missing = store.download("none", &mut file, 2).unwrap_err().to_string();
        assert!(missing.starts_with("s3://flights/none: "), "{missing}");
        store.remove("logs/b.ulg").unwrap();
        store.remove("logs/b.ulg").unwrap();
        assert_eq!(names("logs"), ["logs/deep/a.ulg"]);
    }
}
