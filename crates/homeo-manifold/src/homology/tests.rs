use super::*;
use crate::record::{read_record, read_records};
use crate::sample::{Random, random_gluings, relabelled, with_one_gluing_turned};
use crate::signature::from_signature;
use dashu_base::Abs;
use dashu_int::IBig;

const TRIPUS: &str = include_str!("../../../../testdata/hyperbolic/tripus.json");
const CENSUS: &str = include_str!("../../../../testdata/hyperbolic/census.json");

#[test]
fn groups_are_those_of_the_census() {
    let file: serde_json::Value = serde_json::from_str(CENSUS).unwrap();
    let records = read_records(CENSUS).unwrap();
    for (number, record) in records.iter().enumerate() {
        let stated = file["triangulations"][number]["H1"].as_str().unwrap();
        assert_eq!(Homology::new(&record.triangulation).to_string(), stated, "{:?}", record.signature);
    }
    assert_eq!(records.len(), 16);
    assert_eq!(Homology::new(&read_record(TRIPUS).unwrap().triangulation).to_string(), "2 Z");
}

#[test]
fn groups_known_from_elsewhere() {
    for (signature, group) in [("cPcbbbiht", "Z"), ("cPcbbbdxm", "Z + Z_5")] {
        assert_eq!(Homology::new(&from_signature(signature).unwrap()).to_string(), group);
    }
    assert_eq!(Homology::new(&Triangulation::new(3)).to_string(), "0");
}

#[test]
fn labels_make_no_difference() {
    let mut random = Random(11);
    let (mut groups, mut turned) = (std::collections::BTreeSet::new(), 0);
    for round in 0..300 {
        let triangulation = random_gluings(&mut random, 1 + round % 12, round % 4);
        let group = Homology::new(&triangulation);
        assert_eq!(Homology::new(&relabelled(&mut random, &triangulation)), group);
        // The control: another gluing has another group in a good third of the cases.
        turned += usize::from(with_one_gluing_turned(&triangulation).is_some_and(|t| Homology::new(&t) != group));
        groups.insert(group.to_string());
    }
    assert!(groups.len() > 30 && turned > 100, "{} groups, {turned} turned gluings with another", groups.len());
}

/// Greatest common divisors of all minors of each size tell the group: the product of the first `k` orders is that of
/// the minors of size `k`.
fn by_minors(generators: usize, rows: &[Vec<i64>]) -> Homology {
    let mut orders = Vec::new();
    let mut before = UBig::ONE;
    for size in 1..=generators.min(rows.len()) {
        let mut divisor = UBig::ZERO;
        for chosen in subsets(rows.len(), size) {
            for columns in subsets(generators, size) {
                let minor: Vec<Vec<i64>> =
                    chosen.iter().map(|&i| columns.iter().map(|&j| rows[i][j]).collect()).collect();
                let minor = UBig::try_from(determinant(&minor).abs()).unwrap();
                divisor = if divisor == UBig::ZERO { minor } else { divisor.gcd(minor) };
            }
        }
        if divisor == UBig::ZERO {
            break;
        }
        orders.push(&divisor / &before);
        before = divisor;
    }
    let rank = generators - orders.len();
    orders.retain(|order| *order > UBig::ONE);
    Homology { rank, torsion: orders }
}

fn subsets(count: usize, size: usize) -> Vec<Vec<usize>> {
    let has_size = |mask: &u32| mask.count_ones() as usize == size;
    (0..1_u32 << count).filter(has_size).map(|mask| (0..count).filter(|i| mask >> i & 1 == 1).collect()).collect()
}

fn determinant(matrix: &[Vec<i64>]) -> IBig {
    if matrix.is_empty() {
        return IBig::ONE;
    }
    let term = |column: usize| {
        let rest: Vec<Vec<i64>> = matrix[1..].iter().map(|row| [&row[..column], &row[column + 1..]].concat()).collect();
        let value = IBig::from(matrix[0][column]) * determinant(&rest);
        if column.is_multiple_of(2) { value } else { -value }
    };
    (0..matrix.len()).map(term).sum()
}

