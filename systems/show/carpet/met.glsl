// How much of each kind lines of sight meet: at a low angle, taller kinds hide the others.
#include "systems/show/carpet/sight.glsl"

// How many leaves of each kind a line of sight of this slope meets on its way to the ground, where that grows densely.
ByKind leaves_met(float slope) {
    ByKind leaves = all_kinds(0.0);
    for (int kind = 0; kind < KINDS; kind++)
        OF(leaves, kind) = OF(leaf, kind) * leaves_on_way(kind, 1.0 / (slope * slope));
    return leaves;
}

#ifdef HEADS
#include "systems/show/carpet/heads.glsl"
#else

const int LAYERS = 4;

// How much of what a line of sight meets is of each kind. The grass is taken in layers from the top, up to `below` of its
// height, or from `left` [m]; its leaf area falls off linearly with height.
ByKind kinds_met(ByKind grows, float slope, float left, float below, out ByKind riper) {
    float top = 0.0;
    ByKind leaves = leaves_met(slope);
    riper = all_kinds(0.0);  // none has heads
    for (int kind = 0; kind < KINDS; kind++)
        top = max(top, OF(grows, kind) > LEAST_MET ? OF(crown, kind) : 0.0);
    top = min(top, left) * below;
    ByKind met = all_kinds(0.0);
    float through = 1.0, part = 1.0 / float(LAYERS);
    for (int layer = 0; layer < LAYERS; layer++) {
        float height = top * (1.0 - part * (float(layer) + 0.5));
        ByKind stop = all_kinds(0.0);
        for (int kind = 0; kind < KINDS; kind++) {
            float canopy_height = OF(crown, kind);
            OF(stop, kind) = OF(grows, kind) * OF(leaves, kind) * 2.0 * max(1.0 - height / canopy_height, 0.0) * top / canopy_height;
        }
        float sum = total(stop);
        float stopped = through * (1.0 - comes_through(part * sum));
        for (int group = 0; group < GROUPS; group++)
            met[group] += stopped * stop[group] / max(sum, THINNEST_LAYER);
        through -= stopped;
    }
    return met;
}

// How much an image of a kind hides where it grows densely and alone.
float hidden_by_image(int kind, ByKind leaves) {
    return 1.0 - comes_through(OF(leaves, kind));
}
#endif

// What is met of each kind, as parts of all that is hidden. Images show how much a kind hides where it grows densely and
// alone. A line of sight that meets half of its leaves is stopped by more than half as many, and leaves of two kinds stop more
// than either.
ByKind shared_out(ByKind met, ByKind grows, float slope) {
    float all = max(total(met), THINNEST_LAYER), alone = 0.0;
    ByKind leaves = leaves_met(slope);
    for (int kind = 0; kind < KINDS; kind++)
        alone += OF(met, kind) / all * hidden_by_image(kind, leaves);
    float hides = (1.0 - comes_through(weighed(leaves, grows))) / max(alone, TINY);
    for (int group = 0; group < GROUPS; group++)
        met[group] = met[group] / all * hides;
    return met;
}

// Up to which height a line of sight has met no strips, of the grass's height: where strips stand out of the carpet, it has
// met the tops of grass on them. Where the carpet itself gives way to strips, these leave more to it than their heights tell.
float left_by_strips(float met_carpet, float share) {
    return mix(1.0, mix(RAISED, 1.0, met_carpet), share * share * share * share);
}

// How much of its tips is met, in the mean over the kinds, of what their images show, which have each grow densely and alone.
// What grows thinly, or stands out of a lower kind, is met farther down; as blades differ in length, that is less far down each.
float tips_met(ByKind met, ByKind grows, float slope) {
    ByKind area = areas(grows);
    float tips = 0.0;
    slope = max(slope, LOWEST);
    for (int kind = 0; kind < KINDS; kind++) {
        float usual = depth_met(OF(leaf, kind) / slope), high = OF(crown, kind);
        float leaves = leaves_above(high * (1.0 - usual), area) - leaves_above(high, area);
        tips += OF(met, kind) * sqrt((1.0 - depth_met(leaves / (usual * usual * slope))) / (1.0 - usual));
    }
    return tips / max(total(met), TINY);
}
