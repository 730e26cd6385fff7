// An instance is a blade from blade.vert: a ribbon of quads. With SOFT it is drawn half a pixel wider on either side, and the
// fragments compute their coverage; so a blade thinner than a pixel is faint, and not a row of dots. With MORPH it is on its
// way to its painted place on a moving strip (paper, section 4.2).
#define PIXELS_ASK  // the light from blade.vert includes that of lamps
#include "lib/light.glsl"
#include "lib/posture.glsl"
#include "systems/grow/bend.py"
#include "systems/show/blades/organs.glsl"

in vec4 foot;
in vec4 lean_across;
in vec4 root_pigment;
in vec4 tip_pigment;
in mat4 lit;
in vec4 canopy_organ;
in vec4 level_kind;
#ifdef MORPH
#include "lib/painted.glsl"

in vec4 base;
in vec4 painted;
#endif

#define PASSED out
#include "systems/show/blades/ribbon.glsl"
#ifdef DEEP
#include "lib/random.glsl"
#endif

const float AT_TIP = 0.9999;  // place along a blade from which on it is the tip
const float LEAST_BREADTH = 1e-3;  // relative width of a blade at its tip that keeps the division safe
const float POINTED = 1e-4;  // half the width of an end that looks like a point, relative to its distance

// What blade.vert packs into one component.
int organ() {
    return int(canopy_organ.z);
}

float cut_off() {
    return fract(canopy_organ.z);
}

int kind() {
    return int(level_kind.z);
}

float lamp_part() {
    return fract(level_kind.z);
}

// Relative width of a blade at place `t` along it, as in systems/grow/bend.py. The tip is blunt, to make up for the area that
// the last segment cuts off; but seen from near by it ends in a point, unless the blade is round. Where segments are longer
// than the waist, the waist is wider, so that the mean width is kept.
float profile(float t, float taper, float segments) {
    if (!is_blade(organ()))
        return width_of(organ(), t);
    float narrower = kinds[kind()].narrowed;
    if (t > AT_TIP) {
        float blunt = pow(segments, -taper) * max((1.0 - taper) / (1.0 + taper), 0.0);
        return narrower < 0.0 ? blunt : min(blunt, POINTED * distance(foot.xyz, eye) / max(length(lean_across.zw), LEAST_LENGTH));
    }
    float waist = max(narrower, 0.0) * min(WIDENS * segments, 1.0);
    return pow(max(1.0 - t, 0.0), taper) * (1.0 - waist * max(1.0 - t / WIDENS, 0.0));
}

uniform int segments;                // segments of a ribbon
uniform int counts;                  // number of sub-levels
uniform int segments_of[SUBLEVELS];  // segments of a blade, by sub-level
#ifdef OWN_SEGMENTS
const int own_segments[KINDS] = OWN_SEGMENTS;  // segments at the finest level that a kind declares, else 0
#endif

// Number of segments of a blade of a kind on a sub-level.
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

// Place along a blade of the joint nearest to place `t`, with this number of segments. Where ends are round, joints are closer.
float joint_at(float t, int segments) {
    float joint = floor(t * float(segments) + 0.5) / float(segments);
#ifdef ORGANS
    if (is_at_tip(organ()))
        return 1.0 - (1.0 - joint) * sqrt(1.0 - joint);
#endif
    return joint;
}

// A point on the middle line of a ribbon.
struct Point {
    vec3 place;
    vec3 tangent;
    vec2 across;  // (x, z) from the middle line to the edge on the vertex's side
};

const float NEAREST = 0.15;  // distance from the eye below which a ribbon is widened along its own edge: it may be sharply bent there [m]
const float CLIPPED = 0.05;  // distance below which it has no soft edges, as a near plane cuts it off [m]
const float UNEDGED = 8.0;  // half width that counts there, and half length where the ends are not soft [pixel]
#ifdef ORGANS
const float SMALL = 4.0;  // length up to which an organ on the tip of a stem is drawn straight, with soft ends [pixel]
#endif

