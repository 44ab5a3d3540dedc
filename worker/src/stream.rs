//! Framed messages on the pipe between a worker and a slot process.
use protocol::{
    id::RunId,
    wire::{self, FrameKind, WireError},
};
use serde::{Serialize, de::DeserializeOwned};
use std::io::{self, Read, Write};

/// Writes one framed message to the pipe and flushes.
pub(crate) fn write<T: Serialize>(
    to: &mut impl Write,
    kind: FrameKind,
    message: &T,
) -> io::Result<()> {
    let frame = wire::encode_frame(kind, RunId::default(), message).map_err(invalid)?;
    to.write_all(&frame)?;
    to.flush()
}

/// Reads one framed message from the pipe; `None` at the end of the stream.
pub(crate) fn read<T: DeserializeOwned>(
    from: &mut impl Read,
    kind: FrameKind,
) -> io::Result<Option<T>> {
    let mut frame = vec![0; wire::HEADER_BYTES];
    match from.read_exact(&mut frame) {
        Ok(()) => {}
        Err(error) if error.kind() == io::ErrorKind::UnexpectedEof => return Ok(None),
        Err(error) => return Err(error),
    }
    let mut header = [0; wire::HEADER_BYTES];
    header.copy_from_slice(&frame);
    let length = wire::body_length(kind, &header).map_err(invalid)?;
    frame.resize(wire::HEADER_BYTES + length, 0);
    from.read_exact(frame.get_mut(wire::HEADER_BYTES..).unwrap_or_default())?;
    wire::decode_frame(kind, &frame)
        .map(|(_, message)| Some(message))
        .map_err(invalid)
}

fn invalid(error: WireError) -> io::Error {
    io::Error::new(io::ErrorKind::InvalidData, error)
}
