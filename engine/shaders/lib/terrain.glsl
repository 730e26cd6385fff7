// Heights of the terrain, interpolated bilinearly, as numpy's are; hardware filters are too coarse for that.
#include "lib/frame.glsl"
#include "systems/land/heights.py"

uniform sampler2D heights;

// A place from the terrain's corner [m]. With MIRRORED, the terrain is mirrored beyond its edges.
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

// Height by the hardware's filter: one sample, exact to 1/256 of the rise of a cell.
float height_filtered(vec2 place) {
    vec2 on = clamp(on_terrain(place) / terrain_size, 0.0, 1.0), size = vec2(textureSize(heights, 0));
    return textureLod(heights, (on * (size - 1.0) + 0.5) / size, 0.0).r;
}

// 1 for a sample of the terrain in a hole: the last bit of its height.
float hole_bit(float height) {
    return float(floatBitsToUint(height) & uint(HOLE));
}

// Whether a place is in a hole, where grass ends. Only programs with EDGED or RECEIVES test it; they read the same texels for the
// height anyway.
bool is_hole(vec2 place) {
#if defined(EDGED) || defined(RECEIVES)
    ivec2 last = textureSize(heights, 0) - 1;
    vec2 cell = clamp((place - terrain_origin) / terrain_cell, vec2(0.0), vec2(last));
    ivec2 low = min(ivec2(cell), last - 1);
    vec2 part = cell - vec2(low);
    float a = hole_bit(texelFetch(heights, low, 0).r), b = hole_bit(texelFetch(heights, low + ivec2(1, 0), 0).r);
    float c = hole_bit(texelFetch(heights, low + ivec2(0, 1), 0).r), d = hole_bit(texelFetch(heights, low + ivec2(1, 1), 0).r);
    return mix(mix(a, b, part.x), mix(c, d, part.x), part.y) > 0.5;
#else
    return false;
#endif
}
