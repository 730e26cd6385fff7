// What a line of sight meets where it enters the grass of the carpet.
#include "lib/frame.glsl"

const float CREST = 2.5;  // leaves met over a crest, of those that a level line of sight as deep would meet: as the reference shows it
const float STEEP = 0.02;  // a line of sight counts as at least so steep, for how deep it goes

// Tangent of the angle between the line of sight and ground that rises by `rise` along x and z.
float viewing_slope(vec2 rise, vec3 place) {
    vec3 ray = place - eye.xyz;
    return (dot(rise, ray.xz) - ray.y) / max(length(ray.xz), 1e-4);
}

// Where leaves are that are seen: deeper in the grass, where the line of sight has met enough.
vec3 seen_at(vec3 place, float slope, float tall, float dense) {
    float deeper = min(tall * inversesqrt(max(slope, STEEP) * max(dense, 0.01)), 15.0);
    vec2 on = normalize(place.xz - eye.xz + 1e-4) * deeper;
    return vec3(place.x + on.x, place.y, place.z + on.y);
}
