// There is a receiver in the middle of each patch around the viewer. It has no part in the small oscillations.
#include "lib/light.glsl"
#include "systems/wind/hear.glsl"

uniform ivec4 around;  // viewer's cell; patches along the window's side; number of the first receiver

const int PERIODS = 4096;  // of the window; no cell lies farther off

out vec2 told;

void main() {
    ivec2 at = ivec2(gl_FragCoord.xy), low = around.xy - around.z / 2;
    // Rows wrap round: each texel is a cell of the window. What is added keeps the remainder from being that of a negative.
    ivec2 cell = low + (at - low + PERIODS * around.z) % around.z;
    vec2 place = (vec2(cell) + 0.5) * patch_side;
    ByKind grows = density_at(place);
    int kind = 0;
    for (int other = 1; other < KINDS; other++)
        kind = OF(grows, other) > OF(grows, kind) ? other : kind;
    told = hear(place, kind, true, around.w + at.y * around.z + at.x);
}
