// The mesh of the ground: square tiles whose grids slide into the next coarser one with distance, so that tiles of different
// fineness meet without cracks. One instance is one tile.
#include "lib/terrain.glsl"

in vec2 corner;  // of the grid, 0 .. GRID
in vec4 tile;    // x, z [m]; spacing [m]; distance at which the next coarser spacing has taken over [m]

const float SLIDES = 0.75;  // part of that distance from which on the grid slides

float spaced;  // how far apart grid points are there [m]: the same from both sides where tiles meet, as what it makes out

vec2 on_mesh() {
    vec2 at = tile.xy + corner * tile.z;
    float slide = clamp((distance(at, eye.xz) / tile.w - SLIDES) / (1.0 - SLIDES), 0.0, 1.0);
    spaced = tile.z * (1.0 + slide);
    return clamp(at - fract(corner * 0.5) * 2.0 * tile.z * slide, mesh_low, mesh_high);
}

vec3 on_ground(vec2 at) {
    return vec3(at, height_at(at)).xzy;
}
