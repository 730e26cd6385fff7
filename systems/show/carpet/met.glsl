// Shares of kinds in what lines of sight meet: at a low angle, taller kinds hide the others.
#include "systems/show/carpet/sight.glsl"

// Optical depth of each kind, in leaves, for a line of sight of this slope down to the ground, where the kind grows densely.
ByKind leaves_met(float slope) {
    ByKind leaves = all_kinds(0.0);
    for (int kind = 0; kind < KINDS; kind++)
        OF(leaves, kind) = OF(leaf, kind) * extinction_along(kind, 1.0 / (slope * slope));
    return leaves;
}

#ifdef HEADS
#include "systems/show/carpet/heads.glsl"
#else

const int LAYERS = 4;

// Share of each kind in what a line of sight meets. The grass is taken in layers, down from its top or from `cut_height` [m],
// beginning at a fraction `below` of that; leaf area falls off linearly with height.
ByKind kinds_met(ByKind densities, float slope, float cut_height, float below, out ByKind riper) {
    float top = 0.0;
    ByKind leaves = leaves_met(slope);
    riper = all_kinds(0.0);  // none has heads
    for (int kind = 0; kind < KINDS; kind++)
        top = max(top, OF(densities, kind) > LEAST_MET ? OF(crown, kind) : 0.0);
    top = min(top, cut_height) * below;
    ByKind met = all_kinds(0.0);
    float through = 1.0, part = 1.0 / float(LAYERS);
    for (int layer = 0; layer < LAYERS; layer++) {
        float height = top * (1.0 - part * (float(layer) + 0.5));
        ByKind stop = all_kinds(0.0);
        for (int kind = 0; kind < KINDS; kind++) {
            float canopy_height = OF(crown, kind);
            OF(stop, kind) = OF(densities, kind) * OF(leaves, kind) * 2.0 * max(1.0 - height / canopy_height, 0.0) * top / canopy_height;
        }
        float sum = total(stop);
        float stopped = through * (1.0 - transmittance(part * sum));
        for (int group = 0; group < GROUPS; group++)
            met[group] += stopped * stop[group] / max(sum, THINNEST_LAYER);
        through -= stopped;
    }
    return met;
}

// Opacity of a kind that grows densely and alone, as its image shows it.
float image_opacity(int kind, ByKind leaves) {
    return 1.0 - transmittance(OF(leaves, kind));
}
#endif

// Weights of the images of kinds, by what is met of each. Images have the opacity of a kind that grows densely and alone. Half of its
// leaves have more than half of its opacity, and the leaves of two kinds have more than those of either.
ByKind image_weights(ByKind met, ByKind densities, float slope) {
    float all = max(total(met), THINNEST_LAYER), alone = 0.0;
    ByKind leaves = leaves_met(slope);
    for (int kind = 0; kind < KINDS; kind++)
        alone += OF(met, kind) / all * image_opacity(kind, leaves);
    float hides = (1.0 - transmittance(weighted_sum(leaves, densities))) / max(alone, TINY);
    for (int group = 0; group < GROUPS; group++)
        met[group] = met[group] / all * hides;
    return met;
}

// Height below which a line of sight has met no strips, as a fraction of the grass's: where strips stand out of the carpet, it has met
// the tops of grass on them. Where the carpet itself gives way to strips, these leave more to it than their heights tell.
float height_past_strips(float met_carpet, float share) {
    return mix(1.0, mix(RAISED, 1.0, met_carpet), share * share * share * share);
}

// Factor of the mean place along blades that is met, averaged over kinds, relative to images, in which each kind grows densely and
// alone. Thin grass, or grass that stands out of a lower kind, is met farther down; as blades differ in length, less so along each.
float tip_ratio(ByKind met, ByKind densities, float slope) {
    ByKind area = leaf_areas(densities);
    float tips = 0.0;
    slope = max(slope, LOWEST);
    for (int kind = 0; kind < KINDS; kind++) {
        float usual = mean_depth_met(OF(leaf, kind) / slope), high = OF(crown, kind);
        float leaves = leaf_area_above(high * (1.0 - usual), area) - leaf_area_above(high, area);
        tips += OF(met, kind) * sqrt((1.0 - mean_depth_met(leaves / (usual * usual * slope))) / (1.0 - usual));
    }
    return tips / max(total(met), TINY);
}
