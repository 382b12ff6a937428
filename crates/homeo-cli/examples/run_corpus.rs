//! Runs `homeo` on every file of a folder and writes a table: `run_corpus HOMEO DATA STATE TABLE.md [SECONDS]`.
//!
//! Each file gives one line per target, kept in STATE: a second run does only what is missing.
#![allow(clippy::print_stdout, clippy::print_stderr, missing_docs)]

use std::fmt::Write as _;
use std::path::{Path, PathBuf};
use std::process::Command;
use std::time::Instant;

use serde_json::{Value, json};

/// Points of the exact round trip for each map.
const POINTS: u64 = 100;

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    let [homeo, data, state, table] = arguments
        .get(..4)
        .and_then(|a| <&[String; 4]>::try_from(a).ok())
        .ok_or("usage: HOMEO DATA STATE TABLE.md [SECONDS]")?;
    let seconds = arguments.get(4).map_or("60", String::as_str);
    let runner =
        Runner { homeo: std::fs::canonicalize(homeo)?, state: PathBuf::from(state), seconds: seconds.to_owned() };
    std::fs::create_dir_all(&runner.state)?;
    let root = Path::new(data);
    let mut files = Vec::new();
    walk(root, &mut files)?;
    files.sort_by_key(|path| (path.metadata().map_or(0, |m| m.len()), path.clone()));
    let mut records = Vec::new();
    for path in &files {
        let name = path.strip_prefix(root)?.display().to_string();
        records.push((name.clone(), runner.file(path, &name)?));
    }
    records.sort_by(|a, b| a.0.cmp(&b.0));
    std::fs::write(table, markdown(&records, seconds))?;
    Ok(())
}

/// All files that are meant as inputs.
fn walk(folder: &Path, files: &mut Vec<PathBuf>) -> std::io::Result<()> {
    for entry in std::fs::read_dir(folder)? {
        let path = entry?.path();
        let name = path.file_name().map(|n| n.to_string_lossy().into_owned()).unwrap_or_default();
        if path.is_dir() {
            walk(&path, files)?;
        } else if name != "README.md" && name != "manifest.json" {
            files.push(path);
        }
    }
    Ok(())
}

struct Runner {
    homeo: PathBuf,
    state: PathBuf,
    seconds: String,
}

impl Runner {
    /// Everything about a file, from the state where it is known.
    fn file(&self, path: &Path, name: &str) -> Result<Value, Box<dyn std::error::Error>> {
        let kept = self.state.join(format!("{}.json", name.replace('/', "__")));
        if let Ok(text) = std::fs::read_to_string(&kept)
            && let Ok(value) = serde_json::from_str(&text)
        {
            return Ok(value);
        }
        let clock = Instant::now();
        let input = path.display().to_string();
        let info = self.homeo(&["info", &input, "--intersections"]);
        let kind = info["kind"].as_str().unwrap_or_default();
        let targets: &[&str] = match (kind, info["ball"] == false, info["disk"] == true) {
            ("tetrahedra", false, _) => &["cube", "ball"],
            ("tetrahedra", true, _) => &["ball"],
            ("triangles", _, true) => &["square", "disk"],
            ("triangles", _, false) => &["disk"],
            _ => &[],
        };
        let maps: Vec<Value> = targets.iter().map(|target| self.map(&input, target)).collect();
        let record = json!({"info": info, "maps": maps});
        let partial = kept.with_extension("partial");
        std::fs::write(&partial, record.to_string())?;
        std::fs::rename(&partial, &kept)?;
        println!("{:8.1} s  {name}", clock.elapsed().as_secs_f64());
        Ok(record)
    }

    /// Runs a verb with `--json`; the object, with the exit code.
    fn homeo(&self, arguments: &[&str]) -> Value {
        let output = Command::new(&self.homeo).args(arguments).args(["--json", "-q"]).output();
        let Ok(output) = output else { return json!({"exit": null}) };
        let text = String::from_utf8_lossy(&output.stdout).into_owned();
        let mut value: Value = serde_json::from_str(&text).unwrap_or_else(|_| json!({"not_json": text}));
        value["exit"] = json!(output.status.code());
        if let Some(object) = value.as_object_mut() {
            object.retain(|key, _| !["parts", "boundary"].contains(&key.as_str()));
        }
        value
    }

    fn map(&self, input: &str, target: &str) -> Value {
        let map = self.state.join(format!("tmp-{}.homeo", std::process::id())).display().to_string();
        let points = self.state.join(format!("tmp-{}-p.csv", std::process::id())).display().to_string();
        let there = self.state.join(format!("tmp-{}-t.csv", std::process::id())).display().to_string();
        let back = self.state.join(format!("tmp-{}-b.csv", std::process::id())).display().to_string();
        let made = self.homeo(&["map", input, "--onto", target, "-o", &map, "--timeout", &self.seconds]);
        let mut record = json!({"target": target, "map": made});
        if made["exit"] == 0 {
            record["verify"] = self.homeo(&["verify", &map, "--source", input]);
            if std::fs::write(&points, target_points(target, true)).is_ok() {
                if std::fs::write(&back, target_points(target, false)).is_ok() {
                    record["float"] = self.homeo(&["eval", &map, "--points", &back, "--inverse", "-o", &there]);
                }
                record["inverse"] =
                    self.homeo(&["eval", &map, "--points", &points, "--inverse", "--exact", "-o", &there]);
                record["forward"] = self.homeo(&["eval", &map, "--points", &there, "--exact", "-o", &back]);
                let same = std::fs::read(&points).ok() == std::fs::read(&back).ok() && record["forward"]["exit"] == 0;
                record["round_trip"] = json!(same);
            }
        }
        for name in [&map, &points, &there, &back] {
            let _ = std::fs::remove_file(name);
        }
        record
    }
}

