// The twigs of trees. With LEAVES each is all of its leaves. With BAKED one is drawn as it will be read from a texture, and else
// it is the card that shows it. What is not a vertex buffer's is made out from the vertex's number.
#include "systems/trees/twig.glsl"
#ifndef BAKED
#include "systems/trees/behind.glsl"
#endif

uniform int leaf_count;  // leaves of a twig
uniform int shoots;      // of a twig: itself, and those on its sides
#ifdef LEAVES
in float first;          // the twig that is drawn, or the first of those
#endif

out vec2 on;
out vec3 facing;
out vec3 seen_at;
out vec3 sunlit;
out vec3 skylit;
out vec3 hazy;
out vec4 inside;  // what leaves meet of light; or tone, 1 on a stem, and what that covers
flat out vec4 across_card; // which way the card's own x goes, in the world; its tone
flat out vec3 along_card;

const float STEM = 0.006;  // half the width of a side shoot at its foot, of its twig's length
const float STEM_TAPERS = 0.6, STEM_OF_TWIG = 1.6;  // how much narrower its tip is; how many times as wide the twig itself is
const float SHOOTS_UP_TO = 0.62, SHOOTS_SHORTEN = 0.5;  // where the last side shoot of a twig stands; how much shorter it is
const vec2 ANGLES = vec2(0.8, 0.4);  // the least angle of shoots and leaves, of what is usual, and how much more it may be
const vec2 LEAF_ANGLES = vec2(1.1, 0.55);  // what is usual of leaves, at the foot and at the tip of a shoot, of the kind's
const float FIRST_LEAF = 0.1;  // where the first leaf of a shoot stands, of its length
const float LEAVES_AROUND = 1.4;  // how far around it leaves are from its left and right [rad]
const float NODS = 0.35, TILTED = 0.6;  // how far leaves hang; how far they are turned about their stalks
const vec2 LEAF_SIZES = vec2(0.75, 0.45);  // the least size of a leaf, of its kind's, and how much more it may be
const float STALK = 0.12;  // of a leaf, of its length
const vec2 LEAF_TONES = vec2(0.25, 0.75);  // the least tone of a leaf, and how much more it may be

// A side shoot of a twig: sine and cosine of its angle; where it stands, and how long it is. The first is the twig itself.
vec4 shoot_at(int twig, int shoot) {
    if (shoot == 0)
        return vec4(0.0, 1.0, 0.0, 1.0);
    float part = float(shoot) / float(shoots), side = shoot % 2 == 0 ? -1.0 : 1.0;
    float angle = side * SHOOTS_OFF * (ANGLES.x + ANGLES.y * random(twig, shoot, 1).x);
    return vec4(sin(angle), cos(angle), SHOOTS_UP_TO * part, SHOOTS_LONG * (1.0 - SHOOTS_SHORTEN * part));
}

// A corner of one of a twig's leaves, in the axes of the twig: across, along and out of its face [of its usual length].
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
    // Side shoots of a twig stand on it to the left and right in turn, and their leaves on those.
    vec4 stands = shoot_at(twig, shoot);
    mat3 turned_aside = mat3(stands.y, -stands.x, 0.0, stands.x, stands.y, 0.0, 0.0, 0.0, 1.0);
    along = turned_aside * along;
    flat_to = turned_aside * flat_to;
    vec3 foot = vec3(0.0, stands.z, 0.0) + turned_aside * vec3(0.0, stands.w * (FIRST_LEAF + (1.0 - FIRST_LEAF) * part), 0.0);
    normal = turned_aside * normal;
    return foot + size * (leaf_shape.x * (corner.y + STALK) * along + leaf_shape.y * corner.x * flat_to);
}

// Half the width of the stem of one of its shoots, at a part of its length [of the twig's usual length].
float stem_width(int shoot, float along) {
    return STEM * (1.0 - STEM_TAPERS * along) * (shoot == 0 ? STEM_OF_TWIG : 1.0);
}

// A corner of such a stem, so wide.
vec3 stem_corner(int twig, int shoot, vec2 corner, float wide) {
    vec4 stands = shoot_at(twig, shoot);
    vec2 own = vec2(corner.x * wide, stands.w * corner.y);
    return vec3(stands.y * own.x + stands.x * own.y, stands.z + stands.y * own.y - stands.x * own.x, 0.0);
}

