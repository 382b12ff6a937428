// Images of points under a composite mean value map, several steps at a time. See `images.rs`, which fills the buffers.

struct Parameters {
    points: u32,
    // Entries of a domain: the vertices of all rings, the first of each ring once more at its end.
    entries: u32,
    // Steps in the buffer.
    steps: u32,
    // 1 if the first of them is the first of the map.
    is_first: u32,
}

struct Entry {
    // The place of the vertex: multiples of 1 / GRID, then remainders.
    place: vec4<f32>,
    // Its displacement; then 1 if an edge ends here, 0 where a ring begins.
    way: vec4<f32>,
}

@group(0) @binding(0) var<uniform> parameters: Parameters;
@group(0) @binding(1) var<storage, read> entries: array<Entry>;
@group(0) @binding(2) var<storage, read_write> places: array<vec4<f32>>;

const GRID: f32 = 4096.0;
// A half tangent above this is left to the processor, as are vertices nearer than this in the frame, and sums of weights
// that are less than this part of the sum of their absolute values.
const MOST_TANGENT: f32 = 4096.0;
const LEAST_DISTANCE: f32 = 0.0001220703125;
const LEAST_BALANCE: f32 = 0.0625;

// In the place of a first coordinate, which is never above 2: what has no place.
const IS_LEFT: f32 = 4.0;
const IS_OUTSIDE: f32 = 8.0;

// The vector to a vertex, and its length.
fn seen(place: vec4<f32>, at: vec4<f32>) -> vec3<f32> {
    let vector = (place.xy - at.xy) + (place.zw - at.zw);
    return vec3<f32>(vector, sqrt(dot(vector, vector)));
}

// At the place and a little further; multiples and remainders are parted again.
fn moved(at: vec4<f32>, way: vec2<f32>) -> vec4<f32> {
    let rest = at.zw + way;
    let grid = floor((at.xy + rest) * GRID + 0.5) / GRID;
    return vec4<f32>(grid, (at.xy - grid) + rest);
}

fn image(step: u32, at: vec4<f32>, is_first: bool) -> vec4<f32> {
    var total = 0.0;
    var size = 0.0;
    var sum = vec2<f32>(0.0);
    var is_good = true;
    var last = vec3<f32>(1.0);
    var last_way = vec2<f32>(0.0);
    let begin = step * parameters.entries;
    for (var k = begin; k < begin + parameters.entries; k++) {
        let way = entries[k].way;
        let next = seen(entries[k].place, at);
        is_good = is_good && next.z > LEAST_DISTANCE;
        if (way.z > 0.5) {
            let cross = last.x * next.y - last.y * next.x;
            let cosine = dot(last.xy, next.xy);
            let lengths = last.z * next.z;
            let safe = lengths + abs(cosine);
            let is_wide = cosine < 0.0;
            is_good = is_good && !(is_wide && safe > MOST_TANGENT * abs(cross));
            let tangent = select(cross, safe, is_wide) / select(safe, cross, is_wide);
            let share = tangent / lengths;
            total += share * (last.z + next.z);
            size += abs(share) * (last.z + next.z);
            sum += share * (next.z * last_way + last.z * way.xy);
        }
        last = next;
        last_way = way.xy;
    }
    if (!is_good || abs(total) < LEAST_BALANCE * size) {
        return vec4<f32>(IS_LEFT);
    }
    if (total < 0.0) {
        return vec4<f32>(select(IS_LEFT, IS_OUTSIDE, is_first));
    }
    return moved(at, sum / total);
}

@compute @workgroup_size(64)
fn main(@builtin(global_invocation_id) id: vec3<u32>) {
    if (id.x >= parameters.points) {
        return;
    }
    var at = places[id.x];
    for (var step = 0u; step < parameters.steps && at.x < IS_LEFT; step++) {
        at = image(step, at, step == 0u && parameters.is_first == 1u);
    }
    places[id.x] = at;
}
