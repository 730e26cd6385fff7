// Every blade is a receiver.
#include "systems/receive/receivers.glsl"
#include "systems/show/blades/store.py"

uniform int each;  // blades of a patch model

void main() {
    int number = receiver_number();
    if (number >= pool.y) {
        received_texel = vec4(0.0);
        return;
    }
    Standing stands = standing_of(number / each);
    Blade blade = blade_of(int(stands.row) * each + number % each);
    received_texel = receiver_texel(blade.root.xz + stands.cell * patch_side, int(blade.kind), number);
}
