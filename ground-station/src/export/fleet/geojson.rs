//! GeoJSON (RFC 7946) of a plan: each feature has a `kind`, and those of vehicles a `vehicle`.

use super::scene::{Point, Scene};
use crate::failure::Failure;
use geojson::{Feature, FeatureCollection, GeometryValue, JsonObject, JsonValue, Position};
use serde_json::json;

pub fn text(scene: &Scene) -> Result<String, Failure> {
    let mut features = vec![feature(GeometryValue::new_point(flat(&scene.depot)), json!({"kind": "depot"}))];
    for (index, (target, place)) in scene.targets.iter().enumerate() {
        let properties = json!({
            "kind": "target",
            "id": index + 1,
            "name": if target.name.is_empty() { JsonValue::Null } else { target.name.clone().into() },
            "radius": target.radius,
            "height": target.height,
            "safe_distance": target.safe_distance,
        });
        features.push(feature(GeometryValue::new_point(flat(place)), properties));
    }
    for vehicle in &scene.vehicles {
        for (targets, ring) in &vehicle.circles {
            let properties = json!({"kind": "circle", "vehicle": vehicle.flight[0], "flight": vehicle.flight[1], "targets": targets});
            features.push(feature(GeometryValue::new_line_string(ring.iter().map(solid)), properties));
        }
        let properties = json!({"kind": "path", "vehicle": vehicle.flight[0], "flight": vehicle.flight[1], "times_s": vehicle.times});
        features.push(feature(GeometryValue::new_line_string(vehicle.path.iter().map(solid)), properties));
    }
    let collection = FeatureCollection { bbox: None, features, foreign_members: None };
    crate::export::json::to_text(&collection).map_err(|source| Failure::Format { source })
}

fn flat(point: &Point) -> Position {
    Position::from([point[0], point[1]])
}

fn solid(point: &Point) -> Position {
    Position::from(*point)
}

fn feature(value: GeometryValue, properties: JsonValue) -> Feature {
    let kept = |(_, value): &(String, JsonValue)| !value.is_null();
    let properties: JsonObject = match properties {
        JsonValue::Object(object) => object.into_iter().filter(kept).collect(),
        _ => JsonObject::new(),
    };
    Feature {
        bbox: None,
        geometry: Some(value.into()),
        id: None,
        properties: Some(properties),
        foreign_members: None,
    }
}
