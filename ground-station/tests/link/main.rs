//! The live link against vehicles that share no code with it: three ArduCopters and three PX4s, over a bad radio, over
//! loopback UDP, and against packets that another library wrote.

mod air;
mod arrivals;
mod damage;
mod flights;
mod follower;
mod packets;
mod peer;
mod sockets;
mod uploads;
mod wire;
