// One instance is one polygon strip between two vertical edges, as many quads high as its ring asks for.
#define PIXELS_ASK  // for shadow maps
#include "lib/light.glsl"
#include "lib/posture.glsl"
#include "lib/received.glsl"
#include "lib/stack.glsl"
#include "systems/show/strips/draw.py"
#include "systems/show/hidden.glsl"
#include "systems/show/strips/pages.py"
#include "systems/show/strips/sublevel.py"

uniform usampler2D strips;  // by place in the queue: the polygon strip that is drawn
uniform sampler2D extents;  // by column and picture: where paint begins and ends across the column, and up to where; its page;
                            // in the last one where the picture begins on its page, across and up, and how far it reaches
uniform int first;
uniform vec2 page_size;     // texels across and up, of each page
uniform int stride;         // number of polygon strips set aside for a patch

uniform int strips_per_plane;
uniform vec2 sizes[FORMS];  // by form: how far strips reach beyond their patch [m], and how high they are
uniform int pictures[RINGS * FORMS];     // by ring and form: its first picture
uniform ivec4 stacks[RINGS];             // by ring: columns of a strip, sections of a column, strips of a kind on a patch

#ifdef DEEP
#include "lib/random.glsl"
#endif

#define PASSED out
#include "systems/show/strips/passed.glsl"

const float SHARPER = 0.15;  // how much finer texels are than pixels, in levels: blades would be washed out
const float NARROWEST = 0.25;  // blades count as no closer together than this part of how far apart they are painted

// From the side, blades that lie show the middles of their arches on top, where strips show their tips: how much less of their
// tips that is where all lie, on strips of one section. Those of more sections are bent to arches themselves. The steeper the
// line of sight, the less of it is seen.
const float ARCHED = 0.42;

const float NEAREST = 0.1;  // distance from the eye that counts at least, for how long a metre is on the screen [m]

// A column of a strip: which it is, and where it stands.
struct Column {
    Placement placement;  // of its patch
    int form, kind, ring, turn, own;
    int number;    // in its strip
    int plane;     // the strip's, of the patch's model
    int receiver;  // of its first edge
    int picture;   // of the strip
};

// One of its edges.
struct Edge {
    vec3 rooted;  // in the middle of its slice of the ground, where light is asked for in the mean
    vec3 foot;
    vec2 bend;
    vec3 top;     // where its posture has its top, from the foot
    vec2 back;    // how far its top lies back beyond that
    float dense;  // how densely its kind grows there
};

Column column_of(int number) {
    Column column;
    column.placement = placement_of(number / stride);
    int code = int(column.placement.code), along = code / RUNS_ALONG % 2;
    bool is_ahead = code / LIES_AHEAD % 2 == 1;
    column.turn = code % 4;
    column.ring = code / OF_RING;
    column.own = (along + column.turn) % 2;
    ivec4 fine = stacks[column.ring];
    int on_patch = number % stride, walked = on_patch / fine.x / strips_per_plane, count = fine.z;
    int stack = is_ahead ? count - 1 - walked : walked;
    column.number = on_patch % fine.x;
    // Strips of several kinds share a plane: each kind comes to lie in front as often as behind.
    column.form = (on_patch / fine.x + stack) % strips_per_plane;
    column.kind = column.form % KINDS;
    column.plane = stack_place(stack, count, column.own, along, column.turn);
    column.receiver = int(column.placement.receiver) + (column.kind * count + stack) * (fine.x + 1) + column.number;
    int first_one = pictures[column.ring * FORMS + column.form];
    column.picture = first_one + (int(column.placement.model) * 2 + column.own) * count + column.plane;
    return column;
}

vec2 foot_of(Column column, int side) {
    ivec4 fine = stacks[column.ring];
    return edge_foot(column.placement.cell, column.turn, column.own, column.plane, fine.z, column.number + side, fine.x,
                     sizes[column.form].x);
}

// An edge of a column: its first or its second side, where `way` leads from the one to the other.
Edge edge_of(Column column, int side, vec2 at, vec2 way) {
    vec4 told = received_by(column.receiver + side);
    int count = stacks[column.ring].z;
    float height = sizes[column.form].y * column.placement.growth;
    Edge edge;
    edge.rooted = vec3(at.x, told.z, at.y);
    edge.foot = pulled_nearer(edge.rooted, way, count);
    edge.bend = bending(column.kind, told.xy);
    edge.top = posture(float(column.form) * posture_variants, edge.bend, 1.0).place * height;
    edge.back = laid_back(way, edge.foot, edge.top, height, count);
    edge.dense = told.w;
    return edge;
}

