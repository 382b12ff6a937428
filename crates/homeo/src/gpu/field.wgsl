// A picture sampled where a field says. See `field.rs`, which fills the buffers, and `warp/filter.rs`, which does the same.

struct Parameters {
    pixels: u32,
    // Samples in one direction: 2, 4 or 6.
    width: u32,
    // The number of the channel of opacity; 4 if there is none.
    opacity: u32,
    unused: u32,
    // The picture's width and height, and the column and row of the window's first pixel.
    picture: vec2<i32>,
    corner: vec2<i32>,
    // The window's width and height.
    window: vec2<i32>,
    unused_too: vec2<i32>,
}

@group(0) @binding(0) var<uniform> parameters: Parameters;
// Four bytes for a pixel, one for each channel.
@group(0) @binding(1) var<storage, read> samples: array<u32>;
@group(0) @binding(2) var<storage, read> origins: array<vec2<f32>>;
@group(0) @binding(3) var<storage, read_write> results: array<u32>;

const PI: f32 = 3.14159265358979;
// A first coordinate below this: no origin.
const NOWHERE: f32 = -1000.0;

fn pixel(column: i32, row: i32) -> vec4<f32> {
    let inside = clamp(vec2<i32>(column, row), vec2<i32>(0), parameters.picture - 1) - parameters.corner;
    let place = clamp(inside, vec2<i32>(0), parameters.window - 1);
    let word = samples[u32(place.y * parameters.window.x + place.x)];
    return vec4<f32>((vec4<u32>(word) >> vec4<u32>(0u, 8u, 16u, 24u)) & vec4<u32>(255u));
}

// sin(pi x), to single precision; built-in sines may be far off.
fn sine(x: f32) -> f32 {
    let turns = floor(x + 0.5);
    let t = PI * (x - turns);
    let s = t * t;
    let value = t * (1.0 + s * (-1.0 / 6.0 + s * (1.0 / 120.0 + s * (-1.0 / 5040.0 + s * (1.0 / 362880.0
        + s * (-1.0 / 39916800.0))))));
    return select(value, -value, (i32(turns) & 1) == 1);
}

fn lanczos(x: f32) -> f32 {
    if (abs(x) < 0.0001) {
        return 1.0;
    }
    if (abs(x) >= 3.0) {
        return 0.0;
    }
    return 3.0 * sine(x) * sine(x / 3.0) / (PI * PI * x * x);
}

// Weights of the samples round a place that is `t` of the way from one to the next.
fn weights(t: f32) -> array<f32, 6> {
    if (parameters.width == 2u) {
        return array<f32, 6>(1.0 - t, t, 0.0, 0.0, 0.0, 0.0);
    }
    if (parameters.width == 4u) {
        let t2 = t * t;
        let t3 = t2 * t;
        return array<f32, 6>(
            -0.5 * t3 + t2 - 0.5 * t,
            1.5 * t3 - 2.5 * t2 + 1.0,
            -1.5 * t3 + 2.0 * t2 + 0.5 * t,
            0.5 * (t3 - t2),
            0.0,
            0.0,
        );
    }
    var found = array<f32, 6>();
    var sum = 0.0;
    for (var k = 0; k < 6; k++) {
        found[k] = lanczos(t + 2.0 - f32(k));
        sum += found[k];
    }
    for (var k = 0; k < 6; k++) {
        found[k] /= sum;
    }
    return found;
}

fn sampled(origin: vec2<f32>) -> u32 {
    let place = origin - 0.5;
    let low = floor(place);
    var across = weights(place.x - low.x);
    var down = weights(place.y - low.y);
    let width = i32(parameters.width);
    let first = vec2<i32>(low) - (width / 2 - 1);
    var sum = vec4<f32>(0.0);
    for (var j = 0; j < width; j++) {
        for (var i = 0; i < width; i++) {
            var found = pixel(first.x + i, first.y + j);
            if (parameters.opacity < 4u) {
                let opacity = found[parameters.opacity];
                found *= opacity;
                found[parameters.opacity] = opacity;
            }
            sum += across[i] * down[j] * found;
        }
    }
    if (parameters.opacity < 4u) {
        let opacity = sum[parameters.opacity];
        sum = select(vec4<f32>(0.0), sum / opacity, opacity > 0.0);
        sum[parameters.opacity] = opacity;
    }
    let bytes = vec4<u32>(floor(clamp(sum, vec4<f32>(0.0), vec4<f32>(255.0)) + 0.5));
    return bytes.x | (bytes.y << 8u) | (bytes.z << 16u) | (bytes.w << 24u);
}

@compute @workgroup_size(64)
fn main(@builtin(global_invocation_id) id: vec3<u32>) {
    if (id.x >= parameters.pixels) {
        return;
    }
    let origin = origins[id.x];
    var result = 0u;
    if (origin.x > NOWHERE) {
        result = sampled(origin);
    }
    results[id.x] = result;
}
