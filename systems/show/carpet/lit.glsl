// Light on what is met of the carpet, in the mean over the kinds, and how the wind bends it.
#include "lib/light.glsl"
#include "lib/shares.glsl"
#include "lib/posture.glsl"
#include "systems/show/carpet/bent.glsl"
#include "systems/show/carpet/sight.glsl"

uniform sampler2D air;  // the wind's message in the middle of each patch, wrapping round
uniform sampler2D mean_air;

struct Canopy {
    Light light;  // on the leaves of the kinds that are met
    vec3 bent;    // how what is met changes as they are bent: of bent_to
    vec2 sway;    // how far they are moved by that [m]
};

const float SWAYS = 0.35;  // how far leaves are moved that are seen, of the canopy's height and the posture index
const vec2 LAID = vec2(0.96, 0.22);  // sine of how far blades lie over, of their posture index; less that by the index's square
const vec2 FAR_AIR = vec2(0.35, 0.48);  // from where to where the mean message takes over, of the width of what is asked

// How leaves of a kind lean that is bent so, for their height at rest.
vec3 leaning(vec2 bend) {
    vec2 leans = bend * (LAID.x - LAID.y * dot(bend, bend));
    return vec3(leans, lodged(bend)).xzy;
}

// The pigment of what is met of a kind that leans so, of that where it stands upright.
vec3 turned_to(int kind, vec3 lean, vec3 ray) {
    return azimuth_tint(kind, seen_azimuth(kind, lean, ray) - seen_azimuth(kind, vec3(0.0, 1.0, 0.0), ray));
}

// The slow noises of the pigment where leaves are seen: the mean of nearer and farther ones.
vec2 slow_seen(vec3 there, float slope, float tall) {
    vec2 apart = heading_to(there.xz) * min(SPREAD * ground_spread(slope, tall), FARTHEST_SEEN);
    return 0.5 * (slow_noise_at(there.xz - apart) + slow_noise_at(there.xz + apart));
}

// The wind's message; far off, where nobody asks for it, the mean of those nearer by.
vec2 message_at(vec2 at) {
    vec2 on = at * (patches_per_metre * windows_per_patch), apart = abs(on - (carpet_window.xy + 0.5) * windows_per_patch);
    float far = smoothstep(FAR_AIR.x, FAR_AIR.y, max(apart.x, apart.y));
    return mix(textureLod(air, on, 0.0).xy, texelFetch(mean_air, ivec2(0), 0).xy, far);
}

// The light there on each kind as its message has bent it, in the mean of all that are met.
Canopy canopy_lit(ByKind met, float slope, float on_level, vec3 there, Lie lies, vec2 messages[KINDS]) {
    ByKind grows = density_at(there.xz);
    Canopy sum = Canopy(Light(vec3(0.0), vec3(0.0), vec3(0.0), 0.0, 0.0, vec2(0.0)), vec3(0.0), vec2(0.0));
    vec3 ray = there - eye;
    ray /= max(length(ray.xz), TINY);
    float all = 1.0 / max(total(met), TINY), area = max(total(leaf_areas(grows)), THINNEST);
    for (int kind = 0; kind < KINDS; kind++) {
        vec2 bend = bending(kind, messages[kind]);
        float part = OF(met, kind) * all;
        Light light = leaf_light(kind, bend, there, lies, grows);
        vec3 turned = turned_to(kind, leaning(bend), ray);
        light.sun *= turned * turned;
        light.sky *= turned * turned;
        sum.light = light_sum(sum.light, light, part);
        sum.bent += part * bent_to(kind, bend, ray.xz, slope, -ray.y, on_level * OF(leaf, kind) / area);
        sum.sway += part * SWAYS * OF(crown, kind) * bend;
    }
    return sum;
}
