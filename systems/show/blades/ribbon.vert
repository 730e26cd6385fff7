// One instance is one blade, as blade.vert has made it out: a ribbon of SEGMENTS quads. With SOFT it is drawn half a pixel
// wider on either side, and the fragments say how much of each pixel it covers; so a blade thinner than a pixel is faint,
// and not a row of dots. With MORPH it is on its way to its painted place on a moving strip (paper, section 4.2).
#include "lib/light.glsl"
#include "lib/posture.glsl"
#include "systems/grow/bend.py"

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

out vec3 color;
flat out float shown;
#ifdef FOLDS
out vec3 keel;  // how much brighter the face to the right of a fold is than both
#endif
#ifdef TOOTHED
#include "systems/show/blades/teeth.glsl"

out vec3 tooth;  // which of them, from the root on; from left, -1, to right, 1; how much is seen
#endif
#ifdef SOFT
noperspective out float aside;  // from the middle line [pixel]
noperspective out float half_width;  // of the ribbon [pixel]
#ifdef PARTED
flat out float hides;  // coverage from which on a pixel counts as hidden behind it
uniform int part;      // 1: where it hides what is behind it; 2: the rest
#endif

// Move a point aside on the screen, so that the ribbon reaches half a pixel beyond its edge.
vec4 widened(vec3 place, vec3 tangent, vec2 across) {
    vec4 middle = clip * vec4(place, 1.0);
    vec4 edge = clip * vec4(across.x, 0.0, across.y, 0.0);
    if (middle.w < 0.15) {
        aside = half_width = 8.0;
        return middle + edge;
    }
    vec4 ahead = clip * vec4(tangent, 0.0);
    vec2 run = (ahead.xy * middle.w - middle.xy * ahead.w) * screen.xy;
    vec2 wide = (edge.xy * middle.w - middle.xy * edge.w) * screen.xy / (middle.w * middle.w);
    vec2 normal = vec2(-run.y, run.x) / max(length(run), 1e-9);
    float signed_width = dot(wide, normal);
    half_width = abs(signed_width);
    aside = (half_width + 0.5) * (gl_VertexID % 2 == 0 ? -1.0 : 1.0);
    middle.xy += normal * aside / screen.xy * middle.w;
    return middle;
}
#endif

#ifdef MORPH
// The radiance at part `t` of a blade of kind `k` with this face normal, where it is painted.
vec3 painted_light(int k, float t, vec2 face, Painted target) {
    Lie lies = lie_at(target.middle.xz);
    vec3 pigment = pigment_at(k, t) * stretch(lies.slow) * grain_at(k, doubled(face));
    pigment *= faced(k, normalize(target.run.xz), target.middle, target.top);
    ByKind grows = grows_at(target.middle.xz);
    Light light = veiled(light_on(k, target.bend, target.middle, lies, grows), target.middle);
#ifdef MOWN
    light = mown_to(left_at(target.place.xz), light, k, areas(grows));
#endif
    return shade(leaf_at(pigment, target.h), light);
}
#endif

#ifdef ORGANS
const vec2 tones[ORGANS] = TONES;
const float widths[ORGANS * KNOTS] = WIDTHS;
#endif

const float POINTED = 1e-4;  // half the breadth of an end that is seen as a point, of its distance

// Width of a blade at part `t` of it: as systems/grow/bend.py has it. It ends as bluntly as makes up for what the last segment
// cuts off, but in a point where it is seen from near by, unless it is round. Where segments are longer than the waist, it is
// less drawn in, so that the blade is as broad in the mean.
float profile(float t, float taper, float segments) {
#ifdef ORGANS
    int organ = int(stands.z);
    if (organ != BLADE_ITSELF) {
        float at = t * float(KNOTS - 1);
        int low = min(int(at), KNOTS - 2), row = organ * KNOTS + low;
        return mix(widths[row], widths[row + 1], at - float(low));
    }
#endif
    float narrower = grain_s[int(joints.z)].w;
    if (t > 0.9999) {
        float blunt = pow(segments, -taper) * max((1.0 - taper) / (1.0 + taper), 0.0);
        return narrower < 0.0 ? blunt : min(blunt, POINTED * distance(foot.xyz, eye.xyz) / max(length(lie_of.zw), 1e-5));
    }
    float waist = max(narrower, 0.0) * min(WIDENS * segments, 1.0);
    return pow(max(1.0 - t, 0.0), taper) * (1.0 - waist * max(1.0 - t / WIDENS, 0.0));
}

