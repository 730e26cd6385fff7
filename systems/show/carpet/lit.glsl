// Mean light on the leaves of all kinds that are met, and their bending.
#include "lib/light.glsl"
#include "lib/shares.glsl"
#include "lib/posture.glsl"
#include "systems/show/carpet/air.py"
#include "systems/show/carpet/bent.glsl"
#include "systems/show/carpet/sight.glsl"

uniform sampler2D air;  // the wind's message in the middle of each patch, wrapping round
uniform sampler2D far_air;  // messages beyond: windows one above another, each twice as coarse, then a texel with the mean message

struct Canopy {
    Light light;  // on the leaves that are met
    vec3 bent;    // from bent_change
    vec2 sway;    // displacement of the leaves by bending [m]
};

const float SWAYS = 0.35;  // displacement of the leaves that are seen, in canopy heights, per posture index
const vec2 LAID = vec2(0.96, 0.22);  // sine of the lean of blades per posture index; its decrease by the index's square
const vec2 FAR_AIR = vec2(0.4, 0.47);  // distances between which the next message takes over, in widths of a window
const float FAR_TAKES = log2(FAR_AIR.y / FAR_AIR.x);  // the same, in octaves of distance

// Vector from foot to tip of leaves with this bending, in heights at rest.
vec3 lean_direction(vec2 bend) {
    vec2 leans = bend * (LAID.x - LAID.y * dot(bend, bend));
    return vec3(leans, lodged(bend)).xzy;
}

// Factor of the pigment of a leaning kind, relative to upright.
vec3 turned_pigment(int kind, vec3 lean, vec3 ray) {
    return azimuth_tint(kind, seen_azimuth(kind, lean, ray) - seen_azimuth(kind, vec3(0.0, 1.0, 0.0), ray));
}

// Distance of a place from the middle of the viewer's patch, along x or z [patches].
float patches_apart(vec2 at) {
    vec2 apart = abs(at * patches_per_metre - carpet_window.xy - 0.5);
    return max(apart.x, apart.y);
}

// The wind's message near by; far away, where there are no receivers, the mean message.
vec2 near_message_at(vec2 at) {
    float far = smoothstep(FAR_AIR.x, FAR_AIR.y, patches_apart(at) * windows_per_patch);
    vec2 mean = texelFetch(far_air, ivec2(0, FAR_LEVELS * FAR_SIDE), 0).xy;
    return mix(textureLod(air, at * (patches_per_metre * windows_per_patch), 0.0).xy, mean, far);
}

// The message at a place in texels.
vec2 linear_at(sampler2D messages, vec2 on) {
    return textureLod(messages, on / vec2(textureSize(messages, 0)), 0.0).xy;
}

#ifdef SPLINES
// The same by cubic splines (Catmull and Rom, 1974): fronts of gusts are only a few texels wide, and lines between texels would flatten
// them. Instead of sixteen texels five places between them are read, without the corners, which hardly weigh.
// The weights of four texels in a line are polynomials of the place between the two in the middle.
const vec4 SPLINE_BEFORE = vec4(0.0, -0.5, 1.0, -0.5), SPLINE_HERE = vec4(1.0, 0.0, -2.5, 1.5);
const vec4 SPLINE_NEXT = vec4(0.0, 0.5, 2.0, -1.5), SPLINE_LAST = vec4(0.0, 0.0, -0.5, 0.5);

vec2 spline_at(sampler2D messages, vec2 on) {
    vec2 from = floor(on - 0.5) + 0.5, f = on - from;
    vec4 x = vec4(1.0, f.x, f.x * f.x, f.x * f.x * f.x), y = vec4(1.0, f.y, f.y * f.y, f.y * f.y * f.y);
    vec2 before = vec2(dot(x, SPLINE_BEFORE), dot(y, SPLINE_BEFORE)), last = vec2(dot(x, SPLINE_LAST), dot(y, SPLINE_LAST));
    vec2 next = vec2(dot(x, SPLINE_NEXT), dot(y, SPLINE_NEXT)), both = vec2(dot(x, SPLINE_HERE), dot(y, SPLINE_HERE)) + next;
    vec2 middle = from + next / both, low = from - 1.0, high = from + 2.0;
    vec2 sum = both.x * both.y * linear_at(messages, middle);
    sum += both.x * (before.y * linear_at(messages, vec2(middle.x, low.y)) + last.y * linear_at(messages, vec2(middle.x, high.y)));
    sum += both.y * (before.x * linear_at(messages, vec2(low.x, middle.y)) + last.x * linear_at(messages, vec2(high.x, middle.y)));
    return sum / (both.x + both.y - both.x * both.y);
}
#else
#define spline_at linear_at
#endif

// Place of the ground on one of the windows beyond, in texels.
vec2 on_far(vec2 at, float level) {
    float side = float(FAR_SIDE), spacing = exp2(level + 1.0);
    vec2 on = at * patches_per_metre / spacing - floor(carpet_window.xy / spacing) + 0.5 * side;
    return clamp(on, 2.0, side - 2.0) + vec2(0.0, level * side);
}

// The wind's message beyond the window around the viewer, from distances of `apart` patches.
vec2 far_message_at(vec2 at, float apart) {
    float beyond = max(log2(apart / (2.0 * float(FAR_SIDE) * FAR_AIR.x)), 0.0), level = min(floor(beyond), float(FAR_LEVELS) - 1.0);
    vec2 message = spline_at(far_air, on_far(at, level));
    if (beyond <= 0.0)
        return message;
    vec2 next = texelFetch(far_air, ivec2(0, FAR_LEVELS * FAR_SIDE), 0).xy;
    if (level < float(FAR_LEVELS) - 1.0)
        next = linear_at(far_air, on_far(at, level + 1.0));
    return mix(message, next, smoothstep(0.0, FAR_TAKES, beyond - level));
}

// The wind's message. Only vertices can afford it.
vec2 message_at(vec2 at) {
    float apart = patches_apart(at), far = smoothstep(FAR_AIR.x, FAR_AIR.y, apart * windows_per_patch);
    vec2 message = spline_at(air, at * patches_per_metre);
    return far > 0.0 ? mix(message, far_message_at(at, apart), far) : message;
}

// Mean over the kinds that are met of their light and bending, each bent by its own message.
Canopy canopy_lit(ByKind met, float slope, float on_level, vec3 there, Lie lies, vec2 messages[KINDS]) {
    ByKind densities = density_at(there.xz);
    Canopy sum = Canopy(Light(vec3(0.0), vec3(0.0), vec3(0.0), 0.0, 0.0, vec2(0.0)), vec3(0.0), vec2(0.0));
    vec3 ray = there - eye;
    ray /= max(length(ray.xz), TINY);
    float all = 1.0 / max(total(met), TINY), area = max(total(leaf_areas(densities)), THINNEST);
    for (int kind = 0; kind < KINDS; kind++) {
        vec2 bend = bending(kind, messages[kind]);
        float part = OF(met, kind) * all;
        Light light = leaf_light(kind, bend, there, lies, densities);
        vec3 turned = turned_pigment(kind, lean_direction(bend), ray);
        light.sun *= turned * turned;
        light.sky *= turned * turned;
        sum.light = light_sum(sum.light, light, part);
        sum.bent += part * bent_change(kind, bend, ray.xz, slope, -ray.y, on_level * OF(leaf, kind) / area);
        sum.sway += part * SWAYS * OF(crown, kind) * bend;
    }
    return sum;
}
