// A pass with one fragment for each receiver. The shader that includes this gives the receiver's place and kind.
#define RECEIVES
#include "lib/light.glsl"
#include "lib/terrain.glsl"
#include "lib/received.glsl"
#include "systems/wind/hear.glsl"
#include "systems/press/press.glsl"

uniform ivec2 pool;  // row of the pool's first receiver; number of its receivers

out vec4 received_texel;

// Number of the fragment's receiver in its pool.
int receiver_number() {
    ivec2 at = ivec2(gl_FragCoord.xy);
    return (at.y - pool.x) * RECEIVED_ROW + at.x;
}

// A receiver's message (x, z), the height of the ground [m], and the density of its kind.
vec4 receiver_texel(vec2 place, int kind, int number) {
    float dense = density_at(place, kind);
    vec2 message = combined_message(hear(place, kind, false, pool.x * RECEIVED_ROW + number), pressing(place, kind));
    return vec4(message, height_at(place), dense);
}
