// Which blades grow where their kind does so thinly: those of the lower ranks.

const float FIRMEST = 1e-3;  // the narrowest span of ranks

// The span of ranks over which blades go, where some density leaves them: so that as many grow in the mean, and none where it
// is 0.
float span_of(float dense, float soft) {
    return clamp(2.0 * min(dense, 1.0 - dense), FIRMEST, soft);
}
