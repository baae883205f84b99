//! The report page in headless Chromium, where there is one.
//!
//! Run with a browser: install Debian's `chromium` (or name a binary in `CHROMIUM`), then
//! `cargo test -p ground-station --test page -- --nocapture`.

use ground_station::command::{ReportRequest, report};
use std::error::Error;
use std::path::{Path, PathBuf};
use std::process::Command;

/// Three targets, two vehicles, one entry: the smallest mission with everything on the page.
const MISSION: &str = r#"
name = "small </script>"
origin = { latitude = 42.0308, longitude = -93.6319, altitude = 290.0 }
[depot]
position = [0.0, 0.0]
[fleet]
vehicles = 2
preset = "survey-450"
[loiter]
speed_limit = 6.0
[transition]
entries = 2
segments = 20
[targets]
positions = [[12.0, 8.0], [-10.0, 15.5], [27.5, 22.0]]
"#;

/// Moves the slider as a hand does, zooms, and notes what the page then shows.
const HAND: &str = r##"<pre id="seen"></pre><script>
"use strict";
const seen = [];
const marks = () => [...document.querySelectorAll(".vehicle")].map((mark) =>
  [mark.dataset.east, mark.dataset.north, mark.getAttribute("transform")].join(" "));
for (const share of [0, 0.25, 0.5, 1]) {
  const slider = document.getElementById("time");
  slider.value = share * slider.max;
  slider.dispatchEvent(new Event("input"));
  seen.push(["at", share, document.getElementById("clock").textContent, ...marks()].join("; "));
}
const before = document.querySelector("#map g").getAttribute("transform");
document.getElementById("map").dispatchEvent(new WheelEvent("wheel", { deltaY: -300, clientX: 200, clientY: 200, cancelable: true }));
seen.push("zoomed " + (before !== document.querySelector("#map g").getAttribute("transform")));
document.getElementById("play").click();
seen.push("play " + document.getElementById("play").textContent);
seen.push("charts " + document.querySelectorAll(".chart polyline").length);
seen.push("rows " + document.querySelectorAll("#vehicles tr").length);
seen.push("errors " + window.errors.length + " " + window.errors.join(" "));
document.getElementById("seen").textContent = seen.join("\n");
</script>"##;
const WATCH: &str =
    r#"<script>window.errors = []; window.onerror = (text) => { window.errors.push(text); };</script>"#;

fn chromium() -> Option<PathBuf> {
    let named = std::env::var_os("CHROMIUM").map(PathBuf::from);
    let usual = ["chromium", "chromium-browser", "google-chrome"].map(PathBuf::from);
    let starts =
        |name: &PathBuf| Command::new(name).arg("--version").output().is_ok_and(|run| run.status.success());
    named.into_iter().chain(usual).find(starts)
}

fn written(folder: &Path) -> Result<String, Box<dyn Error>> {
    let mission = folder.join("small.toml");
    std::fs::write(&mission, MISSION)?;
    let out = folder.join("report.html");
    let request =
        ReportRequest { file: Some(mission), out: out.clone(), force: false, rate: 10.0, quiet: true };
    let text = report(&request)?;
    assert!(text.contains("makespan") && text.contains("wrote "), "{text}");
    assert!(report(&request).is_err_and(|failure| failure.to_string().contains("--force")));
    Ok(std::fs::read_to_string(out)?)
}

#[test]
fn the_page_loads_without_errors_and_the_slider_moves_the_vehicles() -> Result<(), Box<dyn Error>> {
    let home = tempfile::tempdir()?;
    let page = written(home.path())?;
    // The only address in it is the name of SVG's vocabulary, which is never fetched.
    assert_eq!(page.matches("://").count(), 1);
    let Some(chromium) = chromium() else {
        println!("skipped: no chromium; install it, or name it in CHROMIUM");
        return Ok(());
    };
    let watched =
        page.replacen("<head>", &format!("<head>{WATCH}"), 1).replace("</body>", &format!("{HAND}</body>"));
    let file = home.path().join("watched.html");
    std::fs::write(&file, watched)?;
    let run = Command::new(chromium)
        .args(["--headless", "--no-sandbox", "--disable-gpu", "--window-size=1400,1000", "--dump-dom"])
        .arg(format!("--user-data-dir={}", home.path().join("profile").display()))
        .arg(format!("file://{}", file.display()))
        .output()?;
    let dom = String::from_utf8_lossy(&run.stdout).into_owned();
    let seen = dom
        .split("<pre id=\"seen\">")
        .nth(1)
        .and_then(|rest| rest.split("</pre>").next())
        .unwrap_or_default();
    let lines: Vec<&str> = seen.lines().collect();
    assert_eq!(lines.len(), 9, "{seen}\n{}", String::from_utf8_lossy(&run.stderr));
    let places = |line: usize| lines[line].splitn(4, "; ").nth(3).unwrap_or_default();
    // Both vehicles are elsewhere at a quarter and at a half, and at the end where they began.
    assert!(places(0) != places(1) && places(1) != places(2) && places(2) != places(3), "{seen}");
    let ends = |line: usize| {
        places(line)
            .split("; ")
            .map(|mark| mark.split(" translate").next().map(str::to_owned))
            .collect::<Vec<_>>()
    };
    assert_eq!(ends(0), ends(3), "{seen}");
    assert_eq!(lines[4..], ["zoomed true", "play Pause", "charts 6", "rows 4", "errors 0 "], "{seen}");
    Ok(())
}
