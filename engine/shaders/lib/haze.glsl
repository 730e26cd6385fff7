// Haze between the eye and a place.
#include "lib/frame.glsl"
#include "lib/through.glsl"
#include "engine/terrain/record.py"
#include "systems/light/sky.py"

// Radiance of haze in the direction of a place, as if it hid all behind it. Its azimuth counts the less the steeper one looks:
// straight below there is none.
vec3 haze_radiance(vec3 place) {
    vec3 ray = place - eye;
    vec2 to = ray.xz * inversesqrt(dot(ray, ray) + LEAST_LENGTH);
    if (haze_given[0].w > 0.0) {  // the game's own
        vec3 turning = to.x * (haze_given[1].rgb + to.x * haze_given[3].rgb + to.y * haze_given[4].rgb);
        return max(haze_given[0].rgb + turning + to.y * haze_given[2].rgb, 0.0);
    }
    float s = dot(to, sun.xz), forwards = inversesqrt(PEAK - s);
    return horizon[0].rgb + s * (horizon[1].rgb + s * horizon[2].rgb) + forwards * forwards * forwards * horizon[3].rgb;
}

#ifdef MIRRORED
const float FADES_FROM = 0.5;  // ground beyond the terrain fades from this part of its width on, so that it has no visible edge

// Opacity of the ground beyond the terrain: 1 on the terrain, 0 where it ends.
float beyond_fade(vec2 place) {
    vec2 off = max(abs(place - terrain_origin - 0.5 * terrain_size) - 0.5 * terrain_size, 0.0);
    return 1.0 - smoothstep(FADES_FROM * GOES_ON, GOES_ON, length(off));
}
#endif

// Opacity of the haze before a place.
float haze_opacity(vec3 place) {
    float clear = transmittance(distance(place, eye) * haze_density);
#ifdef MIRRORED
    clear *= beyond_fade(place.xz);
#endif
    return 1.0 - clear;
}
