// One instance is one blade, as blade.vert has made it out: a ribbon of SEGMENTS quads. With SOFT it is drawn half a pixel
// wider on either side, and the fragments say how much of each pixel it covers; so a blade thinner than a pixel is faint,
// and not a row of dots. With MORPH it is on its way to its painted place on a moving strip (paper, section 4.2).
#define PIXELS_ASK  // lamps are in its light already
#include "lib/light.glsl"
#include "lib/posture.glsl"
#include "systems/grow/bend.py"
#include "systems/show/blades/organs.glsl"

in vec4 foot;
in vec4 lie_of;
in vec4 low;
in vec4 high;
in mat4 lit;
in vec4 stands;
in vec4 joints;
#ifdef MORPH
#include "lib/painted.glsl"

in vec4 base;
in vec4 painted;
#endif

centroid out vec3 color;
flat out float shown;
#ifdef FOLDS
centroid out vec3 keel;  // how much brighter the face to the right of a fold is than both
#endif
#ifdef TOOTHED
#include "systems/show/blades/teeth.glsl"

out vec4 tooth;  // which of them, from the root on; from left, -1, to right, 1; how much is seen. Or, of ligules, how far along them;
                 // which of them, from the middle on, times the fourth; how much is seen, below 0; how wide all are there
#endif
#ifdef SOFT
noperspective out float aside;  // from the middle line [pixel]
noperspective out float half_width;  // of the ribbon [pixel]
#ifdef ORGANS
noperspective out float onward;  // from its middle [pixel]
flat out float half_length;  // [pixel]
#endif
#ifdef PARTED
flat out float hides;  // coverage from which on a pixel counts as hidden behind it
uniform int part;      // 1: where it hides what is behind it; 2: the rest
#endif
#endif

#ifndef DEEP
flat out vec2 veined;  // how much is seen of its rib; and of its veins
#ifndef SOFT
out vec2 across;  // from left to right, times how wide it is there; and that
#endif
#endif

#ifdef DEEP
#include "lib/random.glsl"

flat out int number;
#endif

const float AT_TIP = 0.9999;  // part of a blade from which on it is its tip
const float LEAST_BREADTH = 1e-3;  // of a blade, at its tip
const float POINTED = 1e-4;  // half the breadth of an end that is seen as a point, of its distance

// Width of a blade at part `t` of it: as systems/grow/bend.py has it. It ends as bluntly as makes up for what the last segment
// cuts off, but in a point where it is seen from near by, unless it is round. Where segments are longer than the waist, it is
// less drawn in, so that the blade is as broad in the mean.
float profile(float t, float taper, float segments) {
    if (!is_blade(int(stands.z)))
        return width_of(int(stands.z), t);
    float narrower = kinds[int(joints.z)].narrowed;
    if (t > AT_TIP) {
        float blunt = pow(segments, -taper) * max((1.0 - taper) / (1.0 + taper), 0.0);
        return narrower < 0.0 ? blunt : min(blunt, POINTED * distance(foot.xyz, eye) / max(length(lie_of.zw), LEAST_LENGTH));
    }
    float waist = max(narrower, 0.0) * min(WIDENS * segments, 1.0);
    return pow(max(1.0 - t, 0.0), taper) * (1.0 - waist * max(1.0 - t / WIDENS, 0.0));
}

uniform int segments;                // of a ribbon
uniform int counts;                  // sub-levels
uniform int segments_of[SUBLEVELS];  // of a blade, sub-level by sub-level
#ifdef OWN_SEGMENTS
const int own_segments[KINDS] = OWN_SEGMENTS;  // of kinds that say how many at the finest level; 0 of the others
#endif

// How many segments a blade of a kind has on a sub-level.
int segments_on(int level, int k) {
#ifdef OWN_SEGMENTS
    int own = own_segments[k];
#ifdef FINEST
    if (own > 0 && level == 0)
        return own;
#endif
    return own > 0 ? min(own, segments_of[level]) : segments_of[level];
#else
    return segments_of[level];
#endif
}

// The part of a blade where its joint is that is nearest to part `t`, of so many segments.
float joint_at(float t, int segments) {
    return floor(t * float(segments) + 0.5) / float(segments);
}

