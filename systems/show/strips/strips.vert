// An instance is a polygon strip: a column of a strip, between two vertical edges. Its ring gives its number of quads.
#define PIXELS_ASK  // for shadow maps
#include "lib/light.glsl"
#include "lib/posture.glsl"
#include "lib/received.glsl"
#include "lib/stack.glsl"
#include "systems/show/strips/draw.py"
#include "systems/show/hidden.glsl"
#include "systems/show/strips/pages.py"
#include "systems/show/strips/sublevel.py"

uniform usampler2D strips;  // numbers of the polygon strips in the order of drawing
uniform sampler2D extents;  // by column and picture: left, right and top end of the paint, as parts of the column; the page;
                            // last column: the picture's rectangle on the page, by left, bottom, width and height
uniform int first;          // index in `strips` of the first instance
uniform vec2 page_size;     // width and height of a page [texels]
uniform int stride;         // number of polygon strips set aside for a patch

uniform int strips_per_plane;
uniform vec2 sizes[FORMS];  // by form: distance that strips reach beyond their patch [m], and their height [m]
uniform int pictures[RINGS * FORMS];     // by ring and form: index of the first picture
uniform ivec4 stacks[RINGS];             // by ring: columns of a strip, sections of a column, strips of a kind on a patch

#ifdef DEEP
#include "lib/random.glsl"
#endif

#define PASSED out
#include "systems/show/strips/passed.glsl"

const float SHARPER = 0.15;  // mip levels by which texels are finer than pixels, as blades would be washed out
const float NARROWEST = 0.25;  // least distance of blades on the screen, of their painted distance

// Seen from the side, lying blades have the middles of their arches on top, where strips show tips. This is the part of the tips'
// pigment that is missing where all blades lie, on strips of one section. Strips of more sections are bent to arches themselves.
// The steeper the line of sight, the less of it is seen.
const float ARCHED = 0.42;

const float NEAREST = 0.1;  // least distance from the eye, for the length of a metre on the screen [m]

struct Column {
    Placement placement;  // of its patch
    int form, kind, ring, turn;
    int orientation;      // of the strip in the patch's model
    int number;           // in its strip
    int plane;            // of its strip in the patch's model
    int receiver;         // of its first edge
    int picture;          // of its strip
};

struct Edge {
    vec3 rooted;  // in the middle of the strip's slice of the ground, where light is computed for the whole slice
    vec3 foot;    // where the edge is drawn, nearer to the eye
    vec2 bend;
    vec3 top;     // top of its posture, from the foot
    vec2 back;    // distance (x, z) that the edge's top lies back beyond that of its posture
    float dense;  // density of its kind
};

Column column_of(int number) {
    Column column;
    column.placement = placement_of(number / stride);
    int code = int(column.placement.code), along = code / RUNS_ALONG % 2;
    bool is_ahead = code / LIES_AHEAD % 2 == 1;
    column.turn = code % 4;
    column.ring = code / OF_RING;
    column.orientation = (along + column.turn) % 2;
    int columns = stacks[column.ring].x, count = stacks[column.ring].z;
    int on_patch = number % stride, from_far = on_patch / columns / strips_per_plane;
    int place = is_ahead ? count - 1 - from_far : from_far;
    column.number = on_patch % columns;
    // Strips of several kinds share a plane. Each kind is in front on as many planes as it is behind.
    column.form = (on_patch / columns + place) % strips_per_plane;
    column.kind = column.form % KINDS;
    column.plane = stack_place(place, count, column.orientation, along, column.turn);
    column.receiver = int(column.placement.receiver) + (column.kind * count + place) * (columns + 1) + column.number;
    int first_picture = pictures[column.ring * FORMS + column.form];
    column.picture = first_picture + (int(column.placement.model) * 2 + column.orientation) * count + column.plane;
    return column;
}

vec2 foot_of(Column column, int side) {
    int columns = stacks[column.ring].x, count = stacks[column.ring].z;
    return edge_foot(column.placement.cell, column.turn, column.orientation, column.plane, count, column.number + side, columns,
                     sizes[column.form].x);
}

// The edge on a side of a column, 0 or 1, at the ground position `at`. `way` leads from side 0 to side 1.
Edge edge_of(Column column, int side, vec2 at, vec2 way) {
    vec4 texel = received_by(column.receiver + side);
    int count = stacks[column.ring].z;
    float height = sizes[column.form].y * column.placement.growth;
    Edge edge;
    edge.rooted = vec3(at.x, texel.z, at.y);
    edge.foot = pulled_nearer(edge.rooted, way, count);
    edge.bend = bending(column.kind, texel.xy);
    edge.top = posture(float(column.form) * posture_variants, edge.bend, 1.0).place * height;
    edge.back = laid_back(way, edge.foot, edge.top, height, count);
    edge.dense = texel.w;
    return edge;
}

