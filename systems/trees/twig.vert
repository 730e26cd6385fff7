// Twigs leaf by leaf. With BAKED they are drawn into a texture: one for its card, or with OF_TREE all of a tree. What no vertex buffer
// holds follows from the vertex's index.
#include "systems/trees/twig.glsl"
#ifndef BAKED
#include "systems/trees/behind.glsl"
#include "systems/trees/hung.glsl"
#include "systems/trees/leaf_light.glsl"
#include "systems/trees/pigment.glsl"

in vec4 hung_at;      // outputs of hang.vert
in uvec4 hung_axes;
in uvec4 hung_light;
in uvec2 hung_haze;
#endif

uniform int leaf_count;   // leaves of a twig
uniform int shoots;       // of a twig: itself and its side shoots
uniform float shoots_off; // angle of these from it [rad]
uniform float finer;      // ratio of a twig's leaves and stems to those drawn

out vec2 on;
#ifdef BAKED
out vec3 facing;
out vec4 inside;     // optical depths
flat out vec2 part;  // tone; narrowing of a stem's tip, or below 0 on a leaf
#else
out float stem_cover;        // coverage of a stem; below 0 on a leaf
flat out vec3 leaf_colour;   // its displayed colour
flat out vec3 midrib_colour; // that of its midrib
#endif

const float STEM = 0.006;  // half the width of a side shoot at its foot, relative to its twig's length
const float STEM_TAPERS = 0.6, STEM_OF_TWIG = 1.6;  // narrowing of its tip; width of the twig itself, relative to that
const float SHOOTS_UP_TO = 0.62, SHOOTS_SHORTEN = 0.5;  // position of a twig's last side shoot; its shortening
const vec2 ANGLES = vec2(0.8, 0.4);  // least angle of shoots and leaves, relative to the usual one, and its range
const vec2 LEAF_ANGLES = vec2(1.1, 0.55);  // usual angle of leaves at the foot and the tip of a shoot, relative to the kind's
const float FIRST_LEAF = 0.1;  // position of a shoot's first leaf, relative to its length
const float LEAVES_AROUND = 1.4;  // range of the angle of leaves around it, about its left and right [rad]
const float NODS = 0.35, TILTED = 0.6;  // drooping of leaves; turn about their stalks
const vec2 LEAF_SIZES = vec2(0.75, 0.45);  // least size of a leaf, relative to its kind's, and its range
const float STALK = 0.12;  // length of the stalk, relative to the leaf's

// A side shoot of a twig: sine and cosine of its angle; position, and length. The first is the twig itself.
vec4 shoot_at(int twig, int shoot) {
    if (shoot == 0)
        return vec4(0.0, 1.0, 0.0, 1.0);
    float part = float(shoot) / float(shoots), side = shoot % 2 == 0 ? -1.0 : 1.0;
    float angle = side * shoots_off * (ANGLES.x + ANGLES.y * random(twig, shoot, 1).x);
    return vec4(sin(angle), cos(angle), SHOOTS_UP_TO * part, SHOOTS_LONG * (1.0 - SHOOTS_SHORTEN * part));
}

// A corner of one of a twig's leaves, in the twig's axes: across, along and out of its face [its usual length].
vec3 leaf_corner(int twig, int leaf, vec2 corner, out vec3 normal) {
    int shoot = leaf % shoots, order = leaf / shoots;
    float part = (float(order) + 0.5) / float(max(leaf_count / shoots, 1)), side = order % 2 == 0 ? -1.0 : 1.0, around;
    vec4 own = random(twig, leaf, 2);
    around = form == NEEDLES ? GOLDEN * float(leaf) : (own.x - 0.5) * LEAVES_AROUND + (side > 0.0 ? 0.0 : PI);
    float angle = leaf_shape.z * mix(LEAF_ANGLES.x, LEAF_ANGLES.y, part) * (ANGLES.x + ANGLES.y * own.y);
    vec3 out_to = vec3(cos(around), 0.0, sin(around));
    vec3 along = normalize(vec3(0.0, cos(angle), 0.0) + sin(angle) * out_to - vec3(0.0, 0.0, NODS * own.z));
    vec3 flat_to = normalize(cross(along, vec3(0.0, 0.0, 1.0) + TILTED * (own.w - 0.5) * out_to.zyx));
    if (form == NEEDLES)
        flat_to = normalize(cross(along, out_to.zyx + ASKEW));
    normal = normalize(cross(flat_to, along));
    if (normal.z < 0.0)
        normal = -normal;
    float size = LEAF_SIZES.x + LEAF_SIZES.y * fract(own.x + own.w);
    // Side shoots stand to the left and right of a twig in turn, and bear leaves.
    vec4 stands = shoot_at(twig, shoot);
    mat3 turned_aside = mat3(stands.y, -stands.x, 0.0, stands.x, stands.y, 0.0, 0.0, 0.0, 1.0);
    along = turned_aside * along;
    flat_to = turned_aside * flat_to;
    vec3 foot = vec3(0.0, stands.z, 0.0) + turned_aside * vec3(0.0, stands.w * (FIRST_LEAF + (1.0 - FIRST_LEAF) * part), 0.0);
    normal = turned_aside * normal;
    return foot + size * (leaf_shape.x * (corner.y + STALK) * along + leaf_shape.y * corner.x * flat_to);
}

