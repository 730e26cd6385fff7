// What the carpet's receivers hear: they stand for all the grass about them, so they are without the small oscillations.
#include "lib/light.glsl"
#include "systems/wind/hear.glsl"

uniform ivec4 around;  // viewer's cell; patches along the window's side; number of the first receiver

const int PERIODS = 4096;  // windows added, more than any cell is away, to keep the remainder from being negative

// The first cell of the window around the viewer.
ivec2 window_low() {
    return around.xy - around.z / 2;
}

// Row in the patch table of a cell of the window: the table wraps round.
int row_of(ivec2 cell) {
    ivec2 at = (cell + PERIODS * around.z) % around.z;
    return at.y * around.z + at.x;
}

// The wind's message to the kind that grows most densely at a place; winds without a twin send that to the patch in a row of the table.
vec2 heard_at(vec2 place, int row) {
    ByKind densities = density_at(place);
    int kind = 0;
    for (int other = 1; other < KINDS; other++)
        kind = OF(densities, other) > OF(densities, kind) ? other : kind;
    return hear(place, kind, true, around.w + row);
}
