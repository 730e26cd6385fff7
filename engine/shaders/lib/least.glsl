// Lower bounds of divisors and of arguments of roots; too small to be seen.
const float LEAST_PART = 1e-3;    // part of a whole, sum of parts, or optical depth
const float LEAST_WIDTH = 1e-4;   // change from pixel to pixel, as a part; sine of an angle
const float LEAST_LENGTH = 1e-6;  // length [m], or square of one
const float LEAST_SQUARE = 1e-9;  // square of a length [m2] that may itself be short, or such a length
