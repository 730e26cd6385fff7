// Twigs on cards, within their outlines.
#include "lib/frame.glsl"
#include "systems/trees/leaf_light.glsl"
#include "systems/trees/hung.glsl"
#include "systems/trees/behind.glsl"
#include "systems/trees/outline.py"

in uvec4 hung_place;  // outputs of hang.vert
in uvec4 hung_look;

uniform vec3 hung_from;  // origin of its places [m]

uniform vec2 corners[CARD_CORNERS]; // of its outline: across from -1 to 1, and up from 0 to 1, more beyond the card
uniform vec4 card;                  // extent: left and right, back from its foot, and along [usual length of a twig]

out vec2 on;
flat out float picture; // index of the card's picture
flat out vec4 relief;   // brightness linear in the normal, in the card's own axes, and constant
flat out vec3 darkest;  // displayed colours of its darkest and brightest leaves
flat out vec3 brightest;

void main() {
    on = corners[gl_VertexID];
    HungCard hung = unpack_card(hung_place, hung_look);
    picture = hung.picture;
    relief = hung.relief;
    darkest = hung.darkest;
    brightest = hung.brightest;
    vec3 place = hung_from + hung.offset + hung.size * (on.x * card.x * hung.aside + mix(card.y, card.z, on.y) * hung.along);
    gl_Position = hung.size > 0.0 ? clip_position(place) : vec4(0.0, 0.0, 2.0, 1.0);
}
