// What the vertices of a coarse carpet tell its pixels.
#include "lib/kinds.glsl"
#include "systems/show/carpet/sight.glsl"
#include "systems/show/carpet/within.glsl"

PASSED vec3 place;
WITHIN PASSED float mesh_share;    // the carpet's share of the grass, in [0, 1]
WITHIN PASSED float facing;        // slope of the line of sight to the ground [m/m]
WITHIN PASSED float crest;         // twice the curvature of the ground along the line of sight [1/m]
WITHIN PASSED float crest_deep;    // that times the height of the grass
WITHIN PASSED float crest_leaves;  // optical depth over a crest, by the root of `crest` and the height of a line of sight to the power of 3/2
WITHIN PASSED float outlined_to;   // square of the slope of a line of sight from which on no outline is seen
WITHIN PASSED vec2 in_pixel;       // heights of the lines of sight LINES of a pixel over the outline [m]
WITHIN PASSED float rim_path;      // from rim_path_at
WITHIN PASSED float rim_leaves;    // optical depth over a rim, for a path of 1
WITHIN PASSED ByKind met;          // by kind: weight of its image
#ifdef HEADS
WITHIN PASSED ByKind riper;        // by kind: excess of heads over its image, from kinds_met
#endif
WITHIN PASSED vec2 blown;          // displacement of leaves [m]
WITHIN PASSED float leaning;       // shear of images in proportion to it [1/m], from image_shear
WITHIN PASSED vec2 stretch;        // lengthening of images along the line of sight: its parts in proportion to their slope, and taken off
WITHIN PASSED float elevation;     // from elevation_index
WITHIN PASSED float level;         // mip level of the images
WITHIN PASSED float litter_level;  // that of litter: a pixel covers a long stripe of ground at a low angle, read as if it were as wide
WITHIN PASSED float grain;         // gain of contrast about the mean of images
WITHIN PASSED float past_strips;   // opacity of the grass among strips, from among_strips
WITHIN PASSED float bent_through;  // transmittance of the additional leaves that a line of sight meets in bent grass
WITHIN PASSED vec4 places;         // place along blades and height of leaves: where images show 0, and the rise to where they show 1
WITHIN PASSED vec3 lit_root;       // root of the radiance of a leaf on the ground, by its pigment: as if linear in pigment and height
WITHIN PASSED vec3 root_rise;      // its rise to the top of the canopy
WITHIN PASSED vec3 air_root;       // root of the radiance of a black leaf behind haze and gloss
WITHIN PASSED vec3 soil_seen;      // display colour of the soil, for litter whose brightness is 1
WITHIN PASSED vec2 in_shade;       // brightness in the shade of a game's own, relative to the sun: of leaves, of the soil

const float CONTRAST = 1.3;  // gain of contrast: several kinds are lit as one, and differ as much as if each were lit
const vec2 LINES = vec2(-0.25, 0.25);  // lines of sight that sample a pixel, as fractions of its height
const float BARE_LEAVES = OPAQUE / (LOWEST_GRASS * sqrt(LOWEST_GRASS));  // value of `crest_leaves` for bare ground, which is its own outline
