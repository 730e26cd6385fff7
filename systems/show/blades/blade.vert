// The pass over blades: a vertex computes everything about a blade that is the same along its ribbon. With STORED the blade
// is read from textures, by the number of its receiver. With MORPH it is between its own place and its painted place on a
// moving strip (paper, section 4.2). With HIDING, a height is computed below which other blades hide it.
#define PIXELS_ASK  // shadow maps are read by the ribbons, not here
#include "lib/light.glsl"
#include "lib/posture.glsl"
#include "systems/show/blades/organs.glsl"
#include "systems/show/blades/store.py"

#ifdef STORED
#include "lib/received.glsl"
#include "systems/show/blades/thin.py"
#ifdef HIDING
#include "systems/show/hidden.glsl"
#endif

in uint number;            // of its receiver, among those of blades
uniform int each;          // blades of a patch model
uniform int blades_from;   // number of the first of these receivers among all
uniform vec3 viewer;       // place of the viewer's eye (x, z) [m], and its zoom: blades are thinned out for it, even where a light looks
uniform float near;        // distance up to which the depth buffer sorts blades [m]; beyond it drawing order does
#ifdef MORPH
uniform sampler2D slices;  // strip that a blade is painted on, by ring, model, orientation and blade
uniform vec2 sizes[FORMS]; // reach of strips beyond their patch, and their height [m], by form
uniform ivec4 stacks[RINGS]; // columns of a strip, sections of a column, strips of a kind on a patch, by ring
uniform int models;
#include "lib/stack.glsl"

out vec4 base;             // foot of its strip's first edge (x, z), and the way from edge to edge (x, z) [m]
out vec4 painted;          // receiver of that edge; row of its targets; height of the strip [m]; morph
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

out vec4 foot;          // foot of its ribbon [m]; its length [m]
out vec4 lean_across;   // bending vector, with the lean at rest; half its width axis at the root [m]
out vec4 root_pigment;  // pigment at the root; row of the posture table
out vec4 tip_pigment;   // pigment at the tip; fraction of its length, from the foot on, that is hidden
out mat4 lit;           // bundled light on it, and the relative change of pigment to its sides
out vec4 canopy_organ;  // height of its foot in the canopy, and its length, both relative to the canopy; organ + fraction cut off; cover
out vec4 level_kind;    // sub-level + slide to the next; coverage from which on it hides what is behind; kind + fraction of
                        // light from lamps; ring of strips, or visibility of teeth

const float MOST_CUT = 0.999;  // largest fraction of a blade that is cut off
const float PARTED = 0.5;  // coverage from which on a blade near by hides what is behind it
const float NEARLY = 0.8;  // fraction of `near` from which on that coverage rises to `NEVER`
const float ALL_LAMPS = 0.99;  // fraction added to the kind where all light is from lamps
const float NEVER = 2.0;  // coverage that no blade has

// A blade with its root in the world, and the message that it receives.
struct BladeInput {
    Blade blade;
    vec2 message;
};

#ifdef STORED
BladeInput blade_input(Standing on_patch, int number_on_patch) {
    BladeInput given;
    given.blade = blade_of(int(on_patch.model_turn) * each + number_on_patch);
    vec4 received = received_by(blades_from + int(number));
    given.blade.root = vec3(given.blade.root.xz + on_patch.cell * patch_side, received.z).xzy;
    given.message = received.xy;
    return given;
}

// Factor on the width of the blade of a number in the stock. Where blades are narrow, only a share is drawn, as wide as all together.
float widened_for_all(Blade blade, uint number_in_stock) {
    float width = is_at_tip(int(blade.organ)) ? NARROW_AT_TIP * min(blade.width, blade.height) : blade.width;
    float share = width * NARROW_FROM * viewer.z / max(distance(blade.root.xz, viewer.xy), LEAST_WIDTH);
    float whole = share * (1.0 - THINS_OVER), none = share * (1.0 + THINS_OVER), range = none - whole, beyond = max(none - 1.0, 0.0);
    float area = whole < 1.0 ? share - 0.5 * beyond * beyond / range : 1.0;
    return clamp((none - float(number_in_stock * IN_TURN) * UNIT) / range, 0.0, 1.0) / area;
}
#else
BladeInput blade_input() {
#ifdef ORGANS
    Blade blade = Blade(root_at, height, rest, facing, width, variant, kind, organ, stem, part, sways);
#else
    Blade blade = Blade(root_at, height, rest, facing, width, variant, kind, 0.0);
#endif
    return BladeInput(blade, message);
}
#endif

// Place of its foot on a stem with this lean, relative to the foot of the stem [m].
vec3 foot_on_stem(Blade blade, vec2 lean) {
#ifdef ORGANS
    float first = float(form_of(blade.variant)) * posture_variants;
    return blade.stem > 0.0 ? posture(first, lean, blade.part).place * blade.stem : vec3(0.0);
#else
    return vec3(0.0);
#endif
}

// Lean of its stem in calm air.
vec2 stem_rest(Blade blade) {
#ifdef ORGANS
    return blade.sways;
#else
    return vec2(0.0);
#endif
}

// Lean of something that the wind bends and that has a lean at rest: bending takes the place of the lean at rest.
vec2 bent(vec2 blown, vec2 at_rest) {
    return blown + at_rest * (1.0 - min(length(blown), 1.0));
}

// Place along a blade, 0 to 1, where it first reaches the relative height `top` in calm air.
float cut_at(Blade blade, float top) {
    float lower = 0.0;
    if (top < 1.0) for (float link = 1.0; link <= posture_links; link++) {
        float upper = posture(blade.variant, blade.rest, link / posture_links).place.y;
        if (upper > top)
            return max((link - 1.0 + (top - lower) / (upper - lower)) / posture_links, 0.0);
        lower = upper;
    }
    return 1.0;
}

