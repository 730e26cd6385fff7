// The frame block and the kinds of grass, for every program.
#include "systems/frame/block.py"
#include "lib/kinds.glsl"
#include "lib/least.glsl"

// Height in the picture of one metre seen from one metre away [pixels].
float pixels_per_metre() {
    return half_screen.y * length(vec3(clip[0].y, clip[1].y, clip[2].y));
}

// Height of a pixel at a place [m].
float pixel_height(vec3 place) {
    return distance(place, eye) / pixels_per_metre();
}

// Offset of z / w that moves something back by `depth`, which is given for the usual clip range of -1 to 1.
float depth_offset(float depth) {
    return 0.5 * (depth_ends.y - depth_ends.x) * depth;
}

// The window depth of a place in clip space.
float window_depth(vec4 at) {
    float from = min(depth_ends.x, depth_ends.y);
    return gl_DepthRange.near + gl_DepthRange.diff * (at.z / at.w - from) / abs(depth_ends.y - depth_ends.x);
}
