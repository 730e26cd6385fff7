// What every program knows of a frame: the fields of FRAME in systems/frame/block.py, in the same order.
layout(std140) uniform Frame {
    mat4 clip;        // world to clip space
    mat4 unclip;      // clip space to world
    vec4 eye;         // eye [m]
    vec4 sun;         // direction to the sun; strength
    vec4 zenith;      // display colour overhead
    vec4 haze;        // display colour of the horizon; 1 / haze distance [1/m]
    vec4 glow;        // display colour of the sun's glow
    vec4 soil;        // display colour of bare ground in this light; patch side [m]
    vec4 terrain;     // origin x, z [m]; metres per cell; posture links
    vec4 field;       // size x, z [m]; posture rows; variants per kind
    vec4 screen;      // pixels from the middle to the edge, across and up
    vec4 root[4];     // by kind: display colour at the root in this light; canopy height [m]
    vec4 tip[4];      // by kind: display colour at the tip in this light; taper
    vec4 grain_x[4];  // by kind: relative change of colour with a face normal's x
    vec4 grain_z[4];  // by kind: the same with z
    vec4 give[17];    // by length of a message, evenly from 0 to 1: posture index that it bends the kinds to
};
