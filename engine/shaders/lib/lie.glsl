// The lie of the land at a place: its normal, the sun over it, and two slow noises.
#include "lib/frame.glsl"

uniform sampler2D lie;  // over the terrain, two maps side by side: normal (x, z) and two slow noises; the horizon map

const float PENUMBRA = 0.02;  // half the width of a shadow's edge, for each metre from what casts it; the sun's disc alone gives 0.005
const float LOWEST_SUN = 0.01;  // least sine of the sun's elevation
const float FLATTEST_NORMAL = 0.01;  // least squared cosine of a slope

struct Lie {
    float sun_sine;    // of the sun's elevation over the slope
    float visibility;  // of the sun's disc behind the terrain
    vec2 slow;         // two slow noises, -1 to 1
    vec3 normal;
};

// Coordinates of a place on a map over the terrain that begins at `origin`, 0 to 1; mirrored beyond its edges.
vec2 on_terrain_map(vec2 place, vec2 origin) {
    return 1.0 - abs(1.0 - mod((place - origin) / terrain_size, 2.0));
}

vec2 on_terrain_map(vec2 place) {
    return on_terrain_map(place, terrain_origin);
}

// Sign of x and z there: -1 where the map is mirrored.
vec2 mirror_sign(vec2 place) {
    return 1.0 - 2.0 * step(terrain_size, mod(place - terrain_origin, 2.0 * terrain_size));
}

// Texture coordinates of a place on the left half of `lie`.
vec2 lie_uv(vec2 place) {
    vec2 at = on_terrain_map(place, lie_origin), half_texel = 0.5 / vec2(textureSize(lie, 0));
    return vec2(clamp(0.5 * at.x, half_texel.x, 0.5 - half_texel.x), at.y);
}

// Normal (x, z) and slow noises of a place.
vec4 lie_texel(vec2 place) {
    vec4 texel = textureLod(lie, lie_uv(place), 0.0);
#ifdef MIRRORED
    texel.xy *= mirror_sign(place);
#endif
    return texel;
}

// The horizon map: tangent of the elevation of what stands before the sun. A mirrored place has the sun on another side.
float horizon_at(vec2 place) {
    vec4 horizons = textureLod(lie, lie_uv(place) + vec2(0.5, 0.0), 0.0);
#ifdef MIRRORED
    vec2 mirrored = mirror_sign(place), sides = mirrored.y > 0.0 ? horizons.rg : horizons.ba;
    return mirrored.x > 0.0 ? sides.x : sides.y;
#else
    return horizons.r;
#endif
}

Lie lie_at(vec2 place) {
    vec4 texel = lie_texel(place);
    float up = sqrt(max(1.0 - dot(texel.xy, texel.xy), 0.0)), sun_sine = dot(sun.xz, texel.xy) + sun.y * up;
    float sun_tangent = max(sun.y, LOWEST_SUN) / max(length(sun.xz), LEAST_WIDTH);
    float visibility = smoothstep(-PENUMBRA, PENUMBRA, sun_tangent - horizon_at(place));
    return Lie(max(sun_sine, 0.0), visibility, texel.zw, vec3(texel.x, up, texel.y));
}

// The two slow noises alone.
vec2 slow_noise_at(vec2 place) {
    return textureLod(lie, lie_uv(place), 0.0).zw;
}

// Gradient of the ground's height along x and z.
vec2 gradient_at(vec2 place) {
    vec2 normal = lie_texel(place).xy;
    return -normal * inversesqrt(max(1.0 - dot(normal, normal), FLATTEST_NORMAL));
}

// Sine of the angle between a line of sight and the ground.
float view_sine(vec3 place) {
    vec2 normal = lie_texel(place.xz).xy;
    return dot(normalize(eye - place), vec3(normal, sqrt(max(1.0 - dot(normal, normal), 0.0))).xzy);
}
