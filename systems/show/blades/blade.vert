// One vertex is one blade: all about it that is the same along its ribbon. With STORED it is looked up by the number of
// its receiver; with MORPH it is on its way between its own place and its painted place on a moving strip (paper, 4.2).
// With HIDING others hide it up to some height.
#define PIXELS_ASK  // or rather ribbons, for shadow maps
#include "lib/light.glsl"
#include "lib/posture.glsl"
#include "systems/show/blades/organs.glsl"
#include "systems/show/blades/store.py"

#ifdef STORED
#include "lib/received.glsl"
#ifdef HIDING
#include "systems/show/hidden.glsl"
#endif

in uint number;            // of its receiver, among those of blades
uniform int each;          // blades of a patch model
uniform int blades_from;   // the first of these receivers among all
uniform float near;        // distance up to which blades hide one another by depth [m]; beyond it order alone says
#ifdef MORPH
uniform sampler2D slices;  // by ring, model, orientation and blade: the strip that it is painted on
uniform vec2 sizes[FORMS]; // by form: how far strips reach beyond their patch [m], and how high they are
uniform ivec4 stacks[RINGS]; // by ring: columns of a strip, sections of a column, strips of a kind on a patch
uniform int models;
#include "lib/stack.glsl"

out vec4 base;             // foot of its strip's first edge (x, z), and the way from edge to edge (x, z) [m]
out vec4 painted;          // receiver of that edge; row of its targets; height of the strip [m]; how far it has moved
#endif
#else
in vec3 root_at;
in float height;
in vec2 rest;
in vec2 facing;
in float width;
in float variant;
in float kind;
#ifdef ORGANS
in float organ;
in float stem;
in float part;
in vec2 sways;
#endif
in vec2 message;
#endif
#ifdef ORGANS
#include "systems/show/blades/heads.glsl"
#endif
#ifdef TOOTHED
#include "systems/show/blades/teeth.glsl"
#endif

out vec4 foot;   // where its ribbon begins [m]; its length [m]
out vec4 lie_of; // bending vector; half its way across at the root [m]
out vec4 low;    // pigment at the root; row of the posture table
out vec4 high;   // pigment at the tip; the part of its length, from its foot on, that nobody sees
out mat4 lit;    // light on it, bundled; beside it the relative change of pigment to its sides
out vec4 stands; // where its foot is in the canopy, and how much of it is its length; organ, plus the part that is cut off; cover
out vec4 joints; // sub-level, and slide to those of the next; coverage from which on it hides what is behind; kind, plus the part of the light that is lamps'; ring of strips, or teeth seen

const float MOST_CUT = 0.999;  // part of a blade that is cut off at most
const float PARTED = 0.5;  // coverage from which on a blade hides what is behind it, near by
const float NEARLY = 0.8;  // from which part of the distance on, up to which blades do so, that begins to change
const float ALL_LAMPS = 0.99;  // what is told beside a kind where no light is the sun's
const float NEVER = 2.0;  // coverage that no blade has

// A blade that is drawn: it roots at a place of the world, and hears this message.
struct Drawn {
    Blade blade;
    vec2 message;
};

#ifdef STORED
Drawn drawn(Standing patch_of_it, int number_on_it) {
    Drawn one;
    one.blade = blade_of(int(patch_of_it.row) * each + number_on_it);
    vec4 told = received_by(blades_from + int(number));
    one.blade.root = vec3(one.blade.root.xz + patch_of_it.cell * patch_side, told.z).xzy;
    one.message = told.xy;
    return one;
}
#else
Drawn drawn() {
#ifdef ORGANS
    Blade blade = Blade(root_at, height, rest, facing, width, variant, kind, organ, stem, part, sways);
#else
    Blade blade = Blade(root_at, height, rest, facing, width, variant, kind, 0.0);
#endif
    return Drawn(blade, message);
}
#endif

// Where it stands on a stem that leans so, from the foot of the stem.
vec3 on_stem(Blade blade, vec2 leans) {
#ifdef ORGANS
    float first = float(form_of(blade.variant)) * posture_variants;
    return blade.stem > 0.0 ? posture(first, leans, blade.part).place * blade.stem : vec3(0.0);
#else
    return vec3(0.0);
#endif
}

// How its stem stands in calm air.
vec2 stem_of(Blade blade) {
#ifdef ORGANS
    return blade.sways;
#else
    return vec2(0.0);
#endif
}

// A bending vector of something that leans so at rest: as much as it is bent, it leans no more.
vec2 bent(vec2 moved, vec2 rest_of_it) {
    return moved + rest_of_it * (1.0 - min(length(moved), 1.0));
}

// The part of a blade up to where it first stands as high as `top` in calm air, of its length.
float cut_at(Blade blade, float top) {
    float before = 0.0;
    if (top < 1.0) for (float link = 1.0; link <= posture_links; link++) {
        float here = posture(blade.variant, blade.rest, link / posture_links).place.y;
        if (here > top)
            return max((link - 1.0 + (top - before) / (here - before)) / posture_links, 0.0);
        before = here;
    }
    return 1.0;
}

