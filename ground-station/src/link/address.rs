//! Where the vehicles are: `udpin:host:port`, `udpout:host:port`, `tcpout:host:port`.

use std::fmt;
use std::str::FromStr;

/// How to reach the vehicles.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Kind {
    /// Wait for datagrams; answer to where each vehicle's last one came from.
    UdpIn,
    /// Send datagrams to one place.
    UdpOut,
    /// Connect a stream.
    TcpOut,
}

/// A kind of connection and the host and port that it is about.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Address {
    /// The kind.
    pub kind: Kind,
    /// `host:port`.
    pub place: String,
}

const KINDS: [(&str, Kind); 3] = [("udpin", Kind::UdpIn), ("udpout", Kind::UdpOut), ("tcpout", Kind::TcpOut)];

impl FromStr for Address {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        const REMEDY: &str =
            "give udpin:HOST:PORT, udpout:HOST:PORT or tcpout:HOST:PORT, for example udpin:0.0.0.0:14550";
        let (word, place) = text.split_once(':').ok_or(REMEDY)?;
        let kind = KINDS.iter().find(|(known, _)| *known == word).map(|&(_, kind)| kind).ok_or(REMEDY)?;
        let (host, port) = place.rsplit_once(':').ok_or(REMEDY)?;
        if host.is_empty() || port.parse::<u16>().is_err() {
            return Err(REMEDY.to_owned());
        }
        Ok(Self { kind, place: place.to_owned() })
    }
}

impl fmt::Display for Address {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        let word = KINDS.iter().find(|(_, kind)| *kind == self.kind).map_or("", |(word, _)| word);
        write!(formatter, "{word}:{}", self.place)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn addresses_are_read_and_written() {
        for text in
            ["udpin:0.0.0.0:14550", "udpout:127.0.0.1:14551", "tcpout:localhost:5760", "udpin:[::1]:14550"]
        {
            assert_eq!(text.parse::<Address>().map(|address| address.to_string()), Ok(text.to_owned()));
        }
        for text in
            ["", "udpin", "udpin:14550", "serial:/dev/ttyUSB0:57600", "udpin::14550", "tcpout:host:99999"]
        {
            assert!(text.parse::<Address>().is_err(), "{text}");
        }
    }
}
