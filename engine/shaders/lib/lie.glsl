// How the terrain lies at a place: its normal, how the sun stands over it, and two slow noises.
#include "lib/frame.glsl"

uniform sampler2D lie;  // over the terrain, side by side: its normal (x, z) and two slow noises; how high what stands before the sun

const float PENUMBRA = 0.02;  // half the width of a shadow's edge, of the distance from what casts it; the sun's alone is 0.005
const float LOWEST_SUN = 0.01;  // sine of the sun's elevation that counts at least

const float FLATTEST_NORMAL = 0.01;  // squared cosine of a slope that counts at least

struct Lie {
    float high;  // sine of the sun's elevation over the slope
    float past;  // how much of the sun's disc is seen past the terrain
    vec2 slow;   // two slow noises, -1 to 1
    vec3 normal; // the slope's
};

// What lies over the terrain at a place, as `lie` has it; beyond the edge that goes on as in a mirror.
vec2 on_map(vec2 place, vec2 origin) {
    return 1.0 - abs(1.0 - mod((place - origin) / terrain_size, 2.0));
}

vec2 on_map(vec2 place) {
    return on_map(place, terrain_origin);
}

// Where the left half of `lie` has a place.
vec2 on_left(vec2 place) {
    vec2 at = on_map(place, lie_origin), half_texel = 0.5 / vec2(textureSize(lie, 0));
    return vec2(clamp(0.5 * at.x, half_texel.x, 0.5 - half_texel.x), at.y);
}

Lie lie_at(vec2 place) {
    vec2 at = on_left(place);
    vec4 still = textureLod(lie, at, 0.0);
    float before = textureLod(lie, vec2(at.x + 0.5, at.y), 0.0).r;
    float up = sqrt(max(1.0 - dot(still.xy, still.xy), 0.0)), high = dot(sun.xz, still.xy) + sun.y * up;
    float rise = max(sun.y, LOWEST_SUN) / max(length(sun.xz), LEAST_WIDTH);
    return Lie(max(high, 0.0), smoothstep(-PENUMBRA, PENUMBRA, rise - before), still.zw, vec3(still.x, up, still.y));
}

// The slow noises alone.
vec2 slow_at(vec2 place) {
    return textureLod(lie, on_left(place), 0.0).zw;
}

// How the ground rises along x and z.
vec2 rise_at(vec2 place) {
    vec2 still = textureLod(lie, on_left(place), 0.0).xy;
    return -still * inversesqrt(max(1.0 - dot(still, still), FLATTEST_NORMAL));
}

// How steep a line of sight is to the ground: the sine of the angle between them.
float steep_at(vec3 place) {
    vec2 still = textureLod(lie, on_left(place.xz), 0.0).xy;
    return dot(normalize(eye - place), vec3(still, sqrt(max(1.0 - dot(still, still), 0.0))).xzy);
}
