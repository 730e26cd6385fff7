// Every vertical edge of a strip is a receiver.
#include "systems/receive/receivers.glsl"
#include "lib/stack.glsl"
#include "systems/show/strips/draw.py"

uniform vec2 sizes[FORMS];   // by form: distance that strips reach beyond their patch [m], and their height [m]
uniform ivec4 stacks[RINGS]; // by ring: columns of a strip, sections of a column, strips of a kind on a patch
uniform ivec2 of_ring;       // the receivers' ring; index of its first placement

void main() {
    int number = receiver_number(), count = stacks[of_ring.x].z, edges = stacks[of_ring.x].x + 1;
    if (number >= pool.y) {
        received_texel = vec4(0.0);
        return;
    }
    Placement placement = placement_of(of_ring.y + number / (KINDS * count * edges));
    int code = int(placement.code), turn = code % 4, along = code / RUNS_ALONG % 2, orientation = (along + turn) % 2;
    int k = number / (count * edges) % KINDS, plane = stack_place(number / edges % count, count, orientation, along, turn);
    vec2 place = edge_foot(placement.cell, turn, orientation, plane, count, number % edges, edges - 1, sizes[k].x);
    received_texel = receiver_texel(place, k, number);
}
