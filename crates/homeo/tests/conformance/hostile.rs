//! Damaged map files: an error, or a map that can be asked. Never a panic, never a leaf without end.

use std::io::{Cursor, Read, Write};
use std::panic::catch_unwind;

use homeo::cage::{CageEvaluator, CageMap};
use homeo::certificate::{FoliationMap, PlanarMap, Provenance, StoredMap, read_map, write_cages};
use homeo::map::{Bijection, Foliation, Target};
use homeo_verify::verify_bytes;
use zip::write::SimpleFileOptions;
use zip::{CompressionMethod, ZipArchive, ZipWriter};

use crate::random::Random;
use crate::shapes::{Shape, balls, disks};
use crate::shells;
use crate::{moved, planar, planar_holes};

fn file<const K: usize>(shape: &Shape<K>, target: Target) -> Vec<u8>
where
    FoliationMap: From<Foliation<K>>,
{
    crate::bytes_of(&crate::built(&shape.mesh(), target).into())
}

/// Small maps of every kind, refined ones among them.
fn files() -> Vec<Vec<u8>> {
    vec![
        file(&disks::fan(5), Target::Square),
        file(&disks::chords(6, 1), Target::Square),
        file(&disks::strip(6), Target::Disk),
        file(&balls::two_tetrahedra(), Target::Ball),
        file(&balls::octahedron(0.0), Target::Ball),
        file(&balls::octahedron_with_axis(), Target::Cube),
        shells::bytes_of(&shells::built(&shells::sphere(0), 0)),
        shells::bytes_of(&shells::built(&shells::singular(), 30)),
        planar::small_file(false),
        planar::small_file(true),
        planar_holes::small_file(),
        planar::small_complex_file(),
        moved::small_files().0,
        moved::small_files().1,
    ]
}

/// Changes a few bytes, most of them where it hurts: whole numbers of all sizes, signs, floating-point exponents.
fn mutate(bytes: &mut Vec<u8>, random: &mut Random) {
    for _ in 0..1 + random.below(3) {
        let at = random.below(bytes.len() as u64) as usize;
        match random.below(9) {
            0 => bytes[at] ^= 1 << random.below(8),
            1 => bytes[at] = random.bits() as u8,
            2 => bytes[at] = [0, 1, 0x7f, 0x80, 0xff][random.below(5) as usize],
            3 => bytes[at] = bytes[at].wrapping_add(1),
            4 => bytes[at] = bytes[at].wrapping_neg(),
            5 => {
                let other = random.below(bytes.len() as u64) as usize;
                bytes.swap(at, other);
            }
            6 => bytes.truncate(at.max(1)),
            7 => bytes[at..].fill([0, 0xff][random.below(2) as usize]),
            _ => {
                let value = (random.bits() as u32 >> random.below(32)).to_le_bytes();
                bytes.iter_mut().skip(at).zip(value).for_each(|(byte, new)| *byte = new);
            }
        }
    }
}

/// Asks a map whatever it is; any answer will do, and errors too.
fn ask(map: &StoredMap) {
    for point in [[0.0; 3], [0.3, 0.2, 0.0], [0.25, 0.25, 0.25], [1.0, 0.0, 0.0], [0.7, 0.1, 0.1]] {
        let exact = crate::points::exact(point);
        match map {
            StoredMap::Foliation(map) => {
                let _ = (map.forward(point), map.inverse(point));
                let _ = (map.forward_exact(&exact), map.inverse_exact(&exact));
            }
            StoredMap::Shell(shell) => {
                let _ = (shell.to_middle(point), shell.to_source(point), shell.is_inside(point));
                let at = shell.project_exact(&exact);
                let _ = at.map(|at| (shell.unproject_exact(&at), shell.to_source_exact(&at)));
            }
            StoredMap::Moved(moved) => {
                let map = moved.as_bijection();
                let _ = (map.forward(point), map.inverse(point));
                let _ = (map.forward_exact(&exact), map.inverse_exact(&exact));
            }
            StoredMap::Cages(map) => {
                let evaluator = CageEvaluator::new(map);
                let _ = (evaluator.forward(point), evaluator.inverse(point), evaluator.jacobian(point));
            }
            StoredMap::Planar(planar) => {
                let ([x, y, _], [u, v, _]) = (point, exact);
                let map = planar.as_bijection();
                let _ = (map.forward([x, y]), map.inverse([x, y]));
                map.inverse_along(&[[x, y], [0.1, 0.1]], &mut [None; 2]);
                map.forward_along(&[[x, y], [0.1, 0.1]], &mut [None; 2]);
                if let PlanarMap::Harmonic(map) = planar {
                    let _ = (map.forward_exact(&[u.clone(), v.clone()]), map.inverse_exact(&[u, v]));
                }
            }
        }
    }
}

/// The entries of an archive, to be changed and packed again with right checksums.
fn unpacked(bytes: &[u8]) -> Vec<(String, Vec<u8>)> {
    let mut archive = ZipArchive::new(Cursor::new(bytes)).expect("a map file");
    (0..archive.len())
        .map(|i| {
            let mut entry = archive.by_index(i).expect("an entry");
            let mut bytes = Vec::new();
            entry.read_to_end(&mut bytes).expect("in memory");
            (entry.name().expect("a name").into_owned(), bytes)
        })
        .collect()
}

