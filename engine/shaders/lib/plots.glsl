// Maps of what a game has sown and cut, in cells of 0.2 m. Only plots of the ground that were changed have pages.
#include "lib/frame.glsl"
#include "engine/terrain/plots.py"

uniform sampler2D plots;  // first the page table: two page numbers a plot, for mowing and sowing; then the pages

struct Plot {
    vec2 cell;  // the place on it [cells]
    int mown;   // page of the heights that grass is left at; 0 where nothing is cut
    int sown;   // first page of densities, four kinds on each; 0 where they are as painted
};

const float BYTE = 255.0;
const float TWO_BYTES = BYTE * (BYTE + 2.0);  // the largest number in two bytes

// The number in two channels, the upper byte first.
float packed_number(vec2 bytes) {
    return BYTE * dot(bytes, vec2(BYTE + 1.0, 1.0));
}

int page_number(vec2 bytes) {
    return int(packed_number(bytes) + 0.5);
}

Plot plot_at(vec2 place) {
    vec2 at = place / PLOT_SIDE + plots_half, corner = floor(at);
    if (any(lessThan(corner, vec2(0.0))) || any(greaterThanEqual(corner, 2.0 * plots_half)))
        return Plot(vec2(0.0), 0, 0);
    int row = textureSize(plots, 0).x, number = int(corner.y) * int(2.0 * plots_half.x) + int(corner.x);
    vec4 pages = texelFetch(plots, ivec2(number % row, number / row), 0);
    return Plot(float(PLOT_CELLS) * (at - corner), page_number(pages.xy), page_number(pages.zw));
}

const float BETWEEN_CELLS = 256.0;  // steps from cell to cell that places are rounded to, so that filtering is the same on all pages
const float IN_STEP = 0.25;  // place within a step: far from where a filter that rounds takes the next one, and one that cuts

// The mip level of a page whose texels have such a side [m].
float page_mip(float side) {
    return log2(clamp(side * (float(PLOT_CELLS) / PLOT_SIDE), 1.0, float(PLOT_CELLS)));
}

// A page's value at a place on its plot, clamped to the plot's outermost cells.
vec4 page_texel(int page, vec2 cell, float level) {
    ivec2 size = textureSize(plots, 0);
    int row = size.x / PLOT_CELLS;
    float edge = 0.5 * exp2(ceil(level));
    vec2 own = (floor(BETWEEN_CELLS * clamp(cell, edge, float(PLOT_CELLS) - edge)) + IN_STEP) / BETWEEN_CELLS;
    vec2 at = own + float(PLOT_CELLS) * vec2(page % row, page / row);
    return textureLod(plots, at / vec2(size), level);
}
