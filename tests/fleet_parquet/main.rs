//! What the feature `fleet` adds: tables as Parquet, streams as MCAP, logs and tables in object stores.

#![cfg(feature = "fleet")]
#![allow(clippy::panic, clippy::unwrap_used, reason = "a test ends where it fails")]

#[path = "../support/python.rs"]
mod python;
#[path = "../support/mod.rs"]
mod support;

mod readers;
mod server;
mod stores;
