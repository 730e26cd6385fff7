// Every blade is a receiver.
#include "systems/receive/receivers.glsl"
#include "systems/show/blades/store.py"

uniform int each;  // blades of a patch model

void main() {
    int number = number_here();
    if (number >= pool.y) {
        told = vec4(0.0);
        return;
    }
    Standing stands = standing_of(number / each);
    Blade blade = blade_of(int(stands.row) * each + number % each);
    told = told_at(blade.root.xz + stands.cell * patch_side, int(blade.kind), number);
}