// Length on the screen of a metre across the line of sight [pixels].
float pixels_per_metre(vec3 place) {
    vec3 up = vec3(clip[0][1], clip[1][1], clip[2][1]);
    return half_screen.y * length(up) / max(dot(vec4(clip[0][3], clip[1][3], clip[2][3], clip[3][3]), vec4(place, 1.0)), NEAREST);
}

// Direction on the screen of a way that begins at a point in clip space, as the derivative along it [pixels].
vec2 on_screen(vec4 from, vec3 way) {
    vec4 to = clip * vec4(way, 0.0);
    return (to.xy * from.w - from.xy * to.w) * half_screen / max(from.w * from.w, NEAREST * NEAREST);
}

// Distance on the screen of two blades that are painted a metre apart [pixels]. The wind bends them along `stem`: the more they
// lie, the closer they are.
float blade_distance(vec3 middle, vec2 run, vec3 stem) {
    vec4 from = clip * vec4(middle, 1.0);
    vec2 beside = on_screen(from, vec3(run.x, 0.0, run.y)), along = on_screen(from, stem);
    float between = abs(beside.x * along.y - beside.y * along.x) / max(length(along), LEAST_LENGTH);
    return max(max(between, NARROWEST * length(beside)), LEAST_PART);
}

// The point of an edge at `t` (0 to 1) of its quads' height, and its height in the canopy.
vec4 on_edge(Column column, Edge edge, float t, float sections) {
    float low = min(floor(t * sections), sections - 1.0), variant = float(column.form) * posture_variants;
    vec3 from = posture(variant, edge.bend, low / sections).place, to = posture(variant, edge.bend, (low + 1.0) / sections).place;
    vec3 spine = mix(from, to, t * sections - low) * sizes[column.form].y;
    vec3 there = edge.foot + spine * column.placement.growth + t * vec3(edge.back.x, 0.0, edge.back.y);
    return vec4(there, spine.y / (OF(crown, column.kind) * lodged(edge.bend)));
}

// First and last place to look up in a picture that is painted from `begins` to `ends`, in texels. Farther out, a texel of the
// mip level, which is `texel` wide, mixes the picture with its neighbour, whose edge has dark roots. `side` is the length of the
// picture's side.
float first_unmixed(float begins, float texel) {
    return min(max(floor((begins + 1.0 - SPARE) / ALIGNMENT), 0.0) * ALIGNMENT + 0.5 * texel, begins);
}

float last_unmixed(float ends, float side, float texel) {
    return max(ceil(min(ends - 1.0 + SPARE, side) / ALIGNMENT) * ALIGNMENT - 0.5 * texel, ends);
}

// Part of the vertex's edge that is hidden, from its root on; `a` and `b` are the edges of its column.
float hidden_part(Column column, Edge a, Edge b) {
#if defined(DEEP) || defined(EDGED)
    return 0.0;
#else
    Edge edge = a;
    if ((gl_VertexID & 1) == 1)
        edge = b;
    float tall = sizes[column.form].y * column.placement.growth;
    return hidden_height(edge.rooted, tall, lodged(edge.bend)) / max(tall, LOWEST_CROWN);
#endif
}

// Place of a vertex on its column, across and up, 0 to 1. What is not painted or is hidden is left out. A strip ends a pixel
// beyond its paint, or where the next picture begins. `pixel` is the size of a pixel in parts of the column, and `side` the size
// of the column in texels, each across and up. `level` is the mip level.
vec2 corner_of(Column column, vec4 extent, vec2 pixel, float level, vec2 side, float hidden) {
    float texel = clamp(exp2(ceil(level)), 1.0, ALIGNMENT), before = float(column.number) * side.x;
    float left = column.number == 0 ? first_unmixed(extent.x * side.x, texel) / side.x : 0.0;
    bool is_last = column.number + 1 == stacks[column.ring].x;
    float right = is_last ? (last_unmixed(before + extent.y * side.x, before + side.x, texel) - before) / side.x : 1.0;
    float across = (gl_VertexID & 1) == 1 ? min(extent.y + pixel.x, min(right, 1.0)) : max(extent.x - pixel.x, left);
    float up = min(last_unmixed(extent.z * side.y, side.y, texel) / side.y, 1.0);
    return vec2(across, min(max(float(gl_VertexID / 2) / float(stacks[column.ring].y), hidden), min(extent.z + pixel.y, up)));
}

