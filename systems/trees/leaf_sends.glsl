// Radiance of leaves.
const vec3 LEAF_THROUGH = vec3(0.92, 1.08, 0.42);  // transmitted light, of the reflected: more yellow
const float SENDS = 1.25;  // radiance of a white face lit from straight ahead, of that of randomly oriented leaves
const float STREWN = 0.45;  // share of a twig's leaves that are randomly oriented, whatever its face

// Radiance of randomly oriented leaves under the sun.
vec3 strewn_send(vec3 ray) {
    float back = 0.5 - 0.5 * dot(ray, sun), against = 1.0 - back;
    return back * sqrt(back) + against * sqrt(against) * LEAF_THROUGH;
}

// Light on the side of a leaf that the eye sees, or below 0 on the other one, as seen by the eye.
vec3 through_leaf(float lit) {
    return max(lit, 0.0) + max(-lit, 0.0) * LEAF_THROUGH;
}

// Radiance of a leaf under the sun; `lit` is below 0 on the side away from the eye, and `strewn` is that of random leaves.
vec3 leaf_sends(float lit, vec3 strewn) {
    return (1.0 - STREWN) * SENDS * through_leaf(lit) + STREWN * strewn;
}

// Radiance of leaves with this normal under the sun.
vec3 leaf_sends(vec3 normal, vec3 ray) {
    return leaf_sends(dot(normal, sun) * -sign(dot(normal, ray)), strewn_send(ray));
}
