// Heights of the terrain, bilinear as systems sample them; hardware filters are too coarse for that.
#include "lib/frame.glsl"
#include "systems/land/heights.py"

uniform sampler2D heights;

// Where on the terrain a place lies, from its corner [m]. With MIRRORED it goes on beyond its edge as in a mirror.
vec2 on_terrain(vec2 place) {
#ifdef MIRRORED
    return terrain_size - abs(terrain_size - mod(place - terrain_origin, 2.0 * terrain_size));
#else
    return place - terrain_origin;
#endif
}

float height_at(vec2 place) {
    ivec2 last = textureSize(heights, 0) - 1;
    vec2 cell = clamp(on_terrain(place) / terrain_cell, vec2(0.0), vec2(last));
    ivec2 low = min(ivec2(cell), last - 1);
    vec2 part = cell - vec2(low);
    float a = texelFetch(heights, low, 0).r, b = texelFetch(heights, low + ivec2(1, 0), 0).r;
    float c = texelFetch(heights, low + ivec2(0, 1), 0).r, d = texelFetch(heights, low + ivec2(1, 1), 0).r;
    return mix(mix(a, b, part.x), mix(c, d, part.x), part.y);
}

// The same as a texture's filter has it, within 1/256 of what a cell rises by: one sample, for who asks often.
float height_near(vec2 place) {
    vec2 on = clamp(on_terrain(place) / terrain_size, 0.0, 1.0), size = vec2(textureSize(heights, 0));
    return textureLod(heights, (on * (size - 1.0) + 0.5) / size, 0.0).r;
}

// Whether a sample of the terrain is one of a hole: the last bit of its height says so.
float hole(float height) {
    return float(floatBitsToUint(height) & uint(HOLE));
}

// Whether there is no ground at a place. Grass ends there: only programs that know edges, and those that tell receivers how
// densely grass grows, ask. They have read the same texels for the height.
bool is_hole(vec2 place) {
#if defined(EDGED) || defined(RECEIVES)
    ivec2 last = textureSize(heights, 0) - 1;
    vec2 cell = clamp((place - terrain_origin) / terrain_cell, vec2(0.0), vec2(last));
    ivec2 low = min(ivec2(cell), last - 1);
    vec2 part = cell - vec2(low);
    float a = hole(texelFetch(heights, low, 0).r), b = hole(texelFetch(heights, low + ivec2(1, 0), 0).r);
    float c = hole(texelFetch(heights, low + ivec2(0, 1), 0).r), d = hole(texelFetch(heights, low + ivec2(1, 1), 0).r);
    return mix(mix(a, b, part.x), mix(c, d, part.x), part.y) > 0.5;
#else
    return false;
#endif
}
