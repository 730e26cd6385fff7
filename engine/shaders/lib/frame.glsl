// What every program knows of a frame, and of the kinds of grass.
#include "systems/frame/block.py"
#include "lib/kinds.glsl"
#include "lib/least.glsl"

// Pixels up the picture that a metre takes a metre off.
float pixels_a_metre() {
    return half_screen.y * length(vec3(clip[0].y, clip[1].y, clip[2].y));
}

// How much is to be added to depth in clip space, of that of the usual one, to lie so much farther off.
float farther_by(float depth) {
    return 0.5 * (depth_ends.y - depth_ends.x) * depth;
}

// The depth of a place in clip space, as a framebuffer has it.
float depth_of(vec4 at) {
    float from = min(depth_ends.x, depth_ends.y);
    return gl_DepthRange.near + gl_DepthRange.diff * (at.z / at.w - from) / abs(depth_ends.y - depth_ends.x);
}
