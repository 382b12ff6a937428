//! Container rules: everything that is not exactly a map file of version 1 is unreadable, with a reason.

mod support;

use homeo_verify::{Verdict, verify_bytes, verify_file};
use serde_json::json;
use support::build::all_maps;
use support::{Map, write};

fn square() -> Map {
    all_maps().swap_remove(1).1
}

#[track_caller]
fn assert_unreadable(bytes: &[u8], words: &str) {
    match verify_bytes(bytes) {
        Err(error) => assert!(error.message.contains(words), "{error}"),
        Ok(verdict) => panic!("readable: {verdict:?}"),
    }
}

/// The file with one entry replaced by what `change` makes of it.
fn with_entry(name: &str, change: impl Fn(&[u8]) -> Vec<u8>) -> Vec<u8> {
    let mut entries = write::entries(&square());
    let entry = entries.iter_mut().find(|entry| entry.0 == name).expect("an entry");
    entry.1 = change(&entry.1);
    write::zip(&entries)
}

fn replace(bytes: &[u8], from: &[u8], to: &[u8]) -> Vec<u8> {
    let at = bytes.windows(from.len()).position(|window| window == from).expect("text to replace");
    [&bytes[..at], to, &bytes[at + from.len()..]].concat()
}

#[test]
fn truncated_files() {
    let bytes = square().bytes();
    for length in 0..bytes.len() {
        assert!(verify_bytes(&bytes[..length]).is_err(), "{length} bytes");
    }
    assert!(verify_file("no/such/file.homeo".as_ref()).is_err());
}

#[test]
fn archives() {
    let bytes = square().bytes();
    assert_unreadable(&[&bytes[..], b"x"].concat(), "end record");
    assert_unreadable(&[b"x", &bytes[..]].concat(), "directory is not where");
    let directory = bytes.windows(4).position(|window| window == b"PK\x01\x02").expect("a directory");
    let patch = |at: usize, value: &[u8]| {
        let mut patched = bytes.clone();
        patched[at..at + value.len()].copy_from_slice(value);
        patched
    };
    assert_unreadable(&patch(directory + 10, &[8]), "compressed"); // deflate
    assert_unreadable(&patch(directory + 8, &[1]), "compressed"); // encrypted
    assert_unreadable(&patch(directory + 24, &[0xff; 4]), "compressed"); // sizes differ: a bomb's directory
    assert_unreadable(&patch(8, &[8]), "differs");
    assert_unreadable(&patch(14, &[0; 4]), "differs");
    assert_unreadable(&patch(60, b"?"), "damaged");
    assert_unreadable(&patch(bytes.len() - 14, &[2]), "split");
    let mut entries = write::entries(&square());
    entries.push(entries[1].clone());
    assert_unreadable(&write::zip(&entries), "two entries");
    let second = bytes[4..].windows(4).position(|window| window == b"PK\x03\x04").expect("an entry") + 4;
    let line = directory + 46 + "manifest.json".len();
    assert_eq!(bytes[line + 42..line + 46], (second as u32).to_le_bytes());
    let overlapping = patch(line + 42, &(second as u32 + 1).to_le_bytes());
    assert!(verify_bytes(&overlapping).is_err());
}

#[test]
fn entries_that_overlap_or_hide() {
    // Two directory lines for one local entry.
    let entries = write::entries(&square());
    let once = write::zip(&entries[..1]);
    let directory = once.windows(4).position(|window| window == b"PK\x01\x02").expect("a directory");
    let (line, end) = (&once[directory..once.len() - 22], once.len() - 22);
    let mut twice = [&once[..end], line, &once[end..]].concat();
    let at = twice.len() - 22;
    twice[at + 8..at + 12].copy_from_slice(&[2, 0, 2, 0]);
    twice[at + 12..at + 16].copy_from_slice(&(2 * line.len() as u32).to_le_bytes());
    assert_unreadable(&twice, "overlaps");
    // Bytes between the entries and the directory.
    let mut hiding = [&once[..directory], b"hidden", &once[directory..]].concat();
    let at = hiding.len() - 22;
    hiding[at + 16..at + 20].copy_from_slice(&(directory as u32 + 6).to_le_bytes());
    assert_unreadable(&hiding, "between");
}

#[test]
fn entries_in_another_order_than_the_directory() {
    let entries = write::entries(&square());
    let bytes = write::zip(&entries[..2]);
    let line =
        |from: usize| bytes[from..].windows(4).position(|window| window == b"PK\x01\x02").expect("a line") + from;
    let (first, end) = (line(0), bytes.len() - 22);
    let second = line(first + 4);
    let turned = [&bytes[..first], &bytes[second..end], &bytes[first..second], &bytes[end..]].concat();
    assert_unreadable(&turned, "overlaps another one or leaves a gap");
}

/// NumPy writes `0xffff_ffff` as sizes into the local headers, and the sizes into an extra field.
#[test]
fn sizes_in_an_extra_field() {
    let entries = write::entries(&square());
    let with_extra = |stated: u64| {
        let mut bytes = write::zip(&entries);
        let directory = bytes.windows(4).position(|window| window == b"PK\x01\x02").expect("a directory");
        // The last entry: the offsets of the others stay.
        let at = bytes[..directory].windows(4).rposition(|window| window == b"PK\x03\x04").expect("an entry");
        let extra = [&[1, 0, 16, 0], &stated.to_le_bytes()[..], &stated.to_le_bytes()].concat();
        bytes[at + 18..at + 26].fill(0xff);
        bytes[at + 28] = extra.len() as u8;
        let behind_name = at + 30 + entries.last().expect("an entry").0.len();
        bytes.splice(behind_name..behind_name, extra);
        let end = bytes.len() - 22;
        bytes[end + 16..end + 20].copy_from_slice(&(directory as u32 + 20).to_le_bytes());
        bytes
    };
    let size = entries.last().expect("an entry").1.len() as u64;
    assert!(matches!(verify_bytes(&with_extra(size)), Ok(Verdict::Certified(_))));
    assert_unreadable(&with_extra(size + 1), "differs");
}

