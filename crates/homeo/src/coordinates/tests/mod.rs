//! One suite of laws for every kind, with controls that must fail.

mod double;
mod naive;
mod shapes;
mod suite;

use homeo_core::planar::PlanarDomain;

use super::*;
use naive::Reference;
use suite::{Misses, misses};

/// What all kinds reach, relative.
const TOLERANCE: f64 = 1e-12;

fn assert_laws(name: &str, worst: &Misses) {
    let Misses { unity, reproduction, lagrange, edge, gradient_laws, value, gradient, .. } = *worst;
    for (law, miss) in [
        ("unity", unity),
        ("reproduction", reproduction),
        ("lagrange", lagrange),
        ("edge", edge),
        ("gradient laws", gradient_laws),
        ("value", value),
        ("gradient", gradient),
    ] {
        assert!(miss <= TOLERANCE, "{name}: {law} missed by {miss:e}: {worst:?}");
    }
}

fn try_on(
    name: &str,
    shape: &str,
    kind: &dyn PlanarCoordinates,
    domain: &PlanarDomain,
    reference: Option<Reference>,
) -> Misses {
    let worst = misses(kind, domain, reference);
    if std::env::var("COORDINATES_REPORT").is_ok() {
        #[allow(clippy::print_stderr)]
        {
            eprintln!("{name:12} {shape:18} {worst:?}");
        }
    }
    assert_laws(&format!("{name} of {shape}"), &worst);
    worst
}

#[test]
fn mean_value_obeys_the_laws_on_every_domain() {
    for (shape, domain) in shapes::convex().into_iter().chain(shapes::general()) {
        let kind = MeanValue::new(&domain);
        try_on("mean value", shape, &kind, &domain, Some(naive::mean_value));
    }
}

#[test]
fn three_point_family_obeys_the_laws_on_convex_polygons() {
    for (shape, domain) in shapes::convex() {
        let family = |p: f64| ThreePoint::new(&domain, p).unwrap();
        let kinds: [(&str, Box<dyn PlanarCoordinates>, Reference); 6] = [
            ("Wachspress", Box::new(Wachspress::new(&domain).unwrap()), naive::wachspress),
            ("harmonic", Box::new(DiscreteHarmonic::new(&domain).unwrap()), naive::discrete_harmonic),
            ("p = 1", Box::new(family(1.0)), naive::mean_value),
            ("p = 1/2", Box::new(family(0.5)), naive::half),
            ("p = -1", Box::new(family(-1.0)), naive::minus_one),
            ("p = 2", Box::new(family(2.0)), naive::discrete_harmonic),
        ];
        for (name, kind, reference) in kinds {
            try_on(name, shape, &*kind, &domain, Some(reference));
        }
    }
}
