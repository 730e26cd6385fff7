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

// Which way round it does along x and z: -1 in the mirror.
vec2 turned_round(vec2 place) {
    return 1.0 - 2.0 * step(terrain_size, mod(place - terrain_origin, 2.0 * terrain_size));
}

// Where the left half of `lie` has a place.
vec2 on_left(vec2 place) {
    vec2 at = on_map(place, lie_origin), half_texel = 0.5 / vec2(textureSize(lie, 0));
    return vec2(clamp(0.5 * at.x, half_texel.x, 0.5 - half_texel.x), at.y);
}

// What `lie` has of a place that never changes.
vec4 still_at(vec2 place) {
    vec4 still = textureLod(lie, on_left(place), 0.0);
#ifdef MIRRORED
    still.xy *= turned_round(place);
#endif
    return still;
}

// How high what stands before the sun stands there. The mirror image of a place has the sun on another side.
float before_sun(vec2 place) {
    vec4 before = textureLod(lie, on_left(place) + vec2(0.5, 0.0), 0.0);
#ifdef MIRRORED
    vec2 turned = turned_round(place), sides = turned.y > 0.0 ? before.rg : before.ba;
    return turned.x > 0.0 ? sides.x : sides.y;
#else
    return before.r;
#endif
}

Lie lie_at(vec2 place) {
    vec4 still = still_at(place);
    float before = before_sun(place);
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
    vec2 still = still_at(place).xy;
    return -still * inversesqrt(max(1.0 - dot(still, still), FLATTEST_NORMAL));
}

// How steep a line of sight is to the ground: the sine of the angle between them.
float steep_at(vec3 place) {
    vec2 still = still_at(place.xz).xy;
    return dot(normalize(eye - place), vec3(still, sqrt(max(1.0 - dot(still, still), 0.0))).xzy);
}
