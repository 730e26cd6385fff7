// The carpet among strips, and over a crest: lines of sight have met others' leaves before, or come no deeper.
#include "systems/show/carpet/border.glsl"

const float MET = 0.85;  // how deep leaves are that are met over a crest, of how deep the line of sight comes
const float UNEVEN = 0.75;  // how deep they are at least, of how deep they are on level ground: tips differ in height
const float LEAST_DEEP = 0.1;  // how deep it comes at least, of the height of the grass
const float LEAST_STRIPS = 1e-3;  // leaf area on strips that counts at least

// How much of the carpet's grass is seen among strips, and how high in the canopy, both relative to a carpet without strips.
// Strips in front, which bear so much of the leaf area, have stopped a part of the line of sight already, high up. The carpet
// lies at RAISED of its share of their height and hides what they have below it: it shows what is left of what both together
// would stop.
vec2 among_strips(float on_strips, float slope, float share, float stands, float leaf_area) {
    slope = max(slope, LOWEST);
    float longer = 1.0 / slope, leaves = leaf_area * longer, out_of_it = max(1.0 - RAISED * share / stands, 0.0);
    vec2 depth = depth_met(max(leaf_area, THINNEST) * longer * vec3(1.0, max(on_strips, LEAST_STRIPS), 1.0)).xy;
    vec2 hides = 1.0 - comes_through(leaves * vec2(1.0, on_strips));
    float own = hides.x * depth.x - hides.y * out_of_it * depth.y, behind = max(hides.x - hides.y, TINY);
    float part = (1.0 - comes_through(leaves * (1.0 - on_strips))) / max(hides.x, TINY);
    return vec2(part, clamp((behind - own) / (behind - behind * depth.x), 0.0, 1.0));
}

// How high leaves are that are seen, of how high the flattest image shows them: flatter lines of sight meet tips alone.
float higher(float on_level, float leaf_area) {
    vec2 high = 1.0 - depth_met(max(leaf_area, THINNEST) / max(vec3(LOWEST, FLATTEST, 1.0), on_level)).xy;
    return high.y / high.x;
}

// How deep leaves are that are seen, of how deep they are on level ground. Over a crest nothing is met that lies deeper than
// the line of sight comes, which is `deep` below the top of the grass.
float shallower(float deep, float on_level, float share, float curvature, float stands, float leaf_area) {
    float most = max(1.0 - RAISED * (share * carpet_lift(deep, curvature, stands) / stands - deep), LEAST_DEEP);
    if (most >= 1.0 / MET)
        return 1.0;
    return clamp(MET * most / depth_met(max(leaf_area, THINNEST) / max(LOWEST, on_level)), UNEVEN, 1.0);
}
