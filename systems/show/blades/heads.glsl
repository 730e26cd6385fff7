// Heads as small as pixels, on tips of stems. What they are made of hides itself; but where each of it covers a part of a pixel,
// blending takes it to lie anywhere in there, and all together would hide more than the head does.
#include "lib/frame.glsl"

const float ALMOST_ALL = 0.9999;  // of a pixel

// With what part of its coverage each thing is drawn that a head is made of, on a way from the eye, for all of them to hide as much
// of a pixel as it does. A head is taken for a box of as many layers, and hides of one pixel what it may at most.
float uncovered(vec3 head, vec3 way) {
    float away = max(length(way), LEAST_WIDTH), slope = way.y / away, pixels = pixels_per_metre() / away;
    float area = pixels * pixels * length(vec2(head.x * slope, head.y * sqrt(max(1.0 - slope * slope, 0.0))));
    float broad = pixels * sqrt(head.x), hides = min(min(broad, 1.0) * min(area / broad, 1.0), ALMOST_ALL);
    return (1.0 - pow(1.0 - hides, 1.0 / head.z)) / hides;
}
