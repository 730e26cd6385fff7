// The footprint of a pixel on the ground.
#include "lib/least.glsl"

const float STRETCH = 5.0;  // how many times longer than wide it counts as at most

// How wide it is, of its length. From a low angle a pixel is a long stripe of ground: a sharper image is nearer to how grass
// looks there.
float narrowed(vec2 dx, vec2 dy) {
    float one = dot(dx, dx), other = dot(dy, dy), longer = max(one, other);
    return sqrt(max(min(one, other) / max(longer, LEAST_SQUARE), 1.0 / (STRETCH * STRETCH)));
}
