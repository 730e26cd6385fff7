// The pass over receivers of blades: each blade is one, at its root.
#include "systems/receive/receivers.glsl"
#include "systems/show/blades/store.py"

uniform int each;  // blades of a patch model

void main() {
    int number = receiver_number();
    if (number >= pool.y) {
        received_texel = vec4(0.0);
        return;
    }
    Standing on_patch = standing_of(number / each);
    Blade blade = blade_of(int(on_patch.model_turn) * each + number % each);
    received_texel = receiver_texel(blade.root.xz + on_patch.cell * patch_side, int(blade.kind), number);
}
