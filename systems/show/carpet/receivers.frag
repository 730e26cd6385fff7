// The wind's message to the receiver in the middle of each patch around the viewer, without the small oscillations.
#include "lib/light.glsl"
#include "systems/wind/hear.glsl"

uniform ivec4 around;  // viewer's cell; patches along the window's side; number of the first receiver

const int PERIODS = 4096;  // windows added, more than any cell is away, to keep the remainder from being negative

out vec2 message;

void main() {
    ivec2 at = ivec2(gl_FragCoord.xy), low = around.xy - around.z / 2;
    // Cells wrap round: each texel is a cell of the window.
    ivec2 cell = low + (at - low + PERIODS * around.z) % around.z;
    vec2 place = (vec2(cell) + 0.5) * patch_side;
    ByKind densities = density_at(place);
    int kind = 0;
    for (int other = 1; other < KINDS; other++)
        kind = OF(densities, other) > OF(densities, kind) ? other : kind;
    message = hear(place, kind, true, around.w + at.y * around.z + at.x);
}
