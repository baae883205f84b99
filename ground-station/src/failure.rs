//! Why a command did not do what it was asked, and the exit code that says so.

use crate::problem::Problem;
use std::io;
use std::path::{Path, PathBuf};

/// Why a command ended without its result.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum Failure {
    /// The input is wrong; nothing was computed and nothing was written.
    #[error("{}", list(problems_word(_0), _0))]
    Input(Vec<Problem>),
    /// The output folder holds something that is not ours.
    #[error(
        "{} exists and does not hold a plan: nothing was planned or written; \
         choose another folder with --out, or replace it with --force", folder.display()
    )]
    ForeignFolder {
        /// The folder.
        folder: PathBuf,
    },
    /// A file that is to be written is there already.
    #[error("{} exists: nothing was written; choose another file with --out, or replace it with --force", path.display())]
    Exists {
        /// The file.
        path: PathBuf,
    },
    /// The planner found no plan.
    #[error("no plan: {source}")]
    Planning {
        /// What it says.
        source: planner::Error,
    },
    /// The plan does not stand up to the independent check.
    #[error("{report}\n{}", list("the plan fails its verification and was not written", failures))]
    Verification {
        /// The tables of the plan and of the check.
        report: String,
        /// Everything out of tolerance.
        failures: Vec<planner::Failure>,
    },
    /// The plan cannot be followed through time.
    #[error("the flight of vehicle {} cannot be sampled: the plan is not the one of this mission; nothing was written", vehicle + 1)]
    Sampling {
        /// The vehicle, from 0.
        vehicle: usize,
    },
    /// The connection to the vehicles could not be made, or broke.
    #[error("{address}: {}", reason(source))]
    Link {
        /// The connection.
        address: String,
        /// What the operating system says.
        source: io::Error,
    },
    /// Vehicles did not do what was asked.
    #[error("{}", list("not done as asked", _0))]
    Flight(Vec<String>),
    /// Something that this mission, way or autopilot does not allow.
    #[error("{0}")]
    Refused(String),
    /// A file could not be put into its format.
    #[error("the plan cannot be put into its file format ({source}); nothing was written")]
    Format {
        /// What the serialiser says.
        source: serde_json::Error,
    },
    /// A file or folder could not be written.
    #[error("{} cannot be written ({}): nothing was left behind; check permissions and space", path.display(), reason(source))]
    Write {
        /// The file or folder.
        path: PathBuf,
        /// What the operating system says.
        source: io::Error,
    },
}

impl Failure {
    /// The exit code of the program: 2 for bad input, 1 for everything else.
    #[must_use]
    pub fn exit_code(&self) -> u8 {
        match self {
            Self::Input(_) => 2,
            _ => 1,
        }
    }

    /// The failure for an error of the planner on the mission of a file.
    #[must_use]
    pub fn of_planner(file: &str, error: planner::Error) -> Self {
        let planner::Error::Mission { problems } = error else { return Self::Planning { source: error } };
        let problem = |problem: &planner::Problem| Problem {
            file: file.to_owned(),
            line: None,
            key: problem.field().to_owned(),
            message: problem.to_string(),
        };
        Self::Input(problems.iter().map(problem).collect())
    }

    /// A function that turns an operating system's error about `path` into a failure.
    pub fn writing(path: &Path) -> impl FnOnce(io::Error) -> Self {
        let path = path.to_owned();
        move |source| Self::Write { path, source }
    }
}

/// What the operating system says, without the number of the error.
#[must_use]
pub fn reason(error: &io::Error) -> String {
    let text = error.to_string();
    match text.find(" (os error") {
        Some(end) => text[..end].to_lowercase(),
        None => text,
    }
}

fn problems_word(problems: &[Problem]) -> &'static str {
    if problems.len() == 1 { "1 problem" } else { "several problems" }
}

fn list<T: ToString>(title: &str, lines: &[T]) -> String {
    let mut text = format!("{title}:");
    for line in lines {
        text.push_str("\n  ");
        text.push_str(&line.to_string());
    }
    text
}
