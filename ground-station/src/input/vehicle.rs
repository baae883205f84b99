//! The vehicle: a preset, a `[vehicle]` table with every parameter, or a preset with some of them changed.

use super::range::Range;
use super::reader::{Item, Reader, Section};
use planner::quad_dynamics::{Rotor, Spin, Vehicle, VehicleParameters};

/// A vehicle known by name.
type Preset = fn() -> VehicleParameters;

/// The vehicles known by name.
const PRESETS: [(&str, Preset); 4] = [
    ("survey-450", VehicleParameters::survey_450),
    ("crazyflie", VehicleParameters::crazyflie),
    ("hummingbird", VehicleParameters::hummingbird),
    ("racing", VehicleParameters::racing),
];

/// Where the rotors of a layout sit.
#[derive(Debug, Clone, Copy)]
enum Layout {
    X,
    Plus,
}

/// `fleet.preset` and `[vehicle]`.
///
/// With a preset, the table changes single parameters; without one, a table must have them all. Neither is the preset
/// `survey-450`. What cannot be used is recorded, and the preset returned in its place.
pub fn read(root: &Section<'_, '_>, reader: &Reader<'_>, preset: Option<&Item<'_, '_>>) -> Option<Vehicle> {
    let section = root.section("vehicle");
    let chosen = preset.and_then(|item| item.choice(&PRESETS));
    let mut parameters = chosen.unwrap_or(VehicleParameters::survey_450)();
    let complete = change(&section, &mut parameters);
    if let (true, None) = (section.is_present(), preset) {
        let remedy =
            "give every parameter of the vehicle, or fleet.preset = \"survey-450\" to change only some";
        for key in complete {
            section.missing(key, remedy);
        }
    }
    section.finish();
    if !reader.is_wrong("vehicle") {
        for problem in parameters.problems() {
            reader.add(reader.line("vehicle"), "vehicle", format!("vehicle: {problem}"));
        }
    }
    // The rest of the mission is still looked at with a vehicle that can fly.
    Vehicle::new(parameters).or_else(|_| Vehicle::new(VehicleParameters::survey_450())).ok()
}

/// Puts the parameters of the table in their places; returns the keys that the table does not have.
fn change(section: &Section<'_, '_>, parameters: &mut VehicleParameters) -> Vec<&'static str> {
    // Farther from the centre than any rotor of a craft of this kind (m).
    const REACH: Range = Range::between(-10.0, 10.0);
    let numbers = [
        ("mass", Range::POSITIVE, &mut parameters.mass),
        ("max_thrust", Range::POSITIVE, &mut parameters.max_thrust),
        ("min_thrust_share", Range::between(0.0, 1.0), &mut parameters.min_thrust_share),
        ("drag_coefficient", Range::NOT_NEGATIVE, &mut parameters.drag_coefficient),
        ("torque_to_thrust", Range::POSITIVE, &mut parameters.torque_to_thrust),
    ];
    let mut absent = Vec::new();
    for (key, range, place) in numbers {
        *place = section.number(key, range).unwrap_or(*place);
        absent.extend((!section.has(key)).then_some(key));
    }
    match section.item("max_body_rates") {
        Some(item) => {
            parameters.max_body_rates =
                item.numbers::<3>(Range::POSITIVE).unwrap_or(parameters.max_body_rates)
        }
        None => absent.push("max_body_rates"),
    }
    match section.item("inertia_tensor") {
        Some(item) => parameters.inertia_tensor = inertia(&item).unwrap_or(parameters.inertia_tensor),
        None => absent.push("inertia_tensor"),
    }
    let layout = section.choice("layout", &[("x", Layout::X), ("plus", Layout::Plus)]).unwrap_or(Layout::X);
    let arm = section.number("arm", Range::above_to(0.0, 10.0));
    match (section.item("rotors"), arm) {
        (Some(item), _) if section.has("arm") => {
            item.wrong("stand beside an arm", "keep only one of the two")
        }
        (Some(item), _) => parameters.rotors = rotors(&item, REACH).unwrap_or(parameters.rotors),
        (None, Some(arm)) => {
            parameters.rotors = match layout {
                Layout::X => VehicleParameters::x_layout(arm),
                Layout::Plus => VehicleParameters::plus_layout(arm),
            }
        }
        (None, None) if section.has("arm") => {}
        (None, None) => absent.push("arm"),
    }
    absent
}

/// Three principal moments, or three rows of three.
fn inertia(item: &Item<'_, '_>) -> Option<[[f64; 3]; 3]> {
    // Greater than that of any craft that a field team can carry (kg m^2).
    const MOMENTS: Range = Range::between(-1e3, 1e3);
    let wanted = "a list of 3 principal moments or of 3 rows of 3";
    let entries = item.items(wanted)?;
    if entries.iter().any(Item::is_list) && entries.len() == 3 {
        let rows: Vec<Option<[f64; 3]>> = entries.iter().map(|row| row.numbers::<3>(MOMENTS)).collect();
        return Some([rows[0]?, rows[1]?, rows[2]?]);
    }
    let [x, y, z] = item.numbers::<3>(MOMENTS)?;
    Some([[x, 0.0, 0.0], [0.0, y, 0.0], [0.0, 0.0, z]])
}

/// Four tables with a position (forward, left) and a turning sense.
fn rotors(item: &Item<'_, '_>, reach: Range) -> Option<[Rotor; 4]> {
    const SPINS: [(&str, Spin); 2] =
        [("clockwise", Spin::Clockwise), ("counter-clockwise", Spin::CounterClockwise)];
    let wanted = "a list of 4 tables { position = [forward, left], spin = \"clockwise\" }";
    let entries = item.items(wanted)?;
    let count = entries.len();
    let mut rotors = Vec::new();
    for entry in entries {
        let section = entry.into_section();
        for key in ["position", "spin"] {
            if section.is_present() && !section.has(key) {
                section.missing(key, "give position = [forward, left] in metres and spin");
            }
        }
        let position = section.item("position").and_then(|item| item.numbers::<2>(reach));
        let spin = section.choice("spin", &SPINS);
        section.finish();
        rotors.extend(position.zip(spin).map(|(position, spin)| Rotor { position, spin }));
    }
    if count != 4 {
        item.wrong(&format!("has {count} entries"), &format!("give {wanted}"));
    }
    rotors.try_into().ok()
}
