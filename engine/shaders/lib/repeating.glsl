// Squares that repeat over the land: the clouds', and what lies on the ground.
#include "systems/light/repeating.py"

uniform sampler2D repeating;  // how dense clouds are; root of how bright the ground is, and where low leaves cover it