// Set its pigments; return their relative change to its sides.
vec3 set_pigments(Blade blade, vec2 across, bool has_section, bool is_round, vec2 slow) {
    int k = int(blade.kind);
    vec2 twice = doubled_angle(blade.facing), tones = tones_of(int(blade.organ));
    vec3 grain = azimuth_tint(k, twice), dry = dryness_tint(slow) * grain;
    vec2 eyed = vec2(0.0);
#ifdef EYED
    eyed = vec2(eyed_at(int(blade.organ), 0.0), eyed_at(int(blade.organ), 1.0));
#endif
    root_pigment = vec4(pigment_at(k, tones.x, eyed.x) * dry, blade.variant);
    tip_pigment = vec4(pigment_at(k, tones.y, eyed.y) * dry, 0.0);
    if (has_section) {
        vec2 round_to = doubled_angle(toward_sun);
        float fold = twice.x * round_to.y - twice.y * round_to.x;
        return vec3(kinds[k].apart * (is_round ? dot(across, toward_sun) : fold));
    }
    return 2.0 * ROUND * (kinds[k].grain_s * twice.x - kinds[k].grain_c * twice.y) / grain;
}

#ifdef MORPH
// Set its painted place.
void set_painted(Standing on_patch, int blade, int k, int form) {
    int ring = int(on_patch.ring), model = int(on_patch.model_turn) / 4, turn = int(on_patch.model_turn) % 4;
    int along = int(on_patch.along), orientation = (along + turn) % 2, count = stacks[ring].z, columns = stacks[ring].x;
    int row = (model * 2 + orientation) * each + blade, slice = ring * models * 2 * each + row;
    int plane = int(texelFetch(slices, ivec2(slice % SLICES_ROW, slice / SLICES_ROW), 0).r);
    int strip = k * count + stack_place(plane, count, orientation, along, turn);
    vec2 first = edge_foot(on_patch.cell, turn, orientation, plane, count, 0, columns, sizes[form].x);
    vec2 second = edge_foot(on_patch.cell, turn, orientation, plane, count, 1, columns, sizes[form].x);
    float receiver = on_patch.first_edge + float(strip * (columns + 1));
    base = vec4(first, second - first);
    painted = vec4(receiver, float(row), sizes[form].y * on_patch.growth, on_patch.morph);
    level_kind.yw = vec2(NEVER, on_patch.ring);
}
#endif

void main() {
#ifdef STORED
    Standing on_patch = standing_of(int(number) / each);
    BladeInput given = blade_input(on_patch, int(number) % each);
    float hides = mix(PARTED, NEVER, smoothstep(NEARLY * near, near, distance(given.blade.root.xz, eye.xz)));
    level_kind = vec4(on_patch.sublevel, hides, given.blade.kind, 0.0);
    float wide = widened_for_all(given.blade, uint(int(on_patch.model_turn) * each + int(number) % each));
    canopy_organ.w = on_patch.cover;
#else
    BladeInput given = blade_input();
    level_kind = vec4(0.0, NEVER, given.blade.kind, 0.0);
    float wide = 1.0;
    canopy_organ.w = 1.0;
#endif
    Blade blade = given.blade;
    int k = int(blade.kind);
    vec2 blown = bending(k, given.message);
    vec3 up = foot_on_stem(blade, bent(blown, stem_rest(blade)));
    foot = vec4(blade.root + up, blade.height);

    bool is_plain = is_blade(int(blade.organ));
    bool has_section = is_plain && kinds[k].apart > 0.0, is_round = is_plain && kinds[k].narrowed < 0.0;
    vec2 across = is_round ? normalize(blade.root.xz - eye.xz + LEAST_LENGTH) : blade.facing;
    across = vec2(-across.y, across.x);
    lean_across = vec4(bent(blown * give_of(int(blade.organ)), blade.rest), 0.5 * wide * blade.width * across);

    Lie lies = lie_at(blade.root.xz);
    ByKind densities = density_at(blade.root.xz);
    Light light = leaf_light(k, blown, blade.root, lies, densities);
    if (any_lamps()) {
        float suns;
        light = add_lamps(light, blade.root, Reflector(k, blown, lies.normal, 1.0), suns);
        level_kind.z += ALL_LAMPS * (1.0 - suns);
    }
    light = hazed(light, blade.root);
    vec3 side_change = set_pigments(blade, across, has_section, is_round, lies.slow);
    float canopy_height = OF(crown, k) * lodged(blown);
    canopy_organ.xyz = vec3(up.y / canopy_height, blade.height / canopy_height, blade.organ);
    if (anything_is_cut()) {
        float top = cut_height_at(blade.root.xz);
        light = light_when_cut(top, light, k, leaf_areas(densities));
        top -= foot_on_stem(blade, stem_rest(blade)).y;
        canopy_organ.z += min(1.0 - cut_at(blade, top / blade.height), MOST_CUT);
    }
    lit = pack_light(light, side_change);
#if defined(ORGANS) && defined(STORED)
    if (is_at_tip(int(blade.organ)))
        canopy_organ.w *= overlap_factor(kinds[k].head, foot.xyz - eye);
#endif
#ifdef HIDING
    tip_pigment.w = clamp((hidden_height(blade.root, OF(crown, k), lodged(blown)) - up.y) / blade.height, 0.0, 1.0);
#endif
#ifdef TOOTHED
    level_kind.w = outline_seen(int(blade.organ), blade.height, blade.width, foot.xyz);
#endif
#ifdef MORPH
    set_painted(on_patch, int(number) % each, k, form_of(blade.variant));
#endif
    gl_Position = vec4(0.0, 0.0, 0.0, 1.0);
}
