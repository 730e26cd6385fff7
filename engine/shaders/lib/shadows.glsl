// Visibility of the sun from a place, 0 to 1: behind terrain, clouds, bodies, trees, and a game's shades and shadow maps. A shadow of
// another sort is one more factor in `sun_visibility`.
#include "lib/clouds.glsl"
#include "lib/listed.glsl"
#include "lib/trees.glsl"
#include "systems/shadows/shades.py"

const float FAR_OFF = 1e3;  // distance from a body's middle of a ray that misses it, in radii

uniform sampler2DShadow map_0;  // a game's shadow maps; of cascades, the first that contains the place is read
uniform sampler2DShadow map_1;
uniform sampler2DShadow map_2;
uniform sampler2DShadow map_3;

// Whether there may be shadows of trees, shades or shadow maps. Programs for scenes without the last two are compiled with PLAIN.
bool has_casters() {
#ifdef TREES
    return true;
#elif defined(PLAIN)
    return false;
#else
    return maps_shown + shades_grid.w > 0.0;
#endif
}

const int TAPS = 4;  // samples of a shadow map, at the corners of a square
const float TAPS_APART = 0.75;  // distance of the taps from its middle, across and up [texels]: they soften the edge
const float MAP_EDGE = 2.0;  // border of a map that is not used, as taps would leave the map [texels]

// Visibility of the sun by one shadow map, at a place in its texture space, with the depth as z.
float map_visibility(sampler2DShadow map, vec3 at) {
    vec2 apart = TAPS_APART / vec2(textureSize(map, 0));
    float seen = 0.0;
    for (int tap = 0; tap < TAPS; tap++)
        seen += textureLod(map, vec3(at.xy + apart * vec2(tap % 2 * 2 - 1, tap / 2 * 2 - 1), at.z), 0.0);
    return seen / float(TAPS);
}

bool is_in_map(sampler2DShadow map, vec3 at) {
    vec2 edge = MAP_EDGE / vec2(textureSize(map, 0));
    return all(lessThan(edge, at.xy)) && all(lessThan(at.xy, 1.0 - edge)) && at.z > 0.0 && at.z < 1.0;
}

// Visibility of the sun by the game's shadow maps.
float maps_visibility(vec3 place) {
    for (int map = 0; map < int(maps_shown); map++) {
        vec4 clipped = maps[map].clip_of * vec4(place + sun * maps[map].bias, 1.0);
        vec3 at = 0.5 + 0.5 * clipped.xyz / clipped.w;
        if (map == 0 && is_in_map(map_0, at))
            return map_visibility(map_0, at);
        if (map == 1 && is_in_map(map_1, at))
            return map_visibility(map_1, at);
        if (map == 2 && is_in_map(map_2, at))
            return map_visibility(map_2, at);
        if (map == 3 && is_in_map(map_3, at))
            return map_visibility(map_3, at);
    }
    return 1.0;
}

// Where the sun's ray through a place passes an ellipsoid of revolution: the offset from its middle [radii], and the softness of the
// shadow's edge in w. Space is scaled along the axis, so that the ellipsoid is a ball. An ellipsoid that is not towards the sun is FAR_OFF.
vec4 ray_offset(vec3 apart, vec3 axis, float pressed, float radius) {
    vec3 way = apart + axis * (pressed * dot(axis, apart)), ray = sun + axis * (pressed * dot(axis, sun));
    float before = dot(way, ray) / dot(ray, ray), along = dot(apart, sun);
    vec3 by = (way - ray * before) / radius;
    // Penumbras grow with distance.
    float soft = SHADOW_EDGE + SHADOW_SOFTER * abs(along) * max(length(by), LEAST_PART) / max(length(apart - sun * along), LEAST_PART * radius);
    return vec4(before > 0.0 ? by : vec3(FAR_OFF), soft);
}

vec4 ray_offset(int body, vec3 place) {
    return ray_offset(bodies[body].middle - place, bodies[body].axis, bodies[body].pressed, bodies[body].radius);
}

// Visibility of the sun behind a ball, by the distance of its ray from the middle [radii] and the softness of the edge.
float body_visibility(float near, float soft) {
    return 1.0 - (1.0 - smoothstep(1.0 - soft, 1.0 + soft, near)) / max(soft * soft, 1.0);
}