// A point of a ribbon on its way.
struct Point {
    vec3 place;
    vec3 tangent;
    vec2 across;  // half the ribbon, to the point's side
};

const float NEAREST = 0.15;  // distance from the eye below which a ribbon is as wide as it is [m]
const float UNEDGED = 8.0;  // how wide it counts there, and how long where its ends are not soft [pixel]
#ifdef ORGANS
const float SMALL = 4.0;  // length up to which what stands on the tip of a stem is drawn straight, and with soft ends [pixel]
#endif

#ifdef SOFT
// Whether the `side` of a ribbon that a point is on is seen on the other side of its line, where that runs upwards on the screen.
bool is_turned(Point point, float side) {
    vec3 across = vec3(clip[0].x, clip[1].x, clip[2].x), up = vec3(clip[0].y, clip[1].y, clip[2].y), ahead = vec3(clip[0].w, clip[1].w, clip[2].w);
    float face = dot(cross(point.tangent, vec3(point.across.x, 0.0, point.across.y)), point.place - eye);
    return side * face * dot(cross(across, up), ahead) < 0.0;  // in a mirror the other way round
}

// Move a point to one side, -1 or 1, on the screen, so that the ribbon reaches half a pixel beyond its edge.
vec4 widened(Point point, float t, float to) {
    vec4 middle = clip * vec4(point.place, 1.0);
#ifdef ORGANS
    onward = 0.0;
    half_length = UNEDGED;
#endif
    vec4 edge = clip * vec4(point.across.x, 0.0, point.across.y, 0.0);
    if (middle.w < NEAREST) {
        half_width = UNEDGED;
        aside = (half_width - 0.5) * to;  // its edges are not soft, and it covers all between
        return middle + edge;
    }
    vec3 along = point.tangent;
#ifdef ORGANS
    bool is_small = is_at_tip(int(stands.z)) && foot.w * pixels_per_metre() < SMALL * middle.w;
    if (is_small)
        along = posture(low.w, lie_of.xy, 1.0).place * foot.w;
#endif
    vec4 ahead = clip * vec4(along, 0.0);
    vec2 run = (ahead.xy * middle.w - middle.xy * ahead.w) * half_screen;
    vec2 wide = (edge.xy * middle.w - middle.xy * edge.w) * half_screen / (middle.w * middle.w);
    vec2 normal = vec2(-run.y, run.x) / max(length(run), LEAST_SQUARE);
    float out_by = dot(wide, normal);
    half_width = abs(out_by);
    aside = (half_width + 0.5) * to;
    // Seen aslant, its two edges are not level with one another along it: that shows in petals and leaves, which are broad.
    vec2 level = (wide - normal * out_by) * (out_by < 0.0 ? -to : to);
    middle.xy += (normal * aside + level) / half_screen * middle.w;
#ifdef ORGANS
    if (is_small) {
        half_length = 0.5 * length(run) / (middle.w * middle.w);
        onward = (2.0 * t - 1.0) * (half_length + 0.5);
        middle.xy += vec2(normal.y, -normal.x) * (t - 0.5) / half_screen * middle.w;
    }
#endif
    return middle;
}
#endif

#ifdef EYED
const float ASLANT = 0.2;  // cosine between a petal's face and the line of sight from which on it is seen from within, or outside
#ifdef SOFT
const float UNHIDDEN = 0.2;  // of the feet of a cup's petals, how much is seen past others and past stamens: measured on poppies
const vec2 BY_ORDER = vec2(0.5, 2.0);  // coverages from which on a ribbon hides what is behind it, where depth says so, and where order alone does
#endif

// How far a point at part `t` of a blade is seen in the colour of its head's eye. A petal leans outwards to where it faces. Where order
// alone says what is before it, neither other petals nor the eye itself hide its foot.
float eyed_seen(Point point, float t) {
    int organ = int(stands.z);
    if (!is_blotched(organ))
        return eyed_at(organ, t);
    vec2 out_to = normalize(vec2(lie_of.w, -lie_of.z));
    vec3 along = normalize(point.tangent), within = vec3(-out_to * along.y, dot(out_to, along.xz)).xzy;
    float seen = clamp(0.5 - 0.5 / ASLANT * dot(within, normalize(point.place - eye)), 0.0, 1.0);
#ifdef SOFT
    seen *= mix(1.0, UNHIDDEN, smoothstep(BY_ORDER.x, BY_ORDER.y, joints.y));
#endif
    return eyed_at(organ, t) * seen;
}
#endif

