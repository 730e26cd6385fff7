// How much of a pixel a tree covers, and the ways in which what covers it in part is drawn: opaque where it covers nearly all of
// it, and blended over that and all else where it covers less; or with SAMPLED, and as textures have it, opaque in as many samples of
// a pixel as it covers.

#include "systems/trees/packed.glsl"
#include "systems/trees/wood.py"

const float LEAST_COVER = 0.01;  // coverage that divides what is multiplied by it at least

// The coverage of what lies within an edge, which is a pixel wide however large it is; `least` is how fast it changes at least.
float sharpened(float cover, float edge, float least) {
    return clamp((cover - edge) / max(fwidth(cover), least) + 0.5, 0.0, 1.0);
}

uniform float solid_from;  // coverage from which on what is there is opaque

const vec4 BAYER = vec4(0.125, 0.625, 0.875, 0.375);  // thresholds of two by two samples of a pixel

// Coverage from which on a sample is covered: those side by side have different ones, and each thing has its own order of them.
float threshold_of(float own) {
    ivec2 sample_at = ivec2(gl_FragCoord.xy) & 1;
    return fract(BAYER[2 * sample_at.y + sample_at.x] + own);
}

const float OWN_ORDER = 0.618034;  // golden section: by it, numbers one after another are spread evenly

// Leaves out what the other way draws.
void must_cover(float cover) {
#ifdef SOFT
    if (cover >= solid_from || cover < FAINTEST)
        discard;
#elif defined(SAMPLED)
    if (cover <= threshold_of(OWN_ORDER * float(gl_PrimitiveID / 2)))
        discard;
#else
    if (cover < solid_from)
        discard;
#endif
}

// What is drawn of a colour as it is shown.
vec4 covered(vec3 shown, float cover) {
#ifdef SOFT
    return vec4(shown, 1.0) * cover;
#else
    return vec4(shown, 1.0);
#endif
}

vec4 drawn(vec3 radiance, float cover) {
    return covered(shown_of(radiance), cover);
}