// Pixels that a metre is long on the screen, across the line of sight.
float pixels_at(vec3 place) {
    vec3 up = vec3(clip[0][1], clip[1][1], clip[2][1]);
    return half_screen.y * length(up) / max(dot(vec4(clip[0][3], clip[1][3], clip[2][3], clip[3][3]), vec4(place, 1.0)), NEAREST);
}

// Where a way that begins at a point leads on the screen [pixel].
vec2 on_screen(vec4 from, vec3 way) {
    vec4 to = clip * vec4(way, 0.0);
    return (to.xy * from.w - from.xy * to.w) * half_screen / max(from.w * from.w, NEAREST * NEAREST);
}

// Pixels that two blades of a strip are apart on the screen that are painted a metre apart, as the wind has bent them: the
// more they lie, the closer they are.
float apart_at(vec3 middle, vec2 run, vec3 stem) {
    vec4 from = clip * vec4(middle, 1.0);
    vec2 beside = on_screen(from, vec3(run.x, 0.0, run.y)), along = on_screen(from, stem);
    float between = abs(beside.x * along.y - beside.y * along.x) / max(length(along), LEAST_LENGTH);
    return max(max(between, NARROWEST * length(beside)), LEAST_PART);
}

// Where a point of an edge is, `t` of the way up its section's quads, and its height in the canopy.
vec4 on_edge(Column column, Edge edge, float t, float sections) {
    float low = min(floor(t * sections), sections - 1.0), variant = float(column.form) * posture_variants;
    vec3 from = posture(variant, edge.bend, low / sections).place, to = posture(variant, edge.bend, (low + 1.0) / sections).place;
    vec3 spine = mix(from, to, t * sections - low) * sizes[column.form].y;
    vec3 there = edge.foot + spine * column.placement.growth + t * vec3(edge.back.x, 0.0, edge.back.y);
    return vec4(there, spine.y / (OF(crown, column.kind) * lodged(edge.bend)));
}

// Where a picture may begin or end that is painted from `begins`, or to `ends`, of `side` texels: where a texel of its mip-map is
// so large, what is looked up farther out is mixed with the picture beside it, which has dark roots at its edge [texel].
float alone_after(float begins, float texel) {
    return min(max(floor((begins + 1.0 - SPARE) / WHOLE), 0.0) * WHOLE + 0.5 * texel, begins);
}

float alone_before(float ends, float side, float texel) {
    return max(ceil(min(ends - 1.0 + SPARE, side) / WHOLE) * WHOLE - 0.5 * texel, ends);
}

// The part of an edge that nobody sees, from its root on.
float hidden_of(Column column, Edge edge) {
#if defined(DEEP) || defined(EDGED)
    return 0.0;
#else
    float tall = sizes[column.form].y * column.placement.growth;
    return hidden_to(edge.rooted, tall, lodged(edge.bend)) / max(tall, LOWEST_CROWN);
#endif
}

// Where a vertex is on its column, across and up: nothing is drawn where nothing is painted or seen, and a strip ends a pixel beyond
// its paint, or where the next picture begins. A pixel is so large in widths of the column and in heights; `side` texels are in it,
// and what is looked up is of this level of their mip-maps.
vec2 corner_of(Column column, vec4 extent, vec2 pixel, float level, vec2 side, float hidden) {
    float texel = clamp(exp2(ceil(level)), 1.0, WHOLE), before = float(column.number) * side.x;
    float left = column.number == 0 ? alone_after(extent.x * side.x, texel) / side.x : 0.0;
    bool is_last = column.number + 1 == stacks[column.ring].x;
    float right = is_last ? (alone_before(before + extent.y * side.x, before + side.x, texel) - before) / side.x : 1.0;
    float across = (gl_VertexID & 1) == 1 ? min(extent.y + pixel.x, min(right, 1.0)) : max(extent.x - pixel.x, left);
    float up = min(alone_before(extent.z * side.y, side.y, texel) / side.y, 1.0);
    return vec2(across, min(max(float(gl_VertexID / 2) / float(stacks[column.ring].y), hidden), min(extent.z + pixel.y, up)));
}

