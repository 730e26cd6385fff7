// Fills tiles of the smaller picture of one sort with two triangles each.

#include "engine/gl/smaller.py"

uniform sampler2D tiles;  // sort of each tile
uniform float sort;       // sort of the tiles that are filled
uniform vec2 texel;       // size of the smaller picture's pixels, if the picture's is 1
uniform float far_end;    // depth of the far plane in clip space

out vec2 at;  // position in the viewport, 0 to 1 across and up

const vec4 NOWHERE = vec4(2.0, 2.0, 2.0, 1.0);  // beyond the picture

void main() {
    int number = gl_VertexID / TILE_VERTICES, corner = gl_VertexID % TILE_VERTICES, columns = textureSize(tiles, 0).x;
    ivec2 tile = ivec2(number % columns, number / columns);
    corner = corner < TILE_VERTICES / 2 ? corner : TILE_VERTICES - corner;  // 0 1 2, 3 2 1
    at = min(vec2(tile + ivec2(corner & 1, corner >> 1)) * float(TILE) * texel, 1.0);
    bool is_of_sort = abs(texelFetch(tiles, tile, 0).r - sort) < 0.5 * (TILE_OF_HOST - TILE_FLAT);
    gl_Position = is_of_sort ? vec4(2.0 * at - 1.0, far_end, 1.0) : NOWHERE;
}