#ifdef MORPH
// The radiance of a blade of kind `k` with this face normal, where it is painted: its tone is `t`, and so much of it is its eye's.
vec3 painted_light(int k, float t, float eyed, vec2 face, Painted target) {
    Lie lies = lie_at(target.middle.xz);
    ByKind grows = density_at(target.middle.xz);
    float deep = depth_correction(target.run.xz, target.middle, stacks[int(joints.w)].z, grows, OF(crown, k) * lodged(target.bend));
    vec3 pigment = pigment_at(k, mix(1.0, t, deep), eyed) * dryness_tint(lies.slow) * azimuth_tint(k, doubled_angle(face));
    pigment *= facing_tint(k, normalize(target.run.xz), target.middle, target.top);
    Light light = leaf_light(k, target.bend, target.middle, lies, grows);
    if (has_casters())
        light = shadowed(light, casters_visibility(target.place), 1.0);
    if (any_lamps()) {
        float suns;
        light = add_lamps(light, target.middle, Reflector(k, target.bend, lies.normal, 1.0), suns);
    }
    light = hazed(light, target.middle);
    if (anything_is_cut())
        light = light_when_cut(cut_height_at(target.place.xz), light, k, leaf_areas(grows));
    return shade(leaf_surface(pigment, mix(1.0, target.h, deep)), light);
}

// Bring a point at part `t` of a blade nearer to where it is painted, and its light to what it is there.
void bring(inout Point point, inout vec3 light, float t, int k) {
    Painted target = painted_at(base, int(painted.x), int(painted.y), painted.z, t, k, form_of(low.w), int(joints.w));
    vec2 run = normalize(target.run.xz), tones = tones_of(int(stands.z)), face = normalize(vec2(lie_of.w, -lie_of.z));
    float wide = dot(run, point.across);
    if (is_blade(int(stands.z)) && kinds[k].narrowed < 0.0)  // it is round
        wide = sign(wide) * length(point.across);
    point.place = mix(point.place, target.place, painted.w);
    point.tangent = mix(point.tangent, target.tangent, painted.w);
    float boost = coverage_factor(k, run, target.middle, target.top, target.back);
    if (OF(bears, k) > 0.5)
        boost = mix(boost, head_coverage_factor(k, run, target.middle, target.top, target.back), head_part(mix(tones.x, tones.y, t)));
    point.across = mix(point.across, run * wide * boost, painted.w);
    float eyed = 0.0;
#ifdef EYED
    eyed = eyed_seen(point, t);
#endif
    light = mix(light, painted_light(k, mix(tones.x, tones.y, t), eyed, face, target), painted.w);
}
#endif

#ifdef TOOTHED
// How much wider a ribbon is for its teeth or ligules, and what fragments must know of them.
float widened_by_teeth(float t, float side) {
    int organ = int(stands.z);
#ifdef MORPH
    float seen = outline_seen(organ, foot.w, 2.0 * length(lie_of.zw), foot.xyz) * (1.0 - painted.w);
#else
    float seen = joints.w;
#endif
    float wide = width_of(organ, t);
    tooth = seen < 0.0 ? vec4(t, 0.5 * side * LIGULES_OF[organ] * wide, seen, wide) : vec4(t * TEETH_OF[organ], side, seen, 1.0);
    return seen < 0.0 ? mix(1.0, LIGULES_WIDER, -seen) : mix(1.0, TOOTHED_WIDER, seen);
}
#endif

#ifndef DEEP
// What is seen of the veins of what a ribbon is: leaves have a rib, blades that are not round have veins beside it.
vec2 veins_of(int organ, int k) {
    float flat_one = float(is_blade(organ) && kinds[k].narrowed >= 0.0), seen = max(flat_one, float(is_leaf(organ)));
#ifdef MORPH
    return vec2(seen, flat_one) * (1.0 - painted.w);
#else
    return vec2(seen, flat_one);
#endif
}
#endif

