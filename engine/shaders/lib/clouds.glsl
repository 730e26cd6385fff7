// Clouds: their place on the map, and their shadows.
#include "lib/frame.glsl"
#include "lib/repeating.glsl"
#include "lib/through.glsl"
#include "systems/light/clouds.py"

// Offset on the clouds' map in a direction [sides of the map]; the layer comes down to the horizon, as on a globe.
vec2 clouds_uv_toward(vec3 direction) {
    return direction.xz * (CLOUD_BASE_HEIGHT / CLOUDS_SIDE / (max(direction.y, 0.0) + CLOUD_BEND));
}

// Texture coordinates of the clouds above a place of the ground.
vec2 clouds_uv_over(vec2 place) {
    return place / CLOUDS_SIDE - clouds_drift;
}

// Visibility of the sun behind clouds.
float clouds_visibility(vec3 place) {
    float dense = textureLod(repeating, clouds_uv_over(place.xz) + clouds_uv_toward(sun), 0.0).r, deep = max(dense - cloud_edge, 0.0);
    return mix(CLOUD_LONE * clamp(cloud_edge, 0.0, 1.0), 1.0, transmittance(CLOUD_DEPTH * deep));
}
