//! KML of a plan: targets as placemarks, circles as lines, flights as tracks in time (`gx:Track`), and a tour that flies along
//! with each vehicle.
//!
//! Times count from a fixed date: a plan has none of its own.

use super::scene::{Point, Scene, Vehicle};
use crate::failure::Failure;
use crate::plot::colour;
use quick_xml::Writer;
use quick_xml::events::{BytesDecl, BytesEnd, BytesStart, BytesText, Event};
use std::io;

type Xml = Writer<Vec<u8>>;

const SPACES: [(&str, &str); 2] =
    [("xmlns", "http://www.opengis.net/kml/2.2"), ("xmlns:gx", "http://www.google.com/kml/ext/2.2")];

pub fn text(scene: &Scene) -> Result<String, Failure> {
    let bytes =
        document(scene).map_err(|source| Failure::Format { source: serde_json::Error::io(source) })?;
    Ok(String::from_utf8_lossy(&bytes).into_owned() + "\n")
}

fn document(scene: &Scene) -> io::Result<Vec<u8>> {
    let mut xml = Writer::new_with_indent(Vec::new(), b' ', 1);
    xml.write_event(Event::Decl(BytesDecl::new("1.0", Some("UTF-8"), None)))?;
    within(&mut xml, BytesStart::new("kml").with_attributes(SPACES), |xml| {
        within(xml, BytesStart::new("Document"), |xml| {
            leaf(xml, "name", &scene.name)?;
            for vehicle in &scene.vehicles {
                style(xml, vehicle.number)?;
            }
            folder(xml, "targets", |xml| {
                scene.targets.iter().enumerate().try_for_each(|(index, (target, place))| {
                    let name =
                        if target.name.is_empty() { (index + 1).to_string() } else { target.name.clone() };
                    let numbers = [
                        ("radius", target.radius),
                        ("height", target.height),
                        ("safe_distance", target.safe_distance),
                    ];
                    marked(xml, &name, &numbers, place)
                })
            })?;
            scene.vehicles.iter().try_for_each(|vehicle| flight(xml, vehicle))
        })
    })?;
    Ok(xml.into_inner())
}

fn flight(xml: &mut Xml, vehicle: &Vehicle) -> io::Result<()> {
    folder(xml, &format!("vehicle {}", vehicle.name), |xml| {
        for (targets, ring) in &vehicle.circles {
            placemark(xml, &format!("circle around {targets}"), vehicle.number, |xml| {
                within(xml, BytesStart::new("LineString"), |xml| {
                    leaf(xml, "altitudeMode", "relativeToGround")?;
                    leaf(xml, "coordinates", &ring.iter().map(comma).collect::<Vec<_>>().join(" "))
                })
            })?;
        }
        placemark(xml, &format!("flight of vehicle {}", vehicle.name), vehicle.number, |xml| {
            within(xml, BytesStart::new("gx:Track"), |xml| {
                leaf(xml, "altitudeMode", "relativeToGround")?;
                vehicle.times.iter().try_for_each(|&time| leaf(xml, "when", &moment(time)))?;
                vehicle.path.iter().try_for_each(|[longitude, latitude, height]| {
                    leaf(xml, "gx:coord", &format!("{longitude} {latitude} {height}"))
                })
            })
        })?;
        tour(xml, vehicle)
    })
}

/// The camera flies along, once a second, looking ahead and down.
fn tour(xml: &mut Xml, vehicle: &Vehicle) -> io::Result<()> {
    within(xml, BytesStart::new("gx:Tour"), |xml| {
        leaf(xml, "name", &format!("fly with vehicle {}", vehicle.name))?;
        within(xml, BytesStart::new("gx:Playlist"), |xml| {
            let mut last = f64::NEG_INFINITY;
            for ((&time, place), heading) in vehicle.times.iter().zip(&vehicle.path).zip(&vehicle.headings) {
                if time - last < 1.0 {
                    continue;
                }
                let span = if last.is_finite() { time - last } else { 1.0 };
                last = time;
                within(xml, BytesStart::new("gx:FlyTo"), |xml| {
                    leaf(xml, "gx:duration", &format!("{span:.3}"))?;
                    leaf(xml, "gx:flyToMode", "smooth")?;
                    within(xml, BytesStart::new("Camera"), |xml| {
                        within(xml, BytesStart::new("gx:TimeStamp"), |xml| leaf(xml, "when", &moment(time)))?;
                        leaf(xml, "longitude", &place[0].to_string())?;
                        leaf(xml, "latitude", &place[1].to_string())?;
                        leaf(xml, "altitude", &(place[2] + 8.0).to_string())?;
                        leaf(xml, "heading", &format!("{heading:.1}"))?;
                        leaf(xml, "tilt", "60")?;
                        leaf(xml, "altitudeMode", "relativeToGround")
                    })
                })?;
            }
            Ok(())
        })
    })
}

