// Squares that repeat over the land: the clouds', and what lies on the ground. `systems/light/repeating.py` makes them.
uniform sampler2D repeating;  // how dense clouds are; root of how bright the ground is, and where low leaves cover it

const float CLOUDS_SIDE = 900.0;  // side of the square of clouds [m]
const float LITTER_SIDE = 1.8;  // side of the square of ground [m]
