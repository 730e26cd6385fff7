// Blends the picture over what the host has drawn: filtered, but never over an edge of that.

#include "engine/gl/smaller.glsl"

const float APART = 0.1;  // depths that differ by this part of their way to infinity are two things'

out vec4 pixel;

void main() {
    vec2 place = place_in_it();
    float depth = texelFetch(before, ivec2(gl_FragCoord.xy) - corner, 0).r;
    ivec2 own = min(ivec2(place), size - 1);
    ivec2 next = clamp(own + ivec2(sign(place - vec2(own) - 0.5)), ivec2(0), size - 1);
    ivec2 around[4] = ivec2[4](own, ivec2(next.x, own.y), ivec2(own.x, next.y), next);
    ivec2 alike = own;
    float least = 2.0, most = 0.0;
    for (int k = 0; k < 4; k++) {
        float apart = abs(depth_before(around[k]) - depth);
        alike = apart < least ? around[k] : alike;
        least = min(least, apart);
        most = max(most, apart);
    }
    float edge = APART * (1.0 - depth);
    bool thin = least > edge && texelFetch(deep, alike, 0).r > depth;  // something that the smaller picture lacks
    pixel = most <= edge ? sharp(place) : thin ? vec4(0.0) : texelFetch(picture, alike, 0);
}
