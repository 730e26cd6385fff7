// What a line of sight meets where it enters the grass of the carpet.
#include "lib/frame.glsl"

const float CREST = 2.5;  // leaves met over a crest, of those that a level line of sight as deep would meet: as the reference shows it

// Tangent of the angle between the line of sight and ground that rises by `rise` along x and z.
float viewing_slope(vec2 rise, vec3 place) {
    vec3 ray = place - eye.xyz;
    return (dot(rise, ray.xz) - ray.y) / max(length(ray.xz), 1e-4);
}