#ifdef PARTED
// Leave a blade out of the pass over what hides what is behind it.
void leave_out() {
    gl_Position = vec4(2.0, 2.0, 2.0, 1.0);
    color = vec3(0.0);
    aside = half_width = shown = 0.0;
#ifdef ORGANS
    onward = half_length = 0.0;
#endif
    veined = vec2(0.0);
#ifdef TOOTHED
    tooth = vec4(0.0, 0.0, 0.0, 1.0);
#endif
#ifdef FOLDS
    keel = vec3(0.0);
#endif
}
#endif

// Up to which part of it, from the foot on, nobody sees a blade; the sun does.
float unseen() {
#ifdef DEEP
    return 0.0;
#else
    return high.w;
#endif
}

// The part of the blade that a vertex is at, and how broad the blade is there.
vec2 along_blade(int k) {
    int level = min(int(joints.x), counts - 1);
    int fine = segments_on(level, k), coarse = segments_on(min(level + 1, counts - 1), k);
    float t = float(gl_VertexID / 2) / float(segments), left = 1.0 - fract(stands.z), taper = kinds[k].taper;
    float of_fine = max(left * joint_at(t, fine), unseen()), broad = profile(of_fine, taper, float(fine));
#ifndef MORPH
    float slide = fract(joints.x), of_coarse = max(left * joint_at(t, coarse), unseen());
    // A blade's width slides along with its joints: as it is where they are meanwhile, a tip would be far broader.
    if (slide > 0.0) {
        broad = mix(broad, profile(of_coarse, taper, float(coarse)), slide);
        of_fine = mix(of_fine, of_coarse, slide);
    }
#endif
    return vec2(of_fine, broad);
}

// Which side's light a point has, and to which side of its line it is moved.
vec2 sides_of(Point point, float side) {
#ifdef SOFT
    // Far off, points are moved to both sides by turns, or a ribbon would be twisted where it is seen edge-on.
    if (is_turned(point, side))
        return distance(foot.xyz, eye) < foot.w + NEAREST ? vec2(side, -side) : vec2(-side, side);
#endif
    return vec2(side);
}

void main() {
    shown = stands.w;
#ifdef PARTED
    hides = joints.y;
    if (part == 1 && hides > 1.0) {
        leave_out();
        return;
    }
#endif
    int k = int(joints.z);
    vec2 along = along_blade(k);
    float t = along.x, side = float(gl_VertexID % 2) * 2.0 - 1.0;
    Spine spine = posture(low.w, lie_of.xy, t);
    Point point = Point(foot.xyz + spine.place * foot.w, spine.tangent * foot.w, lie_of.zw * (side * along.y));
#ifdef TOOTHED
    point.across *= widened_by_teeth(t, side);
#endif
#ifndef DEEP
    veined = veins_of(int(stands.z), k);
#ifndef SOFT
    across = vec2(side, 1.0) * max(along.y, LEAST_BREADTH);
#endif
#endif
    float high_up = stands.x + spine.place.y * stands.y;
    Light reaches = unpack_light(lit);
    if (has_casters())
        reaches = shadowed(reaches, casters_visibility(point.place), 1.0 - fract(joints.z));
    vec2 sides = sides_of(point, side);
    float face = sides.x, to = sides.y;
    float way = t;
#ifdef EYED
    if (is_blotched(int(stands.z)))
        way = 1.0 - eyed_seen(point, t);
#endif
    vec3 pigment = mix(low.rgb, high.rgb, way), light = shade(leaf_surface(pigment * (1.0 + face * packed_extra(lit)), high_up), reaches);
#ifdef FOLDS
    bool is_folded = is_blade(int(stands.z)) && kinds[k].apart > 0.0 && kinds[k].narrowed > 0.0;
    keel = is_folded ? to * (tone_mapped(light) - tone_mapped(shade(leaf_surface(pigment, high_up), reaches))) : vec3(0.0);
#endif
#ifdef MORPH
    bring(point, light, t, k);
#ifdef FOLDS
    keel *= 1.0 - painted.w;
#endif
#endif
    color = tone_mapped(light);
#ifdef DEEP
    number = place_number(foot.xz);
#endif
#ifdef SOFT
    gl_Position = widened(point, t, to);
#else
    gl_Position = clip * vec4(point.place.x + point.across.x, point.place.y, point.place.z + point.across.y, 1.0);
#endif
}
