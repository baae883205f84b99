//! What is wrong with an input file, said so that it can be mended.

use std::fmt;

/// One thing that is wrong with an input file.
///
/// Its message names the key, the value and the remedy; [`Display`](fmt::Display) puts the file and the line before it.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Problem {
    /// The file, as the user named it.
    pub file: String,
    /// The line in that file, from 1, where there is one.
    pub line: Option<usize>,
    /// The key, as in the mission file: `loiter.radius`, `targets.positions[3]`; empty if the file as a whole is meant.
    pub key: String,
    /// Key, value, what is wrong and the remedy.
    pub message: String,
}

impl fmt::Display for Problem {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self.line {
            Some(line) => write!(formatter, "{}:{line}: {}", self.file, self.message),
            None => write!(formatter, "{}: {}", self.file, self.message),
        }
    }
}

/// A value as it may stand in a message: on one line, and not longer than a glance.
#[must_use]
pub fn abridged(value: &str) -> String {
    const LONGEST: usize = 48;
    let line: String = value.split_whitespace().collect::<Vec<_>>().join(" ");
    if line.chars().count() <= LONGEST {
        return line;
    }
    let head: String = line.chars().take(LONGEST).collect();
    format!("{head}...")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_problem_is_one_line_with_its_place() {
        let problem = Problem {
            file: "a.toml".into(),
            line: Some(3),
            key: "seed".into(),
            message: "seed = -1 is out of range: give 0 or more".into(),
        };
        assert_eq!(problem.to_string(), "a.toml:3: seed = -1 is out of range: give 0 or more");
        let whole = Problem { line: None, ..problem };
        assert_eq!(whole.to_string(), "a.toml: seed = -1 is out of range: give 0 or more");
    }

    #[test]
    fn long_values_are_cut_at_characters_and_not_inside_them() {
        assert_eq!(abridged("[1,\n 2]"), "[1, 2]");
        let cut = abridged(&"ä".repeat(60));
        assert_eq!(cut.chars().count(), 51);
        assert!(cut.ends_with("..."));
    }
}
