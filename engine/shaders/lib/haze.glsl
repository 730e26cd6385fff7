// The haze before a place.
#include "lib/frame.glsl"

// Radiance of the haze that lies before a place.
vec3 haze_light(vec3 place) {
    vec2 ray = place.xz - eye.xz;
    float c = dot(ray, toward_sun) * inversesqrt(dot(ray, ray) + 1e-6);
    return horizon[0].rgb + c * (horizon[1].rgb + c * horizon[2].rgb);
}

float haze_at(vec3 place) {
    return 1.0 - exp(-distance(place, eye) * haze_density);
}