#[test]
fn orders_are_those_of_minors() {
    let mut random = Random(12);
    let (mut torsion, mut several, mut wrong) = (0, 0, 0);
    for round in 0..400 {
        let (generators, relations) = (1 + random.below(5), 1 + random.below(5));
        // Entries without 1 and -1 leave all the work to the dense part.
        let spread = if round % 2 == 0 { 3 } else { 40 };
        let step = if round % 4 < 2 { 1 } else { 6 };
        let mut entry = || step * (random.below(2 * spread + 1) as i64 - spread as i64);
        let rows: Vec<Vec<i64>> = (0..relations).map(|_| (0..generators).map(|_| entry()).collect()).collect();
        let sparse = |row: &Vec<i64>| row.iter().enumerate().map(|(i, &value)| (i as u32, value)).collect();
        let group = Homology::of_relations(generators, &rows.iter().map(sparse).collect::<Vec<_>>());
        assert_eq!(group, by_minors(generators, &rows), "{rows:?}");
        torsion += usize::from(!group.torsion.is_empty());
        several += usize::from(group.torsion.len() > 1);
        // The control: one entry changed by 1 is seen where the group changes by it, which it mostly does.
        let mut changed = rows.clone();
        changed[0][0] += 1;
        wrong += usize::from(group != by_minors(generators, &changed));
    }
    assert!(torsion > 150 && several > 100 && wrong > 150, "{torsion} {several} {wrong}");
}

#[test]
fn large_coefficients_do_not_overflow() {
    let power = 1_i64 << 62;
    let rows: Vec<Vec<(u32, i64)>> = (0..40).map(|i| vec![(i, power), (i + 1, -1)]).collect();
    let group = Homology::of_relations(41, &rows);
    assert_eq!((group.rank(), group.torsion().len()), (1, 0));
    let mut closed = rows;
    closed.push(vec![(40, 2)]);
    assert_eq!(Homology::of_relations(41, &closed).torsion(), [UBig::from(2_u8) << (62 * 40)]);
}

#[test]
fn sums_are_printed_in_one_form() {
    let cyclic = |orders: &[i64]| {
        let rows: Vec<_> = orders.iter().enumerate().map(|(i, &order)| vec![(i as u32, order)]).collect();
        Homology::of_relations(orders.len(), &rows).to_string()
    };
    assert_eq!(cyclic(&[]), "0");
    assert_eq!(cyclic(&[1, -1]), "0");
    assert_eq!(cyclic(&[0]), "Z");
    assert_eq!(cyclic(&[2, 3]), "Z_6");
    assert_eq!(cyclic(&[4, 0, 2, 0, 2]), "2 Z + 2 Z_2 + Z_4");
    // Z_2 + Z_3 + Z_2 + Z_5 + Z_3 + Z_5.
    assert_eq!(cyclic(&[6, 10, 15]), "2 Z_30");
}

#[test]
fn a_mesh_of_a_hundred_thousand_tetrahedra_has_its_homology() {
    let torus = Triangulation::from_complex(&crate::mesh::tests::torus(26)).unwrap();
    assert_eq!(torus.len(), 105_456);
    assert_eq!(Homology::new(&torus).to_string(), "3 Z");
}

#[test]
fn random_gluings_of_many_tetrahedra_have_a_homology() {
    let triangulation = random_gluings(&mut Random(13), 100_000, 0);
    let group = Homology::new(&triangulation);
    assert_eq!(Homology::new(&relabelled(&mut Random(14), &triangulation)), group);
}

#[test]
fn many_summands_are_taken_one_by_one() {
    let rows: Vec<_> = (0..3_000).map(|i| vec![(2 * i, 2), (2 * i + 1, 4)]).collect();
    assert_eq!(Homology::of_relations(6_000, &rows).to_string(), "3000 Z + 3000 Z_2");
}