const int segments_of[COUNTS] = SEGMENTS_OF;  // of a blade, sub-level by sub-level
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

void main() {
#ifdef PARTED
    hides = joints.y;
    if (part == 1 && hides > 1.0) {
        gl_Position = vec4(2.0, 2.0, 2.0, 1.0);
        color = vec3(0.0);
        aside = half_width = shown = 0.0;
#ifdef TOOTHED
        tooth = vec3(0.0);
#endif
        return;
    }
#endif
    int level = min(int(joints.x), COUNTS - 1), k = int(joints.z);
    int fine = segments_on(level, k), coarse = segments_on(min(level + 1, COUNTS - 1), k);
    float t = float(gl_VertexID / 2) / float(SEGMENTS), slide = fract(joints.x), of_coarse = joint_at(t, coarse);
#ifdef MORPH
    slide = 0.0;
#endif
    t = joint_at(t, fine);
#ifdef MOWN
    float left = 1.0 - fract(stands.z);
    t *= left;
    of_coarse *= left;
#endif
    // A blade's width slides along with its joints: as it is where they are meanwhile, a tip would be far broader.
    float broad = profile(t, high.w, float(fine));
    if (slide > 0.0) {
        broad = mix(broad, profile(of_coarse, high.w, float(coarse)), slide);
        t = mix(t, of_coarse, slide);
    }
    float side = float(gl_VertexID % 2) * 2.0 - 1.0;
    Spine spine = posture(low.w, lie_of.xy, t);
    vec3 place = foot.xyz + spine.place * foot.w, tangent = spine.tangent * foot.w;
    vec2 across = lie_of.zw * (side * broad);
#ifdef TOOTHED
    float teeth = TEETH_OF[int(stands.z)];
#ifdef MORPH
    float seen = teeth_seen(foot.w, teeth, foot.xyz) * (1.0 - painted.w);
#else
    float seen = joints.w;
#endif
    tooth = vec3(t * teeth, side, seen);
    across *= mix(1.0, TOOTHED_WIDER, seen);
#endif
    float high_up = stands.x + spine.place.y * stands.y;
    Light reaches = unbundled(lit);
    vec3 pigment = mix(low.rgb, high.rgb, t), light = shade(leaf_at(pigment * (1.0 + side * lit[3].xyz), high_up), reaches);
#ifdef FOLDS
    bool is_folded = grain_c[int(joints.z)].w > 0.0 && grain_s[int(joints.z)].w > 0.0;
#ifdef ORGANS
    is_folded = is_folded && int(stands.z) == BLADE_ITSELF;
#endif
    keel = is_folded ? side * (shown_of(light) - shown_of(shade(leaf_at(pigment, high_up), reaches))) : vec3(0.0);
#endif
#ifdef MORPH
    Painted target = painted_at(base, int(painted.x), int(painted.y), painted.z, t, k, int(joints.w));
    vec2 run = normalize(target.run.xz);
    place = mix(place, target.place, painted.w);
    tangent = mix(tangent, target.tangent, painted.w);
    float wide = dot(run, across);
    bool is_round = grain_s[k].w < 0.0;
#ifdef ORGANS
    is_round = is_round && int(stands.z) == BLADE_ITSELF;
#endif
    wide = is_round ? sign(wide) * length(across) : wide;
    across = mix(across, run * wide * boosted(k, run, target.middle, target.top, target.back), painted.w);
    vec2 face = normalize(vec2(lie_of.w, -lie_of.z));
    float tone = t;
#ifdef ORGANS
    tone = mix(tones[int(stands.z)].x, tones[int(stands.z)].y, t);
#endif
    vec3 painted_as = painted_light(k, tone, face, target);
    light = mix(light, painted_as, painted.w);
#ifdef FOLDS
    keel *= 1.0 - painted.w;
#endif
#endif
    color = shown_of(light);
#ifdef SOFT
    gl_Position = widened(place, tangent, across);
#else
    gl_Position = clip * vec4(place.x + across.x, place.y, place.z + across.y, 1.0);
#endif
    shown = stands.w;
}
