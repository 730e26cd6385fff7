// The teeth along the sides of a ribbon: florets of a spike, or the leaves of a twig; and its ligules, narrow petals beside one
// another. Where they are too small to be seen, a ribbon is as wide and as bright as it is with them in the mean.
#include "lib/frame.glsl"

const float BETWEEN = 0.4;  // how wide it is between teeth, of how wide it is at their ends
const float ENDS_AT = 0.7;   // where they end, on the way from one to the next: they point upwards
const float TOOTHED_WIDER = 2.0 / (1.0 + BETWEEN);  // how wide it is at their ends, of the mean
const float TEETH_FROM = 1.2, TEETH_ALL = 3.0;  // pixels from one to the next from which on they are seen, and all of them
const float TEETH_NEAREST = 0.1;  // distance from the eye that counts at least [m]
const float OUTER = 0.5;     // how much brighter a tooth is at its end than deep between two
const float MEAN_END = (0.5 * BETWEEN + (1.0 - BETWEEN) / 3.0) * TOOTHED_WIDER;  // how far out on teeth its area is, in the mean

const float SLIT_FROM = 0.25;  // of the way along ligules, from where on there are slits between them
const float SLIT_TO = 0.3;     // how wide slits are at the ends, of the way from one ligule to the next
const float SHORTER = 0.2;     // how much shorter the shortest is than the longest
const float LIGULES_WIDER = 1.0 / ((1.0 - 0.5 * SLIT_TO * (1.0 - SLIT_FROM)) * (1.0 - 0.5 * SHORTER));  // for as much to be left of it

const float TEETH_OF[ORGANS] = TEETH, LIGULES_OF[ORGANS] = LIGULES;

// How much is seen of so many teeth along a ribbon of some length [m] at a place.
float teeth_seen(float along, float teeth, vec3 place) {
    return teeth > 0.0 ? smoothstep(TEETH_FROM, TEETH_ALL, pixels_per_metre() * along / teeth / max(distance(place, eye), TEETH_NEAREST)) : 0.0;
}

// How much is seen of what the outline of an organ of some length and width [m] is like: above 0 of teeth, below 0 of ligules.
float outline_seen(int organ, float along, float across, vec3 place) {
    return teeth_seen(along, TEETH_OF[organ], place) - teeth_seen(across, LIGULES_OF[organ], place);
}
