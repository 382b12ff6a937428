//! `homeo verify` and `homeo report`: claims that hold, and claims that do not.

mod common;

use common::{Folder, cubes};

/// CRC-32 as zip archives use it.
fn crc32(bytes: &[u8]) -> u32 {
    !bytes.iter().fold(!0u32, |crc, &byte| {
        (0..8).fold(crc ^ u32::from(byte), |c, _| if c & 1 == 1 { c >> 1 ^ 0xedb8_8320 } else { c >> 1 })
    })
}

fn number(bytes: &[u8], at: usize, width: usize) -> usize {
    (0..width).map(|i| usize::from(bytes[at + i]) << (8 * i)).sum()
}

/// Changes an entry of a map file and makes its checksums right again.
fn tampered(archive: &[u8], name: &str, change: impl Fn(&mut [u8])) -> Vec<u8> {
    let mut bytes = archive.to_vec();
    let find = |bytes: &[u8], signature: &[u8], offset: usize| {
        (0..bytes.len())
            .find(|&at| bytes[at..].starts_with(signature) && bytes[at + offset..].starts_with(name.as_bytes()))
            .unwrap()
    };
    let local = find(&bytes, b"PK\x03\x04", 30);
    let central = find(&bytes, b"PK\x01\x02", 46);
    let size = number(&bytes, central + 24, 4);
    let start = local + 30 + number(&bytes, local + 26, 2) + number(&bytes, local + 28, 2);
    change(&mut bytes[start..start + size]);
    let crc = crc32(&bytes[start..start + size]).to_le_bytes();
    bytes[local + 14..local + 18].copy_from_slice(&crc);
    bytes[central + 16..central + 20].copy_from_slice(&crc);
    bytes
}

fn mapped() -> Folder {
    let folder = Folder::new();
    folder.write("two.mesh", cubes(&[[0, 0, 0], [1, 0, 0]]));
    folder.line("map two.mesh --onto cube -o m.homeo -q").expect(0);
    folder
}

#[test]
fn a_map_is_about_its_mesh_and_no_other() {
    let folder = mapped();
    let report = folder.line("verify m.homeo --source two.mesh --json -q").expect(0).json();
    assert_eq!((&report["certificate"]["holds"], &report["source"]["same"]), (&true.into(), &true.into()));
    assert_eq!(report["input"]["tetrahedra"], 12);
    let run = folder.line("verify m.homeo -q").expect(0);
    assert!(run.stdout.starts_with("certified: ") && run.stdout.contains("limits"));
    folder.write("other.mesh", cubes(&[[0, 0, 0], [0, 1, 0]]));
    let report = folder.line("verify m.homeo --source other.mesh --json -q").expect(3).json();
    assert_eq!((&report["error"]["code"], &report["source"]["same"]), (&"other-source".into(), &false.into()));
}

#[test]
fn a_false_claim_is_refuted_with_a_witness() {
    let folder = mapped();
    // The last direction: one entry more, so that it does not add up to zero.
    let broken = tampered(&folder.read("m.homeo"), "directions.npy", |data| *data.last_mut().unwrap() ^= 1);
    folder.write("broken.homeo", broken);
    let report = folder.line("verify broken.homeo --json -q").expect(5).json();
    assert_eq!((&report["ok"], &report["certificate"]["holds"]), (&false.into(), &false.into()));
    assert!(report["witness"]["rule"].is_string() && report["witness"]["cells"].is_array());
    let run = folder.line("verify broken.homeo").expect(5);
    assert!(run.stderr.contains("rule"), "{}", run.stderr);
    folder.write("p.csv", "x,y,z\n0.5,0.5,0.5\n");
    folder.line("eval broken.homeo --points p.csv -q").expect(5);
    folder.line("report broken.homeo -o b.html -q").expect(5);
    assert!(!folder.names().contains(&"b.html".to_owned()));
}

#[test]
fn what_is_no_map_is_unreadable() {
    let folder = mapped();
    let bytes = folder.read("m.homeo");
    folder.write("cut.homeo", &bytes[..bytes.len() / 2]).write("empty.homeo", b"");
    let version = tampered(&bytes, "manifest.json", |data| {
        let at = data.windows(12).position(|w| w == b"\"version\": 1").unwrap();
        data[at + 11] = b'2';
    });
    folder.write("version.homeo", version);
    for name in ["cut.homeo", "empty.homeo", "version.homeo", "two.mesh", "nowhere.homeo"] {
        let run = folder.homeo(&["verify", name, "--json"]).expect(3);
        assert!(run.json()["error"]["message"].as_str().unwrap().contains(name));
    }
}

#[test]
fn a_report_is_one_page() {
    let folder = mapped();
    let report = folder.line("report m.homeo -o m.html --json -q").expect(0).json();
    assert_eq!(report["output"], "m.html");
    let page = folder.text("m.html");
    assert!(page.starts_with("<!doctype html>") && page.contains("proved"));
    folder.line("report m.homeo -q").expect(2);
}
