// The wind's message to the receiver in the middle of each patch around the viewer.
#include "systems/show/carpet/heard.glsl"

out vec2 message;

void main() {
    ivec2 at = ivec2(gl_FragCoord.xy), low = window_low();
    // Cells wrap round: each texel is a cell of the window.
    ivec2 cell = low + (at - low + PERIODS * around.z) % around.z;
    message = heard_at((vec2(cell) + 0.5) * patch_side, at.y * around.z + at.x);
}
