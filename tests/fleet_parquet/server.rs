//! A small store on this computer: files over HTTP, and what the program uses of the words of S3, which are also those of Google Cloud
//! Storage, and of Azure.

use std::collections::BTreeMap;
use std::io::{BufRead, BufReader, Read, Write};
use std::net::{TcpListener, TcpStream};
use std::sync::{Arc, Mutex};
use std::thread;

/// Files by their paths, with the leading slash.
type Files = Arc<Mutex<BTreeMap<String, Vec<u8>>>>;

/// The server; it ends with the program.
pub struct Server {
    pub address: String,
    pub files: Files,
    /// method and path of every request
    pub asked: Arc<Mutex<Vec<String>>>,
}

impl Server {
    pub fn start() -> Self {
        let listener = TcpListener::bind("127.0.0.1:0").unwrap();
        let address = listener.local_addr().unwrap().to_string();
        let server = Self { address, files: Files::default(), asked: Arc::default() };
        let (files, asked) = (server.files.clone(), server.asked.clone());
        thread::spawn(move || {
            for stream in listener.incoming() {
                let (stream, files, asked) = (stream.unwrap(), files.clone(), asked.clone());
                thread::spawn(move || serve(stream, &files, &asked));
            }
        });
        server
    }

    pub fn put(&self, path: &str, bytes: Vec<u8>) {
        self.files.lock().unwrap().insert(path.to_owned(), bytes);
    }

    /// Requests since the last call.
    pub fn requests(&self) -> Vec<String> {
        std::mem::take(&mut *self.asked.lock().unwrap())
    }
}

/// Answers the requests of one connection until its other end closes it.
fn serve(stream: TcpStream, files: &Files, asked: &Mutex<Vec<String>>) {
    let mut reader = BufReader::new(stream.try_clone().unwrap());
    let mut stream = stream;
    loop {
        let mut line = String::new();
        if reader.read_line(&mut line).unwrap_or(0) == 0 {
            return;
        }
        let mut words = line.split_whitespace();
        let (method, target) = (words.next().unwrap().to_owned(), words.next().unwrap().to_owned());
        let mut length = 0;
        loop {
            let mut header = String::new();
            reader.read_line(&mut header).unwrap();
            let Some((name, value)) = header.trim().split_once(':') else { break };
            if name.eq_ignore_ascii_case("content-length") {
                length = value.trim().parse().unwrap();
            }
        }
        let mut body = vec![0; length];
        reader.read_exact(&mut body).unwrap();
        let (path, query) = target.split_once('?').unwrap_or((&target, ""));
        asked.lock().unwrap().push(format!("{method} {path}"));
        let (status, kind, bytes) = answer((&method, &decoded(path), query), body, files);
        let head = format!(
            "HTTP/1.1 {status}\r\nContent-Length: {}\r\nContent-Type: {kind}\r\nETag: \"{:x}\"\r\nLast-Modified: Thu, 01 Jan 2026 \
             00:00:00 GMT\r\n\r\n",
            bytes.len(),
            bytes.len()
        );
        stream.write_all(head.as_bytes()).unwrap();
        if method != "HEAD" {
            stream.write_all(&bytes).unwrap();
        }
    }
}

fn answer(
    (method, path, query): (&str, &str, &str),
    body: Vec<u8>,
    files: &Files,
) -> (&'static str, &'static str, Vec<u8>) {
    const BYTES: &str = "application/octet-stream";
    const XML: &str = "application/xml";
    let mut files = files.lock().unwrap();
    match method {
        "GET" if query.contains("list-type=2") => ("200 OK", XML, list(path, query, &files)),
        "GET" if query.contains("comp=list") => ("200 OK", XML, list_of_azure(path, query, &files)),
        "GET" | "HEAD" => match files.get(path) {
            Some(bytes) => ("200 OK", BYTES, bytes.clone()),
            None => ("404 Not Found", BYTES, Vec::new()),
        },
        "PUT" => {
            files.insert(path.to_owned(), body);
            ("200 OK", BYTES, Vec::new())
        }
        "DELETE" => {
            files.remove(path);
            ("204 No Content", BYTES, Vec::new())
        }
        // many at once
        "POST" => {
            let text = String::from_utf8(body).unwrap();
            for key in text.split("<Key>").skip(1).filter_map(|rest| rest.split("</Key>").next()) {
                files.remove(&format!("{}/{key}", path.trim_end_matches('/')));
            }
            ("200 OK", XML, b"<DeleteResult></DeleteResult>".to_vec())
        }
        _ => ("405 Method Not Allowed", BYTES, Vec::new()),
    }
}

/// Names and sizes of the files of a bucket that begin with a prefix.
fn of_prefix(bucket: &str, query: &str, files: &BTreeMap<String, Vec<u8>>) -> Vec<(String, usize)> {
    let prefix =
        query.split('&').find_map(|part| part.strip_prefix("prefix=")).map_or(String::new(), decoded);
    let head = format!("{}/", bucket.trim_end_matches('/'));
    let of = |(path, bytes): (&String, &Vec<u8>)| Some((path.strip_prefix(&head)?.to_owned(), bytes.len()));
    files.iter().filter_map(of).filter(|(key, _)| key.starts_with(&prefix)).collect()
}

fn list(bucket: &str, query: &str, files: &BTreeMap<String, Vec<u8>>) -> Vec<u8> {
    let mut text = "<ListBucketResult><IsTruncated>false</IsTruncated>".to_owned();
    for (key, bytes) in of_prefix(bucket, query, files) {
        text.push_str(&format!(
            "<Contents><Key>{key}</Key><Size>{bytes}</Size><LastModified>2026-01-01T00:00:00.000Z</LastModified><ETag>\"x\"</ETag></Contents>"
        ));
    }
    (text + "</ListBucketResult>").into_bytes()
}

fn list_of_azure(container: &str, query: &str, files: &BTreeMap<String, Vec<u8>>) -> Vec<u8> {
    let mut text = "<EnumerationResults><Blobs>".to_owned();
    for (name, bytes) in of_prefix(container, query, files) {
        text.push_str(&format!(
            "<Blob><Name>{name}</Name><Properties><Last-Modified>Thu, 01 Jan 2026 00:00:00 GMT</Last-Modified><Content-Length>{bytes}\
             </Content-Length><Content-Type>application/octet-stream</Content-Type><Etag>x</Etag></Properties></Blob>"
        ));
    }
    (text + "</Blobs><NextMarker/></EnumerationResults>").into_bytes()
}

/// Without `%2F` and its like.
fn decoded(text: &str) -> String {
    let mut bytes = Vec::new();
    let mut rest = text.as_bytes();
    while let [first, behind @ ..] = rest {
        let digits = behind.get(..2).and_then(|two| std::str::from_utf8(two).ok());
        match digits.and_then(|two| u8::from_str_radix(two, 16).ok()).filter(|_| *first == b'%') {
            Some(byte) => {
                bytes.push(byte);
                rest = &behind[2..];
            }
            None => {
                bytes.push(*first);
                rest = behind;
            }
        }
    }
    String::from_utf8(bytes).unwrap()
}
