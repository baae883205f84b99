//! Targets from GeoJSON (RFC 7946): every `Point`, and every point of a `MultiPoint`, is a target.
//!
//! The properties `name` (or `id`), `radius`, `height` and `safe_distance` are used if present; others are left alone.

use super::range::Range;
use super::targets::{Frame, LATITUDES, LONGITUDES, Listed, Wrong};
use crate::problem::abridged;
use geojson::{Feature, GeometryValue, JsonObject, JsonValue, Position};
use planner::Target;

/// Kinds of features in exports that are no targets.
const OURS: [&str; 4] = ["circle", "path", "keep-out", "depot"];

/// Reads the targets; what is wrong goes to `wrong`, feature by feature.
pub fn read(file: &str, text: &str, frame: Frame, wrong: Wrong<'_>) -> Vec<Listed> {
    let document: JsonValue = match serde_json::from_str(text) {
        Ok(document) => document,
        Err(error) => {
            wrong(Some(error.line()), "", format!("not JSON: {error}: give a GeoJSON file with points"));
            return Vec::new();
        }
    };
    let mut targets = Vec::new();
    for (key, value) in members(document, wrong) {
        let mut feature = FeatureReader { file, key: &key, frame, targets: &mut targets };
        feature.read(value, wrong);
    }
    if targets.is_empty() {
        wrong(
            None,
            "features",
            "features: no point could be read: give a FeatureCollection of points".into(),
        );
    }
    targets
}

/// The features of the document with their keys; a bare feature or geometry counts as one.
fn members(mut document: JsonValue, wrong: Wrong<'_>) -> Vec<(String, JsonValue)> {
    let kind = document.get("type").and_then(JsonValue::as_str).unwrap_or_default().to_owned();
    match (kind.as_str(), document.get_mut("features").map(JsonValue::take)) {
        ("FeatureCollection", Some(JsonValue::Array(features))) => features
            .into_iter()
            .enumerate()
            .map(|(index, feature)| (format!("features[{index}]"), feature))
            .collect(),
        ("Feature", _) => vec![("feature".to_owned(), document)],
        ("Point" | "MultiPoint", _) => {
            let mut feature = JsonObject::new();
            feature.insert("type".into(), "Feature".into());
            feature.insert("properties".into(), JsonValue::Null);
            feature.insert("geometry".into(), document);
            vec![("geometry".to_owned(), JsonValue::Object(feature))]
        }
        _ => {
            let shown = if kind.is_empty() { "missing".to_owned() } else { abridged(&format!("\"{kind}\"")) };
            wrong(
                None,
                "type",
                format!("type is {shown}: give a FeatureCollection (with its list of features) of points"),
            );
            Vec::new()
        }
    }
}

struct FeatureReader<'a> {
    file: &'a str,
    key: &'a str,
    frame: Frame,
    targets: &'a mut Vec<Listed>,
}

