// Clouds: where they are, and what they leave of the sun's light.
#include "lib/frame.glsl"
#include "lib/repeating.glsl"
#include "systems/light/clouds.py"

const float LOWEST_RAY = 0.1;  // sine of the sun's elevation that counts at least, for where its ray meets the clouds

// How much of the sun's light comes past the clouds to a place: two slices hide it, which stand for all.
float past_clouds(vec3 place) {
    vec2 at = (place.xz + sun.xz * (CLOUDS_AT / max(sun.y, LOWEST_RAY))) / CLOUDS_SIDE - clouds_drift;
    float dense = textureLod(repeating, at, 0.0).r - cloud_edge;
    vec2 open = clamp(1.0 - vec2(dense, dense - CLOUD_STEP) / CLOUD_HIDES, 0.0, 1.0);
    open *= open;
    return mix(CLOUD_SENDS * clamp(cloud_edge, 0.0, 1.0), 1.0, open.x * open.x * open.y * open.y);
}
