// A fragment is a receiver. Who includes this says where receiver `number` stands and of which kind it is.
#define RECEIVES
#include "lib/light.glsl"
#include "lib/terrain.glsl"
#include "lib/received.glsl"
#include "systems/wind/hear.glsl"
#include "systems/press/press.glsl"

uniform ivec2 pool;  // row of its first receiver; how many it has

out vec4 told;

int number_here() {
    ivec2 at = ivec2(gl_FragCoord.xy);
    return (at.y - pool.x) * RECEIVED_ROW + at.x;
}

// What a receiver is told, and what it stands on.
vec4 told_at(vec2 place, int kind, int number) {
    float grows = density_at(place, kind);
    vec2 message = combined_message(hear(place, kind, false, pool.x * RECEIVED_ROW + number), pressing(place, kind));
    return vec4(message, height_at(place), grows);
}
