//! `study`: the paper's figures and simulations.

use super::plan::mission;
use crate::export::folder::{self, OutputFile};
use crate::failure::{Failure, reason};
use crate::problem::Problem;
use crate::report::Table;
use crate::study::chart::{chart, words_of};
use crate::study::procedures::Meaning;
use crate::study::tally::{Row, merged, to_csv};
use crate::study::{Trials, cost, fans, holonomic, procedures};
use std::path::{Path, PathBuf};

/// Which study.
#[derive(Debug, Clone, PartialEq)]
pub enum Study {
    /// Path cost per vehicle for numbers of targets and vehicles.
    Cost {
        /// n.
        targets: Vec<usize>,
        /// m.
        vehicles: Vec<usize>,
    },
    /// Ratio of the procedures' lengths.
    Procedures {
        /// n.
        targets: usize,
        /// m.
        vehicles: usize,
        /// r.
        arrivals: Vec<usize>,
        /// How the procedures are meant.
        meaning: Meaning,
    },
    /// Ratio of transition times, for distances in loiter radii.
    Holonomic {
        /// The mission whose vehicle and settings are used; the built-in field if there is none.
        file: Option<PathBuf>,
        /// Entries tried.
        entries: usize,
        /// Between the circles.
        distances: Vec<f64>,
    },
}

/// Runs a study and writes its table and chart into a folder; returns the table to be printed.
///
/// # Errors
///
/// [`Failure`]; nothing is written then.
pub fn study(study: &Study, trials: &Trials, out: &Path, force: bool) -> Result<String, Failure> {
    let (name, rows) = match study {
        Study::Cost { targets, vehicles } => ("cost", cost::run(trials, targets, vehicles)?),
        Study::Procedures { targets, vehicles, arrivals, meaning } => {
            ("procedures", procedures::run(trials, *targets, *vehicles, arrivals, *meaning)?)
        }
        Study::Holonomic { file, entries, distances } => {
            ("holonomic", holonomic::run(trials, &mission(file.as_deref())?.mission, *entries, distances)?)
        }
    };
    let shard = trials.shard;
    let end =
        if shard.count == 1 { String::new() } else { format!("-{}-of-{}", shard.index + 1, shard.count) };
    write(name, &end, &rows, out, force)
}

fn write(name: &str, end: &str, rows: &[Row], out: &Path, force: bool) -> Result<String, Failure> {
    let files = [
        OutputFile { name: format!("{name}{end}.csv"), content: to_csv(name, rows) },
        OutputFile { name: format!("{name}{end}.svg"), content: chart(rows, words_of(name)) },
    ];
    folder::write_files(out, &files, force)?;
    let mut table =
        Table::new(&["series", "x", "trials", "mean", "deviation", "least", "greatest", "above 1"]);
    for Row { series, x, tally } in rows.iter().filter(|row| row.tally.count > 0) {
        let mut cells = vec![series.clone(), x.to_string(), tally.count.to_string()];
        cells.extend(
            [tally.mean(), tally.deviation(), tally.least, tally.greatest].map(|value| format!("{value:.4}")),
        );
        cells.push(format!("{:.2} %", 100.0 * tally.above_one as f64 / tally.count as f64));
        table.push(cells);
    }
    Ok(table.render() + &wrote(out, &files))
}

fn wrote(out: &Path, files: &[OutputFile]) -> String {
    files.iter().map(|file| format!("wrote {}\n", out.join(&file.name).display())).collect()
}

/// Adds up the tables of shards.
///
/// # Errors
///
/// [`Failure::Input`] for what is no table of one study.
pub fn merge(tables: &[PathBuf], out: &Path, force: bool) -> Result<String, Failure> {
    let read = |path: &PathBuf| {
        let file = path.display().to_string();
        std::fs::read_to_string(path).map(|text| (file.clone(), text)).map_err(|error| {
            let message = format!("cannot be read ({})", reason(&error));
            Failure::Input(vec![Problem { file, line: None, key: String::new(), message }])
        })
    };
    let texts = tables.iter().map(read).collect::<Result<Vec<_>, _>>()?;
    let (name, rows) = merged(&texts)?;
    write(&name, "", &rows, out, force)
}

/// The fans of minimum-time flights, from distances in loiter radii.
///
/// # Errors
///
/// [`Failure`]; nothing is written then.
pub fn transitions(
    file: Option<&Path>,
    distances: &[f64],
    out: &Path,
    force: bool,
) -> Result<String, Failure> {
    let mission = mission(file)?.mission;
    let flights = fans::run(&mission, distances)?;
    let files = [
        OutputFile { name: "transitions.csv".into(), content: fans::to_csv(&flights) },
        OutputFile {
            name: "transitions.svg".into(),
            content: fans::picture(&flights, mission.loiter.radius),
        },
    ];
    folder::write_files(out, &files, force)?;
    let mut table = Table::new(&["from", "entry", "direction", "time"]);
    for flight in &flights {
        table.push(vec![
            format!("{:.1} m", flight.distance),
            format!("{:.0} deg", flight.entry.to_degrees()),
            if flight.direction > 0 { "counter-clockwise" } else { "clockwise" }.to_owned(),
            format!("{:.3} s", flight.duration),
        ]);
    }
    Ok(table.render() + &wrote(out, &files))
}