// What all of a column's fragments have in common of its pigment: what faces the eye is seen most. Where grass grows so densely,
// they are lit and dyed as less deep than they are.
void dye(Column column, vec2 run, vec3 middle, vec3 top, float lying, vec2 slow, ByKind grows) {
    vec3 mean_face = facing_tint(column.kind, run, middle, top), dry = dryness_tint(slow) * mean_face;
    float aside = 1.0 - smoothstep(0.0, 1.0, view_sine(middle)), turned = column.turn % 2 == 0 ? 1.0 : -1.0;
    float arched = 1.0 - ARCHED * inversesqrt(float(stacks[column.ring].y)) * lying * aside;
    if (OF(bears, column.kind) > 0.5)  // heads are on top, however they lie
        arched = 1.0;
    float deep = depth_correction(run, middle, stacks[column.ring].z, grows, OF(crown, column.kind) * (1.0 - lying));
    on.w = mix(1.0, on.w, deep);
    rise.rgb = (pigment_at(column.kind, 1.0) - pigment_at(column.kind, 0.0)) * dry * arched;
    foot.rgb = pigment_at(column.kind, 0.0) * dry + rise.rgb * (1.0 - deep);
    rise.rgb *= deep;
    grain_cos.rgb = turned * kinds[column.kind].grain_c / mean_face;
    grain_sin.rgb = turned * kinds[column.kind].grain_s / mean_face;
#ifdef EYED
    eyed = has_eyes(column.kind, column.form != column.kind) ? 1.0 : 0.0;
    if (eyed > 0.0)
        grain_sin.rgb = (kinds[column.kind].eye_pigment - kinds[column.kind].tip) * dry;
#endif
}

#ifdef SHADED
const float UNSHADED = 9.0;  // square of how far off a body's middle the sun's ray goes where nothing is shaded, in radii

// The body whose shadow comes nearest to a column between two places; none is -1. Where it ends, pixels find out.
int shading(vec3 a, vec3 b) {
    int nearest = -1;
    float least = UNSHADED;
    shadow = vec4(least, 0.0, 0.0, 1.0);
    for (int body = 0; body < BODIES && bodies[body].radius > 0.0; body++) {
        vec4 from = ray_offset(body, a), to = ray_offset(body, b);
        vec3 way = to.xyz - from.xyz, near = vec3(dot(from.xyz, from.xyz), 2.0 * dot(from.xyz, way), dot(way, way));
        float at = clamp(-0.5 * near.y / max(near.z, LEAST_LENGTH), 0.0, 1.0), nearness = near.x + at * (near.y + at * near.z);
        if (nearness < least) {
            least = nearness;
            nearest = body;
            shadow = vec4(near, 0.5 * (from.w + to.w));
        }
    }
    return nearest;
}
#endif

#if defined(TREES) && !defined(SHADED)
// Where maps of trees tell of a place on a column that is rooted so, and how much that counts; of lights, the sun's part.
void tell_shade(vec3 place, vec3 rooted, float suns) {
    float counts;
    spot = on_sun_map(place, rooted, counts).xy;
    past = vec2(counts * part_before(on_sun_map(rooted, rooted, counts)), suns);
}
#endif

#ifdef CUT
const float UNCUT = 0.999;  // grass that is left to stand so high, of the tallest, is not cut

// What pixels of a column must know where anything is cut within so many metres of it.
vec4 cut_about(Column column, vec2 rooted, vec3 middle, float pixels, float within) {
    float spacing = patch_side / float(stacks[column.ring].z), far = max(distance(middle.xz, eye.xz), 0.5 * patch_side);
    bool is_cut = anything_is_cut() && cut_height_about(rooted, within) < UNCUT * tallest_grass;
    return vec4(float(column.kind), pixels, CROSSED * spacing * abs(eye.y - middle.y) / far, is_cut ? 1.0 : 0.0);
}
#endif

#ifdef THIN
#include "systems/show/strips/thin.glsl"
const float UNHURRIED = 0.15;  // part of all ranks that change their sub-level at a time: one by one, blades would flicker
const float SOFTER = 0.35;  // how much wider the span of ranks is that go, of all, each time that texels are half as large
const float SHARPEST = 0.06;  // the narrowest

// What shows by rank of a form while its kind becomes another: the lower ranks of what comes, the higher of what goes.
vec2 aged_by(Column column, float soft) {
    float part = OF(came, column.kind);
    if (part <= 0.0)
        return vec2(0.0, 1.0);
    vec2 comes = vec2(-1.0, mix(-0.5 * soft, 1.0 + 0.5 * soft, part)) / soft + vec2(0.0, 0.5);
    return column.form == column.kind ? vec2(0.0, 1.0) - comes : comes;
}

