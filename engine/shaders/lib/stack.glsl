// The strips of a patch: planes of its model, which turn with it and are stacked along an axis of the world.
#include "lib/light.glsl"

vec2 quarter_turned(vec2 place, int turn) {
    return turn == 0 ? place : turn == 1 ? vec2(-place.y, place.x) : turn == 2 ? -place : vec2(place.y, -place.x);
}

// Whether a model's planes are numbered against the axis that they are stacked on; `orientation` is theirs in the model.
bool is_reversed(int orientation, int along, int turn) {
    return orientation == 0 ? turn == (along == 0 ? 2 : 1) : turn == (along == 0 ? 3 : 2);
}

// The place in the stack of a plane of the model, and also the plane of a place.
int stack_place(int plane, int count, int orientation, int along, int turn) {
    return is_reversed(orientation, along, turn) ? count - 1 - plane : plane;
}

// Foot of a strip's vertical edge on the patch of a cell (x, z) [m].
vec2 edge_foot(vec2 cell, int turn, int orientation, int plane, int count, int edge, int columns, float margin) {
    float side = patch_side, u = -margin + (side + 2.0 * margin) * float(edge) / float(columns);
    float v = (float(plane) + 0.5) * (side / float(count));
    vec2 local = (orientation == 0 ? vec2(u, v) : vec2(v, u)) - 0.5 * side;
    return cell * side + quarter_turned(local, turn) + 0.5 * side;
}

const float CLOSEST = 0.01;  // least distance from the eye [m]
const float NEARER = 0.33;  // offset of strips towards the eye, as a part of their spacing
const vec2 AT_MOST = vec2(0.2, 0.0125);  // limits of that: [m], and as a part of the distance, or blades would leap to their painted places

// Foot of a strip along `run`, moved towards the eye from the middle of the slice of ground that it stands for. In the middle, lines
// of sight over the last strip would meet half a slice of open ground, a dark line. `strips` stand on a patch.
vec3 pulled_nearer(vec3 foot, vec2 run, int strips) {
    vec3 ray = foot - eye;
    vec2 off = normalize(vec2(-run.y, run.x));
    vec2 way = off * -dot(off, ray.xz) * min(min(NEARER * patch_side / float(strips), AT_MOST.x) / max(length(ray), CLOSEST), AT_MOST.y);
    return foot + vec3(way.x, dot(gradient_at(foot.xz), way), way.y);
}

const float SPREAD = 2.0;  // spacings of strips that each must hide of the ground behind it

// Extra offset (x, z) [m] of a strip's top away from the eye, beyond its posture's `top` [m]. A strip seen along its bent blades is
// a thin line with bare ground on both sides, while real blades are rooted all over a slice of ground and hide it: the more, the more
// the ground falls away from the eye. `run` is along the strip; `strips` stand on a patch.
vec2 laid_back(vec2 run, vec3 foot, vec3 top, float height, int strips) {
    vec2 off = normalize(vec2(-run.y, run.x)), ray = foot.xz - eye.xz;
    off *= sign(dot(off, ray));
    float above = eye.y - foot.y, along = dot(ray, off);
    float behind = along / max(above + dot(gradient_at(foot.xz), ray), CLOSEST);  // ground hidden by a metre of height [m]
    float least = min(SPREAD * patch_side / float(strips), height * behind), drop = max(above, CLOSEST) / max(along, CLOSEST);
    float reach = (top.y + dot(top.xz, off) * drop) * behind;
    return off * clamp((least - reach) / max(drop * behind, 1.0), 0.0, 2.0 * least);
}

const float FLATTEST_SIGHT = 1e-3;  // least slope of a line of sight to the ground
const float LEAST_LEAVES = 0.1;  // least leaf area index, and least optical depth from strip to strip

// Factor on the depth at which leaves are seen on strips, to light them as if they stood anywhere. Among leaves that stand anywhere, a
// line of sight comes in the mean half a spacing of strips times 2 / x far, where x is a strip's optical depth; among strips it comes
// half a spacing times 1 / tanh(x / 2) far. Half of the difference counts, from the top of the grass on. `run` is along the strips;
// `strips` stand on a patch; `tall` is the height of the grass [m].
float depth_correction(vec2 run, vec3 foot, int strips, ByKind densities, float tall) {
    tall = max(tall, LOWEST_CROWN);
    vec2 off = normalize(vec2(-run.y, run.x)), ray = foot.xz - eye.xz;
    float away = max(length(ray), CLOSEST), slope = max((eye.y - foot.y + dot(gradient_at(foot.xz), ray)) / away, FLATTEST_SIGHT);
    float way = patch_side / float(strips) * away / max(abs(dot(off, ray)), CLOSEST), area = max(total(leaf_areas(densities)), LEAST_LEAVES);
    float deep = mean_depth_met(area / slope), leaves = max(way * 2.0 * area * deep / tall, LEAST_LEAVES);
    return deep / (deep + 0.5 * slope * way / tall * (0.5 / tanh(0.5 * leaves) - 1.0 / leaves));
}

const float EDGE_ON = 0.4;  // least breadth of painted blades on a strip seen edge-on, relative to real ones
const float BOOSTED = 0.95;  // part of the factor that is used, as leaves hide leaves

float breadth_ratio(float whole, float painted) {
    return mix(1.0, whole / max(max(abs(painted), EDGE_ON * whole), LEAST_SQUARE), BOOSTED);
}

// Factor on the coverage of painted blades: the ratio of the breadths that the eye sees of real blades, which face all ways and lean
// to `top`, and of painted ones, which face as their strip does. The strip runs along `run` and leans to `top` and `back`.
float coverage_factor(int kind, vec2 run, vec3 middle, vec3 top, vec2 back) {
    vec3 ray = normalize(middle - eye), painted_across = cross(top + vec3(back.x, 0.0, back.y), ray);
    vec2 all = cross(top, ray).xz;
    float lies = OF(lying, kind) * top.y * ray.y, whole = sqrt(dot(all, all) + lies * lies);
    return breadth_ratio(whole, dot(run, painted_across.xz));
}

// The same factor for heads. These are as broad from all sides, so that flat ones keep their breadth, which on a strip they would
// lose as leaves do.
float head_coverage_factor(int kind, vec2 run, vec3 middle, vec3 top, vec2 back) {
    float leaves = coverage_factor(kind, run, middle, top, back);
    if (OF(bears, kind) < 0.5)
        return leaves;
    vec3 ray = normalize(middle - eye), painted_across = cross(top + vec3(back.x, 0.0, back.y), ray);
    return max(leaves, breadth_ratio(length(cross(top, ray)), dot(run, painted_across.xz)));
}

const vec2 HEADED = vec2(0.1, 0.6);  // painted tones: those of stems and leaves are below, those of petals and florets above

// Share of heads in what is painted in a tone.
float head_part(float tone) {
    return smoothstep(HEADED.x, HEADED.y, tone);
}

// Factor on painted pigments by the azimuth that blades face. Real blades are seen most where they face the eye; painted ones, where
// they face as their strip does, which runs along `run`.
vec3 facing_tint(int kind, vec2 run, vec3 middle, vec3 top) {
    vec2 seen = seen_azimuth(kind, top, middle - eye) - FACING * vec2(run.y * run.y - run.x * run.x, -2.0 * run.x * run.y);
    return 1.0 + kinds[kind].grain_c * seen.x + kinds[kind].grain_s * seen.y;
}
