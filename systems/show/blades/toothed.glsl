// Pixels of a ribbon's teeth or ligules.
#include "systems/show/blades/teeth.glsl"

const float LIGULE_EDGES = 0.4;  // relative brightness of a ligule's middle over its edges
const float GOLDEN_PART = 0.618034;  // multiples of it, modulo 1, are spread evenly

// The outline of a ribbon at a pixel.
struct Outline {
    float width;       // relative to the drawn width
    float coverage;    // part of the pixel outside of slits
    float brightness;  // relative to the ribbon's
};

// Teeth, which are round and alternate between the two sides.
Outline teeth_outline(float to_side) {
    float up = fract(tooth + (to_side > 0.0 ? 0.5 : 0.0)), end = min(up / ENDS_AT, (1.0 - up) / (1.0 - ENDS_AT));
    return Outline(tooth_widths.x + tooth_widths.y * end * (2.0 - end), 1.0, 1.0 + outlined * OUTER * (end - MEAN_END));
}

#ifdef LIGULES_TOO
// Ligules, at a place in them; `pixel_size` is the size of a pixel there. They show where they are wider than pixels, with round ends.
Outline ligules_outline(vec2 place, vec2 pixel_size) {
    float ligule = floor(place.y), off = abs(place.y - ligule - 0.5), end = 1.0 - SHORTER * fract(ligule * GOLDEN_PART);
    float half_wide = 0.5 * (1.0 - SLIT_TO * smoothstep(SLIT_FROM, 1.0, place.x)), ending = 2.0 * off * off * pixel_size.x / pixel_size.y;
    vec2 inside = clamp(vec2(end - ending - place.x, half_wide - off) / pixel_size + 0.5, 0.0, 1.0);
    float seen = clamp(1.0 / pixel_size.y - 1.0, 0.0, 1.0) * -outlined;
    return Outline(1.0, mix(1.0, inside.x * inside.y, seen), 1.0 + seen * LIGULE_EDGES * (0.5 - 2.0 * off));
}
#endif

// Place of a pixel along and across the ligules of a ribbon that is drawn `widened` times as wide as it is.
vec2 place_in_ligules(float widened) {
#ifdef LIGULES_TOO
    return vec2(tooth, tooth_side.x / tooth_side.y * widened);
#else
    return vec2(0.0);
#endif
}

// The outline of a ribbon at a pixel on one of its sides, and at a place among ligules.
Outline outline_at(float to_side, vec2 place, vec2 pixel_size) {
#ifdef LIGULES_TOO
    if (outlined < 0.0)
        return ligules_outline(place, pixel_size);
#endif
    return teeth_outline(to_side);
}
