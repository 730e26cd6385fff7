// With multisampling, a pixel's centre may lie outside of a triangle, where extrapolated varyings are wrong, badly so over a crest. So all
// are taken WITHIN it, except the place, whose derivatives are needed.
#if KINDS > 15  // a separate varying for the place would exceed the guaranteed components with so many kinds
#define WITHIN
#else
#define WITHIN centroid
#endif
