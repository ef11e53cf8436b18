//! What is known of a link's capacity from its address.

use std::path::Path;

use crate::fly::requests::LinkKind;
use crate::link::Address;

pub(super) fn kind_of(address: &Address) -> LinkKind {
    match address {
        // what a USB port is told of its speed means nothing, but a radio's does
        Address::Serial { path, baud, .. } if !is_usb(path) => LinkKind::Serial { baud: f64::from(*baud) },
        _ => LinkKind::Wide,
    }
}

fn is_usb(path: &Path) -> bool {
    path.to_string_lossy().contains("ttyACM")
}
