// Where the strips of a patch stand: planes of its model, turned with it, and stacked along an axis of the world.
#include "lib/frame.glsl"

vec2 turned_by(vec2 place, int turn) {
    return turn == 0 ? place : turn == 1 ? vec2(-place.y, place.x) : turn == 2 ? -place : vec2(place.y, -place.x);
}

// Whether the planes of a model fall along the axis that they are stacked on: `own` is the model's orientation.
bool falls(int own, int along, int turn) {
    return own == 0 ? turn == (along == 0 ? 2 : 1) : turn == (along == 0 ? 3 : 2);
}

// The place in the stack of a plane of the model, and the plane of a place.
int stacked(int plane, int count, int own, int along, int turn) {
    return falls(own, along, turn) ? count - 1 - plane : plane;
}

// The foot (x, z) [m] of an edge of a strip, on the patch of a cell.
vec2 edge_foot(vec2 cell, int turn, int own, int plane, int count, int edge, int columns, float margin) {
    float side = soil.w, u = -margin + (side + 2.0 * margin) * float(edge) / float(columns);
    float v = (float(plane) + 0.5) * (side / float(count));
    vec2 local = (own == 0 ? vec2(u, v) : vec2(v, u)) - 0.5 * side;
    return cell * side + turned_by(local, turn) + 0.5 * side;
}
