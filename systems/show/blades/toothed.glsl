// What pixels see of a ribbon's teeth, or of its ligules.
#include "systems/show/blades/teeth.glsl"

in vec4 tooth;  // which of them, from the root on; from left, -1, to right, 1; how much is seen. Or, of ligules, how far along them;
                // which of them, from the middle on, times the fourth; how much is seen, below 0; how wide all are there

const float LIGULE_EDGES = 0.4;  // how much brighter a ligule is along its middle than at its edges
const float GOLDEN_PART = 0.618034;  // what follows one another in steps of it is spread evenly

// What there is of a ribbon at a pixel.
struct Outline {
    float wide;    // how wide it is there, of how wide it is drawn
    float covers;  // how much of the pixel there is none of its slits in
    float bright;  // of its colour
};

// Teeth: those of its sides take turns.
Outline of_teeth(float to_side) {
    float up = fract(tooth.x + (to_side > 0.0 ? 0.5 : 0.0)), end = min(up / ENDS_AT, (1.0 - up) / (1.0 - ENDS_AT));
    float wide = mix(1.0, TOOTHED_WIDER * mix(BETWEEN, 1.0, end), tooth.z);
    return Outline(wide / mix(1.0, TOOTHED_WIDER, tooth.z), 1.0, 1.0 + tooth.z * OUTER * (end - MEAN_END));
}

// Ligules, at a place in them; `finely` is how far from it the next pixel's is. They are seen where they are wider than pixels.
Outline of_ligules(vec2 place, vec2 finely) {
    float own = floor(place.y), off = abs(place.y - own - 0.5), end = 1.0 - SHORTER * fract(own * GOLDEN_PART);
    float half_wide = 0.5 * (1.0 - SLIT_TO * smoothstep(SLIT_FROM, 1.0, place.x));
    vec2 inside = clamp(vec2(end - place.x, half_wide - off) / finely + 0.5, 0.0, 1.0);
    float seen = clamp(1.0 / finely.y - 1.0, 0.0, 1.0) * -tooth.z;
    return Outline(1.0, mix(1.0, inside.x * inside.y, seen), 1.0 + seen * LIGULE_EDGES * (0.5 - 2.0 * off));
}

// Where a pixel is in the ligules of a ribbon whose sides are drawn so many times as far apart as they are.
vec2 among_ligules(float drawn) {
    return vec2(tooth.x, tooth.y / tooth.w * drawn);
}

// What there is of a ribbon at a pixel to one of its sides, and at a place among ligules.
Outline outline_at(float to_side, vec2 place, vec2 finely) {
    return tooth.z < 0.0 ? of_ligules(place, finely) : of_teeth(to_side);
}
