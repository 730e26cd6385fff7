// The footprint of a pixel on the ground.
#include "lib/least.glsl"

const float STRETCH = 5.0;  // greatest ratio of its length to its width that counts

// Its width, as a fraction of its length. At a low angle it is a long stripe of ground, but sharper images look more like grass.
float narrowed(vec2 dx, vec2 dy) {
    float one = dot(dx, dx), other = dot(dy, dy), longer = max(one, other);
    return sqrt(max(min(one, other) / max(longer, LEAST_SQUARE), 1.0 / (STRETCH * STRETCH)));
}
