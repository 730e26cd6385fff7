// Tells of each tile of the smaller picture whether anything in it has depth.

#include "engine/gl/smaller.glsl"
#include "engine/gl/smaller.py"

out vec4 pixel;

void main() {
    ivec2 first = ivec2(gl_FragCoord.xy) * TILE, last = textureSize(small_depth, 0) - 1;
    bool is_deep = false;
    for (int up = 0; up < TILE; up++)
        for (int across = 0; across < TILE; across++)
            is_deep = is_deep || is_drawn(texelFetch(small_depth, min(first + ivec2(across, up), last), 0).r);
    pixel = vec4(is_deep ? TILE_DEEP : TILE_FLAT);
}
