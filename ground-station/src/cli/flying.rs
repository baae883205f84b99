//! Arguments of `fly`.

use super::values::{parse_action, parse_positive, parse_setpoint_rate, parse_way};
use crate::command::FlyRequest;
use crate::execution::Way;
use crate::link::address::Address;
use crate::link::settings::{Reach, SafeAction, Settings};
use std::path::PathBuf;

pub(super) const FLY_EXAMPLES: &str = "\
Examples:
  ground-station fly field-ardupilot.toml --connect udpin:0.0.0.0:14550 --dry-run     checks, nothing is changed
  ground-station fly field-ardupilot.toml --connect udpin:0.0.0.0:14550 --arm --log a.tlog
  ground-station fly field.toml --connect tcpout:127.0.0.1:5760 --way loiter-items    uploads and reads back

Without --arm nothing moves. While it flies, say hold, return or land on the standard input, for all vehicles or with
a vehicle's number; or what has changed, and the fleet is re-planned: appears EAST NORTH, moves TARGET EAST NORTH,
vanishes TARGET, fails VEHICLE. A pilot who changes the mode has the last word: the link then lets go of that vehicle.";

/// Arguments of `fly`.
#[derive(Debug, clap::Args)]
pub struct FlyArguments {
    /// The mission file (TOML); without one, the built-in field mission.
    pub file: Option<PathBuf>,
    /// udpin:HOST:PORT, udpout:HOST:PORT or tcpout:HOST:PORT.
    #[arg(long, value_name = "ADDRESS")]
    pub connect: Address,
    /// How the plan is flown: stream, loiter-items (ArduPilot), polygon, live-orbit (PX4).
    #[arg(long, value_parser = parse_way, default_value = "stream")]
    pub way: Way,
    /// Only look: nothing is sent that changes a vehicle.
    #[arg(long, conflicts_with = "arm")]
    pub dry_run: bool,
    /// Arm, take off and fly.
    #[arg(long)]
    pub arm: bool,
    /// System ids of the vehicles in the order of the plan; 1,2,3,.. if not given.
    #[arg(long, value_delimiter = ',', value_name = "IDS")]
    pub systems: Vec<u8>,
    /// Setpoints per second.
    #[arg(long, value_name = "HZ", default_value_t = 20.0, value_parser = parse_setpoint_rate)]
    pub rate: f64,
    /// Least battery before the start (percent).
    #[arg(long, value_name = "PERCENT", default_value_t = 50)]
    pub least_battery: u8,
    /// Battery at which a vehicle returns (percent).
    #[arg(long, value_name = "PERCENT", default_value_t = 20)]
    pub return_battery: u8,
    /// Distance from the plan at which a vehicle is stopped (m).
    #[arg(long, value_name = "M", default_value_t = 2.0, value_parser = parse_positive)]
    pub deviation: f64,
    /// Silence after which a link counts as lost (s).
    #[arg(long, value_name = "S", default_value_t = 3.0, value_parser = parse_positive)]
    pub link_timeout: f64,
    /// What a vehicle is told whose link is lost: hold, return or land.
    #[arg(long, value_parser = parse_action, default_value = "return")]
    pub on_link_loss: SafeAction,
    /// What a vehicle is told that is too far from its plan: hold, return or land.
    #[arg(long, value_parser = parse_action, default_value = "hold")]
    pub on_deviation: SafeAction,
    /// Log every packet of the session into a new file (.tlog).
    #[arg(long, value_name = "FILE")]
    pub log: Option<PathBuf>,
    /// Read an operator's lines from a file (or pipe) instead of the standard input.
    #[arg(long, value_name = "FILE")]
    pub commands: Option<PathBuf>,
    /// Follow the events of a file: lines as for simulate, `12.5 appears EAST NORTH`, times after the plan's start.
    #[arg(long, value_name = "FILE")]
    pub arrivals: Option<PathBuf>,
    /// No progress bar.
    #[arg(long, short)]
    pub quiet: bool,
}

impl FlyArguments {
    pub(super) fn request(self) -> FlyRequest {
        let reach = match (self.dry_run, self.arm) {
            (true, _) => Reach::Check,
            (_, true) => Reach::Fly,
            _ => Reach::Upload,
        };
        let settings = Settings {
            reach,
            rate: self.rate,
            least_battery: self.least_battery,
            return_battery: self.return_battery,
            deviation: self.deviation,
            link_timeout: self.link_timeout,
            on_link_loss: self.on_link_loss,
            on_deviation: self.on_deviation,
            ..Settings::default()
        };
        FlyRequest {
            file: self.file,
            address: self.connect,
            way: self.way,
            systems: self.systems,
            settings,
            log: self.log,
            commands: self.commands,
            arrivals: self.arrivals,
            quiet: self.quiet,
        }
    }
}
