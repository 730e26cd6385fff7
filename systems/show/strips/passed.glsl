// Varyings from strips.vert to strips.frag: few whole vectors, as not every driver packs small ones together.
PASSED vec4 uv;             // place on the page; place across the column, 0 to 1; height in the canopy
PASSED vec4 roots;          // ground position (x, z), height over it in calm air [m]; kind with EDGED, density with THIN alone
flat PASSED vec4 root_pigment;   // pigment at the root; opacity of the strip
flat PASSED vec4 pigment_change; // change of pigment from root to tip; with EDGED, greatest span of fading ranks; with THIN alone, 1 / span
flat PASSED vec4 grain_cos; // change of pigment with the cosine of twice the normal's azimuth; with THIN, slope of opacity by rank
flat PASSED vec4 grain_sin; // change of pigment with the sine; with THIN, opacity at rank 0
flat PASSED mat4 lit;       // light, bundled; beside it the page, the mip level, and the factor on coverage
#ifdef SHADED
PASSED vec4 spot;           // place (x, y, z) [m]; the sun's part of the light that is not the sky's
flat PASSED vec4 shadow;    // square of the sun ray's distance from a body [radii], as a polynomial of `uv.z`; softness of the edge
#endif
#if defined(TREES) && !defined(SHADED)
PASSED vec2 spot;           // place in the trees' maps of the sun
flat PASSED vec2 past;      // from halvings_before for the column; the sun's part of the light
#endif
#ifdef HEADS
flat PASSED vec2 heads;     // factor on the coverage of heads, beyond that of leaves; from levels_to_heads
#endif
#ifdef THIN
flat PASSED vec2 form_fade; // opacity over rank while a kind changes its form: slope, and value at rank 0
#endif
#ifdef EYED
flat PASSED float eyed;     // above 0 for kinds with eyes: then `grain_sin` is the change of pigment with the eye's part
#endif
#ifdef DEEP
flat PASSED int number;     // of the column
#endif
#ifdef CUT
flat PASSED vec4 cut;       // kind; pixels per metre; height below which strips would show as rows [m]; 1 near cut grass
#endif
