// How much of each kind lines of sight meet where some kinds bear heads: these stand high, and are met first.
#include "systems/show/carpet/heads.py"

uniform vec2 profile[KINDS * (HEIGHTS + 1)];  // by kind and height: how much of its leaf area is above that; of heads

const int LAYERS = 12;
const vec2 LONE = vec2(0.9, 1.0);  // parts of the height from which on lone heads above the canopy are met as well

// How much of a kind's leaf area is above a height, of its canopy's: in all, and of heads.
vec2 profile_above(int kind, float height) {
    float at = min(height / HIGHEST, 1.0) * float(HEIGHTS);
    int low = min(int(at), HEIGHTS - 1), own = kind * (HEIGHTS + 1) + low;
    return mix(profile[own], profile[own + 1], at - float(low));
}

// What has been met on the way down.
struct Met {
    ByKind all;
    ByKind heads;
    ByKind alone;  // of each kind, did it grow alone, in the image that shows it
    ByKind heads_alone;
    ByKind through_alone;
    float through;
};

// Take in a layer that has so many leaves of each kind on the way, and such parts of heads, as far as the line of sight is `inside`;
// in images there are `part` of them.
void take_in(inout Met met, ByKind stop, ByKind heads, ByKind grows, float inside, float part) {
    float sum = weighted_sum(stop, grows), stopped = met.through * (1.0 - transmittance(inside * sum));
    for (int group = 0; group < GROUPS; group++) {
        vec4 share = stopped * stop[group] * grows[group] / max(sum, THINNEST_LAYER);
        vec4 alone = met.through_alone[group];
        alone *= 1.0 - vec4(transmittance(part * stop[group].xy), transmittance(part * stop[group].zw));
        met.all[group] += share;
        met.heads[group] += share * heads[group];
        met.alone[group] += alone;
        met.heads_alone[group] += alone * heads[group];
        met.through_alone[group] -= alone;
    }
    met.through -= stopped;
}

// How much of what a line of sight meets is of each kind, in layers from the top that grow thicker downwards, up to `below` of
// its height, or from `left` [m]. `riper` is how much more of a kind's heads are met than its image shows, which has it grow
// alone: all the others at 1, none at -1.
ByKind kinds_met(ByKind grows, float slope, float left, float below, out ByKind riper) {
    float top = 0.0, from = 1.0;
    for (int kind = 0; kind < KINDS; kind++)
        top = max(top, OF(grows, kind) > LEAST_MET ? OF(crown, kind) * HIGHEST : 0.0);
    top = min(top, left);
    Met met = Met(all_kinds(0.0), all_kinds(0.0), all_kinds(0.0), all_kinds(0.0), all_kinds(1.0), 1.0);
    below /= mix(HIGHEST, 1.0, smoothstep(LONE.x, LONE.y, below));  // strips take away from the canopy, not from lone heads
    ByKind leaves = leaves_met(slope);
    vec2 above[KINDS];
    for (int kind = 0; kind < KINDS; kind++)
        above[kind] = profile_above(kind, top / OF(crown, kind));
    for (int layer = 1; layer <= LAYERS; layer++) {
        float part = float(layer) / float(LAYERS), to = 1.0 - part * part;
        ByKind stop = all_kinds(0.0), heads = stop;
        for (int kind = 0; kind < KINDS; kind++) {
            vec2 above_here = profile_above(kind, to * top / OF(crown, kind)), here = above_here - above[kind];
            above[kind] = above_here;
            OF(stop, kind) = here.x * OF(leaves, kind);
            OF(heads, kind) = here.y / max(here.x, THINNEST_LAYER);
        }
        take_in(met, stop, heads, grows, clamp((below - to) / (from - to), 0.0, 1.0), min(slope / LOWEST, 1.0));
        from = to;
    }
    for (int group = 0; group < GROUPS; group++) {
        vec4 seen = met.heads[group] / max(met.all[group], THINNEST_LAYER);
        vec4 usual = met.heads_alone[group] / max(met.alone[group], THINNEST_LAYER), more = seen - usual;
        riper[group] = mix(more / max(usual, LEAST_HEADS), more / max(1.0 - usual, LEAST_HEADS), greaterThan(seen, usual));
    }
    return met.all;
}

// How much an image of a kind hides where it grows densely and alone; one with heads is taken in parts of its mean.
float image_opacity(int kind, ByKind leaves) {
    return OF(bears, kind) > 0.0 ? 1.0 : 1.0 - transmittance(OF(leaves, kind));
}
