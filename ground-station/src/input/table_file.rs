//! Targets from CSV with a header: `id,lat,lon[,alt][,radius][,height][,safe_distance]`, or `id,east,north,...`.
//!
//! Columns may stand in any order. `alt` is accepted and not used, since heights are above the ground; so is any other
//! column, unless its name is a near miss of a known one.

use super::range::Range;
use super::suggest::nearest;
use super::targets::{Frame, LATITUDES, LONGITUDES, Listed, Wrong};
use crate::problem::abridged;
use planner::Target;

const COLUMNS: [&str; 13] = [
    "id",
    "name",
    "lat",
    "lon",
    "latitude",
    "longitude",
    "east",
    "north",
    "alt",
    "altitude",
    "radius",
    "height",
    "safe_distance",
];

/// Reads the targets; what is wrong goes to `wrong`, row by row.
pub fn read(file: &str, text: &str, frame: Frame, wrong: Wrong<'_>) -> Vec<Listed> {
    let text = text.strip_prefix('\u{feff}').unwrap_or(text);
    let mut table =
        csv::ReaderBuilder::new().trim(csv::Trim::All).comment(Some(b'#')).from_reader(text.as_bytes());
    let Some(columns) = table.headers().ok().and_then(|header| Columns::find(header, wrong)) else {
        return Vec::new();
    };
    let mut targets = Vec::new();
    for record in table.records() {
        match record {
            Ok(record) => targets.extend(Row { file, columns: &columns, record: &record, frame }.read(wrong)),
            Err(error) => {
                let line = error.position().map(|position| position.line() as usize);
                wrong(
                    line,
                    "",
                    format!("not a row of the table ({}): correct it", abridged(&error.to_string())),
                );
            }
        }
    }
    if targets.is_empty() {
        wrong(None, "id", "no target could be read: give one row per target below the header".into());
    }
    targets
}

/// Which column holds what.
struct Columns {
    place: [usize; 2],
    geographic: bool,
    name: Option<usize>,
    radius: Option<usize>,
    height: Option<usize>,
    safe_distance: Option<usize>,
}

impl Columns {
    fn find(header: &csv::StringRecord, wrong: Wrong<'_>) -> Option<Self> {
        for name in header.iter().filter(|name| !COLUMNS.contains(&name.to_lowercase().as_str())) {
            if let Some(near) = nearest(name, &COLUMNS) {
                wrong(Some(1), name, format!("column \"{name}\" is unknown: did you mean \"{near}\"?"));
            }
        }
        let find =
            |names: &[&str]| header.iter().position(|name| names.contains(&name.to_lowercase().as_str()));
        let local = find(&["east"]).zip(find(&["north"]));
        let geographic = find(&["lat", "latitude"]).zip(find(&["lon", "longitude"]));
        let Some((first, second)) = geographic.or(local) else {
            let shown = abridged(&header.iter().collect::<Vec<_>>().join(","));
            let remedy = "give a header with the columns id,lat,lon or id,east,north";
            wrong(Some(1), "header", format!("header = \"{shown}\" has no coordinates: {remedy}"));
            return None;
        };
        Some(Self {
            place: [first, second],
            geographic: geographic.is_some(),
            name: find(&["name"]).or_else(|| find(&["id"])),
            radius: find(&["radius"]),
            height: find(&["height"]),
            safe_distance: find(&["safe_distance"]),
        })
    }
}

struct Row<'a> {
    file: &'a str,
    columns: &'a Columns,
    record: &'a csv::StringRecord,
    frame: Frame,
}

