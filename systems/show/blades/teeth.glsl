// The teeth along the sides of a ribbon: florets of a spike, or the leaves of a twig; and its ligules, narrow petals side by side.
// Where they are too small to be seen, a ribbon has their mean width and brightness.
#include "lib/frame.glsl"

#if defined(LIGULES_TOO) || !defined(SOFT)
#define SIDED  // pixels of soft ribbons with teeth alone know their side by themselves
#endif

const float BETWEEN = 0.3;   // width of the ribbon between teeth, relative to that at their ends
const float ENDS_AT = 0.7;   // place of a tooth's end between the feet of two teeth: they point upwards
const float ROUND_MEAN = 2.0 / 3.0, ROUND_MOMENT = 5.0 / 12.0;  // of x * (2 - x) on [0, 1], which makes teeth round: mean, and that of x times it
const float TOOTHED_WIDER = 1.0 / mix(ROUND_MEAN, 1.0, BETWEEN);  // width at the ends of teeth, relative to the mean
const float TEETH_FROM = 1.2, TEETH_ALL = 3.0;  // spacing of teeth from which on they begin to show, and show fully [pixel]
const float TEETH_NEAREST = 0.1;  // least distance from the eye that counts [m]
const float OUTER = 0.5;     // relative brightness of a tooth's end over that deep between two
const float MEAN_END = mix(ROUND_MOMENT, 0.5, BETWEEN) * TOOTHED_WIDER;  // mean place of the area along teeth, towards their ends

const float SLIT_FROM = 0.25;  // place along ligules from which on slits part them
const float SLIT_TO = 0.3;     // width of slits at the ends, relative to the spacing of ligules
const float SHORTER = 0.2;     // fraction by which the shortest ligule is shorter than the longest
const float LIGULES_WIDER = 1.0 / ((1.0 - 0.5 * SLIT_TO * (1.0 - SLIT_FROM)) * (1.0 - 0.5 * SHORTER));  // width that keeps the mean area
const float ENDS_LACK = 1.0 / 3.0;  // area that round ends lack, relative to half a ligule's width times its width

const float TEETH_OF[ORGANS] = TEETH, LIGULES_OF[ORGANS] = LIGULES;

// Visibility, 0 to 1, of `teeth` teeth along a ribbon of a length [m] at a place.
float teeth_seen(float along, float teeth, vec3 place) {
    return teeth > 0.0 ? smoothstep(TEETH_FROM, TEETH_ALL, pixels_per_metre() * along / teeth / max(distance(place, eye), TEETH_NEAREST)) : 0.0;
}

// Visibility of the outline of an organ of a length and a width [m]: of teeth, above 0, or of ligules, below 0.
float outline_seen(int organ, float along, float across, vec3 place) {
    return teeth_seen(along, TEETH_OF[organ], place) - teeth_seen(across, LIGULES_OF[organ], place);
}
