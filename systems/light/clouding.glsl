// Clouds along a line of sight through the layer, from the height of the bases (0) to that of the highest tops (1).
#include "lib/clouds.glsl"
#include "systems/light/billows.py"
#include "systems/light/cloudscape.py"
#include "systems/light/heaps.py"

uniform sampler2D heaps;    // cloud map: broad density, its slopes along x and z, and fine density
uniform sampler3D billows;  // noise of billows, and its gradient along the axes of the block

// From positions in sides of the cloud map's square to those in the block of billows. It is rotated, so that no rows of the block are
// level, and a whole number of blocks fits a side, so that it tiles with the square.
const mat3 BLOCK = mat3(8.0, 1.0, -4.0, -4.0, 4.0, -7.0, 1.0, 8.0, 4.0);

struct Way {
    vec2 start;         // position at the height of the bases, in sides of the cloud map's square
    vec2 span;          // horizontal distance up to the height of the highest tops, in the same unit
    float mip_level;    // of the billows
    float length_ratio; // length of the way, relative to one straight up
};

Way way_toward(vec3 direction) {
    float sine = max(direction.y, 0.0) + CLOUD_BEND, far = CLOUD_BASE_HEIGHT / CLOUDS_SIDE / sine;
    float texel = BILLOWS_SIDE / (BILLOWS_TEXELS * CLOUD_BASE_HEIGHT) * sine * pixels_per_metre();  // its width in the picture [pixels]
    vec2 span = min(CLOUD_TALLEST_RATIO * far, CLOUD_FARTHEST_ASIDE) * direction.xz;
    float length_ratio = length(vec3(span * CLOUDS_SIDE / CLOUD_TALLEST, 1.0));
    return Way(clouds_uv_over(eye.xz) + far * direction.xz, span, max(-log2(texel), 0.0), length_ratio);
}

// Excess density at the base below the highest tops. Where there are many clouds, it is the map's largest one.
float tallest_column() {
    return max(CLOUD_DENSEST - cloud_edge, CLOUD_DOME);
}

struct CloudPoint {
    float along;   // position on the way, 0 to 1
    float excess;  // excess density, negative outside clouds
    float dome;    // excess density without billows
    float column;  // excess density of the column, which loses its fine part with height
    float relief;  // how far the billows are lit and shaded one by one, 0 at bases to 1
    vec4 map;      // texel of the cloud map
    vec4 billow;   // texel of the billows
};

CloudPoint cloud_at(Way way, float along) {
    vec2 uv = way.start + way.span * along;
    vec4 map = textureLod(heaps, uv, 0.0);
    vec4 billow = textureLod(billows, BLOCK * vec3(uv.x, along * (CLOUD_TALLEST / CLOUDS_SIDE), uv.y), way.mip_level);
    float below = 1.0 - along, column = map.x + HEAPS_FINE * below * below * (map.w - 0.5) - cloud_edge;  // small heaps are low
    float dome = column - tallest_column() * along * along;
    float relief = clamp(CLOUD_RELIEF * along, 0.0, 1.0);
    float strength = clamp(CLOUD_SUPPORT * column + 1.0 - relief, 0.0, 1.0);
    float excess = dome + CLOUD_BILLOWED * strength * (billow.x - 0.5);
    excess *= excess > 0.0 ? clamp(CLOUD_BASE_DEPTH + CLOUD_BASE_DEPTH_RISE * along, 0.0, 1.0) : 1.0;
    return CloudPoint(along, excess, dome, column, relief, map, billow);
}
