// Twigs leaf by leaf, also as they are baked.
#include "lib/light.glsl"
#include "systems/trees/leaf.glsl"
#include "systems/trees/coverage.glsl"

in vec2 on;
#ifdef BAKED
in vec3 facing;
in vec4 inside;
flat in vec2 part;

layout(location = 0) out vec4 pixel;
layout(location = 1) out vec4 second;
#else
in float stem_cover;
flat in vec3 leaf_colour;
flat in vec3 midrib_colour;

out vec4 pixel;
#endif

const float VEIN = 0.05;  // width of a leaf's midrib

void main() {
    float ribbed = smoothstep(0.0, VEIN, abs(on.x)), cover = leaf_cover(on);  // called in all pixels, as it takes derivatives
#ifdef BAKED
    bool stem = part.y >= 0.0;
    float in_part = stem ? 1.0 - part.y * on.y - abs(on.x) : cover - 0.5;
    if (min(in_part, 1.0 - on.y) <= 0.0)  // its triangle is larger
        discard;
    float tone = mix(RIBBED, 1.0, ribbed);
#ifdef OF_TREE
    pixel = vec4(part.x * tone, 0.0, 0.0, 1.0);  // tone, wood and its radius
    second = packed_shading(inside);
#else
    pixel = vec4(part.x * tone, stem ? 0.0 : tone, 0.0, 1.0);  // tone, and the tone if all leaves had a tone of 1
    second = vec4(0.5 + 0.5 * normalize(facing), 1.0);
#endif
#else
    cover = stem_cover < 0.0 ? cover : stem_cover;
    discard_uncovered(cover);
    pixel = blend_colour(mix(midrib_colour, leaf_colour, ribbed), cover);
#endif
}