/// Points inside the exact target, always the same: reduced fractions, or decimals near them.
fn target_points(target: &str, exact: bool) -> String {
    let mut state = 7u64;
    let mut random = |below: u64| {
        state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (state >> 33) % below
    };
    let mut text = String::from(if ["square", "disk"].contains(&target) { "x,y\n" } else { "x,y,z\n" });
    for _ in 0..POINTS {
        // A prime denominator: fractions are reduced as they are.
        let q = 1009i64;
        let row: Vec<i64> = match target {
            "square" => vec![1 + random(1008) as i64, 1 + random(1008) as i64],
            "cube" => (0..3).map(|_| 1 + random(1008) as i64).collect(),
            "disk" => vec![random(1009) as i64 - 504, random(1009) as i64 - 504],
            // Inside the ball of radius 1/(2 sqrt 3) about the origin, which the tetrahedron holds.
            _ => (0..3).map(|_| random(321) as i64 - 160).collect(),
        };
        let fraction = |p: &i64| match (*p, exact) {
            (0, true) => "0".to_owned(),
            (p, true) => format!("{p}/{q}"),
            (p, false) => format!("{:?}", p as f64 / q as f64),
        };
        let _ = writeln!(text, "{}", row.iter().map(fraction).collect::<Vec<_>>().join(","));
    }
    text
}

fn markdown(records: &[(String, Value)], seconds: &str) -> String {
    let mut text = format!(
        "# homeo on the development data\n\nMade by `scripts/run-corpus`. Exit codes as in the interface; time limit {seconds} s for each map; \
         the round trip takes {POINTS} rational points of the exact target back and forth and compares them digit by digit.\n\n{}\n\
         | file | kind | vertices | cells | info | says | onto | exit | cells mapped | refinements | s | peak MB | verify | round trip | float error |\n\
         |---|---|---:|---:|---:|---|---|---:|---:|---:|---:|---:|---:|---|---:|\n",
        summary(records)
    );
    for (name, record) in records {
        let info = &record["info"];
        let cells = info["tetrahedra"].as_u64().or(info["triangles"].as_u64());
        let start = format!(
            "| {name} | {} | {} | {} | {} | {} |",
            word(&info["kind"]),
            word(&info["vertices"]),
            cells.map_or_else(String::new, |n| n.to_string()),
            word(&info["exit"]),
            says(info)
        );
        let maps = record["maps"].as_array().cloned().unwrap_or_default();
        if maps.is_empty() {
            let _ = writeln!(text, "{start} | | | | | | | | |");
        }
        for map in &maps {
            let _ = writeln!(text, "{start} {}", map_columns(map));
        }
    }
    text
}

fn map_columns(record: &Value) -> String {
    let made = &record["map"];
    let quality = &made["quality"];
    let refinements =
        quality["local_refinements"].as_u64().unwrap_or(0) + quality["barycentric_refinements"].as_u64().unwrap_or(0);
    let number = |value: &Value, digits: usize| value.as_f64().map_or_else(String::new, |x| format!("{x:.digits$}"));
    let peak = made["peak_bytes"].as_f64().map_or_else(String::new, |b| format!("{:.0}", b / 1e6));
    let float = &record["float"]["error"]["max_radius"];
    let exit = match made["error"]["code"].as_str() {
        Some(code) => format!("{} {code}", word(&made["exit"])),
        None => word(&made["exit"]),
    };
    format!(
        "{} | {exit} | {} | {refinements} | {} | {peak} | {} | {} | {} |",
        word(&record["target"]),
        word(&quality["cells"]),
        number(&made["seconds"]["total"], 2),
        word(&record["verify"]["exit"]),
        match record["round_trip"].as_bool() {
            Some(true) => "same",
            Some(false) => "DIFFERS",
            None => "",
        },
        float.as_f64().map_or_else(String::new, |x| format!("{x:.0e}")),
    )
}

fn word(value: &Value) -> String {
    match value {
        Value::Null => String::new(),
        Value::String(text) => text.clone(),
        other => other.to_string(),
    }
}

/// What matters in an answer of `info`, in few words.
fn says(info: &Value) -> String {
    if let Some(code) = info["error"]["code"].as_str() {
        return code.to_owned();
    }
    let mut words = Vec::new();
    for what in ["ball", "disk", "sphere"] {
        if info[what] == true {
            words.push(what.to_owned());
        }
    }
    if info["ball"].is_null() && info["kind"] == "tetrahedra" {
        words.push("perhaps a ball".to_owned());
    }
    let violations = info["violations"].as_array().cloned().unwrap_or_default();
    words.extend(violations.iter().filter(|v| v["severity"] != "info").map(|v| word(&v["code"])));
    words.join(", ")
}

fn summary(records: &[(String, Value)]) -> String {
    let maps: Vec<&Value> = records.iter().flat_map(|(_, r)| r["maps"].as_array().into_iter().flatten()).collect();
    let exits = |code: u64| maps.iter().filter(|m| m["map"]["exit"] == code).count();
    let verified = maps.iter().filter(|m| m["verify"]["exit"] == 0).count();
    let trips = maps.iter().filter(|m| m["round_trip"] == true).count();
    let read = |code: u64| records.iter().filter(|(_, r)| r["info"]["exit"] == code).count();
    format!(
        "{} files: `info` answers {} and refuses {}, anything else {}. {} runs of `map`: {} certified, {} refused (3), {} out of limits (4), \
         {} bugs (1). `verify` holds for {verified}, the exact round trip for {trips}.\n",
        records.len(),
        read(0),
        read(3),
        records.len() - read(0) - read(3),
        maps.len(),
        exits(0),
        exits(3),
        exits(4),
        exits(1)
    )
}
