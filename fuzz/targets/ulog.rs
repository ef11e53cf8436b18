#![no_main]

libfuzzer_sys::fuzz_target!(|data: &[u8]| mavid_fuzz::fuzz("ulog", data));
