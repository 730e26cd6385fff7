// How much of the sun is seen from a place: past the terrain, clouds, bodies and what a game's shadow maps have. A shadow of
// another sort joins `sun_seen`.
#include "lib/clouds.glsl"

const float FAR_OFF = 1e3;  // how far off a body's middle a ray goes that does not come by it, in radii
const float SHADOW_EDGE = 0.12;  // half the width of a body's shadow's edge, of its radius, where it is at the body
const float SHADOW_SOFTER = 0.01;  // how much more that is for each radius that the shadow falls

uniform sampler2DShadow map_0;  // a game's shadow maps, the first that a place lies in counts
uniform sampler2DShadow map_1;
uniform sampler2DShadow map_2;
uniform sampler2DShadow map_3;

// Whether there are any: else nobody need look. Programs that are made for none are told so by PLAIN.
bool any_maps() {
#ifdef PLAIN
    return false;
#else
    return maps_shown > 0.0;
#endif
}

const float TAPS_APART = 0.75;  // how far from the middle a map is read, in its texels, across and up: so edges are soft
const float MAP_EDGE = 2.0;  // texels along a map's edges that do not count: taps would go beyond

// How much of the sun is seen past what a map has, from a place in it and in the sun's depth.
float past_map(sampler2DShadow map, vec3 at) {
    vec2 apart = TAPS_APART / vec2(textureSize(map, 0));
    float seen = 0.0;
    for (int tap = 0; tap < 4; tap++)
        seen += textureLod(map, vec3(at.xy + apart * vec2(tap % 2 * 2 - 1, tap / 2 * 2 - 1), at.z), 0.0);
    return 0.25 * seen;
}

bool lies_in(sampler2DShadow map, vec3 at) {
    vec2 edge = MAP_EDGE / vec2(textureSize(map, 0));
    return all(lessThan(edge, at.xy)) && all(lessThan(at.xy, 1.0 - edge)) && at.z > 0.0 && at.z < 1.0;
}

// How much of it is seen past what the game's shadow maps have.
float past_maps(vec3 place) {
    for (int map = 0; map < int(maps_shown); map++) {
        vec4 clipped = maps[map].clip_of * vec4(place + sun * maps[map].bias, 1.0);
        vec3 at = 0.5 + 0.5 * clipped.xyz / clipped.w;
        if (map == 0 && lies_in(map_0, at))
            return past_map(map_0, at);
        if (map == 1 && lies_in(map_1, at))
            return past_map(map_1, at);
        if (map == 2 && lies_in(map_2, at))
            return past_map(map_2, at);
        if (map == 3 && lies_in(map_3, at))
            return past_map(map_3, at);
    }
    return 1.0;
}

// How the sun's ray past a place comes by a body: from its middle, in radii, and how soft the shadow's edge is; far off where
// the body stands behind. A body is a ball that is stretched or pressed flat along an axis: it is drawn out until it is one,
// and the ray with it.
vec4 ray_by(int body, vec3 place) {
    vec3 apart = shades[body].middle - place, axis = shades[body].axis;
    float pressed = shades[body].pressed, radius = shades[body].radius;
    vec3 way = apart + axis * (pressed * dot(axis, apart)), ray = sun + axis * (pressed * dot(axis, sun));
    float before = dot(way, ray) / dot(ray, ray), along = dot(apart, sun);
    vec3 by = (way - ray * before) / radius;
    // The farther a shadow falls, the softer is its edge.
    float soft = SHADOW_EDGE + SHADOW_SOFTER * abs(along) * max(length(by), 1e-3) / max(length(apart - sun * along), 1e-3 * radius);
    return vec4(before > 0.0 ? by : vec3(FAR_OFF), soft);
}

// How much of the sun is seen past a body, where its ray comes so near to the middle, in radii.
float past_body(float near, float soft) {
    return 1.0 - (1.0 - smoothstep(1.0 - soft, 1.0 + soft, near)) / max(soft * soft, 1.0);
}

// How much of it is seen from a place past all bodies but one.
float past_bodies(vec3 place, int but) {
    float seen = 1.0;
    for (int body = 0; body < SHADES && shades[body].radius > 0.0; body++) {
        vec4 by = ray_by(body, place);
        seen *= body == but ? 1.0 : past_body(length(by.xyz), by.w);
    }
    return seen;
}

// How much of the sun is seen from a place past all but bodies, `past` of it past the terrain.
float sun_past(vec3 place, float past) {
    return cloud_edge < 1.0 ? past * past_clouds(place) : past;
}

// How much of it is seen past these too; past shadow maps where pixels do not ask for that.
float sun_seen(vec3 place, float past) {
    float seen = sun_past(place, past) * (shades[0].radius > 0.0 ? past_bodies(place, -1) : 1.0);
#ifndef PIXELS_ASK
    if (any_maps())
        seen *= past_maps(place);
#endif
    return seen;
}