fn packed(entries: &[(String, Vec<u8>)]) -> Vec<u8> {
    let mut archive = ZipWriter::new(Cursor::new(Vec::new()));
    let options = SimpleFileOptions::default().compression_method(CompressionMethod::Stored);
    for (name, bytes) in entries {
        archive.start_file(name.as_str(), options).expect("in memory");
        archive.write_all(bytes).expect("in memory");
    }
    archive.finish().expect("in memory").into_inner()
}

/// What a try led to: a map, an error, or (to be reported) a panic.
struct Outcomes {
    readable: usize,
    panics: Vec<String>,
}

fn try_mutations(count: usize, seed: u64, mutation: impl Fn(&[u8], &mut Random) -> Vec<u8>) -> Outcomes {
    let mut random = Random::new(seed);
    let mut outcomes = Outcomes { readable: 0, panics: Vec::new() };
    for (number, original) in files().iter().enumerate() {
        for round in 0..count {
            let bytes = mutation(original, &mut random);
            let answer = catch_unwind(|| {
                // The checker is asked too: whatever it says, it does not panic.
                let _ = verify_bytes(&bytes);
                read_map(&bytes).map(|map| ask(&map)).is_ok()
            });
            match answer {
                Ok(is_readable) => outcomes.readable += usize::from(is_readable),
                Err(_) => outcomes.panics.push(format!("file {number} round {round}")),
            }
        }
    }
    outcomes
}

#[test]
fn damaged_bytes_are_refused_or_harmless() {
    let outcomes = try_mutations(3000, 17, |original, random| {
        let mut bytes = original.to_vec();
        mutate(&mut bytes, random);
        bytes
    });
    assert!(outcomes.panics.is_empty(), "panics: {:?}", outcomes.panics);
}

/// Two steps between tetrahedra that hold the points asked for.
fn cages_file() -> Vec<u8> {
    let stage = |top: f64| vec![[-1.0, -1.0, -1.0], [5.0, -1.0, -1.0], [-1.0, 5.0, -1.0], [-1.0, -1.0, top]];
    let stages = [5.0, 4.0, 6.0].map(stage).to_vec();
    let map = CageMap::from_stages(stages, vec![[0, 2, 1], [0, 1, 3], [0, 3, 2], [1, 2, 3]]).expect("cages");
    let mut file = Cursor::new(Vec::new());
    write_cages(&map, &Provenance::default(), &mut file).expect("in memory");
    file.into_inner()
}

/// The proof of such a map takes long, so the checker is asked of some only.
#[test]
fn damaged_maps_between_cages_are_refused_or_harmless() {
    let (original, mut random, mut readable) = (cages_file(), Random::new(19), 0);
    ask(&read_map(&original).expect("a map"));
    for round in 0..2000 {
        let mut entries = unpacked(&original);
        let at = random.below(entries.len() as u64) as usize;
        mutate(&mut entries[at].1, &mut random);
        let bytes = packed(&entries);
        let answer = catch_unwind(|| {
            let _ = (round % 100 == 0).then(|| verify_bytes(&bytes));
            read_map(&bytes).map(|map| ask(&map)).is_ok()
        });
        readable += usize::from(answer.unwrap_or_else(|_| panic!("round {round} panics")));
    }
    assert!(readable > 200, "only {readable} damaged files could be read: the test tests little");
}

/// Behind the checksums: numbers that do not fit together.
#[test]
fn damaged_entries_are_refused_or_harmless() {
    let outcomes = try_mutations(2000, 18, |original, random| {
        let mut entries = unpacked(original);
        let at = random.below(entries.len() as u64) as usize;
        mutate(&mut entries[at].1, random);
        packed(&entries)
    });
    assert!(outcomes.panics.is_empty(), "panics: {:?}", outcomes.panics);
    assert!(outcomes.readable > 500, "only {} damaged files could be read: the test tests little", outcomes.readable);
}

#[test]
fn missing_and_exchanged_entries_are_refused_or_harmless() {
    let mut count = 0;
    for original in files() {
        let entries = unpacked(&original);
        for i in 0..entries.len() {
            let mut fewer = entries.clone();
            fewer.remove(i);
            let answer = read_map(&packed(&fewer));
            let is_refinement = ["cells.npy", "parents.npy", "carrier_vertices.npy", "carrier_weights.npy"];
            assert!(answer.is_err() || is_refinement.contains(&entries[i].0.as_str()), "no {} needed", entries[i].0);
            for j in 0..i {
                let mut exchanged = entries.clone();
                exchanged[i].1.clone_from(&entries[j].1);
                exchanged[j].1.clone_from(&entries[i].1);
                if let Ok(map) = read_map(&packed(&exchanged)) {
                    ask(&map);
                }
                count += 1;
            }
        }
    }
    assert!(count > 50, "only {count} files were tried");
}

#[test]
fn truncated_files_are_refused() {
    for original in files() {
        for length in (0..original.len()).step_by(7) {
            assert!(read_map(&original[..length]).is_err(), "{length} of {} bytes are taken for a map", original.len());
        }
    }
}
