// Of several samples a pixel, its middle may lie beyond the edge of a tile, where what corners bring along has any value: over a
// crest, that is wild. So all but the place is that of somewhere WITHIN; the place tells how far it is to the next pixel.
#if KINDS > 15  // with a vector for the place alone, not all numbers of so many kinds are sure to come through
#define WITHIN
#else
#define WITHIN centroid
#endif
