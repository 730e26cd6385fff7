// Height up to which grass is hidden: at a low angle, leaves in front hide its lower part.
#include "lib/canopy.glsl"
#include "lib/mown.glsl"

const float HIDDEN = 2.0;  // optical depth beyond which the rest of a line of sight is left out: 14 % comes through, of dark roots
const float TRAIL = 0.5;  // greatest width of a trail right in front, on which all grass lies [m]
const int SPANS = 5;  // spans of a line of sight, from the trail on, each twice as long as the one before it
const float MIDDLE = 1.5;  // distance to the middle of a span, over the distance to its beginning, which is also its length
const int HALVINGS = 5;  // steps of the search for the height
const float LEAST_BEND = 2.5e-6;  // least bend of the ground that divides [1/m]

// A span of a line of sight, by its middle.
struct Span {
    float away;    // distance from the root along the ground [m]
    float ground;  // height of the ground over the root [m]
    ByKind area;   // leaf area
};

Span span_at(vec3 root, vec2 toward, float away) {
    vec2 place = root.xz + toward * away, on = (place - terrain_origin) / terrain_size;
    Span span = Span(away, height_filtered(place) - root.y, leaf_areas(density_at(place)));
    bool counts = all(lessThan(abs(on - 0.5), vec2(0.5))) && away < distance(root.xz, eye.xz);
    for (int group = 0; group < GROUPS; group++)
        span.area[group] *= counts ? 1.0 : 0.0;
    return span;
}

// Optical depth of a line of sight that ends `high` [m] over the root. Leaf area falls off linearly with height. `stands` is the
// height of bent grass, of its height at rest.
float depth_before(Span spans[SPANS], float high, float slope, float stands) {
    float depth = 0.0;
    for (int number = 0; number < SPANS; number++) {
        Span part = spans[number];
        float over = max(high + part.away * slope - part.ground, 0.0), per_metre = 0.0;
        for (int group = 0; group < GROUPS; group++) {
            vec4 tall = max(crown[group] * stands, LOWEST_CROWN);
            per_metre += dot(part.area[group], 2.0 * max(1.0 - over / tall, 0.0) / tall);
        }
        depth += per_metre * part.away / MIDDLE;
    }
    return depth;
}

// Height over a root [m] above which lines of sight rise past it to the sky: those that fall meet farther land, and those below a
// height meet the ground right behind, a parabola through the root and two spans before it. `over` is the eye's height over the root.
float height_before_sky(Span near, Span far, float over, float away) {
    float first = near.ground / near.away, bend = (far.ground / far.away - first) / (far.away - near.away);
    float half_fall = 0.5 * max(over / away - first + bend * near.away, 0.0);  // of lines of sight to the ground at the root, by slope
    return max(half_fall * half_fall / max(-bend, LEAST_BEND), over);
}

// Whether the eye is among stems. Right in front of it are too few of them to hide what their mean optical depth tells.
bool eye_among_stems() {
    float above_ground = eye.y - height_filtered(eye.xz);
    if (above_ground > tallest_grass)
        return false;
    ByKind density = density_at(eye.xz);
    float tallest = 0.0;
    for (int group = 0; group < GROUPS; group++) {
        vec4 tall = crown[group] * vec4(greaterThan(density[group], vec4(0.0)));
        tallest = max(tallest, max(max(tall.x, tall.y), max(tall.z, tall.w)));
    }
    return above_ground < tallest;
}

// Height [m] up to which grass with this root is hidden, at most `tall`. `stands` is its height in the wind, of that at rest. It
// is 0 in scenes with cut grass, or with grass missing where the density map has some, and for an eye among stems.
float hidden_height(vec3 root, float tall, float stands) {
    if (anything_is_cut() || anything_open > 0.5 || eye_among_stems())
        return 0.0;
    float away = max(distance(eye.xz, root.xz), TRAIL);
    Span spans[SPANS];
    for (int number = 0; number < SPANS; number++)
        spans[number] = span_at(root, (eye.xz - root.xz) / away, MIDDLE * TRAIL * exp2(float(number)));
    vec2 between = vec2(0.0, min(tall, height_before_sky(spans[2], spans[3], eye.y - root.y, away)));
    for (int halving = 0; halving < HALVINGS; halving++) {
        float middle = 0.5 * (between.x + between.y);
        if (depth_before(spans, middle, (eye.y - root.y - middle) / away, stands) > HIDDEN)
            between.x = middle;
        else
            between.y = middle;
    }
    return between.x;
}
