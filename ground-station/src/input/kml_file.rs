//! Targets from KML: every placemark with a point.
//!
//! `radius`, `height` and `safe_distance` are used if the placemark has them as `ExtendedData`. Elements are told by their names
//! alone, so that all versions and name spaces will do.

use super::range::Range;
use super::targets::{Frame, Listed, Place, Wrong, all_listed};
use crate::problem::abridged;
use planner::Target;
use quick_xml::Reader;
use quick_xml::events::{BytesStart, Event};

/// Reads the targets; what is wrong goes to `wrong`.
pub fn read(file: &str, text: &str, frame: Frame, wrong: Wrong<'_>) -> Vec<Listed> {
    let text = text.strip_prefix('\u{feff}').unwrap_or(text);
    let mut document = Document::default();
    let mut reader = Reader::from_str(text);
    loop {
        let outcome = match reader.read_event() {
            Ok(Event::Eof) => break,
            Ok(event) => document.take(&event, wrong),
            Err(error) => Err(error.to_string()),
        };
        if let Err(what) = outcome {
            let before = usize::try_from(reader.buffer_position()).unwrap_or(text.len()).min(text.len());
            let line = 1 + text.as_bytes()[..before].iter().filter(|&&byte| byte == b'\n').count();
            wrong(Some(line), "", format!("not KML ({}): give a KML file with placemarks", abridged(&what)));
            return Vec::new();
        }
    }
    if !document.open.is_empty() || !document.has_root {
        wrong(None, "", "not KML, or cut off: give a whole KML file with placemarks".to_owned());
        return Vec::new();
    }
    all_listed(document.places, file, frame, wrong)
}

/// What has been read so far.
#[derive(Debug, Default)]
struct Document {
    /// Names of the elements around the place that is read.
    open: Vec<String>,
    has_root: bool,
    /// Text of the innermost element.
    text: String,
    placemark: Placemark,
    /// Name of the `Data` that is read.
    data: String,
    places: Vec<Place>,
}

#[derive(Debug, Default)]
struct Placemark {
    name: String,
    point: Option<String>,
    data: Vec<(String, String)>,
}

impl Document {
    fn take(&mut self, event: &Event<'_>, wrong: Wrong<'_>) -> Result<(), String> {
        match event {
            Event::Start(start) => self.begin(start),
            Event::Text(text) => self.text.push_str(&text.decode().map_err(|error| error.to_string())?),
            Event::CData(text) => self.text.push_str(&text.decode().map_err(|error| error.to_string())?),
            Event::GeneralRef(reference) => {
                let name = reference.decode().map_err(|error| error.to_string())?;
                let character = match reference.resolve_char_ref().map_err(|error| error.to_string())? {
                    Some(character) => character.to_string(),
                    None => quick_xml::escape::resolve_xml_entity(&name).unwrap_or_default().to_owned(),
                };
                self.text.push_str(&character);
            }
            Event::End(_) => self.end(wrong),
            _ => {}
        }
        Ok(())
    }

    fn begin(&mut self, start: &BytesStart<'_>) {
        let name = String::from_utf8_lossy(start.local_name().as_ref()).into_owned();
        self.has_root |= self.open.is_empty() && name == "kml";
        if name == "Placemark" {
            self.placemark = Placemark::default();
        }
        if name == "Data" || name == "SimpleData" {
            let attribute = start.try_get_attribute("name").ok().flatten();
            self.data =
                attribute.map(|name| String::from_utf8_lossy(&name.value).into_owned()).unwrap_or_default();
        }
        self.text.clear();
        self.open.push(name);
    }

    fn end(&mut self, wrong: Wrong<'_>) {
        let name = self.open.pop().unwrap_or_default();
        let parent = self.open.last().map(String::as_str).unwrap_or_default();
        let text = std::mem::take(&mut self.text);
        match (name.as_str(), parent) {
            ("name", "Placemark") => self.placemark.name = text.trim().to_owned(),
            ("coordinates", "Point") => self.placemark.point = Some(text),
            ("value", "Data") | ("SimpleData", _) => {
                self.placemark.data.push((std::mem::take(&mut self.data), text));
            }
            ("Placemark", _) => {
                let placemark = std::mem::take(&mut self.placemark);
                self.places.extend(placemark.place(self.places.len(), wrong));
            }
            _ => {}
        }
    }
}

impl Placemark {
    /// The place; a placemark with a line or an area is no target.
    fn place(self, index: usize, wrong: Wrong<'_>) -> Option<Place> {
        let key = format!("placemark[{index}]");
        let point = self.point.as_ref()?;
        let numbers: Vec<f64> = point.trim().split(',').map_while(|word| word.trim().parse().ok()).collect();
        let &[longitude, latitude, ..] = numbers.as_slice() else {
            let message =
                format!("{key}.coordinates = {}: give longitude,latitude in degrees", abridged(point));
            wrong(None, &key, message);
            return None;
        };
        let mut number = |name: &str, range: Range| {
            let (_, text) = self.data.iter().find(|(known, _)| known == name)?;
            let found = text.trim().parse().ok().filter(|&number| range.contains(number));
            if found.is_none() {
                let message =
                    format!("{key}.{name} = {} is out of range: give a number {range}", abridged(text));
                wrong(None, &format!("{key}.{name}"), message);
            }
            found
        };
        let target = Target {
            radius: number("radius", Range::POSITIVE),
            height: number("height", Range::POSITIVE),
            safe_distance: number("safe_distance", Range::NOT_NEGATIVE),
            name: self.name,
            ..Target::default()
        };
        Some(Place { latitude, longitude, target, key })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn read_all(text: &str) -> (Vec<Listed>, Vec<String>) {
        let mut messages = Vec::new();
        let targets = read("t.kml", text, Frame::Degrees, &mut |_, _, message| messages.push(message));
        (targets, messages)
    }

    #[test]
    fn points_of_any_version_are_targets() {
        let (targets, messages) = read_all(
            "<?xml version=\"1.0\"?><kml xmlns=\"http://earth.google.com/kml/2.1\"><Folder><Placemark><name>a &amp; b&#33;</name>\
             <ExtendedData><Data name=\"radius\"><value>4</value></Data></ExtendedData>\
             <Point><coordinates> 151.2,-33.8,7 </coordinates></Point></Placemark><Placemark><name>way</name><LineString>\
             <coordinates>1,2 3,4</coordinates></LineString></Placemark></Folder></kml>",
        );
        assert!(messages.is_empty(), "{messages:?}");
        let wanted = Target { name: "a & b!".into(), radius: Some(4.0), ..Target::at([151.2, -33.8]) };
        assert_eq!(targets.into_iter().map(|listed| listed.target).collect::<Vec<_>>(), [wanted]);
    }

    #[test]
    fn what_is_cut_off_or_no_kml_is_said() {
        for text in [
            "",
            "<kml>",
            "<html></html>",
            "<kml><Placemark></kml>",
            "<kml><Placemark><Point><coordinates>1,2",
        ] {
            let (targets, messages) = read_all(text);
            assert!(
                targets.is_empty() && messages.iter().any(|message| message.contains("not KML")),
                "{text}: {messages:?}"
            );
        }
        let point = "<kml><Placemark><Point><coordinates>x</coordinates></Point></Placemark></kml>";
        assert!(read_all(point).1[0].contains("placemark[0].coordinates = x"));
    }
}
