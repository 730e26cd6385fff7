// The haze before a place.
#include "lib/frame.glsl"
#include "lib/through.glsl"
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

float haze_at(vec3 place) {
    return 1.0 - comes_through(distance(place, eye) * haze_density);
}