// Set the varyings of a column's pigment: blades that face the eye are seen most. In dense grass, fragments are lit and coloured
// as less deep in the canopy than they are.
void set_pigment(Column column, vec2 run, vec3 middle, vec3 top, float lying, vec2 slow, ByKind densities) {
    vec3 mean_face = facing_tint(column.kind, run, middle, top), dry = dryness_tint(slow) * mean_face;
    float aside = 1.0 - smoothstep(0.0, 1.0, view_sine(middle)), turned = column.turn % 2 == 0 ? 1.0 : -1.0;
    float arched = 1.0 - ARCHED * inversesqrt(float(stacks[column.ring].y)) * lying * aside;
    if (OF(bears, column.kind) > 0.5)  // heads are on top, even on lying stems
        arched = 1.0;
    float deep = depth_correction(run, middle, stacks[column.ring].z, densities, OF(crown, column.kind) * (1.0 - lying));
    uv.w = mix(1.0, uv.w, deep);
    pigment_change.rgb = (pigment_at(column.kind, 1.0) - pigment_at(column.kind, 0.0)) * dry * arched;
    root_pigment.rgb = pigment_at(column.kind, 0.0) * dry + pigment_change.rgb * (1.0 - deep);
    pigment_change.rgb *= deep;
    grain_cos.rgb = turned * kinds[column.kind].grain_c / mean_face;
    grain_sin.rgb = turned * kinds[column.kind].grain_s / mean_face;
#ifdef EYED
    eyed = has_eyes(column.kind, column.form != column.kind) ? 1.0 : 0.0;
    if (eyed > 0.0)
        grain_sin.rgb = (kinds[column.kind].eye_pigment - kinds[column.kind].tip) * dry;
#endif
}

#ifdef SHADED
const float UNSHADED = 9.0;  // square of the distance of a sun ray from a body's middle beyond which there is no shadow [radii]

