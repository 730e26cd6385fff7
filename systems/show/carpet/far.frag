// The wind's messages in a window beyond the one around the viewer. Only what may be seen of it is computed.
#include "systems/show/carpet/heard.glsl"
#include "systems/show/carpet/air.py"

uniform int level;  // number of the window, from the finest

const float ASIDE = 0.25;  // distance from the middle of a texel, along x and z, of two places whose messages are averaged [texels]

out vec2 message;

// Row of the patch that winds without a twin have told instead of one beyond the window: they blow there as in a mirror at its edge.
int mirrored_row(vec2 place) {
    ivec2 low = window_low(), on = ivec2(floor(place * patches_per_metre)) - low, twice = ivec2(2 * around.z);
    on = (on + PERIODS * twice) % twice;
    return row_of(low + min(on, twice - 1 - on));
}

// The message at a place, which is given in texels of this window.
vec2 heard_on(vec2 on, float spacing) {
    vec2 place = on * spacing;
    return heard_at(place, mirrored_row(place));
}

void main() {
    ivec2 at = ivec2(gl_FragCoord.xy);
    float patches = exp2(float(level) + 1.0), spacing = patches * patch_side;
    vec2 middle = floor(vec2(around.xy) / patches) + vec2(at.x, at.y - level * FAR_SIDE) + 0.5 - float(FAR_SIDE / 2);
    // Coarser texels are wider than fronts of gusts: both diagonals take turns.
    vec2 aside = level > 0 ? ASIDE * vec2(1.0, 1.0 - 2.0 * float(at.x + at.y & 1)) : vec2(0.0);
    message = heard_on(middle + aside, spacing);
    if (level > 0)
        message = 0.5 * (message + heard_on(middle - aside, spacing));
}
