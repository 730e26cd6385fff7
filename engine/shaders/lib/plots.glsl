// What a game has changed of where grass grows and how high it is left: maps in cells of 0.2 m, of which only those plots of the
// ground are there that were changed.
#include "lib/frame.glsl"
#include "engine/terrain/plots.py"

uniform sampler2D plots;  // first, plot by plot, two numbers of pages, of what is mown and of what is sown; then the pages

struct Plot {
    vec2 cell;  // where a place is on it [cells]
    int mown;   // its page of what is left; 0 where nothing is cut
    int sown;   // its first page of densities, four kinds on each; 0 where they are as painted
};

const float BYTE = 255.0;
const float TWO_BYTES = BYTE * (BYTE + 2.0);  // the largest number in them

// The number that two channels hold together, the upper byte first.
float number_in(vec2 bytes) {
    return BYTE * dot(bytes, vec2(BYTE + 1.0, 1.0));
}

int page_number(vec2 bytes) {
    return int(number_in(bytes) + 0.5);
}

Plot plot_at(vec2 place) {
    vec2 at = place / PLOT_SIDE + plots_half, corner = floor(at);
    if (any(lessThan(corner, vec2(0.0))) || any(greaterThanEqual(corner, 2.0 * plots_half)))
        return Plot(vec2(0.0), 0, 0);
    int row = textureSize(plots, 0).x, number = int(corner.y) * int(2.0 * plots_half.x) + int(corner.x);
    vec4 pages = texelFetch(plots, ivec2(number % row, number / row), 0);
    return Plot(float(PLOT_CELLS) * (at - corner), page_number(pages.xy), page_number(pages.zw));
}

const float BETWEEN_CELLS = 256.0;  // steps from one cell to the next: places are read alike wherever their page lies

// The level of a page whose texels are as long as `side` [m].
float page_level(float side) {
    return log2(clamp(side * (float(PLOT_CELLS) / PLOT_SIDE), 1.0, float(PLOT_CELLS)));
}

// What a page has at a place on its plot: a plot's outermost cells go on to its edge.
vec4 on_page(int page, vec2 cell, float level) {
    ivec2 size = textureSize(plots, 0);
    int row = size.x / PLOT_CELLS;
    float edge = 0.5 * exp2(ceil(level));
    vec2 own = (floor(BETWEEN_CELLS * clamp(cell, edge, float(PLOT_CELLS) - edge)) + 0.5) / BETWEEN_CELLS;
    vec2 at = own + float(PLOT_CELLS) * vec2(page % row, page / row);
    return textureLod(plots, at / vec2(size), level);
}
