// What every program knows of a frame: the fields of FRAME in systems/frame/block.py, in the same order. There is room for
// as many kinds as there can be, MOST_KINDS in engine/declared/grass.py.
#include "lib/kinds.glsl"

layout(std140) uniform Frame {
    mat4 clip;        // world to clip space
    mat4 unclip;      // clip space to world
    vec4 eye;         // eye [m]
    vec4 sun;         // direction to the sun; 1 where raw radiance is written
    vec4 sunlight;    // radiance of a white leaf in full sun; how much of the sky has clouds
    vec4 skylight;    // radiance of a white leaf under the whole sky; 1 / haze distance [1/m]
    vec4 zenith;      // radiance overhead; height that no blade comes to [m]
    vec4 horizon[3];  // radiance of horizon and haze, by powers of the cosine of the azimuth from the sun
    vec4 drift;       // where the clouds have drifted to, in their own sides; the sun's azimuth as a direction (x, z)
    vec4 shades[8];   // of bodies that cast shadows: middle, radius [m]; radius 0 where there is none
    vec4 shaped[8];   // of the same: axis; how much longer it would have to be along it to be a ball
    vec4 soil;        // pigment of bare ground; patch side [m]
    vec4 terrain;     // origin x, z [m]; metres per cell; posture links
    vec4 field;       // size x, z [m]; posture rows; variants per kind
    vec4 screen;      // pixels from the middle to the edge, across and up
    vec4 crown[4];    // by kind, four in each: height of the canopy [m]
    vec4 leaf[4];     // by kind, four in each: leaf area seen from the side, of the ground's area
    vec4 lying[4];    // by kind, four in each: leaf area seen from above, of that from the side
    vec4 understorey[4]; // by kind, four in each: how much of the ground low leaves cover, of what they cover at most
    vec4 undertone[4]; // by kind, four in each: how much of the colour of tips low leaves have
    vec4 root[16];    // by kind: pigment at the root; gloss
    vec4 tip[16];     // by kind: pigment at the tip; taper
    vec4 through[16]; // by kind: light that a leaf lets through, of what it sends back; how much has the tip's pigment
    vec4 grain_c[16]; // by kind: relative change of pigment with the cosine of twice the face normal's azimuth; how far a face's sides are lit apart
    vec4 grain_s[16]; // by kind: the same with the sine; how much narrower it is at its root, below 0 where it is round
    vec4 give[68];    // by four kinds, by length of a message, evenly from 0 to 1: posture index that it bends the kinds to
};
