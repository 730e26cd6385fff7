// A tree: its message of the wind, the sun past all but trees, the haze in front, the grass about it, and its trunk's displacement.
#include "systems/trees/tree.glsl"

uniform sampler2D tree_air;  // messages of the patches around the viewer, wrapping round
uniform sampler2D tree_mean; // the mean message is in its last row
uniform vec2 middle;         // of the viewer's patch [m]
in float crown_at;           // height of its crown's middle over its root [m]
in float hertz;              // frequency of its trunk [Hz]

out vec4 out_wind_response;  // inputs of tree.glsl
out vec4 out_haze;
out vec4 out_grass;
out vec3 out_light_from_grass;

const vec3 TRUNK_ASIDE = vec3(TRUNK_SIDEWAYS, TRUNK_ACROSS, 0.37);  // of the trunk across the wind: amplitude and frequency, relative to those along it; phase
const vec2 GRASS_REFLECTS = vec2(0.5, 0.55);  // part of the sun's and of the sky's light that grass reflects, with its gaps
const float GRASS_TONE_AT = 0.7;  // height on its blades whose pigment is seen from above
const float LOWEST_LIGHT = 0.12;  // least sine of the sun's elevation for that light

// Displacement of the trunk's top, relative to its height.
vec2 sway_of_trunk(vec2 message) {
    vec2 aside = vec2(-message.y, message.x);
    float across = swing(hertz * TRUNK_ASIDE.y, phase + TRUNK_ASIDE.z);
    return message * (TRUNK_LEANS + TRUNK_SWINGS * swing(hertz, phase)) + aside * (TRUNK_ASIDE.x * TRUNK_SWINGS * across);
}

// Light reflected by the grass about a tree, as radiance of a white face that looks down.
vec3 reflected_light() {
    vec3 grass = pigment_at(0, GRASS_TONE_AT);
    return grass * grass * (GRASS_REFLECTS.x * sunlight * max(sun.y, LOWEST_LIGHT) + GRASS_REFLECTS.y * skylight);
}

// Message of the wind where it stands, as the carpet receives it.
vec2 message_here() {
    float side = float(textureSize(tree_air, 0).x) * patch_side;
    vec2 apart = abs(root.xz - middle) / side;
    float far = smoothstep(AIR_FADES.x, AIR_FADES.y, max(apart.x, apart.y));
    return mix(textureLod(tree_air, root.xz / side, 0.0).xy, texelFetch(tree_mean, ivec2(0, textureSize(tree_mean, 0).y - 1), 0).xy, far);
}

void main() {
    vec3 place = root + vec3(0.0, crown_at, 0.0);
    vec2 wind_message = message_here();
    out_wind_response = vec4(wind_message, sway_of_trunk(wind_message));
    out_haze = vec4(haze_radiance(place), haze_opacity(place));
    ByKind area = leaf_areas(density_at(root.xz));
    float leaves = total(area), high = 0.0;
    for (int group = 0; group < GROUPS; group++)
        high += dot(area[group], crown[group]);
    float sun_seen = sun_visibility(place, lie_at(root.xz).visibility);
    out_grass = vec4(max(high / max(leaves, LEAST_PART), LOWEST_CROWN), leaves, sun_extinction(0, sun.y), sun_seen);
    out_light_from_grass = reflected_light();
    gl_Position = vec4(0.0, 0.0, 0.0, 1.0);
}
