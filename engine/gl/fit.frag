// Blends the picture over what the host has drawn: filtered, but never over an edge of that.

#include "engine/gl/smaller.glsl"

const float APART = 0.1;  // depths that differ by this part of their way to infinity are two things'

out vec4 pixel;

void main() {
    float depth = texture(before, at).r;
    vec2 own = middle_of(at), next = clamp(own + sign(at - own) * unit, 0.5 * unit, 1.0 - 0.5 * unit);
    vec2 around[4] = vec2[4](own, vec2(next.x, own.y), vec2(own.x, next.y), next);
    vec2 alike = own;
    float least = 2.0, most = 0.0;
    for (int k = 0; k < 4; k++) {
        float apart = abs(texture(before, around[k]).r - depth);
        alike = apart < least ? around[k] : alike;
        least = min(least, apart);
        most = max(most, apart);
    }
    float edge = APART * abs(farthest - depth);
    bool thin = least > edge && behind(texture(deep, alike).r, depth) > 0.0;  // something that the smaller picture lacks
    pixel = most <= edge ? sharp(at) : thin ? vec4(0.0) : texture(picture, alike);
}
