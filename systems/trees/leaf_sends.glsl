// How leaves send light.
const vec3 LEAF_THROUGH = vec3(0.92, 1.08, 0.42);  // light that leaves let through, of what they send back: more yellow
const float SENDS = 1.25;  // what a white face sends of the sun's light from straight ahead, of what a leaf facing all ways does
const float STREWN = 0.45;  // of a twig's leaves that face all ways, whatever its face is

// What leaves that face all ways send to the eye of the sun's light.
vec3 strewn_send(vec3 ray) {
    float back = 0.5 - 0.5 * dot(ray, sun), against = 1.0 - back;
    return back * sqrt(back) + against * sqrt(against) * LEAF_THROUGH;
}

// Light that so falls on the side of a leaf which the eye sees, or below 0 through it from the other one.
vec3 through_leaf(float lit) {
    return max(lit, 0.0) + max(-lit, 0.0) * LEAF_THROUGH;
}

// What leaves send to the eye of the sun's light that so falls on the side which it sees, below 0 on the other one; and what such
// send that face all ways.
vec3 leaf_sends(float lit, vec3 strewn) {
    return (1.0 - STREWN) * SENDS * through_leaf(lit) + STREWN * strewn;
}

// What leaves with this face send to the eye of the sun's light.
vec3 leaf_sends(vec3 normal, vec3 ray) {
    return leaf_sends(dot(normal, sun) * -sign(dot(normal, ray)), strewn_send(ray));
}
