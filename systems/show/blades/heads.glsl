// Coverage of heads as small as pixels, on tips of stems. Their organs hide one another; but where each covers a part of a pixel,
// blending assumes them at independent places in it, and together they would cover more than the head does.
#include "lib/frame.glsl"

const float ALMOST_ALL = 0.9999;  // largest coverage of a pixel

// Factor on the coverage of each organ of a head, so that all together cover as much of a pixel as the head does. `head` is
// `Headed`, `way` the way from the eye [m]. A head counts as a box of `head.z` layers that covers as much of one pixel as it can.
float overlap_factor(vec3 head, vec3 way) {
    float away = max(length(way), LEAST_WIDTH), slope = way.y / away, pixels = pixels_per_metre() / away;
    float area = pixels * pixels * length(vec2(head.x * slope, head.y * sqrt(max(1.0 - slope * slope, 0.0))));
    float broad = pixels * sqrt(head.x), covered = min(min(broad, 1.0) * min(area / broad, 1.0), ALMOST_ALL);
    return (1.0 - pow(1.0 - covered, 1.0 / head.z)) / covered;
}
