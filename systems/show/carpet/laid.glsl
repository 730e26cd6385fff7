// The grass at a vertex of the mesh, and the height of the carpet there.
#include "systems/show/carpet/border.glsl"
#include "systems/show/carpet/lit.glsl"
#include "systems/show/carpet/mesh.glsl"
#include "systems/show/carpet/sight.glsl"
#include "lib/mown.glsl"
#ifdef TRODDEN
#include "systems/press/press.glsl"
#endif

const float STOPPED = 0.6;          // typical depth at which a line of sight is stopped, as a fraction of the height of the grass
const float FARTHEST = 5.0;         // largest distance ahead at which curvature is measured, in distances close by
const float NEAR_CELLS = 4.0;       // the distance close by, in cells of the terrain
const float TRODDEN_HEIGHT = 0.05;  // height of the carpet where all grass lies flat, as a fraction of its usual height
const float UNCUT = 1e9;            // cut height of uncut grass [m]
const float SPARSEST = 0.02;        // least density at which a neighbour tells what grows around a vertex
const float EDGE = 0.01;            // a vertex this near to a patch's edge counts for both patches [m]

uniform ByKind raised; // by kind: height of the carpet above the ground [m]

struct Laid {
    float ground;          // height of the ground [m]
    float share;           // the carpet's share of the grass, in [0, 1]
    ByKind densities;      // density of each kind
    float cut_height;      // height to which it is cut [m]
    float tall;            // height of the carpet [m]
    float tops;            // height of the tops that form the silhouette over a crest, as a fraction of `tall`
    float trodden_height;  // fraction of `tall` that is left where grass is trodden
    float lowered;         // how much lower the carpet lies than where no strips stand [m]
    float leaf_area;       // leaf area index, seen from the side
    vec2 rise;             // gradient of the ground along x and z [m/m]
    float curvature;       // decrease of the gradient along the line of sight [1/m]; positive over a crest
    float stands;          // height of the grass in the wind, as a fraction of that at rest
    vec2 message;          // message of the wind
    float slope;           // slope of the line of sight to the ground [m/m]
    float crest_weight;    // degree to which the line of sight passes over a crest there, in [0, 1]
    float rim_path;        // path over a rim, from rim_path_at
};

// The least of the carpet's shares of the patches that a place lies on or next to.
float lowest_share(vec2 place) {
    ivec2 low = ivec2(floor((place - EDGE) * patches_per_metre)), high = ivec2(floor((place + EDGE) * patches_per_metre));
    return min(min(share_at(low), share_at(high)), min(share_at(ivec2(low.x, high.y)), share_at(ivec2(high.x, low.y))));
}

// Height of the grass under a message of the wind, as a fraction of that at rest.
float height_in_wind(ByKind densities, vec2 message) {
    ByKind area = leaf_areas(densities);
    float high = 0.0;
    for (int kind = 0; kind < KINDS; kind++)
        high += OF(area, kind) * lodged(bending(kind, message));
    return total(area) > TINY ? high / total(area) : 1.0;
}

// Curvature of the ground along a line of sight [1/m], positive over a crest: the greater of that at the place and that on the way
// on through the grass. `here` is the height of the ground at the place [m].
float curvature_at(vec2 place, float here, vec2 rise, float slope, float tall) {
    float near_by = max(NEAR_CELLS * terrain_cell, 2.0 * grid_spacing);
    float far = clamp(STOPPED * tall / max(slope, FLATTEST), near_by, FARTHEST * near_by);
    vec2 way = heading_to(place);
    float bulges = (2.0 * here - height_at(place + way * near_by) - height_at(place - way * near_by)) / (near_by * near_by);
    float falls = 2.0 * (here + dot(rise, way) * far - height_at(place + way * far)) / (far * far);
    return max(bulges, falls);
}

// Gradient of the ground over a grid spacing.
vec2 mesh_rise_at(vec2 at) {
    vec2 step = vec2(max(terrain_cell, grid_spacing), 0.0);
    return vec2(height_at(at + step.xy) - height_at(at - step.xy), height_at(at + step.yx) - height_at(at - step.yx)) / (2.0 * step.x);
}

const int NEIGHBOURS = 5, ALL_NEIGHBOURS = 9;  // a vertex with its four straight neighbours, and with the four diagonal ones too

// The place of a neighbour, 0 for the vertex itself.
vec2 neighbour(vec2 place, int number) {
    ivec2 diagonal = ivec2(number - NEIGHBOURS) >> ivec2(0, 1) & 1, straight = ivec2(number > 2, number == 1 || number == 2);
    vec2 way = number < NEIGHBOURS ? vec2(straight) * (number % 2 == 0 ? 1.0 : -1.0) : vec2(diagonal) * 2.0 - 1.0;
    return place + way * grid_spacing;
}

#ifdef EDGED
// Densities at a vertex: those of the densest neighbour, as pixels find out themselves how much grass there is.
ByKind densest_about(vec2 place) {
    ByKind densest = all_kinds(0.0);
    for (int number = 0; number < NEIGHBOURS; number++) {
        ByKind densities = density_at(neighbour(place, number));
        if (total(densities) > total(densest))
            densest = densities;
    }
    return total(densest) > SPARSEST ? densest : all_kinds(1.0 / float(KINDS));
}
#endif

