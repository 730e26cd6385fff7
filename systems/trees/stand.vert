// What is the same all over a tree: what the wind tells it, how much of the sun is seen past all but trees, the haze before it, the
// grass that it stands in.
#include "systems/trees/tree.glsl"

uniform sampler2D tree_air;   // by patch around the viewer, wrapping round: what the wind tells it
uniform sampler2D tree_mean;  // their mean
uniform vec2 middle;          // of the patch that the viewer stands on [m]
in float crown_at;            // height of its crown's middle over its root [m]

out vec2 told;
out float open;
out vec4 veil;
out vec2 stands_in;

// What the wind tells the place where it stands, as the carpet is told.
vec2 message_here() {
    float side = float(textureSize(tree_air, 0).x) * patch_side;
    vec2 apart = abs(root.xz - middle) / side;
    float far = smoothstep(AIR_FADES.x, AIR_FADES.y, max(apart.x, apart.y));
    return mix(textureLod(tree_air, root.xz / side, 0.0).xy, texelFetch(tree_mean, ivec2(0), 0).xy, far);
}

void main() {
    vec3 place = root + vec3(0.0, crown_at, 0.0);
    told = message_here();
    open = sun_seen(place, lie_at(root.xz).past);
    veil = vec4(haze_light(place), haze_at(place));
    ByKind area = areas(grows_at(root.xz));
    float leaves = total(area), high = 0.0;
    for (int group = 0; group < GROUPS; group++)
        high += dot(area[group], crown[group]);
    stands_in = vec2(max(high / max(leaves, LEAST_PART), LOWEST_CROWN), leaves);
    gl_Position = vec4(0.0, 0.0, 0.0, 1.0);
}
