// Corrections to the carpet's images among strips, where lines of sight have met leaves on strips before, and over a crest.
#include "systems/show/carpet/border.glsl"

const float MET = 0.85;  // mean depth of leaves met over a crest, as a fraction of the line of sight's greatest depth
const float UNEVEN = 0.75;  // least depth of those leaves, relative to level ground: tips differ in height
const float LEAST_DEEP = 0.1;  // least depth of the line of sight, as a fraction of the height of the grass
const float LEAST_STRIPS = 1e-3;  // least leaf area on strips, as a fraction of the grass's

// Opacity of the carpet's grass among strips, and height in the canopy at which it is seen, both relative to a carpet without strips.
// Strips in front, which bear a fraction `on_strips` of the leaf area, have stopped a part of the light already, high up. The carpet
// lies at RAISED times its share of their height and hides what they have below it: it shows the rest of what both together stop.
vec2 among_strips(float on_strips, float slope, float share, float stands, float leaf_area) {
    slope = max(slope, LOWEST);
    float longer = 1.0 / slope, leaves = leaf_area * longer, out_of_it = max(1.0 - RAISED * share / stands, 0.0);
    vec2 depth = mean_depth_met(max(leaf_area, THINNEST) * longer * vec3(1.0, max(on_strips, LEAST_STRIPS), 1.0)).xy;
    vec2 hides = 1.0 - transmittance(leaves * vec2(1.0, on_strips));
    float own = hides.x * depth.x - hides.y * out_of_it * depth.y, behind = max(hides.x - hides.y, TINY);
    float part = (1.0 - transmittance(leaves * (1.0 - on_strips))) / max(hides.x, TINY);
    return vec2(part, clamp((behind - own) / (behind - behind * depth.x), 0.0, 1.0));
}

// Factor of the height of leaves that are seen, relative to the flattest image: flatter lines of sight meet tips alone.
float height_factor(float on_level, float leaf_area) {
    vec2 high = 1.0 - mean_depth_met(max(leaf_area, THINNEST) / max(vec3(LOWEST, FLATTEST, 1.0), on_level)).xy;
    return high.y / high.x;
}

// Factor of the depth of leaves that are seen, relative to level ground. Over a crest nothing deeper is met than `deep`, the greatest
// depth of the line of sight below the top of the grass.
float depth_factor(float deep, float on_level, float share, float curvature, float stands, float leaf_area) {
    float most = max(1.0 - RAISED * (share * carpet_lift(deep, curvature, stands) / stands - deep), LEAST_DEEP);
    if (most >= 1.0 / MET)
        return 1.0;
    return clamp(MET * most / mean_depth_met(max(leaf_area, THINNEST) / max(LOWEST, on_level)), UNEVEN, 1.0);
}
