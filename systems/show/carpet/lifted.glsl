// Where the carpet lies higher or lower than a share of the grass's height.
#include "systems/show/carpet/laid.glsl"

const float UNEVENNESS = 0.4;  // amplitude, as a fraction of the grass's height
const vec4 UNEVEN_WAVES = vec4(5.3, 4.7, 0.2, 0.7);  // [1/m], along x, along z, and across the latter; phase

// Unevenness of the carpet where it gives way to strips, as a fraction of the grass's height. Over an even carpet, a row of strips would
// come out all at once; so it does here and there.
float uneven(vec2 at) {
    return UNEVENNESS * sin(UNEVEN_WAVES.x * at.x + UNEVEN_WAVES.w) * sin(UNEVEN_WAVES.y * at.y + UNEVEN_WAVES.z * at.x);
}

// Raise of the carpet along an outline [m]: to the tops of the tallest kinds, and by half a pixel, in which coverage fades.
float outline_height(Laid laid, vec3 place) {
#ifdef EDGED
    return 0.0;
#else
    float tops = (laid.tops - 1.0) * laid.tall * HIGHER_OUTLINE;
    return laid.rim_path < NO_RIM || over_hosts > 0.0 ? 0.0 : laid.share * laid.crest_weight * (tops + 0.5 * pixel_height(place));
#endif
}

// The grass at a place of the ground; the place is raised to the uneven carpet with its outlines.
Laid lifted_on(inout vec3 place) {
    Laid laid = laid_on(place);
    float moved = laid.share * (1.0 - laid.share) * laid.tall * uneven(place.xz);
    place.y += moved + outline_height(laid, place);
    laid.lowered -= moved;
    return laid;
}
