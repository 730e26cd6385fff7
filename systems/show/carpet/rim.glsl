// Grass on the rim of a cliff. Over a crest the ground curves evenly; over a rim it breaks off. There a line of sight is as deep in the
// grass as it passes below its top at the rim, and the slopes on both sides give the length of its path.
const int LOOKS = 12;           // places on a line of sight that may be the rim
const float APART_BY = 0.5;     // distance from one to the next, in grid spacings
const float LEAST_TURN = 0.05;  // least slope at which it enters the grass, or leaves it

// Depth of a line of sight below the top of the grass at a rim, as a fraction of its height, times the root of its path through grass
// one metre deep [m^0.5]: the leaf area that it meets goes by the square. It is interpolated evenly along the mesh before the rim.
// At least NO_RIM where there is no rim. `top` is the height of the grass over the `ground` [m], `place` lies on the raised mesh.
float rim_path_at(vec3 place, float ground, float top) {
    // Far from any rim the loop has no turns: a software rasteriser would execute a branch that is not taken.
    int looks = rim_at(place.xz) > ON_RIM.y * terrain_cell ? 0 : LOOKS;
    vec2 way = heading_to(place.xz);
    float away = distance(place.xz, eye.xz), step = max(terrain_cell, grid_spacing), at = 0.0, high = ground;
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
    if (before < 0.0)  // it comes from below, through grass that is drawn before the rim
        return 0.0;
    float over = place.y + at * (place.y - eye.y) / away - high;
    return max(1.0 - over / max(top, LOWEST_GRASS), 0.0) * sqrt(1.0 / max(before, LEAST_TURN) + 1.0 / max(behind, LEAST_TURN));
}
