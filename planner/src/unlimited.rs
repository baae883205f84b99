//! Limits as data: an infinite one is left out, because not every format can write it.

use serde::{Deserialize, Deserializer, Serialize, Serializer};

/// What stands for a limit that is left out.
pub(crate) fn none() -> f64 {
    f64::INFINITY
}

/// Whether there is no limit.
pub(crate) fn is(limit: &f64) -> bool {
    *limit == f64::INFINITY
}

pub(crate) fn serialize<S: Serializer>(limit: &f64, serializer: S) -> Result<S::Ok, S::Error> {
    (!is(limit)).then_some(*limit).serialize(serializer)
}

pub(crate) fn deserialize<'de, D: Deserializer<'de>>(deserializer: D) -> Result<f64, D::Error> {
    Ok(Option::deserialize(deserializer)?.unwrap_or_else(none))
}
