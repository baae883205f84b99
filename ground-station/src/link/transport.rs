//! Sockets: bytes in, bytes out. Everything that thinks lies elsewhere.

use super::address::{Address, Kind};
use super::frames::{Decoder, Received};
use std::collections::BTreeMap;
use std::io::{self, Read, Write};
use std::net::{SocketAddr, TcpStream, ToSocketAddrs, UdpSocket};
use std::time::Duration;

/// An open connection.
#[derive(Debug)]
pub struct Transport {
    wire: Wire,
    buffer: Vec<u8>,
}

#[derive(Debug)]
enum Wire {
    /// Where each system's last datagram came from.
    UdpIn(UdpSocket, BTreeMap<u8, SocketAddr>),
    UdpOut(UdpSocket),
    TcpOut(TcpStream, Decoder),
}

/// Longer than any datagram.
const BUFFER: usize = 65536;

impl Transport {
    /// Opens the connection; [`receive`](Self::receive) will wait for at most `patience`.
    ///
    /// # Errors
    ///
    /// What the operating system says.
    pub fn open(address: &Address, patience: Duration) -> io::Result<Self> {
        let wire = match address.kind {
            Kind::UdpIn => {
                let socket = UdpSocket::bind(&address.place)?;
                socket.set_read_timeout(Some(patience))?;
                Wire::UdpIn(socket, BTreeMap::new())
            }
            Kind::UdpOut => {
                let to = first(&address.place)?;
                let any: SocketAddr =
                    if to.is_ipv4() { ([0, 0, 0, 0], 0).into() } else { ([0u16; 8], 0).into() };
                let socket = UdpSocket::bind(any)?;
                socket.connect(to)?;
                socket.set_read_timeout(Some(patience))?;
                Wire::UdpOut(socket)
            }
            Kind::TcpOut => {
                let stream = TcpStream::connect_timeout(&first(&address.place)?, Duration::from_secs(5))?;
                stream.set_read_timeout(Some(patience))?;
                stream.set_write_timeout(Some(Duration::from_secs(1)))?;
                stream.set_nodelay(true)?;
                Wire::TcpOut(stream, Decoder::default())
            }
        };
        Ok(Self { wire, buffer: vec![0; BUFFER] })
    }

    /// Where it listens, for tests that let the system choose a port.
    ///
    /// # Errors
    ///
    /// What the operating system says.
    pub fn local_address(&self) -> io::Result<SocketAddr> {
        match &self.wire {
            Wire::UdpIn(socket, _) | Wire::UdpOut(socket) => socket.local_addr(),
            Wire::TcpOut(stream, _) => stream.local_addr(),
        }
    }

    /// What arrives within the patience; nothing if nothing does.
    ///
    /// # Errors
    ///
    /// What the operating system says, but for time running out and for peers that are not there yet.
    pub fn receive(&mut self) -> io::Result<Vec<Received>> {
        let Self { wire, buffer } = self;
        let outcome = match wire {
            Wire::UdpIn(socket, places) => socket.recv_from(buffer).map(|(length, from)| {
                let received = Decoder::default().push(&buffer[..length]);
                places.extend(received.iter().map(|received| (received.system, from)));
                received
            }),
            Wire::UdpOut(socket) => {
                socket.recv(buffer).map(|length| Decoder::default().push(&buffer[..length]))
            }
            Wire::TcpOut(stream, decoder) => match stream.read(buffer) {
                Ok(0) => Err(io::Error::new(io::ErrorKind::UnexpectedEof, "the connection was closed")),
                outcome => outcome.map(|length| decoder.push(&buffer[..length])),
            },
        };
        outcome.or_else(|error| if is_passing(&error) { Ok(Vec::new()) } else { Err(error) })
    }

    /// Sends a frame to a system; `Ok(false)` if it cannot go now (nothing heard from it yet, a full link).
    ///
    /// # Errors
    ///
    /// What the operating system says of a connection that is gone.
    pub fn send(&mut self, system: u8, frame: &[u8]) -> io::Result<bool> {
        let outcome = match &mut self.wire {
            Wire::UdpIn(socket, places) => match places.get(&system) {
                Some(place) => socket.send_to(frame, place).map(drop),
                None => return Ok(false),
            },
            Wire::UdpOut(socket) => socket.send(frame).map(drop),
            Wire::TcpOut(stream, _) => stream.write_all(frame),
        };
        match outcome {
            Ok(()) => Ok(true),
            Err(error) if is_passing(&error) => Ok(false),
            Err(error) => Err(error),
        }
    }
}

fn first(place: &str) -> io::Result<SocketAddr> {
    let mut found = place.to_socket_addrs()?;
    found.next().ok_or_else(|| io::Error::new(io::ErrorKind::NotFound, "the host has no address"))
}

/// Errors that go away by themselves: nothing came, no room to send, nobody listens on the other side yet.
fn is_passing(error: &io::Error) -> bool {
    use io::ErrorKind::{ConnectionRefused, ConnectionReset, Interrupted, TimedOut, WouldBlock};
    const NO_BUFFER_SPACE: i32 = 105;
    matches!(error.kind(), WouldBlock | TimedOut | Interrupted | ConnectionRefused | ConnectionReset)
        || error.raw_os_error() == Some(NO_BUFFER_SPACE)
}
