// What is listed by cells of the ground, in one texture: lamps, and below them shades. `systems/lamps/card.py` fills it.
#include "lib/frame.glsl"
#include "systems/lamps/card.py"

const int BYTE_BITS = 8;  // of a thing's number in a list

uniform usampler2D listed;  // a column a thing; then by cell where its list begins and how long it is; then the lists

uint listed_word(int row, int number) {
    return texelFetch(listed, ivec2(number / 4 % LISTED_ROW, row + number / (4 * LISTED_ROW)), 0)[number % 4];
}

// The numbers in the lists from which and to which things are listed that may reach a place; their rows begin at `top`.
ivec2 listed_about(vec4 grid, int top, vec2 place) {
    vec2 at = floor((place - grid.xy) * grid.z);
    if (min(at.x, at.y) < 0.0 || max(at.x, at.y) >= grid.w)
        return ivec2(0);
    uint word = listed_word(top + CELLS_FROM, int(at.y * grid.w + at.x));
    return ivec2(int(word >> COUNT_BITS)) + ivec2(0, int(word & ((1u << COUNT_BITS) - 1u)));
}

// What is told of the thing of a number in the lists.
mat3x4 listed_at(int top, int number) {
    int column = int(listed_word(top + LISTS_FROM, number / 4) >> (BYTE_BITS * (number % 4))) & (LISTED_ROW - 1);
    mat3x4 told;
    for (int row = 0; row < 3; row++)
        told[row] = uintBitsToFloat(texelFetch(listed, ivec2(column, top + row), 0));
    return told;
}