// Half the width of the stem of a shoot, at a part of its length [the twig's usual length]. A baked one has parallel sides that its
// pixels narrow, so that a triangle may reach beyond it.
float stem_width(int shoot, float along) {
#ifdef BAKED
    along = 0.0;
#endif
    return STEM / finer * (1.0 - STEM_TAPERS * along) * (shoot == 0 ? STEM_OF_TWIG : 1.0);
}

// A corner of such a stem, `wide` at each side.
vec3 stem_corner(int twig, int shoot, vec2 corner, float wide) {
    vec4 stands = shoot_at(twig, shoot);
    vec2 own = vec2(corner.x * wide, stands.w * corner.y);
    return vec3(stands.y * own.x + stands.x * own.y, stands.z + stands.y * own.y - stands.x * own.x, 0.0);
}

vec2 corner_of(int vertex) {
    return vec2(vertex % 2 == 1 ? 1.0 : -1.0, vertex % 4 > 1 ? 1.0 : 0.0);
}

// A corner of a leaf or a stem of a twig, in its axes [its usual length], no stem narrower than `narrowest`. `values` is its tone, 1 on
// a stem, and its width, relative to that drawn.
vec3 corner_on(int twig, int leaf, vec2 corner, float narrowest, out vec3 normal, out vec3 values) {
    if (leaf < leaf_count) {
        values = vec3(LEAF_TONES.x + LEAF_TONES.y * random(twig, leaf, 4).x, 0.0, 1.0);
        return leaf_corner(twig, leaf, corner, normal);
    }
    float wide = stem_width(leaf - leaf_count, corner.y), widened = max(wide, narrowest);
    normal = vec3(0.0, 0.0, 1.0);
    values = vec3(0.0, 1.0, wide / widened);
    return stem_corner(twig, leaf - leaf_count, corner, widened);
}

#ifdef BAKED
const int CORNERS = 3;
const vec2 REACHES = vec2(4.0, 2.0);  // of a triangle about a quad: of leaves so small, each triangle costs more than its area

void main() {
    int corner = gl_VertexID % CORNERS;
    on = vec2(REACHES.x * float(corner == 1) - 1.0, REACHES.y * float(corner == 2));
#ifdef OF_TREE
    int number = gl_InstanceID;
    Twig twig = twig_of(number);
    float size = twig_size((float(number) + 0.5) / float(twigs), 0);
#else
    const int number = 0;
    const float size = 1.0;
    Twig twig = Twig(vec3(0.0), twig_length, vec3(0.0, 1.0, 0.0), 0.0, vec3(0.0, 0.0, 1.0), 0.0, vec3(0.0), 1.0, vec4(0.0));
#endif
    vec3 normal, values, aside = cross(twig.along, twig.face);
    vec3 shape = size * twig.span * corner_on(number, gl_VertexID / CORNERS, on, 0.0, normal, values);
    inside = twig.shading;
    part = vec2(values.x, values.y > 0.5 ? STEM_TAPERS : -1.0);
    facing = normal.x * aside + normal.y * twig.along + normal.z * twig.face;
    gl_Position = baked * vec4(twig.foot + shape.x * aside + shape.y * twig.along + shape.z * twig.face, 1.0);
    if (size <= 0.0)
        gl_Position = vec4(0.0, 0.0, 2.0, 1.0);
}
#else
// Half a pixel at a twig, relative to its length: narrower stems are drawn as wide, with less coverage.
float half_pixel() {
    return 0.5 * distance(eye, hung_at.xyz) / (pixels_per_metre() * hung_at.w);
}

void main() {
    HungLeaves hung = unpack_leaves(hung_axes, hung_light, hung_haze);
    vec3 normal, values, face = cross(hung.aside, hung.along);
    on = corner_of(gl_VertexID);
    vec3 shape = corner_on(hung.number, gl_VertexID / 4, on, half_pixel(), normal, values);
    vec3 own = shape.x * hung.aside + shape.y * hung.along + shape.z * face + shape.y * tip_offset(face, hung.aside, hung.rotation);
    vec3 at_rest = normal.x * hung.aside + normal.y * hung.along + normal.z * face;
    vec3 facing = normalize(at_rest + normal_change(hung.along, hung.aside, hung.rotation));
    vec3 ray = normalize(hung_at.xyz - eye);
    vec3 sky = mix(hung.below, hung.above, 0.5 - 0.5 * facing.y * sign(dot(facing, ray)));
    Light light = Light(hung.sun * leaf_radiance(facing, ray), sky, hung.haze, 0.0, 0.0, vec2(0.0));
    stem_cover = values.y > 0.5 ? values.z : -1.0;
    // Stems are green, as the darkest leaves.
    leaf_colour = tone_mapped(shade(Surface(pigment_of(values.x, 0.0, 0.0), 1.0, LEAF_SCATTERING), light));
    midrib_colour = tone_mapped(shade(Surface(pigment_of(RIBBED * values.x, 0.0, 0.0), 1.0, LEAF_SCATTERING), light));
    gl_Position = hung_at.w > 0.0 ? clip_position(hung_at.xyz + hung_at.w * own) : vec4(0.0, 0.0, 2.0, 1.0);
}
#endif
