// Layers of an array texture. With STACK, each of its layers holds that many of ours, one above the other, where GL has too few. With
// REPEATED, ours wrap round vertically.
#ifdef STACK
vec4 layer_at(sampler2DArray from, vec3 at, float level) {
    float rows = float(textureSize(from, 0).y) / float(STACK);
    float edge = 0.5 * exp2(clamp(floor(level + 0.5), 0.0, log2(rows))) / rows; // half a texel: beyond it is another layer
#ifdef REPEATED
    at.y = fract(at.y);
#endif
    float up = (mod(at.z, float(STACK)) + clamp(at.y, edge, 1.0 - edge)) / float(STACK);
    return textureLod(from, vec3(at.x, up, floor(at.z / float(STACK))), level);
}

vec4 layer_mean(sampler2DArray from, int layer, int coarsest) {
    return texelFetch(from, ivec3(0, layer % STACK, layer / STACK), coarsest);
}
#else
vec4 layer_at(sampler2DArray from, vec3 at, float level) {
    return textureLod(from, at, level);
}

vec4 layer_mean(sampler2DArray from, int layer, int coarsest) {
    return texelFetch(from, ivec3(0, 0, layer), coarsest);
}
#endif
