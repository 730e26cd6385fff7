// Clouds along a line of sight, on the way from the height of their bases to that of the highest tops: from 0 to 1.
#include "lib/clouds.glsl"
#include "systems/light/billows.py"
#include "systems/light/cloudscape.py"
#include "systems/light/heaps.py"

uniform sampler2D heaps;    // how dense clouds are, and how that rises along x and z
uniform sampler3D billows;  // how high their billows are, and how that rises along the axes of their block

// From places among clouds, in sides of their square, to those in the block: turned, so that rows of it lie nowhere level, and a whole
// number of blocks to a side, so that it meets itself where the square repeats.
const mat3 BLOCK = mat3(8.0, 1.0, -4.0, -4.0, 4.0, -7.0, 1.0, 8.0, 4.0);

struct Way {
    vec2 at;      // where it meets the height of the bases, in sides of the clouds' square
    vec2 each;    // how far it goes aside, in the same
    float level;  // of the block's mip-maps
    float longer;  // how long it is, of one straight up
};

Way way_toward(vec3 direction) {
    float near = max(direction.y, 0.0) + CLOUDS_BENT, far = CLOUDS_AT / CLOUDS_SIDE / near;
    float texel = BILLOWS_SIDE / (BILLOWS_TEXELS * CLOUDS_AT) * near * pixels_per_metre();  // how wide it is seen [pixels]
    vec2 each = min(CLOUD_STEP * far, CLOUD_FARTHEST) * direction.xz;
    float longer = length(vec3(each * CLOUDS_SIDE / CLOUD_RISE, 1.0));
    return Way(clouds_uv_over(eye.xz) + far * direction.xz, each, max(-log2(texel), 0.0), longer);
}

struct Place {
    float along;  // where it is on the way
    float deep;   // how much denser clouds are there than at their edge: less than 0 outside
    float side;   // how much of billows shows there: less at bases
    float heap;   // how much higher they are there than in the mean
    vec3 map;
    vec4 billow;
};

Place place_on(Way way, float along) {
    vec2 at = way.at + way.each * along;
    vec3 map = textureLod(heaps, at, 0.0).rgb;
    vec4 billow = textureLod(billows, BLOCK * vec3(at.x, along * (CLOUD_RISE / CLOUDS_SIDE), at.y), way.level);
    float side = min(CLOUD_BASE + CLOUD_SIDE * along, 1.0), heap = side * (billow.x - 0.5);
    float deep = map.x - cloud_edge - CLOUD_ROUND * along * along + CLOUD_BILLOWED * heap;
    deep *= deep > 0.0 ? min(CLOUD_BASE_DENSE + CLOUD_BASE_HIGH * along, 1.0) : 1.0;
    return Place(along, deep, side, heap, map, billow);
}
