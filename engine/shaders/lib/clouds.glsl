// Clouds: where they are, and what they leave of the sun's light.
#include "lib/frame.glsl"
#include "lib/repeating.glsl"
#include "lib/through.glsl"
#include "systems/light/clouds.py"

// How far off one sees the clouds in a direction, in sides of their square: they come down to the horizon, as on a globe.
vec2 clouds_toward(vec3 direction) {
    return direction.xz * (CLOUDS_AT / CLOUDS_SIDE / (max(direction.y, 0.0) + CLOUDS_BENT));
}

// Where clouds stand over a place of the ground, in the same.
vec2 clouds_over(vec2 place) {
    return place / CLOUDS_SIDE - clouds_drift;
}

// How much of the sun's light comes past the clouds to a place.
float past_clouds(vec3 place) {
    float dense = textureLod(repeating, clouds_over(place.xz) + clouds_toward(sun), 0.0).r, deep = max(dense - cloud_edge, 0.0);
    return mix(CLOUD_SENDS * clamp(cloud_edge, 0.0, 1.0), 1.0, comes_through(CLOUD_COLUMN * deep));
}
