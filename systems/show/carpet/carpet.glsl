// What the vertices of the carpet tell its pixels; with EDGED, pixels compute themselves what is PER_VERTEX otherwise.
#include "lib/kinds.glsl"
#include "systems/show/carpet/within.glsl"

// OpenGL guarantees only 60 varying components: with many kinds, pixels compute themselves what is a varying for FEW_KINDS.
#if KINDS > 4
#define FEW_KINDS
#else
#define FEW_KINDS WITHIN PASSED
#endif

#ifdef EDGED
#define PER_VERTEX
#define OF_SOIL
#define OF_SLOPE WITHIN PASSED
vec3 place;
PASSED vec3 mesh_place;           // place on the mesh, which is as high as the carpet of uncut grass
WITHIN PASSED float mesh_height;  // height of that over the ground [m]
WITHIN PASSED float mesh_lift;    // the same, as a fraction of the carpet's height on level ground
WITHIN PASSED float skirt;        // drop of the skirt below the border of its piece, as a fraction of the border's height
#else
#define PER_VERTEX WITHIN PASSED
PASSED vec3 place;
#define OF_SOIL FEW_KINDS
#define OF_SLOPE FEW_KINDS
#endif

WITHIN PASSED float mesh_share;  // the carpet's share of the grass, in [0, 1]
OF_SLOPE vec2 rise;              // gradient of the ground along x and z [m/m]
WITHIN PASSED float curvature;   // curvature of the ground along the line of sight [1/m]
WITHIN PASSED float rim_path;    // from rim_path_at
PER_VERTEX float tall;           // height of the carpet [m]
PER_VERTEX float leaf_area;      // leaf area index, seen from the side
PER_VERTEX ByKind met;           // by kind: weight of its image
PER_VERTEX vec3 soil_seen;       // radiance of the soil, without haze
WITHIN PASSED mat4 lit;          // light on the leaves that are met, and what their bending changes: from bundled
#ifdef HEADS
PER_VERTEX ByKind riper;  // by kind: excess of heads over its image, from kinds_met
#endif
FEW_KINDS float stands;         // height of the grass in the wind, as a fraction of that at rest
FEW_KINDS float strips_before;  // mean share of strips above the carpet, along the line of sight
WITHIN PASSED float lowered;    // depth of the carpet below its height where no strips stand [m]
FEW_KINDS float sway;           // displacement of leaves per message of the wind [m]
FEW_KINDS vec2 slow_noise;      // slow noises of the pigment at the leaves that are seen
OF_SOIL float elevation;        // from elevation_index
OF_SOIL vec3 sunlit;            // radiance of the soil without any grass: from the sun
OF_SOIL vec3 skylit;            // and from the sky
OF_SOIL float soil_extinction;  // of sunlight: optical depth for each 1 of leaf area seen from the side
OF_SOIL float soil_through;     // transmittance of the grass for sunlight
OF_SOIL vec3 lush;              // pigment of the understorey, relative to that of the ground between
