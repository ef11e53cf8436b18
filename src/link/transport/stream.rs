//! A connection that carries a stream of bytes.

use std::time::Duration;

use tokio::io::{AsyncRead, AsyncReadExt, AsyncWrite, AsyncWriteExt};
use tokio::time::timeout;

use super::super::incoming::Incoming;
use super::super::outgoing::Outgoing;

const BUFFER: usize = 1 << 16;
/// A frame is not interrupted for longer: what waits for more bytes is then decided. Radios that take turns
/// pause for less.
const SILENCE: Duration = Duration::from_millis(250);

/// Carries bytes both ways until the connection ends, and says why it did.
pub(super) async fn session(
    stream: impl AsyncRead + AsyncWrite,
    incoming: &mut Incoming,
    outgoing: &mut Outgoing,
) -> String {
    let (mut from, mut to) = tokio::io::split(stream);
    let read = async {
        let mut buffer = vec![0; BUFFER];
        let mut in_doubt = false;
        loop {
            let read = if in_doubt {
                match timeout(SILENCE, from.read(&mut buffer)).await {
                    Ok(read) => read,
                    Err(_) => {
                        incoming.silence(incoming.now());
                        in_doubt = false;
                        continue;
                    }
                }
            } else {
                from.read(&mut buffer).await
            };
            let stamp = incoming.now();
            match read {
                Ok(0) => return "the other end closed the connection".into(),
                Ok(bytes) => {
                    incoming.bytes(&buffer[..bytes], stamp);
                    in_doubt = true;
                }
                Err(error) => return format!("reading failed: {error}"),
            }
        }
    };
    let write = async {
        loop {
            let frame = outgoing.next().await;
            match to.write_all(&frame).await {
                Ok(()) => outgoing.sent(&frame),
                Err(error) => {
                    outgoing.failed();
                    return format!("writing failed: {error}");
                }
            }
        }
    };
    tokio::select! {
        why = read => why,
        why = write => why,
    }
}
