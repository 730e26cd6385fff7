// The two ways in which what covers a pixel in part is drawn: opaque where it covers nearly all of it, and blended over that
// and all else where it covers less.

#include "systems/trees/wood.py"

// Leaves out what the other way draws.
void must_cover(float cover) {
#ifdef SOFT
    if (cover >= OPAQUE || cover < FAINTEST)
        discard;
#else
    if (cover < OPAQUE)
        discard;
#endif
}

vec4 drawn(vec3 radiance, float cover) {
#ifdef SOFT
    return vec4(shown_of(radiance), 1.0) * cover;
#else
    return vec4(shown_of(radiance), 1.0);
#endif
}
