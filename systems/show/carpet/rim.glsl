// Grass on the rim of a cliff. Over a crest the ground curves evenly; over a rim it breaks off, so lines of sight come as deep
// as they pass below the top of the grass there, and are out of it again as soon as the slopes on both sides say.
const int LOOKS = 12;       // places on a line of sight that may be the rim,
const float APART_BY = 0.5; // half a point of the mesh from one to the next
const float LEAST_TURN = 0.05;  // slope by which it comes to the ground, or leaves it, at least

// What a line of sight to a place of the raised mesh meets in the grass over a rim, whose top is so high above the `ground` there
// [m]: how deep it comes below that top, of its height, times the root of its way through grass one metre deep [m]. Leaf area is
// met by the square of this. It grows evenly along the mesh before the rim. At least NO_RIM where there is none.
float past_rim(vec3 place, float ground, float top) {
    // Far from any rim it looks nowhere. That is a loop of no turns: software goes through all that a branch leaves out.
    int looks = rim_at(place.xz) > ON_RIM.y * terrain_cell ? 0 : LOOKS;
    vec2 way = heading_to(place.xz);
    float away = distance(place.xz, eye.xz), step = max(terrain_cell, spaced), at = 0.0, high = ground;
    float steepest = (high - eye.y) / away;
    for (int look = 1; look <= looks; look++) {
        float on = APART_BY * step * float(look), there = height_at(place.xz + way * on), rises = (there - eye.y) / (away + on);
        if (rises > steepest) {
            steepest = rises;
            high = there;
            at = on;
        }
    }
    float before = (high - height_at(place.xz + way * (at - step))) / step - steepest;
    float behind = (high - height_at(place.xz + way * (at + 2.0 * step))) / (2.0 * step) + steepest;
    if (looks == 0 || behind < 0.0)
        return 2.0 * NO_RIM;
    if (before < 0.0)  // it comes from beneath, through what is seen of the grass before
        return 0.0;
    float over = place.y + at * (place.y - eye.y) / away - high;
    return max(1.0 - over / max(top, LOWEST_GRASS), 0.0) * sqrt(1.0 / max(before, LEAST_TURN) + 1.0 / max(behind, LEAST_TURN));
}
