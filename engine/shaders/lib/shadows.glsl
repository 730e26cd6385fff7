// How much of the sun is seen from a place: past the terrain, clouds, bodies and what a game's shadow maps have. A shadow of
// another sort joins `sun_seen`.
#include "lib/clouds.glsl"
#include "lib/listed.glsl"
#include "lib/trees.glsl"
#include "systems/shadows/shades.py"

const float FAR_OFF = 1e3;  // how far off a body's middle a ray goes that does not come by it, in radii

uniform sampler2DShadow map_0;  // a game's shadow maps, the first that a place lies in counts
uniform sampler2DShadow map_1;
uniform sampler2DShadow map_2;
uniform sampler2DShadow map_3;

// Whether a game has any, shades or trees: else nobody need look. Programs that are made for none but trees are told so by PLAIN.
bool any_casters() {
#ifdef TREES
    return true;
#elif defined(PLAIN)
    return false;
#else
    return maps_shown + shades_grid.w > 0.0;
#endif
}

const int TAPS = 4;  // places where a map is read, at the corners of a square
const float TAPS_APART = 0.75;  // how far from the middle a map is read, in its texels, across and up: so edges are soft
const float MAP_EDGE = 2.0;  // texels along a map's edges that do not count: taps would go beyond

// How much of the sun is seen past what a map has, from a place in it and in the sun's depth.
float past_map(sampler2DShadow map, vec3 at) {
    vec2 apart = TAPS_APART / vec2(textureSize(map, 0));
    float seen = 0.0;
    for (int tap = 0; tap < TAPS; tap++)
        seen += textureLod(map, vec3(at.xy + apart * vec2(tap % 2 * 2 - 1, tap / 2 * 2 - 1), at.z), 0.0);
    return seen / float(TAPS);
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

// How the sun's ray past a place comes by a ball that is stretched or pressed flat along an axis: from its middle, in radii, and
// how soft the shadow's edge is; far off where the ball stands behind. It is drawn out until it is a ball, and the ray with it.
vec4 ray_by(vec3 apart, vec3 axis, float pressed, float radius) {
    vec3 way = apart + axis * (pressed * dot(axis, apart)), ray = sun + axis * (pressed * dot(axis, sun));
    float before = dot(way, ray) / dot(ray, ray), along = dot(apart, sun);
    vec3 by = (way - ray * before) / radius;
    // The farther a shadow falls, the softer is its edge.
    float soft = SHADOW_EDGE + SHADOW_SOFTER * abs(along) * max(length(by), LEAST_PART) / max(length(apart - sun * along), LEAST_PART * radius);
    return vec4(before > 0.0 ? by : vec3(FAR_OFF), soft);
}

vec4 ray_by(int body, vec3 place) {
    return ray_by(bodies[body].middle - place, bodies[body].axis, bodies[body].pressed, bodies[body].radius);
}

// How much of the sun is seen past a body, where its ray comes so near to the middle, in radii.
float past_body(float near, float soft) {
    return 1.0 - (1.0 - smoothstep(1.0 - soft, 1.0 + soft, near)) / max(soft * soft, 1.0);
}

// How much of it is seen past a capsule: so far away, along an axis as long as `reach` to either end.
float past_capsule(vec3 apart, vec3 axis, float reach, float radius) {
    float lean = dot(axis, sun), aside = dot(axis, apart), before = dot(apart, sun);
    float at = clamp((lean * before - aside) / max(1.0 - lean * lean, LEAST_LENGTH), -reach, reach);
    float along = max(before + at * lean, 0.0);
    at = clamp(along * lean - aside, -reach, reach);
    return past_body(length(apart + at * axis - along * sun) / radius, (SHADOW_CRISP + SHADOW_SOFTER * along) / radius);
}

const vec2 SQUARE_ON = vec2(1e-4, 1e-3);  // what an edge seen from its end is left out by: sine that counts at least; [m]

// How much of it is seen past a box: so far away, and the sun's direction, along its axes.
float past_box(vec3 apart, vec3 toward, vec3 size) {
    vec3 steep = mix(vec3(-LEAST_LENGTH), vec3(LEAST_LENGTH), greaterThanEqual(toward, vec3(0.0)));
    steep = mix(toward, steep, lessThan(abs(toward), vec3(LEAST_LENGTH)));
    vec3 enters = (apart - sign(steep) * size) / steep, leaves = (apart + sign(steep) * size) / steep;
    if (min(min(leaves.x, leaves.y), leaves.z) <= 0.0)
        return 1.0;
    // How far the ray goes by the outline, which has edges along each of the axes [m].
    vec3 wide = size.yzx * abs(toward.zxy) + size.zxy * abs(toward.yzx);
    vec3 by = (abs(cross(toward, apart)) - wide - SQUARE_ON.y) / sqrt(max(1.0 - toward * toward, SQUARE_ON.x * SQUARE_ON.x));
    float soft = SHADOW_CRISP + SHADOW_SOFTER * max(max(max(enters.x, enters.y), enters.z), 0.0);
    float part = soft / min(min(size.x, size.y), size.z);
    return 1.0 - (1.0 - smoothstep(-soft, soft, max(max(by.x, by.y), by.z))) / max(part * part, 1.0);
}

// How much of it is seen past a shade; told as `told_of` does.
float past_shade(mat3x4 told, vec3 place) {
    vec3 apart = told[0].xyz - place, axis = told[1].xyz;
    float deep = told[0].w, reach = told[1].w, radius = told[2].w;
    if (deep < 0.0)
        return past_capsule(apart, axis, reach, radius);
    if (deep == 0.0) {
        vec4 by = ray_by(apart, axis, reach, radius);
        return past_body(length(by.xyz), by.w);
    }
    mat3 axes = mat3(axis, told[2].xyz, cross(axis, told[2].xyz));
    return past_box(apart * axes, sun * axes, vec3(reach, radius, deep));
}

// How much of it is seen past what a game has that casts shadows, its shades and shadow maps, and past trees.
float past_casters(vec3 place) {
    float seen = 1.0;
#if defined(TREES) && !defined(OF_TREES)  // those ask for others by themselves
    seen = past_trees_beyond(place, 0.0);
#endif
#ifndef PLAIN
    ivec2 listed_here = shades_grid.w > 0.0 ? listed_about(shades_grid, SHADES_FROM, place.xz) : ivec2(0);
    for (int number = listed_here.x; number < listed_here.y; number++)
        seen *= past_shade(listed_at(SHADES_FROM, number), place);
    seen *= maps_shown > 0.0 ? past_maps(place) : 1.0;
#endif
    return seen;
}

// How much of it is seen from a place past all bodies but one.
float past_bodies(vec3 place, int but) {
    float seen = 1.0;
    for (int body = 0; body < BODIES && bodies[body].radius > 0.0; body++) {
        vec4 by = ray_by(body, place);
        seen *= body == but ? 1.0 : past_body(length(by.xyz), by.w);
    }
    return seen;
}

// How much of the sun is seen from a place past all but bodies, `past` of it past the terrain.
float sun_past(vec3 place, float past) {
    return cloud_edge < 1.0 ? past * past_clouds(place) : past;
}

// How much of it is seen past these too; past what a game has that casts shadows where pixels do not ask for that.
float sun_seen(vec3 place, float past) {
    float seen = sun_past(place, past) * (bodies[0].radius > 0.0 ? past_bodies(place, -1) : 1.0);
#ifndef PIXELS_ASK
    if (any_casters())
        seen *= past_casters(place);
#endif
    return seen;
}
