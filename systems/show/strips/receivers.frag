// Every vertical edge of a strip is a receiver.
#include "systems/receive/receivers.glsl"
#include "lib/stack.glsl"
#include "systems/show/strips/draw.py"

uniform vec2 sizes[FORMS];   // by form: how far strips reach beyond their patch [m], and how high they are
uniform ivec4 stacks[RINGS]; // by ring: columns of a strip, sections of a column, strips of a kind on a patch
uniform ivec2 of_ring;       // the ring that is asked; its first patch

void main() {
    int number = number_here(), count = stacks[of_ring.x].z, edges = stacks[of_ring.x].x + 1;
    if (number >= pool.y) {
        told = vec4(0.0);
        return;
    }
    Placement placement = placement_of(of_ring.y + number / (KINDS * count * edges));
    int code = int(placement.code), turn = code % 4, along = code / RUNS_ALONG % 2, own = (along + turn) % 2;
    int k = number / (count * edges) % KINDS, plane = stack_place(number / edges % count, count, own, along, turn);
    told = told_at(edge_foot(placement.cell, turn, own, plane, count, number % edges, edges - 1, sizes[k].x), k, number);
}
