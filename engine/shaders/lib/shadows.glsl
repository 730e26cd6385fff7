// How much of the sun is seen from a place: past the terrain, clouds and bodies. A shadow of another sort joins `sun_seen`.
#include "lib/clouds.glsl"

const float FAR_OFF = 1e3;  // how far off a body's middle a ray goes that does not come by it, in radii
const float SHADOW_EDGE = 0.12;  // half the width of a body's shadow's edge, of its radius, where it is at the body
const float SHADOW_SOFTER = 0.01;  // how much more that is for each radius that the shadow falls

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

// How much of it is seen past these too.
float sun_seen(vec3 place, float past) {
    return sun_past(place, past) * (shades[0].radius > 0.0 ? past_bodies(place, -1) : 1.0);
}