impl FeatureReader<'_> {
    fn read(&mut self, value: JsonValue, wrong: Wrong<'_>) {
        let key = self.key;
        let feature = match serde_json::from_value::<Feature>(value) {
            Ok(feature) => feature,
            Err(error) => {
                wrong(
                    None,
                    key,
                    format!("{key} is no feature ({}): correct it", abridged(&error.to_string())),
                );
                return;
            }
        };
        // What an export of ours holds beside the targets.
        if feature.property("kind").and_then(JsonValue::as_str).is_some_and(|kind| OURS.contains(&kind)) {
            return;
        }
        let template = self.template(&feature, wrong);
        match feature.geometry.as_ref().map(|geometry| &geometry.value) {
            Some(GeometryValue::Point { coordinates }) => self.push(&template, coordinates, wrong),
            Some(GeometryValue::MultiPoint { coordinates }) => {
                for position in coordinates {
                    self.push(&template, position, wrong);
                }
            }
            Some(other) => wrong(
                None,
                key,
                format!(
                    "{key}.geometry is a {}: targets are points; remove it or replace it by its centre",
                    other.type_name()
                ),
            ),
            None => wrong(None, key, format!("{key}.geometry is missing: give a Point")),
        }
    }

    /// The target of a feature, but for its position.
    fn template(&self, feature: &Feature, wrong: Wrong<'_>) -> Target {
        let name = |value: &JsonValue| match value {
            JsonValue::String(text) => text.clone(),
            JsonValue::Number(number) => number.to_string(),
            _ => String::new(),
        };
        let property = |key: &str| feature.property(key).filter(|value| !value.is_null());
        let mut number = |key: &str, range: Range| {
            let value = property(key)?;
            let found = value.as_f64().filter(|&number| range.contains(number));
            if found.is_none() {
                let path = format!("{}.properties.{key}", self.key);
                let message = format!(
                    "{path} = {} is out of range: give a number {range}",
                    abridged(&value.to_string())
                );
                wrong(None, &path, message);
            }
            found
        };
        Target {
            radius: number("radius", Range::POSITIVE),
            height: number("height", Range::POSITIVE),
            safe_distance: number("safe_distance", Range::NOT_NEGATIVE),
            name: property("name").or_else(|| property("id")).map(name).unwrap_or_default(),
            ..Target::default()
        }
    }

    fn push(&mut self, template: &Target, position: &Position, wrong: Wrong<'_>) {
        let key = format!("{}.geometry.coordinates", self.key);
        let &[longitude, latitude, ..] = position.as_slice() else {
            let count = position.len();
            wrong(None, &key, format!("{key} has {count} number(s): give longitude and latitude in degrees"));
            return;
        };
        let mut inside = true;
        for (what, value, range) in [("longitude", longitude, LONGITUDES), ("latitude", latitude, LATITUDES)]
        {
            if !range.contains(value) {
                inside = false;
                let hint = "GeoJSON has the longitude first, in degrees of WGS-84";
                wrong(
                    None,
                    &key,
                    format!("{key}: {what} {value} is out of range: give a number {range}; {hint}"),
                );
            }
        }
        if !inside {
            return;
        }
        match self.frame.place(latitude, longitude) {
            Ok(position) => self.targets.push(Listed {
                target: Target { position, ..template.clone() },
                file: self.file.to_owned(),
                line: None,
                key: self.key.to_owned(),
            }),
            Err((what, remedy)) => {
                wrong(None, &key, format!("{key} = [{longitude}, {latitude}] {what}: {remedy}"))
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::geodesy::Origin;

    const FRAME: Frame = Frame::Plane(Origin { latitude: 42.0, longitude: -93.0, altitude: 0.0 });

    fn read_all(text: &str) -> (Vec<Listed>, Vec<String>) {
        let mut messages = Vec::new();
        let targets = read("t.geojson", text, FRAME, &mut |_, _, message| messages.push(message));
        (targets, messages)
    }

    #[test]
    fn points_with_and_without_properties() {
        let (targets, messages) = read_all(
            r#"{"type":"FeatureCollection","features":[
                {"type":"Feature","properties":{"name":"oak","radius":4,"kind":"tree"},"geometry":{"type":"Point","coordinates":[-93.0,42.0]}},
                {"type":"Feature","properties":null,"geometry":{"type":"MultiPoint","coordinates":[[-93.0,42.001],[-93.001,42.0,7.0]]}}]}"#,
        );
        assert!(messages.is_empty(), "{messages:?}");
        assert_eq!(targets.len(), 3);
        assert_eq!(
            targets[0].target,
            Target { name: "oak".into(), radius: Some(4.0), ..Target::at([0.0, 0.0]) }
        );
        assert!(targets[1].target.position[1] > 110.0 && targets[2].target.position[0] < -82.0);
    }

    #[test]
    fn everything_wrong_is_listed() {
        let (targets, messages) = read_all(
            r#"{"type":"FeatureCollection","features":[
                {"type":"Feature","properties":{"radius":-1,"height":"x"},"geometry":{"type":"Point","coordinates":[-93.0,42.0]}},
                {"type":"Feature","properties":{},"geometry":{"type":"LineString","coordinates":[[0,0],[1,1]]}},
                {"type":"Feature","properties":{},"geometry":{"type":"Point","coordinates":[42.0,-93.0]}},
                {"type":"Feature","properties":{},"geometry":{"type":"Point","coordinates":[3.0,4.0]}},
                {"type":"Feature","properties":{},"geometry":null},
                {"type":"Feature","properties":{},"geometry":{"type":"Point","coordinates":["a",4.0]}},
                7]}"#,
        );
        assert_eq!(targets.len(), 1);
        let wanted = [
            "features[0].properties.radius = -1 is out of range: give a number above 0",
            "features[0].properties.height = \"x\" is out of range: give a number above 0",
            "features[1].geometry is a LineString: targets are points; remove it or replace it by its centre",
            "features[2].geometry.coordinates: latitude -93 is out of range: give a number from -90 to 90; \
             GeoJSON has the longitude first, in degrees of WGS-84",
        ];
        assert_eq!(&messages[..4], wanted);
        assert!(messages[4].contains("km from the origin: check the origin"), "{}", messages[4]);
        assert_eq!(messages[5], "features[4].geometry is missing: give a Point");
        assert!(
            messages[6].starts_with("features[5] is no feature")
                && messages[7].starts_with("features[6] is no feature")
        );
    }

    #[test]
    fn what_is_not_geojson_is_said_to_be_so() {
        for (text, start) in [
            ("", "not JSON"),
            ("{", "not JSON"),
            ("[]", "type is missing"),
            (r#"{"type":"Topology"}"#, "type is \"Topology\""),
            (r#"{"type":"FeatureCollection"}"#, "type is \"FeatureCollection\""),
            (r#"{"type":"FeatureCollection","features":[]}"#, "features: no point"),
            (r#"{"type":"Point","coordinates":[]}"#, "geometry"),
        ] {
            let (targets, messages) = read_all(text);
            assert!(targets.is_empty() && messages[0].starts_with(start), "{text}: {messages:?}");
        }
    }
}
