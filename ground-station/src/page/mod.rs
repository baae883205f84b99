//! A plan as one HTML page: map with pan and zoom, the flight through time, charts, tables. No network, no library.
//!
//! The page is three files of this folder (`page.html`, `page.css`, `page.js`) with the plan as JSON between them; its
//! security policy forbids it to load anything.

mod data;

pub use data::{ChartData, CircleData, LimitData, PageData, TargetData, VehicleData};

/// The page's text.
///
/// # Errors
///
/// Those of serialisation; finite data has none.
pub fn page(data: &PageData) -> serde_json::Result<String> {
    // Inside a script element the parser looks for "</" and "<!" only; "<" by its number is the same JSON.
    let json = serde_json::to_string(data)?.replace('<', "\\u003c");
    let parts = [
        ("{{title}}", escaped(&data.title)),
        ("{{style}}", include_str!("page.css").to_owned()),
        ("{{script}}", include_str!("page.js").to_owned()),
        // Last, so that nothing in the data is taken for a place.
        ("{{data}}", json),
    ];
    let template = include_str!("page.html").to_owned();
    Ok(parts.iter().fold(template, |text, (place, part)| text.replacen(place, part, 1)))
}

fn escaped(text: &str) -> String {
    text.replace('&', "&amp;").replace('<', "&lt;").replace('>', "&gt;").replace(['{', '}'], "")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn no_name_ends_the_script_or_fills_a_place() -> serde_json::Result<()> {
        let evil = "</script><b>{{data}} & {{script}}";
        let text = page(&PageData { title: evil.into(), ..PageData::default() })?;
        assert_eq!(text.matches("</script>").count(), 2);
        assert!(text.contains("<title>&lt;/script&gt;&lt;b&gt;data &amp; script</title>"));
        assert!(text.contains("\"title\":\"\\u003c/script>\\u003cb>{{data}} & {{script}}\""));
        Ok(())
    }
}
