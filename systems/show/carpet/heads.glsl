// Shares of kinds in what lines of sight meet, if some kinds bear heads: these stand high, and are met first.
#include "systems/show/carpet/heads.py"

uniform vec2 profile[KINDS * (HEIGHTS + 1)];  // by kind and height: leaf area above it, of all organs and of heads; from profile_of

const int LAYERS = 12;
const vec2 LONE = vec2(0.9, 1.0);  // values of `below` between which lone heads above the canopy come to be met

// Fraction of a kind's leaf area above a height, in steps of its profile: of all organs, and of heads.
vec2 profile_above(int kind, float height) {
    float at = min(height, float(HEIGHTS));
    int low = min(int(at), HEIGHTS - 1), entry = kind * (HEIGHTS + 1) + low;
    return mix(profile[entry], profile[entry + 1], at - float(low));
}

// What has been met down to some layer.
struct Met {
    ByKind all;            // opacity of each kind
    ByKind heads;          // of its heads
    ByKind alone;          // of each kind if it grew alone, as in its image
    ByKind heads_alone;    // of its heads then
    ByKind through_alone;  // transmittance then
    float through;         // transmittance of all kinds
};

// Add a layer with the optical depths `stop` of kinds and the fractions `heads` of that. The line of sight is `inside` for a fraction of
// the layer; `part` is the factor of optical depths in images.
void add_layer(inout Met met, ByKind stop, ByKind heads, ByKind densities, float inside, float part) {
    float sum = weighted_sum(stop, densities), stopped = met.through * (1.0 - transmittance(inside * sum));
    for (int group = 0; group < GROUPS; group++) {
        vec4 share = stopped * stop[group] * densities[group] / max(sum, THINNEST_LAYER);
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

// Share of each kind in what a line of sight meets. Layers grow thicker downwards from the top or from `cut_height` [m], and
// begin at a fraction `below` of that. `riper` is the excess of a kind's heads over its image, in which it grows alone: at 1 all is
// heads, at -1 none.
ByKind kinds_met(ByKind densities, float slope, float cut_height, float below, out ByKind riper) {
    float top = 0.0, from = 1.0;
    for (int kind = 0; kind < KINDS; kind++)
        top = max(top, OF(densities, kind) > LEAST_MET ? OF(crown, kind) * HIGHEST : 0.0);
    top = min(top, cut_height);
    Met met = Met(all_kinds(0.0), all_kinds(0.0), all_kinds(0.0), all_kinds(0.0), all_kinds(1.0), 1.0);
    below /= mix(HIGHEST, 1.0, smoothstep(LONE.x, LONE.y, below));  // strips hide parts of the canopy, not of lone heads
    ByKind leaves = leaves_met(slope);
    vec2 above[KINDS];
    float steps[KINDS];  // height of the top in steps of a kind's profile
    for (int kind = 0; kind < KINDS; kind++) {
        steps[kind] = top / OF(crown, kind) * (float(HEIGHTS) / HIGHEST);
        above[kind] = profile_above(kind, steps[kind]);
    }
    for (int layer = 1; layer <= LAYERS; layer++) {
        float part = float(layer) / float(LAYERS), to = 1.0 - part * part;
        ByKind stop = all_kinds(0.0), heads = stop;
        for (int kind = 0; kind < KINDS; kind++) {
            vec2 above_here = profile_above(kind, to * steps[kind]), here = above_here - above[kind];
            above[kind] = above_here;
            OF(stop, kind) = here.x * OF(leaves, kind);
            OF(heads, kind) = here.y / max(here.x, THINNEST_LAYER);
        }
        add_layer(met, stop, heads, densities, clamp((below - to) / (from - to), 0.0, 1.0), min(slope / LOWEST, 1.0));
        from = to;
    }
    for (int group = 0; group < GROUPS; group++) {
        vec4 seen = met.heads[group] / max(met.all[group], THINNEST_LAYER);
        vec4 usual = met.heads_alone[group] / max(met.alone[group], THINNEST_LAYER), more = seen - usual;
        riper[group] = mix(more / max(usual, LEAST_HEADS), more / max(1.0 - usual, LEAST_HEADS), greaterThan(seen, usual));
    }
    return met.all;
}

// Opacity of a kind that grows densely and alone, as its image shows it; images with heads are relative to their mean.
float image_opacity(int kind, ByKind leaves) {
    return OF(bears, kind) > 0.0 ? 1.0 : 1.0 - transmittance(OF(leaves, kind));
}
