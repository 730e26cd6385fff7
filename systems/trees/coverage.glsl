// Coverage of pixels: opaque where it is nearly whole, and blended where it is less; or with SAMPLED and in baked pictures, opaque in
// as many samples of a pixel as are covered.

#include "systems/trees/packed.glsl"
#include "systems/trees/wood.py"

const float LEAST_COVER = 0.01;  // least coverage, as a divisor

// Coverage within an edge one pixel wide, however large it is; `least` is the least slope.
float sharpened(float cover, float edge, float least) {
    return clamp((cover - edge) / max(fwidth(cover), least) + 0.5, 0.0, 1.0);
}

uniform float solid_from;  // coverage from which on pixels are opaque

const vec4 BAYER = vec4(0.125, 0.625, 0.875, 0.375);  // thresholds of two by two samples of a pixel

// Threshold of coverage of this sample: neighbours have different ones, and each object has its own order.
float threshold_of(float random) {
    ivec2 sample_at = ivec2(gl_FragCoord.xy) & 1;
    return fract(BAYER[2 * sample_at.y + sample_at.x] + random);
}

const float OWN_ORDER = 0.618034;  // golden section: successive multiples are evenly spread

// Discards what is not drawn in this pass. Opaque pixels hide their soft ones by depth: where both were told apart by coverage, which cards
// interpolate in the last digit differently within each pass's outline, some pixels were drawn in neither.
void discard_uncovered(float cover) {
#ifdef SOFT
    if (cover < FAINTEST)
        discard;
#elif defined(SAMPLED)
    if (cover <= threshold_of(OWN_ORDER * float(gl_PrimitiveID / 2)))
        discard;
#else
    if (cover < solid_from)
        discard;
#endif
}

// Colour to output for a displayed colour.
vec4 blend_colour(vec3 shown, float cover) {
#ifdef SOFT
    return vec4(shown, 1.0) * cover;
#else
    return vec4(shown, 1.0);
#endif
}

vec4 output_colour(vec3 radiance, float cover) {
    return blend_colour(tone_mapped(radiance), cover);
}
