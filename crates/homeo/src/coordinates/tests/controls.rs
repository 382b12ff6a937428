//! The suite must fail where coordinates are wrong.

use super::suite::misses;
use super::{TOLERANCE, naive, shapes};
use crate::coordinates::{CoordinateError, MeanValue, PlanarCoordinates};

/// Right coordinates with one thing wrong.
struct Wrong {
    right: MeanValue,
    fault: fn(&mut [f64], &mut [[f64; 2]]),
}

impl PlanarCoordinates for Wrong {
    fn vertex_count(&self) -> usize {
        self.right.vertex_count()
    }

    fn values_into(&self, point: [f64; 2], values: &mut [f64]) -> Result<(), CoordinateError> {
        self.right.values_into(point, values)?;
        (self.fault)(values, &mut []);
        Ok(())
    }

    fn gradients_into(
        &self,
        point: [f64; 2],
        values: &mut [f64],
        gradients: &mut [[f64; 2]],
    ) -> Result<(), CoordinateError> {
        self.right.gradients_into(point, values, gradients)?;
        (self.fault)(values, gradients);
        Ok(())
    }
}

#[test]
fn wrong_coordinates_fail_the_suite() {
    let (_, domain) = shapes::convex().remove(2);
    let tried = |fault| misses(&Wrong { right: MeanValue::new(&domain), fault }, &domain, Some(naive::mean_value));
    let right = tried(|_, _| {});
    assert!(right.value < TOLERANCE && right.gradient < TOLERANCE && right.unity < TOLERANCE);
    let scaled = tried(|values, _| values.iter_mut().for_each(|v| *v *= 1.0 + 1e-11));
    assert!(scaled.unity > TOLERANCE && scaled.lagrange > TOLERANCE && scaled.value > TOLERANCE);
    let shifted = tried(|values, _| values.rotate_left(1));
    assert!(shifted.reproduction > TOLERANCE && shifted.lagrange > TOLERANCE && shifted.edge > TOLERANCE);
    let moved = tried(|values, _| (values[0], values[1]) = (values[0] + 1e-11, values[1] - 1e-11));
    assert!(moved.unity < TOLERANCE && moved.reproduction > TOLERANCE && moved.negative > TOLERANCE);
    let steep = tried(|_, gradients| gradients.iter_mut().for_each(|g| g[0] *= 1.0 + 1e-11));
    assert!(steep.gradient > TOLERANCE && steep.gradient_laws > TOLERANCE && steep.value < TOLERANCE);
    let broken = tried(|values, _| values[0] = f64::NAN);
    assert!(broken.unity == f64::INFINITY && broken.value == f64::INFINITY);
}

/// Others than mean value coordinates obey all laws, but not the reference.
#[test]
fn another_kind_fails_the_reference() {
    let (_, domain) = shapes::convex().remove(2);
    let kind = crate::coordinates::Wachspress::new(&domain).unwrap();
    let worst = misses(&kind, &domain, Some(naive::mean_value));
    assert!(worst.unity < TOLERANCE && worst.reproduction < TOLERANCE && worst.edge < TOLERANCE);
    assert!(worst.value > 1e-3 && worst.gradient > 1e-3);
}
