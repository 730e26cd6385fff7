// The mesh of the ground: square tiles whose grids slide into the next coarser one with distance, so that tiles of different
// fineness meet without cracks. One instance is one tile.
#include "lib/terrain.glsl"
#include "systems/show/carpet/rims.py"
#include "systems/show/carpet/tiles.py"

in vec2 corner;  // of the grid of a tile, or of a piece of it
in vec3 piece;   // where that begins on the tile's grid, 0 of whole tiles; of pieces, which sides hang down, as bits
in vec4 tile;    // x, z [m]; spacing [m]; distance at which the next coarser spacing has taken over [m], below 0 that from rims alone

uniform sampler2D rims;  // over the terrain: how far the next rim of a cliff is [m]

const float SLIDES = 0.75;  // part of that distance from which on the grid slides
const float SLIDES_FIRST = 0.6;  // part of it from which on that of a quarter of a tile slides into the grid of whole ones

uniform float stride = 1.0;  // grid points from one vertex to the next along an axis

float spaced;  // how far apart grid points are there [m]: the same from both sides where tiles meet, as what it makes out

const vec2 ON_RIM = vec2(2.0, 4.0);  // how far off a rim grid points lie on the terrain's own samples, and no more, in cells

// How far off a rim is; beyond the terrain, at least as far as that is.
float rim_at(vec2 at) {
    vec2 inside = clamp(at, terrain_origin, terrain_origin + terrain_size);
    return max(textureLod(rims, (inside - terrain_origin) / terrain_size, 0.0).r, distance(at, inside));
}

// How far off a place is, and how far off it counts as at rims, from which grass stands out against the sky: as nearer than it is.
vec2 far_off(vec2 at, float from_rim) {
    float away = distance(at, eye.xz);
    return vec2(away, (NEARER * away + from_rim) / (1.0 + NEARER));
}

// How far the grid has slid into the next coarser one, and from that into the next after it: only that of a quarter of a tile
// does, which is finer than others that are as near. Towards a rim, where tiles are finer, it lies as others do.
vec2 slid(vec2 far) {
    float slide = clamp(((tile.w < 0.0 ? far.y : min(far.x, far.y)) - SLIDES) / (1.0 - SLIDES), 0.0, 1.0);
    if (tile.w < QUARTERED * tile.z)
        return vec2(slide, 0.0);
    float at_rim = 1.0 - clamp((far.y - SLIDES) / (1.0 - SLIDES), 0.0, 1.0);
    return vec2(max(clamp((far.x - SLIDES_FIRST) / (SLIDES - SLIDES_FIRST), 0.0, 1.0), at_rim), slide);
}

// The nearest place on the terrain's samples, where that is near enough for the next grid point to reach all others.
vec2 on_samples(vec2 at) {
    vec2 sample_at = terrain_origin + terrain_cell * floor((at - terrain_origin) / terrain_cell + 0.5), off = sample_at - at;
    return at + off * vec2(lessThanEqual(abs(off), vec2(0.5 * spaced)));
}

vec2 on_mesh_at(vec2 corner) {
    float wide = tile.z * stride;
    vec2 at = tile.xy + corner * tile.z;
    float from_rim = rim_at(at);
    vec2 slide = slid(far_off(at, from_rim) / abs(tile.w)), pair = 0.5 / stride * corner;
    spaced = wide * (1.0 + slide.x) * (1.0 + slide.y);
    at -= 2.0 * wide * (slide.x * fract(pair) + 2.0 * slide.y * fract(0.5 * floor(pair)));
    if (from_rim < ON_RIM.y * terrain_cell) {
        from_rim = rim_at(at);
        at = mix(on_samples(at), at, smoothstep(ON_RIM.x, ON_RIM.y, from_rim / terrain_cell));
    }
    return clamp(at, mesh_low, mesh_high);
}

vec2 on_mesh() {
    return on_mesh_at(corner + piece.xy);
}

// The sheet of a piece may lie higher than what is beside it, so its border hangs down to the ground: else one would look in under
// it. Corners beyond the grid are the lower ends of that.
vec2 above_border() {
    return clamp(corner, vec2(0.0), vec2(PIECE));
}

// How far a corner hangs down, of how high the sheet lies: on sides of the piece that face the eye, and no other piece as high. It
// tells what hangs down from the sheet that it begins just under the border, so little that no ground is seen between.
const float JUST_UNDER = 0.001;

float hangs(vec2 at) {
    vec2 off = corner - above_border();
    int side = off.y < 0.0 ? LOW_Z : off.y > 0.0 ? HIGH_Z : off.x < 0.0 ? LOW_X : HIGH_X;
    return (int(piece.z) & side) == 0 || dot(off, eye.xz - at) <= 0.0 ? 0.0 : dot(off, off) < 1.0 ? JUST_UNDER : 1.0;
}

vec3 on_ground(vec2 at) {
    return vec3(at, height_at(at)).xzy;
}
