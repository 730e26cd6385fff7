// The teeth along the sides of a ribbon: florets of a spike, or the leaves of a twig. Where they are too small to be seen,
// a ribbon is as wide and as bright as it is with them in the mean.
#include "lib/frame.glsl"

const float BETWEEN = 0.4;  // how wide it is between teeth, of how wide it is at their ends
const float ENDS_AT = 0.7;   // where they end, on the way from one to the next: they point upwards
const float TOOTHED_WIDER = 2.0 / (1.0 + BETWEEN);  // how wide it is at their ends, of the mean
const float TEETH_FROM = 1.2, TEETH_ALL = 3.0;  // pixels from one to the next from which on they are seen, and all of them
const float TEETH_NEAREST = 0.1;  // distance from the eye that counts at least [m]
const float OUTER = 0.5;     // how much brighter a tooth is at its end than deep between two
const float MEAN_END = (0.5 * BETWEEN + (1.0 - BETWEEN) / 3.0) * TOOTHED_WIDER;  // how far out on teeth its area is, in the mean

const float TEETH_OF[ORGANS] = TEETH;

// How much is seen of so many teeth along a ribbon of some length [m] at a place.
float teeth_seen(float along, float teeth, vec3 place) {
    return teeth > 0.0 ? smoothstep(TEETH_FROM, TEETH_ALL, pixels_a_metre() * along / teeth / max(distance(place, eye), TEETH_NEAREST)) : 0.0;
}
