// Radiance of leaves.
const vec3 TRANSMITTED = vec3(0.92, 1.08, 0.42);  // transmitted light, relative to the reflected: more yellow
const float FACE_GAIN = 1.25;  // radiance of a white face lit from straight ahead, relative to that of randomly oriented leaves
const float RANDOM_SHARE = 0.45;  // share of a twig's leaves that are randomly oriented, whatever its face
const float FACED = (1.0 - RANDOM_SHARE) * FACE_GAIN;  // radiance of a twig whose face is lit from straight ahead, without these

// Radiance of randomly oriented leaves under the sun.
vec3 random_leaf_radiance(vec3 ray) {
    float back = 0.5 - 0.5 * dot(ray, sun), against = 1.0 - back;
    return back * sqrt(back) + against * sqrt(against) * TRANSMITTED;
}

// Light on the side of a leaf that the eye sees, or below 0 on the other one, as seen by the eye.
vec3 two_sided_light(float lit) {
    return max(lit, 0.0) + max(-lit, 0.0) * TRANSMITTED;
}

// Radiance of a leaf under the sun; `lit` is below 0 on the side away from the eye, and `random_leaves` is that of random leaves.
vec3 leaf_radiance(float lit, vec3 random_leaves) {
    return FACED * two_sided_light(lit) + RANDOM_SHARE * random_leaves;
}

// Radiance of leaves with this normal under the sun.
vec3 leaf_radiance(vec3 normal, vec3 ray) {
    return leaf_radiance(dot(normal, sun) * -sign(dot(normal, ray)), random_leaf_radiance(ray));
}