// Its pigments, and how they change to its sides.
vec3 dye(Blade blade, vec2 across, bool has_section, bool is_round, vec2 slow) {
    int k = int(blade.kind);
    vec2 twice = doubled_angle(blade.facing), grade = tones_of(int(blade.organ));
    vec3 grain = azimuth_tint(k, twice), dry = dryness_tint(slow) * grain;
    vec2 eyed = vec2(0.0);
#ifdef EYED
    eyed = vec2(eyed_at(int(blade.organ), 0.0), eyed_at(int(blade.organ), 1.0));
#endif
    low = vec4(pigment_at(k, grade.x, eyed.x) * dry, blade.variant);
    high = vec4(pigment_at(k, grade.y, eyed.y) * dry, 0.0);
    if (has_section) {
        vec2 round_to = doubled_angle(toward_sun);
        float fold = twice.x * round_to.y - twice.y * round_to.x;
        return vec3(kinds[k].apart * (is_round ? dot(across, toward_sun) : fold));
    }
    return 2.0 * ROUND * (kinds[k].grain_s * twice.x - kinds[k].grain_c * twice.y) / grain;
}

#ifdef MORPH
// Where it is painted.
void paint(Standing patch_of_it, int blade, int k, int form) {
    int ring = int(patch_of_it.ring), model = int(patch_of_it.row) / 4, turn = int(patch_of_it.row) % 4;
    int along = int(patch_of_it.along), own = (along + turn) % 2, count = stacks[ring].z, columns = stacks[ring].x;
    int row = (model * 2 + own) * each + blade, slice = ring * models * 2 * each + row;
    int plane = int(texelFetch(slices, ivec2(slice % SLICES_ROW, slice / SLICES_ROW), 0).r);
    int strip = k * count + stack_place(plane, count, own, along, turn);
    vec2 first = edge_foot(patch_of_it.cell, turn, own, plane, count, 0, columns, sizes[form].x);
    vec2 second = edge_foot(patch_of_it.cell, turn, own, plane, count, 1, columns, sizes[form].x);
    float receiver = patch_of_it.edges + float(strip * (columns + 1));
    base = vec4(first, second - first);
    painted = vec4(receiver, float(row), sizes[form].y * patch_of_it.growth, patch_of_it.morph);
    joints.yw = vec2(NEVER, patch_of_it.ring);
}
#endif

void main() {
#ifdef STORED
    Standing patch_of_it = standing_of(int(number) / each);
    Drawn one = drawn(patch_of_it, int(number) % each);
    float hides = mix(PARTED, NEVER, smoothstep(NEARLY * near, near, distance(one.blade.root.xz, eye.xz)));
    joints = vec4(patch_of_it.slide, hides, one.blade.kind, 0.0);
    stands.w = patch_of_it.fade;
#else
    Drawn one = drawn();
    joints = vec4(0.0, NEVER, one.blade.kind, 0.0);
    stands.w = 1.0;
#endif
    Blade blade = one.blade;
    int k = int(blade.kind);
    vec2 blown = bending(k, one.message);
    vec3 up = on_stem(blade, bent(blown, stem_of(blade)));
    foot = vec4(blade.root + up, blade.height);

    bool is_itself = is_blade(int(blade.organ));
    bool has_section = is_itself && kinds[k].apart > 0.0, is_round = is_itself && kinds[k].narrowed < 0.0;
    vec2 across = is_round ? normalize(blade.root.xz - eye.xz + LEAST_LENGTH) : blade.facing;
    across = vec2(-across.y, across.x);
    lie_of = vec4(bent(blown * give_of(int(blade.organ)), blade.rest), 0.5 * blade.width * across);

    Lie lies = lie_at(blade.root.xz);
    ByKind grows = density_at(blade.root.xz);
    Light light = leaf_light(k, blown, blade.root, lies, grows);
    if (any_lamps()) {
        float suns;
        light = add_lamps(light, blade.root, Reflector(k, blown, lies.normal, 1.0), suns);
        joints.z += ALL_LAMPS * (1.0 - suns);
    }
    light = hazed(light, blade.root);
    vec3 tilt = dye(blade, across, has_section, is_round, lies.slow);
    float canopy_height = OF(crown, k) * lodged(blown);
    stands.xyz = vec3(up.y / canopy_height, blade.height / canopy_height, blade.organ);
    if (anything_is_cut()) {
        float top = cut_height_at(blade.root.xz);
        light = light_when_cut(top, light, k, leaf_areas(grows));
        top -= on_stem(blade, stem_of(blade)).y;
        stands.z += min(1.0 - cut_at(blade, top / blade.height), MOST_CUT);
    }
    lit = pack_light(light, tilt);
#if defined(ORGANS) && defined(STORED)
    if (is_at_tip(int(blade.organ)))
        stands.w *= uncovered(kinds[k].head, foot.xyz - eye);
#endif
#ifdef HIDING
    high.w = clamp((hidden_height(blade.root, OF(crown, k), lodged(blown)) - up.y) / blade.height, 0.0, 1.0);
#endif
#ifdef TOOTHED
    joints.w = outline_seen(int(blade.organ), blade.height, blade.width, foot.xyz);
#endif
#ifdef MORPH
    paint(patch_of_it, int(number) % each, k, form_of(blade.variant));
#endif
    gl_Position = vec4(0.0, 0.0, 0.0, 1.0);
}