fn marked(xml: &mut Xml, name: &str, numbers: &[(&str, Option<f64>)], place: &Point) -> io::Result<()> {
    within(xml, BytesStart::new("Placemark"), |xml| {
        leaf(xml, "name", name)?;
        let numbers: Vec<(&str, f64)> =
            numbers.iter().filter_map(|&(key, value)| Some((key, value?))).collect();
        if !numbers.is_empty() {
            within(xml, BytesStart::new("ExtendedData"), |xml| {
                numbers.iter().try_for_each(|(key, value)| {
                    within(xml, BytesStart::new("Data").with_attributes([("name", *key)]), |xml| {
                        leaf(xml, "value", &value.to_string())
                    })
                })
            })?;
        }
        within(xml, BytesStart::new("Point"), |xml| leaf(xml, "coordinates", &comma(place)))
    })
}

fn style(xml: &mut Xml, vehicle: usize) -> io::Result<()> {
    let id = format!("vehicle-{vehicle}");
    // KML has alpha, blue, green, red.
    let web = colour(vehicle - 1);
    let reversed = format!("ff{}{}{}", &web[5..7], &web[3..5], &web[1..3]).to_lowercase();
    within(xml, BytesStart::new("Style").with_attributes([("id", id.as_str())]), |xml| {
        within(xml, BytesStart::new("LineStyle"), |xml| {
            leaf(xml, "color", &reversed)?;
            leaf(xml, "width", "3")
        })
    })
}

fn placemark(
    xml: &mut Xml,
    name: &str,
    vehicle: usize,
    content: impl FnOnce(&mut Xml) -> io::Result<()>,
) -> io::Result<()> {
    within(xml, BytesStart::new("Placemark"), |xml| {
        leaf(xml, "name", name)?;
        leaf(xml, "styleUrl", &format!("#vehicle-{vehicle}"))?;
        content(xml)
    })
}

fn folder(xml: &mut Xml, name: &str, content: impl FnOnce(&mut Xml) -> io::Result<()>) -> io::Result<()> {
    within(xml, BytesStart::new("Folder"), |xml| {
        leaf(xml, "name", name)?;
        content(xml)
    })
}

fn within(
    xml: &mut Xml,
    start: BytesStart<'_>,
    content: impl FnOnce(&mut Xml) -> io::Result<()>,
) -> io::Result<()> {
    let name = String::from_utf8_lossy(start.name().as_ref()).into_owned();
    xml.write_event(Event::Start(start))?;
    content(xml)?;
    xml.write_event(Event::End(BytesEnd::new(name)))
}

fn leaf(xml: &mut Xml, name: &str, text: &str) -> io::Result<()> {
    xml.write_event(Event::Start(BytesStart::new(name)))?;
    xml.write_event(Event::Text(BytesText::new(text)))?;
    xml.write_event(Event::End(BytesEnd::new(name)))
}

fn comma([longitude, latitude, height]: &Point) -> String {
    format!("{longitude},{latitude},{height}")
}

/// A moment of the day on which all plans begin.
fn moment(time: f64) -> String {
    let whole = time.floor();
    let milliseconds = ((time - whole) * 1e3).round().min(999.0);
    let seconds = whole as u64;
    let (day, hour) = (seconds / 86_400 + 1, seconds / 3600 % 24);
    format!("2000-01-{day:02}T{hour:02}:{:02}:{:02}.{milliseconds:03}Z", seconds / 60 % 60, seconds % 60)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn moments_count_from_a_fixed_day() {
        assert_eq!(moment(0.0), "2000-01-01T00:00:00.000Z");
        assert_eq!(moment(3661.25), "2000-01-01T01:01:01.250Z");
        assert_eq!(moment(90_001.0 - 1e-4), "2000-01-02T01:00:00.999Z");
    }
}
