// Coverage of a strip's texel where its kind grows thinly: blades of the lower ranks are left, which lie in front of others.
#include "lib/through.glsl"

const float FIRMEST = 1e-3;  // narrowest span of ranks
const float MOST_HIDDEN = 0.98;  // upper limit of coverage: behind it stand as many blades again
const vec2 MANY = vec2(0.5, 2.5);  // mip levels from which on a texel shows several blades, and so many that all texels are alike

// Span of ranks over which blades fade out at a density, at most `soft`. It is limited so that the mean coverage is in proportion
// to the density, and 0 at density 0.
float rank_span(float dense, float soft) {
    return clamp(2.0 * min(dense, 1.0 - dense), FIRMEST, soft);
}

const float VARIANCE = 1.0 / 12.0;  // of ranks, which are uniform between 0 and 1

// Coverage of a texel at a density, from its coverage at density 1, its mean rank and its mip level. `sharp` is the inverse of
// the span of ranks. A texel that shows a single blade keeps or loses it, by its rank. Of many blades a part is left, and
// transmittance follows from their number. The lower their mean rank, the more are left: the slope is the covariance of both over
// the variance of ranks. As lower ranks hide higher ones, the mean rank is usually below one half, by the variance for each unit
// of optical depth.
float thinned(float covers, float dense, float rank, float sharp, float level) {
    float single = covers * clamp((dense - rank) * sharp + 0.5, 0.0, 1.0), depth = -log(1.0 - min(covers, MOST_HIDDEN));
    float part = dense + 0.5 * dense * (1.0 - dense) / VARIANCE * (0.5 - VARIANCE * depth - rank);
    float of_many = 1.0 - transmittance(depth * clamp(part, 0.0, 1.0));
    return mix(single, of_many, clamp((level - MANY.x) / (MANY.y - MANY.x), 0.0, 1.0));
}