// Index of the body whose shadow comes nearest to a column between two places; -1 for none. Fragments find the shadow's edge.
int nearest_body(vec3 a, vec3 b) {
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
// Set the varyings of trees' shade, for a place on a column with this root. `suns` is the sun's part of the light.
void set_tree_shade(vec3 place, vec3 rooted, float suns) {
    float counts;
    spot = on_sun_map(place, rooted, counts).xy;
    past = vec2(halvings_before(on_sun_map(rooted, rooted, counts), counts), suns);
}
#endif

#ifdef CUT
const float UNCUT = 0.999;  // height from which on grass counts as uncut, of the tallest grass

// The varying `cut` of a column; `within` is the distance in which any cut grass counts [m].
vec4 cut_near(Column column, vec2 rooted, vec3 middle, float pixels, float within) {
    float spacing = patch_side / float(stacks[column.ring].z), far = max(distance(middle.xz, eye.xz), 0.5 * patch_side);
    bool is_cut = anything_is_cut() && cut_height_about(rooted, within) < UNCUT * tallest_grass;
    return vec4(float(column.kind), pixels, CROSSED * spacing * abs(eye.y - middle.y) / far, is_cut ? 1.0 : 0.0);
}
#endif

#ifdef THIN
#include "systems/show/strips/thin.glsl"
const float UNHURRIED = 0.15;  // span of ranks that change their sub-level at a time: one by one, blades would flicker
const float SOFTER = 0.35;  // increase of the span of ranks that fade, for each mip level
const float SHARPEST = 0.06;  // narrowest span

// Opacity over rank while a kind changes its form: slope, and value at rank 0. The new form shows the lower ranks, the old one
// the rest.
vec2 form_fade_of(Column column, float soft) {
    float part = OF(came, column.kind);
    if (part <= 0.0)
        return vec2(0.0, 1.0);
    vec2 comes = vec2(-1.0, mix(-0.5 * soft, 1.0 + 0.5 * soft, part)) / soft + vec2(0.0, 0.5);
    return column.form == column.kind ? vec2(0.0, 1.0) - comes : comes;
}

#ifdef HEADS
const float BLADE = 2.83;  // breadth of a blade [texels]: `MANY` of thin.glsl is half of it, and twice

// Mip levels by which texels of a kind may be coarser than those of blades and still show single plants, whose heads are broader.
// There are `fine` texels in a metre.
float levels_to_heads(int kind, float fine) {
    return log2(max(sqrt(kinds[kind].head.y) * fine / BLADE, 1.0));
}
#endif

// Set the varyings by which blades are missing: the density, `dense` at the column's edges, and opacity over rank. Blades fade
// out over a span of ranks, narrow where a texel is one blade, and wide where a pixel is the mean of many. There are `fine` texels in a
// metre.
void set_rank_fade(Column column, vec2 dense, float across, float texels, float fine) {
#ifdef HEADS
    heads.y = levels_to_heads(column.kind, fine);
    texels *= exp2(-heads.y);
#endif
    float soft = clamp(SOFTER * log2(max(texels, 1.0)), SHARPEST, 1.0);
#ifdef EDGED
    pigment_change.a = soft;
#else
    pigment_change.a = 1.0 / rank_span(0.5 * (dense.x + dense.y), soft);
    roots.w = mix(dense.x, dense.y, across);
#endif
    // The edge moves from half a span below all ranks to half a span above them.
    float limit = column.placement.rank_limit, span = max(soft, UNHURRIED), edge = mix(-0.5 * span, 1.0 + 0.5 * span, abs(limit));
    vec2 fade = vec2(-1.0, edge) / span + vec2(0.0, 0.5);
    if (limit < 0.0)
        fade = vec2(0.0, 1.0) - fade;
    grain_cos.a = fade.x;
    grain_sin.a = fade.y;
    form_fade = form_fade_of(column, soft);
}
#endif

void main() {
    int queued = first + gl_InstanceID;
    Column column = column_of(int(texelFetch(strips, ivec2(queued % STRIPS_ROW, queued / STRIPS_ROW), 0).r));
    int k = column.kind;
    ivec4 stack = stacks[column.ring];
    vec2 foot_a = foot_of(column, 0), foot_b = foot_of(column, 1), way = foot_b - foot_a, run = normalize(way);
    Edge a = edge_of(column, 0, foot_a, way), b = edge_of(column, 1, foot_b, way);
    float hidden = hidden_part(column, a, b);  // first, as it takes the most registers while few are taken yet
    vec3 rooted = 0.5 * (a.rooted + b.rooted), middle = 0.5 * (a.foot + b.foot), top = 0.5 * (a.top + b.top);
    vec2 bend = 0.5 * (a.bend + b.bend), back = 0.5 * (a.back + b.back);

    vec4 extent = texelFetch(extents, ivec2(column.number, column.picture), 0);
    vec4 picture = texelFetch(extents, ivec2(textureSize(extents, 0).x - 1, column.picture), 0);
    float pixels = pixels_per_metre(middle), sections = float(stack.y), tall = sizes[column.form].y;
    vec2 side = picture.zw * page_size / vec2(float(stack.x), 1.0);
    float texels = side.y / (tall * blade_distance(middle, run, top + vec3(back.x, 0.0, back.y)));
    float boost = coverage_factor(k, run, middle, top, back), level = log2(texels) - SHARPER;
#ifdef HEADS
    heads = vec2(head_coverage_factor(k, run, middle, top, back) - boost, 0.0);
    level += log2(1.0 + heads.x / boost);  // heads that cover more than is painted have to spread
#endif
    vec2 pixel = 1.0 / (pixels * vec2(distance(a.foot.xz, b.foot.xz), tall));
    vec2 corner = corner_of(column, extent, pixel, level, side, hidden);
    vec4 point = mix(on_edge(column, a, corner.y, sections), on_edge(column, b, corner.y, sections), corner.x);
    gl_Position = clip * vec4(point.xyz, 1.0);
    vec2 at = picture.xy + vec2((float(column.number) + corner.x) / float(stack.x), corner.y) * picture.zw;
    uv = vec4(at, corner.x, point.w);

    Lie lies = lie_at(rooted.xz);
    ByKind densities = density_at(rooted.xz);
    float seen = distant_visibility(rooted, lies.visibility);
#ifdef SHADED
    seen *= bodies_visibility(rooted, nearest_body(a.rooted, b.rooted));
#endif
    roots = vec4(mix(a.rooted.xz, b.rooted.xz, corner.x), corner.y * tall, float(k));
#ifdef CUT
    cut = cut_near(column, rooted.xz, middle, pixels, 2.0 * distance(a.foot.xz, b.foot.xz));
#endif
    Light light = leaf_light(k, bend, rooted, lies, densities, seen);
    float suns = 1.0;
    if (any_lamps())
        light = add_lamps(light, rooted, Reflector(k, bend, lies.normal, 1.0), suns);
    light = hazed(light, middle);
#ifdef SHADED
    spot = vec4(point.xyz, suns);
#elif defined(TREES)
    set_tree_shade(point.xyz, rooted, suns);
#endif
    lit = pack_light(light, vec3(extent.w, level, boost));
    set_pigment(column, run, middle, top, 1.0 - lodged(bend), lies.slow, densities);
    root_pigment.a = column.placement.cover;
#ifdef DEEP
    number = place_number(rooted.xz);
#endif
#ifdef THIN
    set_rank_fade(column, vec2(a.dense, b.dense), corner.x, 0.5 * texels, side.y / tall);
#endif
}
