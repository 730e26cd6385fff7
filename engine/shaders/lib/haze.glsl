// The haze before a place.
#include "lib/frame.glsl"
#include "lib/through.glsl"
#include "engine/terrain/record.py"
#include "systems/light/sky.py"

// Radiance of the haze that lies before a place.
vec3 haze_light(vec3 place) {
    vec2 ray = place.xz - eye.xz;
    if (haze_given[0].w > 0.0) {  // the game's own
        vec2 to = ray * inversesqrt(dot(ray, ray) + LEAST_LENGTH);
        vec3 turning = to.x * (haze_given[1].rgb + to.x * haze_given[3].rgb + to.y * haze_given[4].rgb);
        return max(haze_given[0].rgb + turning + to.y * haze_given[2].rgb, 0.0);
    }
    float s = dot(ray, sun.xz) * inversesqrt(dot(ray, ray) + LEAST_LENGTH), forwards = inversesqrt(PEAK - s);
    return horizon[0].rgb + s * (horizon[1].rgb + s * horizon[2].rgb) + forwards * forwards * forwards * horizon[3].rgb;
}

#ifdef MIRRORED
const float FADES_FROM = 0.5;  // part of the way that ground goes on beyond the terrain from which on it fades: its end is no edge

// How much of the ground at a place shows that goes on beyond the terrain.
float goes_on(vec2 place) {
    vec2 off = max(abs(place - terrain_origin - 0.5 * terrain_size) - 0.5 * terrain_size, 0.0);
    return 1.0 - smoothstep(FADES_FROM * GOES_ON, GOES_ON, length(off));
}
#endif

float haze_at(vec3 place) {
    float clear = comes_through(distance(place, eye) * haze_density);
#ifdef MIRRORED
    clear *= goes_on(place.xz);
#endif
    return 1.0 - clear;
}
