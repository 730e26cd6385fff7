// Smooth noise, read from a table of random numbers that is one of a wind's sheets: the twin of engine/noise.py.

const int PERIOD = 128;

// Four channels in [-1, 1] at a place in lattice units; the table's side is a power of two.
// Shifts must be within one period of the table, as single precision is lost in large ones.
vec4 smooth_noise(Wind wind, int number, vec2 place, int side) {
    vec2 low = floor(place), part = place - low;
    part = smoothstep(0.0, 1.0, part);
    ivec2 corner = ivec2(low) & (side - 1), next = (corner + 1) & (side - 1);
    vec4 far = mix(sheet(wind, number, corner), sheet(wind, number, ivec2(next.x, corner.y)), part.x);
    vec4 near = mix(sheet(wind, number, ivec2(corner.x, next.y)), sheet(wind, number, next), part.x);
    return mix(far, near, part.y);
}

vec4 smooth_noise(Wind wind, int number, vec2 place) {
    return smooth_noise(wind, number, place, PERIOD);
}
