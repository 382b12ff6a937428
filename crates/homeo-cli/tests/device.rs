//! `homeo warp --device`, which is there with the feature `gpu` alone.
#![cfg(feature = "gpu")]
#![allow(clippy::print_stderr, reason = "what is skipped is told")]

mod common;

use common::Folder;
use image::{ImageBuffer, Luma};

const PIXELS: &str = "--from testdata/polygons/square.json --to testdata/polygons/arrow.json";

/// The samples of a picture as they are seen: colours times opacity.
fn seen(folder: &Folder, name: &str) -> Vec<f64> {
    let picture = image::open(folder.path(name)).unwrap().to_rgba8();
    picture.pixels().flat_map(|p| [0, 1, 2, 3].map(|k| f64::from(p[k]) * f64::from(p[3]) / 255.0)).collect()
}

#[test]
fn pictures_are_those_of_the_processor() {
    let folder = Folder::new().with_testdata();
    let line = format!("warp testdata/images/checker.png {PIXELS} --json");
    let run = folder.line(&format!("{line} --device gpu -o device.png"));
    if run.code == 4 {
        assert_eq!(run.json()["error"]["code"], "no-device");
        assert!(!folder.path("device.png").exists());
        eprintln!("pictures_are_those_of_the_processor is SKIPPED: {}", run.stdout);
        return;
    }
    assert_eq!(run.expect(0).json()["certificate"]["holds"], true);
    folder.line(&format!("{line} --device cpu -o processor.png")).expect(0);
    folder.line(&format!("{line} --filter linear -o other.png")).expect(0);
    let [device, processor, other] = ["device.png", "processor.png", "other.png"].map(|name| seen(&folder, name));
    let worst = |a: &[f64], b: &[f64]| a.iter().zip(b).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max);
    // One unit of the device, and another where origins are rounded to single precision.
    assert_eq!(device.len(), processor.len());
    assert!(worst(&device, &processor) <= 2.0 && worst(&device, &other) > 2.0);
}

#[test]
fn what_a_device_does_not_do_is_refused() {
    let folder = Folder::new().with_testdata();
    let picture: ImageBuffer<Luma<u16>, Vec<u16>> = ImageBuffer::from_pixel(64, 64, Luma([40000]));
    picture.save(folder.path("deep.png")).unwrap();
    let cages = "--from testdata/cages/bar.obj --to testdata/cages/bar_twisted.obj";
    for line in [
        format!("warp deep.png {PIXELS} -o out.png"),
        "warp testdata/points/star.csv --pair testdata/polygons/star_to_circle.json -o out.csv".to_owned(),
        format!("warp testdata/images/checker.png {PIXELS} --map out.homeo"),
        format!("warp testdata/meshes/spot.mesh {cages} -o out.mesh"),
    ] {
        folder.line(&line).expect(0);
        let refused = folder.line(&format!("{line} --device gpu --json")).expect(2).json();
        assert!(refused["error"]["message"].as_str().unwrap().contains("8 bits"), "{refused}");
    }
}
