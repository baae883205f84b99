//! prototype
use std::time::Instant;
use mtsp::*;
struct P(Vec<[f64;2]>);
impl christofides::Metric for P { fn len(&self)->usize{self.0.len()} fn distance(&self,i:usize,j:usize)->f64{ let (a,b)=(self.0[i],self.0[j]); ((a[0]-b[0]).powi(2)+(a[1]-b[1]).powi(2)).sqrt() } }
fn main() {
    let a: Vec<String> = std::env::args().collect();
    let m: usize = a[2].parse().unwrap(); let secs: f64 = a[3].parse().unwrap(); let horizon: u64 = a[4].parse().unwrap();
    let seed = a.get(5).map_or(0, |s| s.parse().unwrap());
    let text = std::fs::read_to_string(&a[1]).unwrap();
    let pts: Vec<[f64;2]> = text.lines().filter_map(|l| { let v: Vec<f64> = l.split(|c: char| c==','||c.is_whitespace()).filter(|s|!s.is_empty()).map(|s| s.parse().unwrap_or(f64::NAN)).collect(); if v.iter().any(|x|x.is_nan())||v.len()<2 {None} else {Some([v[v.len()-2],v[v.len()-1]])}}).collect();
    let p = P(pts);
    let pr = Problem::new(&p, m).unwrap();
    let t = Instant::now();
    let b = lower_bound::both(&pr);
    let tb = t.elapsed().as_secs_f64();
    let t = Instant::now();
    let mut its = 0;
    let init = (0..m).map(|v| pr.targets().iter().copied().filter(|t| t % m == v).collect()).collect();
    let s = solve_from(&pr, init, &Options::default().with_seed(seed).with_iterations(u64::MAX/4).with_horizon(horizon), &mut |p| { if p.iteration < 1<<40 {its = p.iteration;} t.elapsed().as_secs_f64() < secs }).unwrap();
    println!("{} {} its {} value {:.3} total {:.1} lb {:.3} ({:.1} ms) gap {:.2}%", a[1].rsplit('/').next().unwrap(), m, its, s.makespan, s.total_cost, b.makespan, tb*1e3, 100.0*s.gap(Objective::Makespan));
}
