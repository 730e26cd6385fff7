// Lists by cells of the ground, in one texture: lamps, and in the rows below them shades. `systems/lamps/card.py` fills it.
#include "lib/frame.glsl"
#include "systems/lamps/card.py"

const int BYTE_BITS = 8;  // bits of a column's number in a list

uniform usampler2D listed;  // one record a column; then for each cell the start and length of its list; then the lists

uint listed_word(int row, int number) {
    return texelFetch(listed, ivec2(number / 4 % LISTED_ROW, row + number / (4 * LISTED_ROW)), 0)[number % 4];
}

// The range in the lists, first and end, of what may reach a place; `top` is the first row of this sort of record.
ivec2 listed_range(vec4 grid, int top, vec2 place) {
    vec2 at = floor((place - grid.xy) * grid.z);
    if (min(at.x, at.y) < 0.0 || max(at.x, at.y) >= grid.w)
        return ivec2(0);
    uint word = listed_word(top + CELLS_FROM, int(at.y * grid.w + at.x));
    return ivec2(int(word >> COUNT_BITS)) + ivec2(0, int(word & ((1u << COUNT_BITS) - 1u)));
}

// The record with an index in the lists.
mat3x4 listed_at(int top, int number) {
    int column = int(listed_word(top + LISTS_FROM, number / 4) >> (BYTE_BITS * (number % 4))) & (LISTED_ROW - 1);
    mat3x4 record;
    for (int row = 0; row < 3; row++)
        record[row] = uintBitsToFloat(texelFetch(listed, ivec2(column, top + row), 0));
    return record;
}
