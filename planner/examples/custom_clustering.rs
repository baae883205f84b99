//! A clustering of one's own in the paper's pipeline: sectors around the depot instead of k-means, and both makespans.
//!
//!     cargo run --release -p uav-planner --example custom_clustering

use planner::quad_dynamics::{Vehicle, VehicleParameters};
use planner::{Mission, Options, Pipeline, Target, plan};

/// Equal numbers of points by their direction from the origin, which is the depot.
fn sectors(points: &[[f64; 2]], n: usize) -> Vec<usize> {
    let mut order: Vec<usize> = (0..points.len()).collect();
    let direction = |i: usize| points[i][1].atan2(points[i][0]);
    order.sort_by(|&a, &b| direction(a).total_cmp(&direction(b)));
    let mut labels = vec![0; points.len()];
    for (place, point) in order.into_iter().enumerate() {
        labels[point] = place * n / points.len();
    }
    labels
}

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let positions = [
        [12.0, 8.0],
        [-31.0, 15.5],
        [25.0, -22.0],
        [-8.0, -30.0],
        [35.0, 34.0],
        [-46.0, -14.0],
        [20.0, 43.0],
    ];
    let vehicle = Vehicle::new(VehicleParameters::survey_450())?;
    let mut mission = Mission::new(vehicle, 3, positions.map(Target::at).to_vec());
    mission.pipeline = Pipeline::Paper;
    for (name, options) in
        [("k-means", Options::default()), ("sectors", Options::default().with_clustering(&sectors))]
    {
        let plan = plan(&mission, &options)?;
        let routes: Vec<_> = plan.vehicles.iter().map(|vehicle| &vehicle.route).collect();
        println!("{name}: makespan {:.2} s, routes {routes:?}", plan.certificate.makespan);
    }
    Ok(())
}
