// Light on what is met of the carpet, summed over the kinds.
#include "lib/light.glsl"
#include "lib/shares.glsl"
#include "lib/posture.glsl"

uniform sampler2D air;  // the wind's message in the middle of each patch, wrapping round
uniform sampler2D mean_air;

struct Sum {
    vec3 direct;   // light on leaves of the kinds that are met: the sun's
    vec3 open_to;  // the sky's
    vec4 shade;    // what they mirror; leaves that the sun's light meets; leaf area above them, and from there to the ground
    float lies;    // how many more leaves a line of sight meets where grass stands densely, for how it is bent
    vec2 sways;    // how far they are moved by that [m]
};

const float SWAYS = 0.35;  // how far leaves are moved that are seen, of the canopy's height and the posture index

// Sine of how far blades lie over, of their posture index, and how much less that is by the index's square.
const vec2 LAID = vec2(0.96, 0.22);

// How leaves of a kind lean that is bent so, for their height at rest.
vec3 leaning(vec2 bend) {
    vec2 leans = bend * (LAID.x - LAID.y * dot(bend, bend));
    return vec3(leans, lodged(bend)).xzy;
}

const float TURNED = 0.12;  // how much more it matters than their lean alone tells, whether blades lean away from the eye or towards it

// How many more leaves a line of sight meets of a kind for how it leans, where it stands densely, than it would meet on level
// ground at rest, that goes `sight` and `falls` while it comes through the canopy at rest, of its height: grass that leans away
// from the eye turns its breadth to it, and grass that leans towards it its edge.
float laid(int kind, vec3 lean, vec2 sight, float falls) {
    float lies = OF(lying, kind);
    vec3 still = vec3(sight * lean.y, lies), away = vec3(falls * lean.xz, 0.0), bent = vec3(still.xy, falls * lies) + away;
    return (length(bent) - length(still) + TURNED * (length(bent) - length(bent - 2.0 * away))) * OF(leaf, kind);
}

// The pigment of what is met of a kind that leans so, of that where it stands upright.
vec3 turned_to(int kind, vec3 lean, vec3 ray) {
    vec2 seen = faces_seen(kind, lean, ray) - faces_seen(kind, vec3(0.0, 1.0, 0.0), ray);
    return 1.0 + kinds[kind].grain_c * seen.x + kinds[kind].grain_s * seen.y;
}

// How much of each kind's tips is met, of what its images show, which have it grow densely and alone. What grows thinly, or
// stands out of a lower kind, is met farther down; as blades differ in length, that is less far down each of them.
ByKind tips_met(ByKind grows, float slope) {
    ByKind area = areas(grows), tips;
    slope = max(slope, LOWEST);
    for (int kind = 0; kind < KINDS; kind++) {
        float usual = depth_met(OF(leaf, kind) / slope), canopy_height = OF(crown, kind);
        float leaves = leaves_above(canopy_height * (1.0 - usual), area) - leaves_above(canopy_height, area);
        OF(tips, kind) = sqrt((1.0 - depth_met(leaves / (usual * usual * slope))) / (1.0 - usual));
    }
    return tips;
}

// How dry or lush the leaves are that are seen there: the mean of nearer and farther ones.
vec3 stretch_seen(vec3 there, float slope, float tall) {
    vec2 apart = normalize(there.xz - eye.xz + 1e-4) * min(SPREAD * along_ground(slope, tall), FARTHEST_SEEN);
    vec4 nearer = textureLod(lie, on_left(there.xz - apart), 0.0), farther = textureLod(lie, on_left(there.xz + apart), 0.0);
    return stretch(0.5 * (nearer + farther).zw);
}

// The wind's message; far off, where nobody asks for it, the mean of those nearer by.
vec2 message_at(vec2 at) {
    float side = float(textureSize(air, 0).x) * patch_side;
    vec2 apart = abs(at - (vec2(window.xy) + 0.5) * patch_side);
    float far = smoothstep(0.35, 0.48, max(apart.x, apart.y) / side);
    return mix(textureLod(air, at / side, 0.0).xy, texelFetch(mean_air, ivec2(0), 0).xy, far);
}

// The light there on each kind as its message has bent it, in the mean of all that are met.
Sum summed(ByKind met, float slope, vec3 there, Lie here, vec2 messages[KINDS]) {
    ByKind grows = grows_at(there.xz);
    Sum sum = Sum(vec3(0.0), vec3(0.0), vec4(0.0), 0.0, vec2(0.0));
    vec3 ray = there - eye;
    ray /= max(length(ray.xz), 1e-4) * max(slope, LOWEST);
    for (int kind = 0; kind < KINDS; kind++) {
        vec2 bend = bending(kind, messages[kind]);
        Light lit = light_on(kind, bend, there, here, grows);
        vec3 lean = leaning(bend), turned = turned_to(kind, lean, ray);
        turned *= turned;
        sum.direct += OF(met, kind) * lit.sun * turned;
        sum.open_to += OF(met, kind) * lit.sky * turned;
        sum.shade += OF(met, kind) * vec4(lit.gloss, lit.way, lit.leaves);
        sum.lies += OF(met, kind) * laid(kind, lean, ray.xz, -ray.y);
        sum.sways += OF(met, kind) * SWAYS * OF(crown, kind) * bend;
    }
    float all = 1.0 / max(total(met), 1e-4);
    return Sum(sum.direct * all, sum.open_to * all, sum.shade * all, sum.lies * all, sum.sways * all);
}
