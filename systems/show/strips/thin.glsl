// How much of a texel grows where its kind does so thinly: blades of the lower ranks. They lie in front of others.
#include "lib/through.glsl"

const float FIRMEST = 1e-3;  // the narrowest span of ranks
const float MOST_HIDDEN = 0.98;  // coverage that counts at most: behind it there are as many more blades
const vec2 MANY = vec2(0.5, 2.5);  // levels of the mip-maps from which on texels are several blades, and so many that all are alike

// The span of ranks over which blades go, where some density leaves them: so that as many grow in the mean, and none where it
// is 0.
float span_of(float dense, float soft) {
    return clamp(2.0 * min(dense, 1.0 - dense), FIRMEST, soft);
}

const float VARIANCE = 1.0 / 12.0;  // of ranks, which lie evenly between 0 and 1

// What a texel covers, which covers so much where its kind grows densely. One that is a single blade is there or not, by its
// rank. Of many blades a part is left, and what is seen past those goes by how many there are. The lower the mean of their ranks,
// the more are left: the slope of that is the covariance of both, over the variance of ranks. As those of lower rank hide
// others, the mean of what is seen is usually below the middle, by the variance for each optical depth.
float thinned(float covers, float dense, float rank, float sharp, float level) {
    float one = covers * clamp((dense - rank) * sharp + 0.5, 0.0, 1.0), depth = -log(1.0 - min(covers, MOST_HIDDEN));
    float some = dense + 0.5 * dense * (1.0 - dense) / VARIANCE * (0.5 - VARIANCE * depth - rank);
    float of_many = 1.0 - transmittance(depth * clamp(some, 0.0, 1.0));
    return mix(one, of_many, clamp((level - MANY.x) / (MANY.y - MANY.x), 0.0, 1.0));
}
