//! Telemetry logs (`.tlog`): every frame of a session behind its time, as ground stations have always written them.

use crate::failure::Failure;
use std::fs::File;
use std::io::{BufWriter, Write};
use std::path::{Path, PathBuf};

/// A log being written. It grows as the session goes: after a power cut it holds what was said until then.
#[derive(Debug)]
pub struct TelemetryLog {
    path: PathBuf,
    writer: BufWriter<File>,
}

impl TelemetryLog {
    /// Begins a log in a new file.
    ///
    /// # Errors
    ///
    /// [`Failure::Write`] if the file is there already or cannot be made.
    pub fn create(path: &Path) -> Result<Self, Failure> {
        let file = File::create_new(path).map_err(Failure::writing(path))?;
        Ok(Self { path: path.to_owned(), writer: BufWriter::new(file) })
    }

    /// Adds a frame sent or received `microseconds` after 1970: eight bytes, most significant first, then the frame.
    ///
    /// # Errors
    ///
    /// [`Failure::Write`] if the operating system refuses.
    pub fn add(&mut self, microseconds: u64, frame: &[u8]) -> Result<(), Failure> {
        let written =
            self.writer.write_all(&microseconds.to_be_bytes()).and_then(|()| self.writer.write_all(frame));
        written.map_err(Failure::writing(&self.path))
    }

    /// Hands everything to the operating system.
    ///
    /// # Errors
    ///
    /// [`Failure::Write`] if it refuses.
    pub fn flush(&mut self) -> Result<(), Failure> {
        self.writer.flush().map_err(Failure::writing(&self.path))
    }
}
