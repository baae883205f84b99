//! The classic problems: a file each, with statement, source and reference value; `tests/data/known_problems.md` has the table.

pub mod alp_rider;
pub mod block_move;
pub mod brachistochrone;
pub mod bryson_denham;
mod cart_pole_model;
pub mod cartpole_kelly;
pub mod cartpole_optimtraj_force;
pub mod cartpole_optimtraj_time;
pub mod catmix;
pub mod definition;
pub mod double_integrator;
pub mod dubins_lsl;
pub mod free_flying_robot;
mod glider_model;
pub mod goddard_cops;
pub mod hang_glider;
pub mod hang_glider_betts;
pub mod linear_tangent;
pub mod moon_landing;
mod planar_model;
pub mod planar_two_axis;
pub mod quad2d_x12;
pub mod quad2d_x3;
pub mod quad2d_x6;
pub mod quad2d_z3;
pub mod robot_arm;
pub mod s_curve;
pub mod triple_integrator;
pub mod vanderpol;

use definition::Known;

/// All of them.
pub fn all() -> Vec<Known> {
    vec![
        double_integrator::known(),
        triple_integrator::known(),
        s_curve::known(),
        block_move::known(),
        brachistochrone::known(),
        bryson_denham::known(),
        planar_two_axis::known(),
        moon_landing::known(),
        dubins_lsl::known(),
        linear_tangent::known(),
        vanderpol::known(),
        cartpole_kelly::known(),
        cartpole_optimtraj_force::known(),
        cartpole_optimtraj_time::known(),
        goddard_cops::known(),
        catmix::known(),
        hang_glider::known(),
        hang_glider_betts::known(),
        free_flying_robot::known(),
        robot_arm::known(),
        alp_rider::known(),
        quad2d_x3::known(),
        quad2d_x6::known(),
        quad2d_x12::known(),
        quad2d_z3::known(),
    ]
}
