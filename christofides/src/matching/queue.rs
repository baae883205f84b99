//! Events in order of time: a radix heap (Ahuja, Mehlhorn, Orlin, Tarjan 1990) on a clock that never goes back.

/// Times with keys; pops in order of time, equal times in an arbitrary but fixed order.
#[derive(Debug)]
pub(crate) struct EventQueue {
    /// Bucket `b` holds times whose highest bit that differs from `last` is bit `b - 1`; bucket 0 holds `last` itself.
    buckets: Vec<Vec<(i64, u32)>>,
    /// Bit `b` is set if bucket `b` is not empty (bucket 64 cannot occur: times are not negative).
    occupied: u64,
    last: i64,
}

impl Default for EventQueue {
    fn default() -> Self {
        EventQueue { buckets: vec![Vec::new(); 64], occupied: 0, last: 0 }
    }
}

impl EventQueue {
    pub fn clear(&mut self) {
        self.buckets.iter_mut().for_each(Vec::clear);
        (self.occupied, self.last) = (0, 0);
    }

    #[inline]
    fn bucket(&self, time: i64) -> usize {
        64 - ((time ^ self.last) as u64).leading_zeros() as usize
    }

    /// Adds an event, not before the last one popped.
    #[inline]
    pub fn push(&mut self, time: i64, key: u32) {
        let bucket = self.bucket(time);
        self.buckets[bucket].push((time, key));
        self.occupied |= 1 << bucket;
    }

    /// Takes out the earliest event.
    pub fn pop(&mut self) -> Option<(i64, u32)> {
        if self.occupied == 0 {
            return None;
        }
        if self.occupied & 1 == 0 {
            self.redistribute(self.occupied.trailing_zeros() as usize);
        }
        let event = self.buckets[0].pop();
        if self.buckets[0].is_empty() {
            self.occupied &= !1;
        }
        event
    }

    /// Moves the first occupied bucket into those below it.
    fn redistribute(&mut self, first: usize) {
        let mut events = std::mem::take(&mut self.buckets[first]);
        self.occupied &= !(1 << first);
        self.last = events.iter().map(|event| event.0).min().unwrap_or(self.last);
        for (time, key) in events.drain(..) {
            self.push(time, key);
        }
        // The storage goes back to its bucket, so that a reused queue does not allocate.
        self.buckets[first] = events;
    }
}