#[test]
fn entries_of_another_kind_of_map() {
    let mut entries = write::entries(&square());
    entries.push(("note_anything".into(), vec![]));
    assert!(matches!(verify_bytes(&write::zip(&entries)), Ok(Verdict::Certified(_))));
    for name in ["extra.npy", "target_positions.npy", "parents.npy", "directions", "manifest.json.npy"] {
        let mut entries = write::entries(&square());
        entries.push((name.into(), vec![]));
        assert_unreadable(&write::zip(&entries), "does not belong");
    }
    for i in 0..write::entries(&square()).len() {
        let mut entries = write::entries(&square());
        entries.remove(i);
        assert!(verify_bytes(&write::zip(&entries)).is_err());
    }
}

#[test]
fn arrays() {
    let header = |from: &'static str, to: &'static str| {
        with_entry("directions.npy", |bytes| replace(bytes, from.as_bytes(), to.as_bytes()))
    };
    assert_unreadable(&header("'fortran_order': False", "'fortran_order': True "), "C order");
    assert_unreadable(&header("|i1", "|u1"), "header");
    assert_unreadable(&header("|i1", "|O1"), "header");
    assert_unreadable(&header("(18, 3)", "(3, 18)"), "shape");
    assert_unreadable(&header("(18, 3)", "(1854,)"), "shape");
    assert_unreadable(&header("(18, 3)", "(18 ,3)"), "header");
    assert_unreadable(&header("(18, 3)", "(+8, 3)"), "header");
    assert_unreadable(&header("NUMPY\x01", "NUMPY\x03"), "header");
    assert_unreadable(&header("'descr'", "'desct'"), "header");
    assert_unreadable(&with_entry("directions.npy", |bytes| [bytes, &[0]].concat()), "number of bytes");
    let swapped = with_entry("source_positions.npy", |bytes| replace(bytes, b"<f8", b">f8"));
    assert_unreadable(&swapped, "header");
    let huge = with_entry("source_positions.npy", |bytes| {
        let content = write::npy("<f8", "(18446744073709551615, 3)", &[]);
        assert!(bytes.len() > content.len());
        content
    });
    assert_unreadable(&huge, "header");
    let second_version = with_entry("directions.npy", |bytes| {
        let length = u32::from(u16::from_le_bytes([bytes[8], bytes[9]]));
        [b"\x93NUMPY\x02\x00", &length.to_le_bytes()[..], &bytes[10..]].concat()
    });
    assert!(matches!(verify_bytes(&second_version), Ok(Verdict::Certified(_))));
}

#[test]
fn manifests() {
    let edit = |words: &str, change: fn(&mut serde_json::Value)| {
        let mut map = square();
        change(&mut map.manifest);
        assert_unreadable(&map.bytes(), words);
    };
    edit("version 1 only", |m| m["version"] = json!(2));
    edit("version", |m| m["version"] = json!(1.0));
    edit("format", |m| m["format"] = json!("homeomorphism"));
    edit("unknown variant", |m| m["kind"] = json!("harmonic"));
    edit("unknown variant", |m| m["target"] = json!("torus"));
    edit("disagree", |m| m["dimension"] = json!(3));
    edit("centre", |m| m["centre"] = json!({"cell": 0, "length": 1}));
    edit("centre", |m| drop(m.as_object_mut().expect("an object").remove("centre")));
    edit("unknown field", |m| m["extra"] = json!(1));
    edit("unknown field", |m| m["source"]["extra"] = json!(1));
    edit("not a text", |m| m["kind"] = json!({"foliation": null}));
    edit("not a text", |m| m["target"] = json!({"square": null}));
    edit("not an object", |m| {
        let s = &m["source"];
        m["source"] = json!([s["vertices"], s["cells"], s["content_sha256"], s["name"]]);
    });
    edit("number of vertices", |m| m["source"]["vertices"] = json!(15));
    edit("do not have the stated", |m| m["source"]["content_sha256"] = json!("A".repeat(64)));
    edit("do not have the stated", |m| m["source"]["content_sha256"] = json!("a".repeat(64)));
    let repeated = with_entry("manifest.json", |text| replace(text, b"\"version\": 1", b"\"version\":2,\"version\":1"));
    assert_unreadable(&repeated, "repeats");
    let inside =
        with_entry("manifest.json", |text| replace(text, b"\"options\": {}", b"\"options\": {\"a\":1,\"a\":1}"));
    assert_unreadable(&inside, "repeats");
    let padded = with_entry("manifest.json", |text| [text, &vec![b' '; 1 << 20]].concat());
    assert_unreadable(&padded, "1 MiB");
    assert_unreadable(&with_entry("manifest.json", |_| vec![b'['; 200_000]), "not JSON");
    assert_unreadable(&with_entry("manifest.json", |_| b"\xff".to_vec()), "not JSON");
    let (_, mut disk) = all_maps().swap_remove(6);
    disk.manifest["centre"] = json!([disk.manifest["centre"]["cell"], 1]);
    assert_unreadable(&disk.bytes(), "not an object");
    for length in [0u64, 1 << 32] {
        let (_, mut disk) = all_maps().swap_remove(6);
        disk.manifest["centre"]["length"] = json!(length);
        assert_unreadable(&disk.bytes(), "nonzero u32");
    }
}
