//! Forwarding of streams between two connections in both directions, without inspection.
use super::terms::CLOSE_OK;
use quinn::{Connection, ConnectionError, RecvStream, SendStream, VarInt};

/// Maximum number of bytes of a stream that are forwarded at a time.
const PIECE: usize = 64 << 10;

/// Forwards all streams between two connections until one of them ends, then closes both.
pub(super) async fn forward_streams(outer: &Connection, inner: &Connection) {
    // streams stand for priorities by their order, which `accept` and `open` keep
    let passing = async {
        tokio::join!(
            both_ways(outer, inner),
            one_way(outer, inner),
            one_way(inner, outer)
        )
    };
    let why = tokio::select! {
        _ = passing => outer.closed().await,
        why = outer.closed() => why,
        why = inner.closed() => why,
    };
    tracing::debug!(%why, "a worker's connection ended");
    for connection in [outer, inner] {
        connection.close(VarInt::from_u32(CLOSE_OK), b"closed");
    }
}

/// Forwards in both directions the single bidirectional stream, which the worker opens.
async fn both_ways(outer: &Connection, inner: &Connection) -> Result<(), ConnectionError> {
    let (outer_send, outer_receive) = outer.accept_bi().await?;
    let (inner_send, inner_receive) = inner.open_bi().await?;
    tokio::join!(
        pass(outer_receive, inner_send),
        pass(inner_receive, outer_send)
    );
    Ok(())
}

/// Forwards all unidirectional streams from one connection to the other.
async fn one_way(from: &Connection, to: &Connection) -> Result<(), ConnectionError> {
    let mut passing = tokio::task::JoinSet::new();
    for priority in 0.. {
        let receive = from.accept_uni().await?;
        let send = to.open_uni().await?;
        // as the bus does it: the first stream is the most urgent
        if send.set_priority(-1 - priority).is_err() {
            break;
        }
        passing.spawn(pass(receive, send));
    }
    Ok(())
}

/// Forwards bytes of one stream; writes wait for the receiver, so backpressure reaches the sender.
async fn pass(mut from: RecvStream, mut to: SendStream) {
    while let Ok(Some(piece)) = from.read_chunk(PIECE, true).await {
        if to.write_chunk(piece.bytes).await.is_err() {
            return;
        }
    }
    if to.finish().is_err() {
        tracing::trace!("a stream was closed before");
    }
}
