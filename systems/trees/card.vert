// Twigs on their cards, as far as their outline goes.
#include "lib/frame.glsl"
#include "systems/trees/leaf_sends.glsl"
#include "systems/trees/hung.glsl"
#include "systems/trees/behind.glsl"
#include "systems/trees/outline.py"

in vec4 hung_at;      // as hang.vert has it
in uvec4 hung_axes;
in uvec4 hung_light;
in uvec2 hung_haze;

uniform vec2 corners[OUTLINE];  // of its outline, left and right in turn: across from -1 to 1, and up from 0 to 1
uniform vec4 card;              // as twig.glsl has it

out vec2 on;
#ifdef SMALL
flat out vec3 darkest;    // the colours of what it shows: of its darkest and brightest leaves, and of its bark
flat out vec3 brightest;
flat out vec3 barked;
#else
flat out vec4 from_sun;  // in the card's own axes, where the sun is; its tone
flat out vec3 from_eye;  // and which way the eye looks
flat out vec3 direct;    // of the sun's light, what leaves that face one way send, and those that face all ways
flat out vec3 strewn;
flat out vec3 skylit;
flat out vec3 hazy;
#endif

void main() {
    on = corners[gl_VertexID];
    vec2 second = two_of(hung_axes.y), fifth = two_of(hung_light.x), seventh = two_of(hung_light.z);
    vec3 along = axis_of(vec3(two_of(hung_axes.x), second.x)), aside = axis_of(vec3(second.y, two_of(hung_axes.z)));
    vec3 first_light = light_of(vec3(two_of(hung_light.y), seventh.x)), second_light = light_of(vec3(seventh.y, two_of(hung_light.w)));
    vec3 third_light = light_of(vec3(two_of(hung_haze.x), two_of(hung_haze.y).x));
#ifdef SMALL
    darkest = first_light;
    brightest = second_light;
    barked = third_light;
#else
    vec3 facing = axis_of(vec3(two_of(hung_axes.w), fifth.x)), ray = normalize(hung_at.xyz + 0.5 * hung_at.w * along - eye);
    mat3 own = transpose(mat3(aside, along, facing));
    from_sun = vec4(own * sun, 2.0 * fifth.y);
    from_eye = own * ray;
    direct = (1.0 - STREWN) * SENDS * first_light;
    strewn = STREWN * strewn_send(ray) * first_light;
    skylit = second_light;
    hazy = third_light;
#endif
    vec3 place = hung_at.xyz + hung_at.w * (on.x * card.x * aside + mix(card.y, card.z, on.y) * along);
    gl_Position = hung_at.w > 0.0 ? stood(place) : vec4(0.0, 0.0, 2.0, 1.0);
}
