// The one light function: blades, strips, carpet and ground all take their colours from here, in display space.
#include "lib/frame.glsl"

uniform sampler2D tone;     // over the terrain: slope x, z and two slow noises, each as 0.5 + 0.5 n
uniform sampler2D density;  // over the terrain: how densely each kind grows

const float SHADE = 0.56;   // brightness at the foot of the grass, of that at its top
const float FLOOR = 0.66;   // brightness of the ground under grass, of bare ground's
const float SLOPE = 0.8;    // how much a hillside that faces the sun is brighter
const float SHEEN = 0.30;   // how much grass bent flat is brighter
const float NAP = 0.35;     // how much grass bent flat is brighter that leans away from the eye, and darker towards it
const float THROUGH = 0.55; // how much grass is brighter with the sun behind it

// Where a place lies on what is laid over the terrain; beyond the edge that goes on as in a mirror.
vec2 on_map(vec2 place) {
    return 1.0 - abs(1.0 - mod((place - terrain.xy) / field.xy, 2.0));
}

// Colour factor of a place: the lie of the land to the sun, and drier and fresher stretches.
vec3 place_tone(vec2 place) {
    vec4 here = 2.0 * textureLod(tone, on_map(place), 0.0) - 1.0;
    float relief = 1.0 - SLOPE * dot(here.xy, sun.xz);
    return relief * (1.0 + 0.16 * here.z + 0.14 * here.w * vec3(1.0, 0.1, -0.9));
}

// How much brighter the tops are than the plain shade: bent by `bend`, or seen against the sun.
float lift(vec2 bend, vec3 place) {
    vec3 ray = normalize(place - eye.xyz);
    float facing = max(dot(ray, sun.xyz), 0.0);
    facing *= facing;
    vec2 away = normalize(ray.xz + 1e-6);
    return SHEEN * dot(bend, bend) + NAP * dot(bend, away) + THROUGH * sun.w * facing * facing;
}

// How high the canopy stands where `bend` bends it, of its height at rest: where all grass lies, its tips are the top.
float lodged(vec2 bend) {
    return 1.0 - 0.55 * min(dot(bend, bend), 1.0);
}

// Brightness at height `h` (1 is the top of the canopy).
float canopy(float h, float lifted) {
    return mix(SHADE, 1.0, h) * (1.0 + lifted * h);
}

float haze_at(vec3 place) {
    return 1.0 - exp(-distance(place, eye.xyz) * haze.w);
}

// Bare ground, darkened where grass stands on it.
vec3 soil_light(vec2 place) {
    vec4 grows = textureLod(density, on_map(place), 0.0);
    float total = min(dot(grows, vec4(1.0)), 1.0);
    vec3 under = vec3(0.0);
    for (int kind = 0; kind < 4; kind++)
        under += grows[kind] * root[kind].rgb;
    under /= max(dot(grows, vec4(1.0)), 1e-3);
    return place_tone(place) * mix(soil.rgb, mix(soil.rgb, under, 0.6) * FLOOR, total);
}

// How much more a strip that runs along `run` covers for being seen at an angle: a line of sight then crosses fewer
// strips on the same way through the grass.
float boosted(vec2 run, vec3 middle) {
    vec2 sight = normalize(middle.xz - eye.xz);
    return mix(1.0, 1.0 / max(abs(run.x * sight.y - run.y * sight.x), 0.6), 0.7);
}
