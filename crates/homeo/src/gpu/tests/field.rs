//! Sampling of pictures.

use super::{Numbers, gpu, gpu_with};
use crate::gpu::{Gpu, GpuError};
use crate::warp::{Filter, Raster, apply_field};

const FILTERS: [Filter; 3] = [Filter::Linear, Filter::Bicubic, Filter::Lanczos];
const WIDTH: usize = 73;
const HEIGHT: usize = 59;

/// A picture of noise; a quarter of it is transparent if it can be.
fn picture(channels: usize, has_alpha: bool) -> Raster<u8> {
    let mut random = Numbers(channels as u64);
    let mut picture = Raster::zero(91, 67, channels, has_alpha);
    picture.samples.iter_mut().for_each(|sample| *sample = (256.0 * random.next()) as u8);
    if has_alpha {
        let pixels = picture.samples.chunks_exact_mut(channels).filter(|pixel| pixel[0] < 64);
        pixels.for_each(|pixel| pixel[channels - 1] = 0);
    }
    picture
}

/// A field that turns the picture, beyond its edges too, with origins at random and from nowhere among them.
fn field() -> Vec<[f32; 2]> {
    let mut random = Numbers(3);
    let pixel = |k: usize| {
        let (x, y) = ((k % WIDTH) as f64, (k / WIDTH) as f64);
        let origin = match k % 11 {
            0 => [f64::NAN, y],
            1 => [x, f64::NAN],
            2 => [200.0 * random.next() - 50.0, 200.0 * random.next() - 50.0],
            3 => [x.floor(), y.floor() + 0.5],
            4 => [-1e9, 1e9 * random.next()],
            _ => [1.3 * x - 0.4 * y + 7.0, 0.4 * x + 1.3 * y - 9.0],
        };
        origin.map(|x| x as f32)
    };
    (0..WIDTH * HEIGHT).map(pixel).collect()
}

/// Samples compared and the largest difference, colours that cannot be seen left out; and samples that differ.
fn compared(found: &Raster<u8>, expected: &Raster<u8>) -> (usize, u8, usize) {
    assert_eq!((found.width, found.height, found.channels), (expected.width, expected.height, expected.channels));
    let (channels, has_alpha) = (found.channels, found.has_alpha);
    let pixels = found.samples.chunks_exact(channels).zip(expected.samples.chunks_exact(channels));
    let seen = pixels.flat_map(|(found, expected)| {
        let is_seen = !has_alpha || found[channels - 1] > 0 && expected[channels - 1] > 0;
        found.iter().zip(expected).enumerate().filter(move |(k, _)| is_seen || k + 1 == channels).map(|(_, pair)| pair)
    });
    seen.fold((0, 0, 0), |(count, most, others), (found, expected)| {
        let difference = found.abs_diff(*expected);
        (count + 1, most.max(difference), others + usize::from(difference > 0))
    })
}

fn difference(gpu: &Gpu, picture: &Raster<u8>, filter: Filter) -> (usize, u8, usize) {
    let field = field();
    let found = gpu.apply_field(picture, &field, WIDTH, filter).unwrap();
    compared(&found, &apply_field(picture, &field, WIDTH, filter))
}

fn pictures() -> impl Iterator<Item = Raster<u8>> {
    [(1, false), (2, true), (3, false), (4, true), (4, false)].into_iter().map(|(c, has_alpha)| picture(c, has_alpha))
}

#[test]
fn samples_differ_by_no_more_than_one() {
    let Some(gpu) = gpu("samples_differ_by_no_more_than_one") else { return };
    for picture in pictures() {
        for filter in FILTERS {
            let (count, most, others) = difference(&gpu, &picture, filter);
            eprintln!("{} channels, {filter:?}: {others} of {count} samples differ, by {most}", picture.channels);
            assert!(most <= 1, "{filter:?}: {most}");
            assert!(
                count > WIDTH * HEIGHT * picture.channels / 2 && others * 100 < count,
                "{filter:?}: {others} of {count}"
            );
        }
    }
}

#[test]
fn wrong_filters_are_seen() {
    let wrong = [
        (Filter::Linear, ["1.0 - t, t, 0.0", "1.0 - t * t, t * t, 0.0"]),
        (Filter::Bicubic, ["- 2.5 * t2", "- 2.4 * t2"]),
        (Filter::Lanczos, ["abs(x) >= 3.0", "abs(x) >= 2.0"]),
    ];
    for (filter, exchange) in wrong {
        let Some(gpu) = gpu_with("wrong_filters_are_seen", exchange) else { return };
        for picture in pictures() {
            let (_, most, _) = difference(&gpu, &picture, filter);
            assert!(most > 1, "{filter:?}, {} channels: {most}", picture.channels);
        }
    }
}

#[test]
fn tiles_make_no_difference() {
    let Some(mut gpu) = gpu("tiles_make_no_difference") else { return };
    for picture in pictures() {
        let at_once = FILTERS.map(|filter| gpu.apply_field(&picture, &field(), WIDTH, filter).unwrap());
        // Windows of up to 32 x 32 pixels: the field jumps, so that tiles are single pixels in the end.
        let most = std::mem::replace(&mut gpu.most_bytes, 4096);
        for (filter, expected) in FILTERS.into_iter().zip(at_once).skip(picture.channels % 3).take(1) {
            assert_eq!(gpu.apply_field(&picture, &field(), WIDTH, filter).unwrap(), expected, "{filter:?}");
        }
        gpu.most_bytes = most;
    }
}

#[test]
fn what_is_no_picture_is_refused() {
    let Some(gpu) = gpu("what_is_no_picture_is_refused") else { return };
    let broken =
        |width, channels, samples| Raster { width, height: 2, channels, has_alpha: false, samples: vec![0; samples] };
    for picture in [broken(3, 1, 5), broken(0, 1, 0), broken(2, 0, 0), broken(2, 5, 20), broken(usize::MAX, 2, 4)] {
        let error = gpu.apply_field(&picture, &[[0.5; 2]], 1, Filter::Linear).unwrap_err();
        assert!(matches!(error, GpuError::Picture { .. }), "{picture:?}: {error}");
    }
    let picture = broken(3, 1, 6);
    let nothing = gpu.apply_field(&picture, &[], 0, Filter::Linear).unwrap();
    assert_eq!((nothing.width, nothing.height), (0, 0));
    let from_nowhere = [[f32::INFINITY, 0.0], [0.0, f32::NAN]];
    assert_eq!(gpu.apply_field(&picture, &from_nowhere, 2, Filter::Bicubic).unwrap().samples, [0, 0]);
}