// Least fraction of the carpet's height that is left where grass is trodden around a vertex: so what a game lays there is not hidden.
// Where all grass lies flat, only blades on top of one another are left of the height.
float trodden_height_about(vec2 place, ByKind densities) {
    float lowest = 1.0;
#ifdef TRODDEN
    ByKind area = leaf_areas(densities);
    float all = max(total(area), TINY);
    for (int number = 0; number < ALL_NEIGHBOURS; number++) {
        vec2 at = neighbour(place, number);
        if (!trodden_at(at))
            continue;
        float stands_up = 0.0;
        for (int kind = 0; kind < KINDS; kind++) {
            vec2 bend = bending(kind, pressing(at, kind));
            stands_up += OF(area, kind) * max(1.0 - dot(bend, bend), 0.0);
        }
        lowest = min(lowest, max(stands_up / all, TRODDEN_HEIGHT));
    }
#endif
    return lowest;
}

const float TALLEST = 4.0;  // exponent of the mean over kinds: a few tall plants are enough to hide what is behind a crest

// Height of the tops of all kinds that are seen over a crest, as a fraction of the mean height.
float tops_height(ByKind densities, float cut_height) {
    float sum = 0.0, mean = 0.0, all = max(total(densities), TINY);
    for (int kind = 0; kind < KINDS; kind++) {
        float high = min(OF(raised, kind), cut_height);
        mean += OF(densities, kind) * high;
        sum += OF(densities, kind) * pow(high, TALLEST);
    }
    return mean > TINY ? pow(sum / all, 1.0 / TALLEST) * all / mean : 1.0;
}

// Set the densities and heights of the grass at a vertex.
void set_grass(inout Laid laid, vec2 place) {
#ifdef EDGED
    laid.densities = densest_about(place);
    laid.cut_height = UNCUT;
    laid.tall = 0.0;
    for (int kind = 0; kind < KINDS; kind++)
        laid.tall = max(laid.tall, OF(raised, kind));
#else
    laid.densities = density_at(place);
    laid.cut_height = anything_is_cut() ? cut_height_about(place, grid_spacing) : UNCUT;
    laid.tall = 0.0;
    for (int group = 0; group < GROUPS; group++)
        laid.tall += dot(laid.densities[group], min(raised[group], laid.cut_height));
    laid.tall /= max(total(laid.densities), 1.0);
#endif
    laid.tops = tops_height(laid.densities, laid.cut_height);
    laid.trodden_height = trodden_height_about(place, laid.densities);
    laid.leaf_area = weighted_sum(laid.densities, leaf_areas(leaf_area_left(laid.cut_height)));
}

#include "systems/show/carpet/rim.glsl"

// The grass at a place of the ground; the place is raised to the carpet.
Laid laid_on(inout vec3 place) {
    Laid laid;
    laid.ground = place.y;
    laid.share = lowest_share(place.xz);
    set_grass(laid, place.xz);
    laid.rise = mesh_rise_at(place.xz);
    float high = laid.share * laid.tall * laid.trodden_height;
    place.y += high;
    laid.curvature = curvature_at(place.xz, laid.ground, laid.rise, viewing_slope(laid.rise, place), laid.tall);
    laid.message = message_at(place.xz);
    laid.stands = height_in_wind(laid.densities, laid.message);
    float deep = deepest(max(viewing_slope(laid.rise, place), 0.0), laid.curvature, laid.tall * laid.stands);
    float lifts = carpet_lift(deep, laid.curvature, laid.stands);
    laid.crest_weight = crest_weight(deep, laid.curvature);
    float at_rim = carpet_lift(0.0, CREST_CURVATURE, laid.stands);
    laid.rim_path = rim_path_at(place + vec3(0.0, high * (at_rim - 1.0), 0.0), laid.ground, laid.tall * laid.stands / RAISED);
    lifts = laid.rim_path < NO_RIM ? at_rim : lifts;
    place.y += high * (lifts - 1.0);
    laid.lowered = (1.0 - laid.share) * laid.tall * laid.trodden_height * lifts;
    laid.slope = viewing_slope(laid.rise, place);
    return laid;
}

const vec2 LOW = vec2(0.1, 0.4);  // slopes of lines of sight up to which their hit on the ground counts, and from which on it does not

// The place of the ground that is seen between blades: at a low angle it is metres behind the place on the carpet.
vec3 seen_behind(vec3 place, float ground, float slope) {
    float over = max(place.y - ground, 0.0) * (1.0 - smoothstep(LOW.x, LOW.y, slope));
    return on_ground(place.xz + heading_to(place.xz) * min(over / max(slope, LOWEST), FARTHEST_SEEN));
}

// Densities at a place of the ground that is seen from a vertex of the mesh.
ByKind grown_at(vec2 place, Laid laid) {
#ifdef EDGED
    return laid.densities;
#else
    return density_at(place);
#endif
}