// How much of a texel stays where its kind grows so densely at the column's edges, and where only blades of some ranks show: the
// others go, over a span of ranks that is narrow where a texel is one blade, and wide where a pixel is the mean of many.
void thin(Column column, vec2 dense, float at, float texels) {
    float soft = clamp(SOFTER * log2(max(texels, 1.0)), SHARPEST, 1.0);
#ifdef EDGED
    rise.a = soft;
#else
    rise.a = 1.0 / span_of(0.5 * (dense.x + dense.y), soft);
    roots.w = mix(dense.x, dense.y, at);
#endif
    // The span must reach from below all ranks to above them, softness included.
    float below = column.placement.rank_limit, span = max(soft, UNHURRIED), edge = mix(-0.5 * span, 1.0 + 0.5 * span, abs(below));
    vec2 stays = vec2(-1.0, edge) / span + vec2(0.0, 0.5);
    if (below < 0.0)
        stays = vec2(0.0, 1.0) - stays;
    grain_cos.a = stays.x;
    grain_sin.a = stays.y;
    aged = aged_by(column, soft);
}
#endif

void main() {
    int queued = first + gl_InstanceID;
    Column column = column_of(int(texelFetch(strips, ivec2(queued % STRIPS_ROW, queued / STRIPS_ROW), 0).r));
    int k = column.kind;
    ivec4 fine = stacks[column.ring];
    vec2 foot_a = foot_of(column, 0), foot_b = foot_of(column, 1), way = foot_b - foot_a, run = normalize(way);
    Edge a = edge_of(column, 0, foot_a, way), b = edge_of(column, 1, foot_b, way);
    vec3 rooted = 0.5 * (a.rooted + b.rooted), middle = 0.5 * (a.foot + b.foot), top = 0.5 * (a.top + b.top);
    vec2 bend = 0.5 * (a.bend + b.bend), back = 0.5 * (a.back + b.back);

    vec4 extent = texelFetch(extents, ivec2(column.number, column.picture), 0);
    vec4 picture = texelFetch(extents, ivec2(textureSize(extents, 0).x - 1, column.picture), 0);
    float pixels = pixels_at(middle), sections = float(fine.y), tall = sizes[column.form].y;
    vec2 side = picture.zw * page_size / vec2(float(fine.x), 1.0);
    float texels = side.y / (tall * apart_at(middle, run, top + vec3(back.x, 0.0, back.y)));
    float boosts = coverage_factor(k, run, middle, top, back), level = log2(texels) - SHARPER;
#ifdef HEADS
    heads = head_coverage_factor(k, run, middle, top, back);
    level += log2(heads / boosts);  // what covers more than it is painted has to spread
#endif
    vec2 pixel = 1.0 / (pixels * vec2(distance(a.foot.xz, b.foot.xz), tall));
    Edge own = a;
    if ((gl_VertexID & 1) == 1)
        own = b;
    vec2 corner = corner_of(column, extent, pixel, level, side, hidden_of(column, own));
    vec4 point = mix(on_edge(column, a, corner.y, sections), on_edge(column, b, corner.y, sections), corner.x);
    gl_Position = clip * vec4(point.xyz, 1.0);
    vec2 at = picture.xy + vec2((float(column.number) + corner.x) / float(fine.x), corner.y) * picture.zw;
    on = vec4(at, corner.x, point.w);

    Lie lies = lie_at(rooted.xz);
    ByKind grows = density_at(rooted.xz);
    float seen = distant_visibility(rooted, lies.visibility);
#ifdef SHADED
    seen *= bodies_visibility(rooted, shading(a.rooted, b.rooted));
#endif
    roots = vec4(mix(a.rooted.xz, b.rooted.xz, corner.x), corner.y * tall, float(k));
#ifdef CUT
    cut = cut_about(column, rooted.xz, middle, pixels, 2.0 * distance(a.foot.xz, b.foot.xz));
#endif
    Light light = leaf_light(k, bend, rooted, lies, grows, seen);
    float suns = 1.0;
    if (any_lamps())
        light = add_lamps(light, rooted, Reflector(k, bend, lies.normal, 1.0), suns);
    light = hazed(light, middle);
#ifdef SHADED
    spot = vec4(point.xyz, suns);
#elif defined(TREES)
    tell_shade(point.xyz, rooted, suns);
#endif
    lit = pack_light(light, vec3(extent.w, level, boosts));
    dye(column, run, middle, top, 1.0 - lodged(bend), lies.slow, grows);
    foot.a = column.placement.cover;
#ifdef DEEP
    number = place_number(rooted.xz);
#endif
#ifdef THIN
    thin(column, vec2(a.dense, b.dense), corner.x, 0.5 * texels);
#endif
}
