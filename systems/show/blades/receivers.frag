// Every blade is a receiver.
#include "systems/receive/receivers.glsl"
#include "systems/show/blades/store.py"

void main() {
    int number = number_here();
    if (number >= pool.y) {
        told = vec4(0.0);
        return;
    }
    Standing stands = standing_of(number / EACH);
    Blade blade = blade_of(int(stands.row) * EACH + number % EACH);
    told = told_at(blade.root.xz + stands.cell * patch_side, int(blade.kind), number);
}
