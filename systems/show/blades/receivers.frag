// Every blade is a receiver.
#include "systems/receive/receivers.glsl"

uniform sampler2D blades;   // by model, quarter turn and blade: BLADE
uniform sampler2D standing; // by patch: STANDING

void main() {
    int number = number_here();
    if (number >= pool.y) {
        told = vec4(0.0);
        return;
    }
    int patch_number = number / EACH;
    vec4 where = texelFetch(standing, ivec2(patch_number % STANDING_ROW * 3, patch_number / STANDING_ROW), 0);
    int record = int(where.z) * EACH + number % EACH;
    ivec2 at = ivec2(record % BLADES_ROW * TEXELS, record / BLADES_ROW);
    vec2 root_at = texelFetch(blades, at, 0).xz + where.xy * soil.w;
    told = told_at(root_at, int(texelFetch(blades, at + ivec2(2, 0), 0).z), number);
}
