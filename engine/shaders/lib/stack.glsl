// Where the strips of a patch stand: planes of its model, turned with it, and stacked along an axis of the world.
#include "lib/light.glsl"

vec2 turned_by(vec2 place, int turn) {
    return turn == 0 ? place : turn == 1 ? vec2(-place.y, place.x) : turn == 2 ? -place : vec2(place.y, -place.x);
}

// Whether the planes of a model fall along the axis that they are stacked on: `own` is the model's orientation.
bool falls(int own, int along, int turn) {
    return own == 0 ? turn == (along == 0 ? 2 : 1) : turn == (along == 0 ? 3 : 2);
}

// The place in the stack of a plane of the model, and the plane of a place.
int stacked(int plane, int count, int own, int along, int turn) {
    return falls(own, along, turn) ? count - 1 - plane : plane;
}

// The foot (x, z) [m] of an edge of a strip, on the patch of a cell.
vec2 edge_foot(vec2 cell, int turn, int own, int plane, int count, int edge, int columns, float margin) {
    float side = patch_side, u = -margin + (side + 2.0 * margin) * float(edge) / float(columns);
    float v = (float(plane) + 0.5) * (side / float(count));
    vec2 local = (own == 0 ? vec2(u, v) : vec2(v, u)) - 0.5 * side;
    return cell * side + turned_by(local, turn) + 0.5 * side;
}

const float CLOSEST = 0.01;  // ways from the eye that count at least [m]
const float NEARER = 0.33;  // how far strips stand before the middles of their slices, of the way from one to the next
const vec2 AT_MOST = vec2(0.2, 0.0125);  // the same [m], and of their distance: blades must not leap to their painted places

// Where a strip along `run` is put whose slice of the ground has its middle at a foot: nearer to the eye. In the middle, half
// a slice would be open to lines of sight behind the last blades, and show as a dark line. So many strips stand on a patch.
vec3 put_nearer(vec3 foot, vec2 run, int strips) {
    vec3 ray = foot - eye;
    vec2 off = normalize(vec2(-run.y, run.x));
    vec2 way = off * -dot(off, ray.xz) * min(min(NEARER * patch_side / float(strips), AT_MOST.x) / max(length(ray), CLOSEST), AT_MOST.y);
    return foot + vec3(way.x, dot(rise_at(foot.xz), way), way.y);
}

const float SPREAD = 2.0;  // ways between strips that one must reach over, as it is seen from the eye

// How far the top of a strip of some height lies back from its foot (x, z) [m], beyond where its posture `top` has it [m].
// Seen along its bent blades, a strip would be a line with bare ground on both sides; but those blades have their roots side
// by side in a slice of the ground, and hide that: the more, the more the ground falls away from the eye. `run` is a way
// along the strip; so many strips stand on a patch.
vec2 laid_back(vec2 run, vec3 foot, vec3 top, float height, int strips) {
    vec2 off = normalize(vec2(-run.y, run.x)), ray = foot.xz - eye.xz;
    off *= sign(dot(off, ray));
    float above = eye.y - foot.y, along = dot(ray, off);
    float behind = along / max(above + dot(rise_at(foot.xz), ray), CLOSEST);  // what a metre of height hides of the ground [m]
    float least = min(SPREAD * patch_side / float(strips), height * behind), drop = max(above, CLOSEST) / max(along, CLOSEST);
    float reach = (top.y + dot(top.xz, off) * drop) * behind;
    return off * clamp((least - reach) / max(drop * behind, 1.0), 0.0, 2.0 * least);
}

const float FLATTEST_SIGHT = 1e-3;  // slope of a line of sight to the ground that counts at least
const float LEAST_LEAVES = 0.1;  // leaf area that counts at least, of the ground's, and what a line of sight meets from a strip to the next

// Of how deep leaves are that are seen on strips, how deep they would be that stand anywhere: so they are lit. With strips that each
// stop a part of a line of sight, it comes on farther in the mean: by half a way from one to the next over the hyperbolic tangent of
// half of what each stops, for 1 over that. From the top of the grass on, where leaves begin, it is half as much. `run` is a way
// along the strips; so many stand on a patch, in grass that grows so densely and stands so high [m].
float less_deep(vec2 run, vec3 foot, int strips, ByKind grows, float tall) {
    tall = max(tall, LOWEST_CROWN);
    vec2 off = normalize(vec2(-run.y, run.x)), ray = foot.xz - eye.xz;
    float away = max(length(ray), CLOSEST), slope = max((eye.y - foot.y + dot(rise_at(foot.xz), ray)) / away, FLATTEST_SIGHT);
    float way = patch_side / float(strips) * away / max(abs(dot(off, ray)), CLOSEST), area = max(total(areas(grows)), LEAST_LEAVES);
    float deep = depth_met(area / slope), leaves = max(way * 2.0 * area * deep / tall, LEAST_LEAVES);
    return deep / (deep + 0.5 * slope * way / tall * (0.5 / tanh(0.5 * leaves) - 1.0 / leaves));
}

const float EDGE_ON = 0.4;  // of the breadth of real blades, what painted ones keep where their strip is seen edge-on
const float BOOSTED = 0.95;  // how much of the factor is taken: leaves hide leaves

float broader(float whole, float painted) {
    return mix(1.0, whole / max(max(abs(painted), EDGE_ON * whole), LEAST_SQUARE), BOOSTED);
}

// Factor on what blades on a strip cover. They are painted as if all faced the way the strip does, which runs along `run` and
// leans to `top` and `back`; real ones face all ways and lean to `top`. It is the ratio of both breadths as the eye sees them,
// a little less, as leaves hide leaves.
float boosted(int kind, vec2 run, vec3 middle, vec3 top, vec2 back) {
    vec3 ray = normalize(middle - eye), own = cross(top + vec3(back.x, 0.0, back.y), ray);
    vec2 all = cross(top, ray).xz;
    float lies = OF(lying, kind) * top.y * ray.y, whole = sqrt(dot(all, all) + lies * lies);
    return broader(whole, dot(run, own.xz));
}

// The same of a kind's heads. They are as broad from all sides, so that one that lies is as long as one that stands; on a strip
// it would come to be as thin as a leaf is, which then lies flat.
float heads_boosted(int kind, vec2 run, vec3 middle, vec3 top, vec2 back) {
    float leaves = boosted(kind, run, middle, top, back);
    if (OF(bears, kind) < 0.5)
        return leaves;
    vec3 ray = normalize(middle - eye), own = cross(top + vec3(back.x, 0.0, back.y), ray);
    return max(leaves, broader(length(cross(top, ray)), dot(run, own.xz)));
}

const vec2 HEADED = vec2(0.1, 0.6);  // tones of paint: stems and leaves of what bears heads are below, petals and florets above

// How much of what is painted in a tone is of heads.
float of_heads(float tone) {
    return smoothstep(HEADED.x, HEADED.y, tone);
}

// The pigment of what is seen on a strip, of that of what is painted there: of blades that lean to `top`, those are seen most
// that face the eye; on a strip that runs along `run`, those that face as it does.
vec3 faced(int kind, vec2 run, vec3 middle, vec3 top) {
    vec2 seen = faces_seen(kind, top, middle - eye) - FACING * vec2(run.y * run.y - run.x * run.x, -2.0 * run.x * run.y);
    return 1.0 + kinds[kind].grain_c * seen.x + kinds[kind].grain_s * seen.y;
}
