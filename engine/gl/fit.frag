// Blends the picture over what the host has drawn, upsampled without crossing edges in the host's depth.

#include "engine/gl/smaller.glsl"

const float APART = 0.1;  // least difference in depth between two things, as a fraction of the depth's distance to the farthest

out vec4 pixel;

void main() {
    float depth = texture(host_depth, at).r;
    vec2 nearest = pixel_centre(at), next = clamp(nearest + sign(at - nearest) * texel, 0.5 * texel, 1.0 - 0.5 * texel);
    vec2 around[4] = vec2[4](nearest, vec2(next.x, nearest.y), vec2(nearest.x, next.y), next);
    vec2 closest = nearest;  // in depth
    float least = 2.0, most = 0.0;
    for (int k = 0; k < 4; k++) {
        float difference = abs(texture(host_depth, around[k]).r - depth);
        closest = difference < least ? around[k] : closest;
        least = min(least, difference);
        most = max(most, difference);
    }
    float edge = APART * abs(farthest - depth);
    bool thin = least > edge && farther_by(texture(small_depth, closest).r, depth) > 0.0;  // a thing that the smaller picture lacks
    pixel = most <= edge ? upsampled(at) : thin ? vec4(0.0) : texture(small_color, closest);
}
