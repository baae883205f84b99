//! Draws a map and a profile from plain data, without planning anything: `cargo run --example draw_map [FOLDER]`.
//!
//! Shows that the pictures need no plan: whoever has routes and paths of their own can draw them.

use ground_station::plot::{
    Band, Limit, MapCircle, MapScene, MapTarget, MapVehicle, Panel, Profile, map, profile,
};

const TARGETS: [[f64; 2]; 6] =
    [[12.0, 8.0], [33.0, 6.0], [41.0, 15.5], [8.0, 31.0], [19.0, 44.5], [31.5, 41.5]];

fn main() -> std::io::Result<()> {
    let folder = std::env::args().nth(1).unwrap_or_else(|| ".".to_owned());
    let vehicles = vec![vehicle(0, &[0, 1, 2]), vehicle(1, &[3, 4, 5])];
    let targets = TARGETS.iter().enumerate().map(|(index, &position)| MapTarget {
        label: (index + 1).to_string(),
        position,
        safe_distance: 1.5,
    });
    let scene = MapScene {
        title: "two vehicles, six targets".into(),
        depot: [0.0, 0.0],
        targets: targets.collect(),
        vehicles,
    };
    std::fs::write(format!("{folder}/map.svg"), map(&scene))?;
    std::fs::write(format!("{folder}/profile.svg"), profile(&speeds()))
}

/// Straight flights from circle to circle, each circle flown once.
fn vehicle(index: usize, route: &[usize]) -> MapVehicle {
    let pad = [3.0 * index as f64, 0.0];
    let mut track = vec![pad];
    let mut circles = Vec::new();
    for (leg, &target) in route.iter().enumerate() {
        let centre = TARGETS[target];
        let direction = if leg % 2 == 0 { 1 } else { -1 };
        let entry = f64::atan2(-centre[1], -centre[0]);
        circles.push(MapCircle { centre, radius: 3.0, direction, entry });
        track.extend((0..=60).map(|step| {
            let angle = entry + f64::from(direction) * f64::from(step) * std::f64::consts::TAU / 60.0;
            [centre[0] + 3.0 * angle.cos(), centre[1] + 3.0 * angle.sin()]
        }));
    }
    track.push(pad);
    MapVehicle { pad, circles, track, caption: format!("vehicle {}: {} targets", index + 1, route.len()) }
}

fn speeds() -> Profile {
    let times: Vec<f64> = (0..600).map(|step| 0.05 * f64::from(step)).collect();
    let values = times.iter().map(|time| 4.0 + 3.0 * (0.8 * time).sin()).collect();
    let limits = vec![Limit { name: "speed limit".into(), value: 8.0 }];
    let panel = Panel { title: "speed (m/s)".into(), values, limits };
    let loiters =
        vec![Band { span: [5.0, 9.0], label: "1".into() }, Band { span: [14.0, 18.0], label: "2".into() }];
    Profile { title: "vehicle 1".into(), vehicle: 0, times, panels: vec![panel.clone(), panel], loiters }
}
