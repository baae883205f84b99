//! What changes for a vehicle while a session goes on: another task, or none any more.

use super::{Outcome, Phase, Pilot, Task};
use crate::execution::Way;
use crate::link::mission::Upload;
use crate::link::modes::Mode;

impl Pilot {
    /// Takes another task, if it is in time for that: what is streamed changes at once, a mission that has not been begun is uploaded
    /// again.
    pub fn renew(&mut self, task: &Task, now: f64) -> bool {
        use Phase::{Checking, Climbing, Flying, Placing, Preparing, ReadingBack, Ready, Uploading, Waiting};
        let is_streamed = task.way == Way::Stream;
        match self.phase {
            Checking => {}
            Preparing(..) | Climbing | Placing | Waiting | Flying if is_streamed => {}
            Uploading(_) | ReadingBack(_) | Ready if !is_streamed => {
                self.say("gets another mission");
                let upload = || Uploading(Box::new(Upload::new(self.target(), task.items.clone(), now)));
                let next = if task.items.is_empty() { Ready } else { upload() };
                self.go(next, now);
            }
            _ => return false,
        }
        self.task = task.clone();
        true
    }

    /// Ends its part before it has left its pad: there is nothing left to do.
    pub fn dismiss(&mut self, now: f64) {
        use Phase::{Checking, Climbing, Flying, Placing, Preparing, ReadingBack, Ready, Uploading, Waiting};
        let next = match self.phase {
            Checking | Uploading(_) | ReadingBack(_) | Ready => Phase::Over(Outcome::Done),
            Preparing(..) | Climbing | Placing | Waiting | Flying if self.task.way == Way::Stream => {
                Phase::Landing(Box::new(self.mode_order(Mode::Land, now)))
            }
            _ => return,
        };
        self.say("has nothing left to do");
        self.go(next, now);
    }
}
