// What goes from strips.vert to strips.frag: few whole vectors, as not every driver packs small ones together.
PASSED vec4 on;             // place on its page; place between the column's edges, 0 to 1; height in the canopy
PASSED vec4 roots;          // place on the ground (x, z), and how high over it in calm air [m]; kind with CUT or EDGED, or with THIN alone what shows by density
flat PASSED vec4 foot;      // pigment at the root; how much of the strip shows
flat PASSED vec4 rise;      // how that changes up to the tip; with THIN, how sharply ranks end, or with EDGED how softly
flat PASSED vec4 grain_cos; // change of pigment with the cosine of twice the normal's azimuth; with THIN, what shows by rank: slope
flat PASSED vec4 grain_sin; // the same with the sine; with THIN, start
flat PASSED mat4 lit;       // light on it, bundled; beside it its page, level of its mip-maps, factor on coverage
#ifdef SHADED
PASSED vec4 spot;           // place (x, y, z) [m]; the sun's part of the light that is not the sky's
flat PASSED vec4 shadow;    // of a body: the square of how near the sun's ray comes to it, by powers of `on.z`; how soft its edge is
#endif
#if defined(TREES) && !defined(SHADED)
PASSED vec2 spot;           // where the maps tell of the sun's ray past trees
flat PASSED vec2 past;      // how much they do of what stands before the column; the sun's part of the light
#endif
#ifdef HEADS
flat PASSED float heads;    // factor on the coverage of heads
#endif
#ifdef THIN
flat PASSED vec2 aged;      // what shows by rank where a kind becomes another: slope, start
#endif
#ifdef EYED
flat PASSED float eyed;     // above 0 where in place of that sine is how much of an eye's colour there is, and in place of its change, the eye's
#endif
#ifdef DEEP
flat PASSED int number;     // of the column
#endif
#ifdef CUT
flat PASSED vec4 cut;       // kind; pixels that a metre is long; height below which strips would show as rows [m]; 1 where any is cut
#endif
