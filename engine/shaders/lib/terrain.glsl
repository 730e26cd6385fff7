// Heights of the terrain, bilinear as systems sample them; hardware filters are too coarse for that.
#include "lib/frame.glsl"

uniform sampler2D heights;

float height_at(vec2 place) {
    ivec2 last = textureSize(heights, 0) - 1;
    vec2 cell = clamp((place - terrain_origin) / terrain_cell, vec2(0.0), vec2(last));
    ivec2 low = min(ivec2(cell), last - 1);
    vec2 part = cell - vec2(low);
    float a = texelFetch(heights, low, 0).r, b = texelFetch(heights, low + ivec2(1, 0), 0).r;
    float c = texelFetch(heights, low + ivec2(0, 1), 0).r, d = texelFetch(heights, low + ivec2(1, 1), 0).r;
    return mix(mix(a, b, part.x), mix(c, d, part.x), part.y);
}

// Whether there is no ground at a place.
bool is_hole(vec2 place) {
#ifdef HOLES
    ivec2 last = textureSize(heights, 0) - 1;
    vec2 cell = clamp((place - terrain_origin) / terrain_cell, vec2(0.0), vec2(last));
    ivec2 low = min(ivec2(cell), last - 1);
    vec2 part = cell - vec2(low);
    float a = texelFetch(heights, low, 0).g, b = texelFetch(heights, low + ivec2(1, 0), 0).g;
    float c = texelFetch(heights, low + ivec2(0, 1), 0).g, d = texelFetch(heights, low + ivec2(1, 1), 0).g;
    return mix(mix(a, b, part.x), mix(c, d, part.x), part.y) > 0.5;
#else
    return false;
#endif
}
