// What the vertices of a ribbon tell its pixels.
centroid PASSED vec3 color;  // with several samples a pixel, a sample beyond a ribbon's edge would extrapolate it
flat PASSED float shown;
#ifdef FOLDS
centroid PASSED vec3 keel;  // radiance of a fold's right face above the mean of both
#endif
#ifdef TOOTHED
#include "systems/show/blades/teeth.glsl"

flat PASSED float outlined;     // visibility of teeth, above 0, or of ligules, below 0
flat PASSED vec2 tooth_widths;  // width between teeth, and how much more it is at their ends, relative to the drawn width
PASSED float tooth;             // number of the tooth, from the root on; or the place along ligules
#ifdef SIDED
PASSED vec2 tooth_side;  // teeth: side, -1 to 1; 1. Ligules: number of the ligule, from the middle on, times the width; relative width
#endif
#endif
#ifdef SOFT
#ifndef EDGE
#define EDGE 0.5  // half the width of soft edges: that of a pixel
#endif
noperspective PASSED float aside;       // distance from the middle line, positive to the right [pixel]
noperspective PASSED float half_width;  // of the ribbon [pixel]
#ifdef ORGANS
noperspective PASSED float onward;  // distance from the ribbon's middle along it [pixel]
flat PASSED float half_length;      // of the ribbon [pixel]
#endif
#ifdef PARTED
flat PASSED float hides;  // coverage from which on a pixel hides what is behind it
uniform int part;         // 1: pixels that hide what is behind them; 2: the others
#endif
#endif
#ifdef DEEP
flat PASSED int number;
#else
flat PASSED vec2 veined;  // visibility of its rib, and of its veins
#ifndef SOFT
PASSED vec2 across;  // place across it, -1 to 1, times its width; its width
#endif
#endif