// Visibility of the sun behind a capsule: its middle as seen from the place, its axis, the distance from there to either end.
float capsule_visibility(vec3 apart, vec3 axis, float reach, float radius) {
    float lean = dot(axis, sun), aside = dot(axis, apart), before = dot(apart, sun);
    float at = clamp((lean * before - aside) / max(1.0 - lean * lean, LEAST_LENGTH), -reach, reach);
    float along = max(before + at * lean, 0.0);
    at = clamp(along * lean - aside, -reach, reach);
    return body_visibility(length(apart + at * axis - along * sun) / radius, (SHADOW_CRISP + SHADOW_SOFTER * along) / radius);
}

const vec2 SQUARE_ON = vec2(1e-4, 1e-3);  // leaves out edges of a box that are seen end-on: least sine; tolerance [m]

// Visibility of the sun behind a box: its middle as seen from the place, the sun's direction and half the size, along its axes.
float box_visibility(vec3 apart, vec3 toward, vec3 size) {
    vec3 steep = mix(vec3(-LEAST_LENGTH), vec3(LEAST_LENGTH), greaterThanEqual(toward, vec3(0.0)));
    steep = mix(toward, steep, lessThan(abs(toward), vec3(LEAST_LENGTH)));
    vec3 enters = (apart - sign(steep) * size) / steep, leaves = (apart + sign(steep) * size) / steep;
    if (min(min(leaves.x, leaves.y), leaves.z) <= 0.0)
        return 1.0;
    // Distance of the ray from the silhouette, whose edges are along the axes [m].
    vec3 wide = size.yzx * abs(toward.zxy) + size.zxy * abs(toward.yzx);
    vec3 by = (abs(cross(toward, apart)) - wide - SQUARE_ON.y) / sqrt(max(1.0 - toward * toward, SQUARE_ON.x * SQUARE_ON.x));
    float soft = SHADOW_CRISP + SHADOW_SOFTER * max(max(max(enters.x, enters.y), enters.z), 0.0);
    float part = soft / min(min(size.x, size.y), size.z);
    return 1.0 - (1.0 - smoothstep(-soft, soft, max(max(by.x, by.y), by.z))) / max(part * part, 1.0);
}

// Visibility of the sun behind a shade; `record` is as `shade_texels` packs it.
float shade_visibility(mat3x4 record, vec3 place) {
    vec3 apart = record[0].xyz - place, axis = record[1].xyz;
    float deep = record[0].w, reach = record[1].w, radius = record[2].w;
    if (deep < 0.0)
        return capsule_visibility(apart, axis, reach, radius);
    if (deep == 0.0) {
        vec4 by = ray_offset(apart, axis, reach, radius);
        return body_visibility(length(by.xyz), by.w);
    }
    mat3 axes = mat3(axis, record[2].xyz, cross(axis, record[2].xyz));
    return box_visibility(apart * axes, sun * axes, vec3(reach, radius, deep));
}

// Visibility of the sun behind a game's shades and shadow maps.
float games_visibility(vec3 place) {
    float seen = 1.0;
#ifndef PLAIN
    ivec2 listed_here = shades_grid.w > 0.0 ? listed_range(shades_grid, SHADES_FROM, place.xz) : ivec2(0);
    for (int number = listed_here.x; number < listed_here.y; number++)
        seen *= shade_visibility(listed_at(SHADES_FROM, number), place);
    seen *= maps_shown > 0.0 ? maps_visibility(place) : 1.0;
#endif
    return seen;
}

// Visibility of the sun behind these and trees.
float casters_visibility(vec3 place) {
    float seen = games_visibility(place);
#if defined(TREES) && !defined(OF_TREES)  // trees ask for one another's shadows themselves
    seen *= trees_visibility_beyond(place, 0.0);
#endif
    return seen;
}

// Visibility of the sun behind all bodies but one.
float bodies_visibility(vec3 place, int but) {
    float seen = 1.0;
    for (int body = 0; body < BODIES && bodies[body].radius > 0.0; body++) {
        vec4 by = ray_offset(body, place);
        seen *= body == but ? 1.0 : body_visibility(length(by.xyz), by.w);
    }
    return seen;
}

// Visibility of the sun behind terrain and clouds; `past` is that behind the terrain.
float distant_visibility(vec3 place, float past) {
    return cloud_edge < 1.0 ? past * clouds_visibility(place) : past;
}

// Visibility of the sun behind everything; `past` is that behind the terrain. With PIXELS_ASK, pixels ask for casters themselves.
float sun_visibility(vec3 place, float past) {
    float seen = distant_visibility(place, past) * (bodies[0].radius > 0.0 ? bodies_visibility(place, -1) : 1.0);
#ifndef PIXELS_ASK
    if (has_casters())
        seen *= casters_visibility(place);
#endif
    return seen;
}