#ifndef BAKED
// Half a pixel at a twig, of its length: narrower stems are drawn so wide, and cover less.
float half_pixel(Twig twig) {
    return 0.5 * distance(eye, root + scale * turned(twig.foot)) / (pixels_a_metre() * scale * twig.span);
}
#endif

void leave_out() {
    gl_Position = vec4(0.0, 0.0, 2.0, 1.0);
    on = vec2(0.0);
    facing = seen_at = sunlit = skylit = hazy = along_card = vec3(0.0);
    inside = across_card = vec4(0.0);
}

vec2 corner_of(int vertex) {
    return vec2(vertex % 2 == 1 ? 1.0 : -1.0, vertex % 4 > 1 ? 1.0 : 0.0);
}

// A corner of a leaf or a stem of a twig, or of its card, in its axes [of its usual length]; `inside` and `normal` follow from it.
vec3 corner_on(Twig twig, int number, int leaf, float size, vec2 corner, out vec3 normal) {
    normal = vec3(0.0, 0.0, 1.0);
#ifdef LEAVES
    if (leaf < leaf_count) {
        inside = vec4(LEAF_TONES.x + LEAF_TONES.y * random(number, leaf, 4).x, 0.0, 1.0, 0.0);
        return leaf_corner(number, leaf, corner, normal);
    }
    float wide = stem_width(leaf - leaf_count, corner.y), widened = wide;
#ifndef BAKED
    widened = max(wide, half_pixel(twig) / size);
#endif
    inside = vec4(0.0, 1.0, wide / widened, 0.0);
    return stem_corner(number, leaf - leaf_count, corner, widened);
#else
    inside = twig.shading;
    return vec3(corner.x * card.x, mix(card.y, card.z, corner.y), 0.0);
#endif
}

#ifdef BAKED
void stand(vec3 place) {
    seen_at = place;
    sunlit = skylit = hazy = vec3(0.0);
    gl_Position = baked * vec4(place, 1.0);
}
#else
// Stand in the wind and in the light; `own` is from the twig's foot, `high_up` how far along it [of its usual length].
void stand(Twig twig, vec3 own, vec3 aside, float length_of, float high_up, vec4 chance) {
    float turns = flutter(chance);
    own += high_up * length_of * fluttered(twig, aside, turns);
    facing = turned_by(twig, facing, aside, turns);
    seen_at = swayed(twig.foot, twig.pivot, twig.limb, twig.hertz, message) + scale * turned(own);
    Light light = light_in_crown(seen_at, twig.shading, facing.y * sign(dot(facing, eye - seen_at)));
    sunlit = light.sun;
    skylit = light.sky;
    hazy = light.haze;
    gl_Position = stood(seen_at);
}
#endif

void main() {
    int number = gl_VertexID / 4, each = 1;
#ifdef LEAVES
    each = leaf_count + shoots;
#endif
    int twig = number / each;
#ifdef LEAVES
    twig += int(first + 0.5);
#endif
    Twig one = twig_of(twig);
    vec4 chance = random(twig, 0, 3);
    float size = size_of((float(twig) + 0.5) / float(twigs));
#if defined(BAKED) && defined(LEAVES)
    size = 1.0;
    one = Twig(vec3(0.0), usual, vec3(0.0, 1.0, 0.0), 0.0, vec3(0.0, 0.0, 1.0), 1.0, vec3(0.0), 0.0, vec4(0.0));
#endif
    bool apart = true;
#ifndef BAKED
    apart = chance.w < leaf_by_leaf(one.foot);
#endif
    if (size <= 0.0 || !apart) {
        leave_out();
        return;
    }
    vec3 normal, shape = corner_on(one, twig, number % each, size, on = corner_of(gl_VertexID), normal);
#ifndef LEAVES
    one.face = face_of(one);
#endif
    vec3 aside = cross(one.along, one.face);
    float length_of = size * one.span;
    one.foot -= 0.5 * max(length_of - one.span, 0.0) * one.along;  // it is larger about its middle: a crown stays as wide
    vec3 own = length_of * (shape.x * aside + shape.y * one.along + shape.z * one.face);
    facing = normal.x * aside + normal.y * one.along + normal.z * one.face;
#ifdef BAKED
    stand(one.foot + own);
#else
    stand(one, own, aside, length_of, shape.y, chance);
#endif
    along_card = turned(one.along);
    across_card = vec4(turned(aside), CARD_TONES.x + CARD_TONES.y * chance.z);
}