#ifdef SOFT
// Whether the `side` of a ribbon projects to the opposite side of its line: the right one to the left of an upright line.
bool is_turned(Point point, float side) {
    vec3 across = vec3(clip[0].x, clip[1].x, clip[2].x), up = vec3(clip[0].y, clip[1].y, clip[2].y), ahead = vec3(clip[0].w, clip[1].w, clip[2].w);
    float face = dot(cross(point.tangent, vec3(point.across.x, 0.0, point.across.y)), point.place - eye);
    return side * face * dot(cross(across, up), ahead) < 0.0;  // the triple product is negative in a mirror
}

// Clip position of a point moved to one side, -1 or 1, on the screen: the ribbon reaches EDGE pixels beyond its edge.
vec4 widened(Point point, float t, float to) {
    vec4 middle = clip * vec4(point.place, 1.0);
#ifdef ORGANS
    onward = 0.0;
    half_length = UNEDGED;
#endif
    vec4 edge = clip * vec4(point.across.x, 0.0, point.across.y, 0.0);
    vec2 wide = (edge.xy * middle.w - middle.xy * edge.w) * half_screen / (middle.w * middle.w);
    if (middle.w < NEAREST) {
        half_width = middle.w < CLIPPED ? UNEDGED : length(wide);
        float softer = middle.w < CLIPPED ? -0.5 : 0.5;  // edges are not soft where the coverage is 1 between them
        aside = (half_width + softer) * to;
        return middle + edge * (1.0 + max(softer, 0.0) / max(half_width, 0.5));
    }
    vec3 along = point.tangent;
#ifdef ORGANS
    bool is_small = is_at_tip(organ()) && foot.w * pixels_per_metre() < SMALL * middle.w;
    if (is_small)
        along = posture(root_pigment.w, lean_across.xy, 1.0).place * foot.w;
#endif
    vec4 ahead = clip * vec4(along, 0.0);
    vec2 run = (ahead.xy * middle.w - middle.xy * ahead.w) * half_screen;
    vec2 normal = vec2(-run.y, run.x) / max(length(run), LEAST_SQUARE);
    float out_by = dot(wide, normal);
    half_width = abs(out_by);
    aside = (half_width + EDGE) * to;
    // Seen at an angle, the two edges are shifted against each other along the line: that shows in broad petals and leaves.
    vec2 shear = (wide - normal * out_by) * (out_by < 0.0 ? -to : to);
    middle.xy += (normal * aside + shear) / half_screen * middle.w;
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
const float ASLANT = 0.2;  // cosine between a petal's normal and the line of sight from which on only one of its sides is seen
#ifdef SOFT
const float UNHIDDEN = 0.2;  // visible fraction of petals' feet in a cup, past other petals and stamens: measured on poppies
const vec2 BY_ORDER = vec2(0.5, 2.0);  // coverage from which on a ribbon hides what is behind it: with depth, and by drawing order alone
#endif

// Fraction of the eye's colour seen at place `t` along a blade. A petal leans outwards to where it faces. Where drawing order
// replaces depth, neither other petals nor the eye itself hide its foot.
float eyed_seen(Point point, float t) {
    if (!is_blotched(organ()))
        return eyed_at(organ(), t);
    vec2 outward = normalize(vec2(lean_across.w, -lean_across.z));
    vec3 along = normalize(point.tangent), inner_normal = vec3(-outward * along.y, dot(outward, along.xz)).xzy;
    float seen = clamp(0.5 - 0.5 / ASLANT * dot(inner_normal, normalize(point.place - eye)), 0.0, 1.0);
#ifdef SOFT
    seen *= mix(1.0, UNHIDDEN, smoothstep(BY_ORDER.x, BY_ORDER.y, level_kind.y));
#endif
    return eyed_at(organ(), t) * seen;
}
#endif

#ifdef MORPH
// Radiance of a blade of kind `k` at its painted place, with tone `t`, a fraction `eyed` of the eye's colour and face normal `face`.
vec3 painted_radiance(int k, float t, float eyed, vec2 face, Painted target) {
    Lie lies = lie_at(target.middle.xz);
    ByKind densities = density_at(target.middle.xz);
    float deep = depth_correction(target.run.xz, target.middle, stacks[int(level_kind.w)].z, densities, OF(crown, k) * lodged(target.bend));
    vec3 pigment = pigment_at(k, mix(1.0, t, deep), eyed) * dryness_tint(lies.slow) * azimuth_tint(k, doubled_angle(face));
    pigment *= facing_tint(k, normalize(target.run.xz), target.middle, target.top);
    Light light = leaf_light(k, target.bend, target.middle, lies, densities);
    if (has_casters())
        light = shadowed(light, casters_visibility(target.place), 1.0);
    if (any_lamps()) {
        float suns;
        light = add_lamps(light, target.middle, Reflector(k, target.bend, lies.normal, 1.0), suns);
    }
    light = hazed(light, target.middle);
    if (anything_is_cut())
        light = light_when_cut(cut_height_at(target.place.xz), light, k, leaf_areas(densities));
    return shade(leaf_surface(pigment, mix(1.0, target.h, deep)), light);
}

// Move a point at place `t` along a blade, and its radiance, towards those where it is painted, by the morph.
void morph_to_painted(inout Point point, inout vec3 radiance, float t, int k) {
    Painted target = painted_at(base, int(painted.x), int(painted.y), painted.z, t, k, form_of(root_pigment.w), int(level_kind.w));
    vec2 run = normalize(target.run.xz), tones = tones_of(organ()), face = normalize(vec2(lean_across.w, -lean_across.z));
    float wide = dot(run, point.across);
    if (is_blade(organ()) && kinds[k].narrowed < 0.0)  // a round blade
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
    radiance = mix(radiance, painted_radiance(k, mix(tones.x, tones.y, t), eyed, face, target), painted.w);
}
#endif

#ifdef TOOTHED
// Set the varyings of teeth or ligules; return the factor by which teeth or ligules widen a ribbon.
float widened_by_teeth(float t, float side) {
#ifdef MORPH
    float seen = outline_seen(organ(), foot.w, 2.0 * length(lean_across.zw), foot.xyz) * (1.0 - painted.w);
#else
    float seen = level_kind.w;
#endif
    float wide = width_of(organ(), t);
    outlined = seen;
    tooth = seen < 0.0 ? t : t * TEETH_OF[organ()];
#ifdef SIDED
    tooth_side = seen < 0.0 ? wide * vec2(0.5 * side * LIGULES_OF[organ()], 1.0) : vec2(side, 1.0);
#endif
    float wider = mix(1.0, TOOTHED_WIDER, max(seen, 0.0));
    tooth_widths = vec2(mix(1.0, TOOTHED_WIDER * BETWEEN, max(seen, 0.0)), TOOTHED_WIDER * (1.0 - BETWEEN) * max(seen, 0.0)) / wider;
#ifdef LIGULES_TOO
    float rounded = ENDS_LACK * length(lean_across.zw) / (foot.w * max(LIGULES_OF[organ()], 1.0));
    wider = seen < 0.0 ? mix(1.0, LIGULES_WIDER * (1.0 + rounded), -seen) : wider;
#endif
    return wider;
}
#endif

#ifndef DEEP
// Visibility of rib and veins: leaves have a rib, blades that are not round also have veins beside it.
vec2 vein_visibility(int k) {
    float veins = float(is_blade(organ()) && kinds[k].narrowed >= 0.0), rib = max(veins, float(is_leaf(organ())));
#ifdef MORPH
    return vec2(rib, veins) * (1.0 - painted.w);
#else
    return vec2(rib, veins);
#endif
}
#endif

#ifdef PARTED
// Leave a blade out of the pass over pixels that hide what is behind them.
void leave_out() {
    gl_Position = vec4(2.0, 2.0, 2.0, 1.0);
    color = vec3(0.0);
    aside = half_width = shown = 0.0;
#ifdef ORGANS
    onward = half_length = 0.0;
#endif
    veined = vec2(0.0);
#ifdef TOOTHED
    outlined = tooth = 0.0;
    tooth_widths = vec2(1.0, 0.0);
#ifdef SIDED
    tooth_side = vec2(0.0, 1.0);
#endif
#endif
#ifdef FOLDS
    keel = vec3(0.0);
#endif
}
#endif

// Fraction of a blade, from the foot on, that is hidden from the eye; it still casts shadows.
float hidden_part() {
#ifdef DEEP
    return 0.0;
#else
    return tip_pigment.w;
#endif
}

// Place of a vertex along the blade, and the relative width there.
vec2 along_blade(int k) {
    int level = min(int(level_kind.x), counts - 1), fine = segments_on(level, k);
    float t = float(gl_VertexID / 2) / float(segments), left = 1.0 - cut_off(), taper = kinds[k].taper;
    float place = max(left * joint_at(t, fine), hidden_part()), broad = profile(place, taper, float(fine));
#ifdef SLIDES
    int coarse = segments_on(min(level + 1, counts - 1), k);
    float slide = fract(level_kind.x), coarse_place = max(left * joint_at(t, coarse), hidden_part());
    // The width slides along with the joint: with the width of the place in between, a tip would be far too broad.
    if (slide > 0.0) {
        broad = mix(broad, profile(coarse_place, taper, float(coarse)), slide);
        place = mix(place, coarse_place, slide);
    }
#endif
    return vec2(place, broad);
}

// Side, -1 or 1, whose light a vertex has, and side of the line to which it is moved.
vec2 sides_of(Point point, float side) {
#ifdef SOFT
    // Far off, vertices are moved to alternate sides of the line: else a ribbon seen edge-on would be twisted.
    if (is_turned(point, side))
        return distance(foot.xyz, eye) < foot.w + NEAREST ? vec2(side, -side) : vec2(-side, side);
#endif
    return vec2(side);
}

void main() {
    shown = canopy_organ.w;
#ifdef PARTED
    hides = level_kind.y;
    if (part == 1 && hides > 1.0) {
        leave_out();
        return;
    }
#endif
    int k = kind();
    vec2 along = along_blade(k);
    float t = along.x, side = float(gl_VertexID % 2) * 2.0 - 1.0;
    Spine spine = posture(root_pigment.w, lean_across.xy, t);
    Point point = Point(foot.xyz + spine.place * foot.w, spine.tangent * foot.w, lean_across.zw * (side * along.y));
#ifdef TOOTHED
    point.across *= widened_by_teeth(t, side);
#endif
#ifndef DEEP
    veined = vein_visibility(k);
#ifndef SOFT
    across = vec2(side, 1.0) * max(along.y, LEAST_BREADTH);
#endif
#endif
    float height = canopy_organ.x + spine.place.y * canopy_organ.y;
    Light light = unpack_light(lit);
    if (has_casters())
        light = shadowed(light, casters_visibility(point.place), 1.0 - lamp_part());
    vec2 sides = sides_of(point, side);
    float face = sides.x, to = sides.y;
    float tone = t;
#ifdef EYED
    if (is_blotched(organ()))
        tone = 1.0 - eyed_seen(point, t);
#endif
    vec3 pigment = mix(root_pigment.rgb, tip_pigment.rgb, tone);
    vec3 radiance = shade(leaf_surface(pigment * (1.0 + face * packed_extra(lit)), height), light);
#ifdef FOLDS
    bool is_folded = is_blade(organ()) && kinds[k].apart > 0.0 && kinds[k].narrowed > 0.0;
    keel = is_folded ? to * (tone_mapped(radiance) - tone_mapped(shade(leaf_surface(pigment, height), light))) : vec3(0.0);
#endif
#ifdef MORPH
    morph_to_painted(point, radiance, t, k);
#ifdef FOLDS
    keel *= 1.0 - painted.w;
#endif
#endif
    color = tone_mapped(radiance);
#ifdef DEEP
    number = place_number(foot.xz);
#endif
#ifdef SOFT
    gl_Position = widened(point, t, to);
#else
    gl_Position = clip * vec4(point.place.x + point.across.x, point.place.y, point.place.z + point.across.y, 1.0);
#endif
}
