// The teeth along the sides of a ribbon: florets of a spike, or the leaves of a twig. Where they are too small to be seen,
// a ribbon is as wide and as bright as it is with them in the mean.
const float BETWEEN = 0.25;  // how wide it is between teeth, of how wide it is at their ends
const float ENDS_AT = 0.7;   // where they end, on the way from one to the next: they point upwards
const float TOOTHED_WIDER = 2.0 / (1.0 + BETWEEN);  // how wide it is at their ends, of the mean
const float TEETH_FROM = 1.5, TEETH_ALL = 4.0;  // pixels from one to the next from which on they are seen, and all of them
const float OUTER = 0.5;     // how much brighter a tooth is at its end than deep between two
const float MEAN_END = (0.5 * BETWEEN + (1.0 - BETWEEN) / 3.0) * TOOTHED_WIDER;  // how far out on teeth its area is, in the mean