impl Row<'_> {
    fn line(&self) -> Option<usize> {
        self.record.position().map(|position| position.line() as usize)
    }

    fn read(&self, wrong: Wrong<'_>) -> Option<Listed> {
        let columns = self.columns;
        let [first, second] = if columns.geographic { ["lat", "lon"] } else { ["east", "north"] };
        let ranges =
            if columns.geographic { [LATITUDES, LONGITUDES] } else { [Range::between(-5e4, 5e4); 2] };
        // All cells are read before any is missed, so that every wrong one is reported.
        let place = [
            self.number(first, columns.place[0], ranges[0], true, wrong),
            self.number(second, columns.place[1], ranges[1], true, wrong),
        ];
        let mut optional = |name, column: Option<usize>, range| {
            column.and_then(|column| self.number(name, column, range, false, wrong))
        };
        let radius = optional("radius", columns.radius, Range::POSITIVE);
        let height = optional("height", columns.height, Range::POSITIVE);
        let safe_distance = optional("safe_distance", columns.safe_distance, Range::NOT_NEGATIVE);
        let [Some(first_value), Some(second_value)] = place else { return None };
        let position = if columns.geographic {
            match self.frame.place(first_value, second_value) {
                Ok(position) => position,
                Err((what, remedy)) => {
                    wrong(
                        self.line(),
                        first,
                        format!("lat,lon = {first_value},{second_value} {what}: {remedy}"),
                    );
                    return None;
                }
            }
        } else {
            [first_value, second_value]
        };
        let name = columns.name.and_then(|column| self.record.get(column)).unwrap_or_default().to_owned();
        let target = Target { name, position, radius, height, safe_distance };
        Some(Listed { target, file: self.file.to_owned(), line: self.line(), key: "row".to_owned() })
    }

    fn number(&self, name: &str, column: usize, range: Range, needed: bool, wrong: Wrong<'_>) -> Option<f64> {
        let cell = self.record.get(column).unwrap_or_default();
        if cell.is_empty() && !needed {
            return None;
        }
        let value = cell.parse().ok().filter(|&number| range.contains(number));
        if value.is_none() {
            let shown = if cell.is_empty() {
                "is missing".to_owned()
            } else {
                format!("= {} is out of range", abridged(cell))
            };
            wrong(self.line(), name, format!("{name} {shown}: give a number {range}"));
        }
        value
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::geodesy::Origin;

    const FRAME: Frame = Frame::Plane(Origin { latitude: 42.0, longitude: -93.0, altitude: 0.0 });

    fn read_all(text: &str, frame: Frame) -> (Vec<Listed>, Vec<String>) {
        let mut messages = Vec::new();
        let mut wrong = |line: Option<usize>, _: &str, message: String| {
            messages.push(format!("{}: {message}", line.unwrap_or(0)))
        };
        let targets = read("t.csv", text, frame, &mut wrong);
        (targets, messages)
    }

    #[test]
    fn local_and_geographic_rows() {
        let (targets, messages) = read_all("id,east,north,radius\na,1,2,\nb, 3.5 ,-4,2.5\n", Frame::Nowhere);
        assert!(messages.is_empty(), "{messages:?}");
        assert_eq!(targets[0].target, Target { name: "a".into(), ..Target::at([1.0, 2.0]) });
        assert_eq!(targets[1].target.radius, Some(2.5));
        let (targets, messages) = read_all("id,lat,lon,alt\n1,42.0,-93.0,300\n", FRAME);
        assert!(messages.is_empty() && targets[0].target.position == [0.0, 0.0], "{messages:?}");
    }

    #[test]
    fn everything_wrong_is_listed_with_its_line() {
        let (targets, messages) = read_all(
            "id,lat,lon,raduis,radius\n1,91,-93,1,-2\n2,,-93,,nan\n3,x,-93,,\n4,0,0,,\n5,1\n",
            FRAME,
        );
        assert!(targets.is_empty());
        let wanted = [
            "1: column \"raduis\" is unknown: did you mean \"radius\"?",
            "2: lat = 91 is out of range: give a number from -90 to 90",
            "2: radius = -2 is out of range: give a number above 0",
            "3: lat is missing: give a number from -90 to 90",
            "3: radius = nan is out of range: give a number above 0",
            "4: lat = x is out of range: give a number from -90 to 90",
        ];
        assert_eq!(&messages[..6], wanted);
        assert!(messages[6].starts_with("5: lat,lon = 0,0 is "), "{messages:?}");
        assert!(messages[7].starts_with("6: not a row"), "{messages:?}");
        assert_eq!(messages[8], "0: no target could be read: give one row per target below the header");
    }

    #[test]
    fn a_missing_origin_and_a_missing_header_are_said() {
        let (_, messages) = read_all("id,lat,lon\n1,42,-93\n", Frame::Nowhere);
        assert!(messages[0].contains("no usable origin: add origin ="), "{messages:?}");
        let (_, messages) = read_all("1,2,3\n", FRAME);
        assert!(messages[0].contains("has no coordinates"), "{messages:?}");
        let (_, messages) = read_all("", FRAME);
        assert!(messages[0].contains("has no coordinates"), "{messages:?}");
    }
}
