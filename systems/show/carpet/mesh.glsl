// The mesh of the ground: square tiles whose grids morph into the next coarser grid with distance, so that tiles of different
// spacing meet without cracks. One instance is one tile, or one piece of a tile.
#include "lib/terrain.glsl"
#include "systems/show/carpet/rims.py"
#include "systems/show/carpet/tiles.py"

in vec2 corner;  // grid coordinates on the tile, or on the piece
in vec3 piece;  // grid coordinates of the piece's start, 0 for whole tiles; bits of its sides with skirts
in vec4 tile;  // low corner (x, z) [m]; grid spacing [m]; take-over distance of the next coarser one [m], negative if only rims count

uniform sampler2D rims;  // over the terrain: distance from the nearest rim of a cliff [m]

const float MORPH_FROM = 0.75;  // fraction of that distance at which the grid starts to morph
const float QUARTER_MORPH_FROM = 0.6;  // the same where a quarter of a tile morphs into the grid of whole tiles

uniform float stride = 1.0;  // grid points from one vertex to the next along an axis

float grid_spacing;  // spacing of the morphed grid at the vertex [m]; the same from both sides where tiles meet

const vec2 ON_RIM = vec2(2.0, 4.0);  // distances from a rim between which vertices leave the terrain's samples [cells]

// Distance from the nearest rim [m]; beyond the terrain, at least the distance from the terrain.
float rim_at(vec2 at) {
    vec2 inside = clamp(at, terrain_origin, terrain_origin + terrain_size);
    return max(textureLod(rims, (inside - terrain_origin) / terrain_size, 0.0).r, distance(at, inside));
}

// Distances from the eye: the true one, and the one that counts near rims [m]. There the mesh is finer, as grass stands out against
// the sky.
vec2 mesh_distances(vec2 at, float from_rim) {
    float away = distance(at, eye.xz);
    return vec2(away, (NEARER * away + from_rim) / (1.0 + NEARER));
}

// Progress of the morph into the next coarser grid and, for a quarter of a tile, from there into the one after it, both in [0, 1].
// Quarters are finer than other tiles at the same distance; near a rim they have morphed into the grid of whole tiles.
vec2 grid_morph(vec2 far) {
    float morph = clamp(((tile.w < 0.0 ? far.y : min(far.x, far.y)) - MORPH_FROM) / (1.0 - MORPH_FROM), 0.0, 1.0);
    if (tile.w < QUARTERED * tile.z)
        return vec2(morph, 0.0);
    float at_rim = 1.0 - clamp((far.y - MORPH_FROM) / (1.0 - MORPH_FROM), 0.0, 1.0);
    return vec2(max(clamp((far.x - QUARTER_MORPH_FROM) / (MORPH_FROM - QUARTER_MORPH_FROM), 0.0, 1.0), at_rim), morph);
}

// The nearest of the terrain's samples, along each axis in which it is at most half a grid spacing away, so that vertices together
// reach all samples.
vec2 snapped_to_samples(vec2 at) {
    vec2 sample_at = terrain_origin + terrain_cell * floor((at - terrain_origin) / terrain_cell + 0.5), off = sample_at - at;
    return at + off * vec2(lessThanEqual(abs(off), vec2(0.5 * grid_spacing)));
}

vec2 on_mesh_at(vec2 corner) {
    float wide = tile.z * stride;
    vec2 at = tile.xy + corner * tile.z;
    float from_rim = rim_at(at);
    vec2 morph = grid_morph(mesh_distances(at, from_rim) / abs(tile.w)), pair = 0.5 / stride * corner;
    grid_spacing = wide * (1.0 + morph.x) * (1.0 + morph.y);
    at -= 2.0 * wide * (morph.x * fract(pair) + 2.0 * morph.y * fract(0.5 * floor(pair)));
    if (from_rim < ON_RIM.y * terrain_cell) {
        from_rim = rim_at(at);
        at = mix(snapped_to_samples(at), at, smoothstep(ON_RIM.x, ON_RIM.y, from_rim / terrain_cell));
    }
    return clamp(at, mesh_low, mesh_high);
}

vec2 on_mesh() {
    return on_mesh_at(corner + piece.xy);
}

// A piece may lie higher than its neighbours, so a skirt hangs down to the ground from its border. Vertices beyond the grid are the
// skirt's; this is the grid point on the border above them.
vec2 skirt_top() {
    return clamp(corner, vec2(0.0), vec2(PIECE));
}

// Drop of a skirt's vertex, as a fraction of the height of the piece over the ground. Only sides that face the eye and adjoin no
// piece as high have a skirt. Its upper end is just below the border: so pixels can tell it from the piece, and no gap shows.
const float JUST_UNDER = 0.001;

float skirt_drop(vec2 at) {
    vec2 off = corner - skirt_top();
    int side = off.y < 0.0 ? LOW_Z : off.y > 0.0 ? HIGH_Z : off.x < 0.0 ? LOW_X : HIGH_X;
    return (int(piece.z) & side) == 0 || dot(off, eye.xz - at) <= 0.0 ? 0.0 : dot(off, off) < 1.0 ? JUST_UNDER : 1.0;
}

vec3 on_ground(vec2 at) {
    return vec3(at, height_at(at)).xzy;
}
