// Clouds over the whole picture, and linear forms for their self-shadowing.
#include "systems/light/clouding.glsl"

out vec3 ray;

// Change of density a step towards the sun, as linear forms of what is known at a point: of the map's slopes, the height and 1; and of
// the billows' gradient and 1.
flat out vec4 map_toward_sun;
flat out vec4 billows_toward_sun;

// Sunlight that a thin cloud sends from its shade, relative to a cloud in full sun: the twin of `sun_scattered` of `clouds.py`.
flat out float sun_scattered;

const float OVER = 4.0;  // legs of a triangle that covers the viewport of 2 by 2

void main() {
    vec2 corner = vec2(float(gl_VertexID & 1), float(gl_VertexID >> 1)) * OVER - 1.0;
    ray = ray_ahead + corner.x * ray_across + corner.y * ray_up;
    vec2 slope = CLOUD_MAP_ASIDE * HEAPS_STEEPEST / CLOUDS_SIDE * sun.xz;
    float up = CLOUD_MAP_ASIDE / CLOUD_TALLEST * sun.y;
    map_toward_sun = vec4(2.0 * slope, -tallest_column() * up * vec2(2.0, up));
    map_toward_sun.w -= slope.x + slope.y;
    vec3 gradient = CLOUD_BILLOWED * BILLOWS_STEEPEST * CLOUD_BILLOWS_ASIDE / CLOUDS_SIDE * (BLOCK * sun);
    billows_toward_sun = vec4(2.0 * gradient, -(gradient.x + gradient.y + gradient.z));
    float aspect = CLOUD_ASPECT * clamp(cloud_edge, 0.0, 1.0);
    sun_scattered = (max(sun.y, 0.0) + aspect * length(sun.xz)) / (1.0 + 2.0 * aspect);
    gl_Position = vec4(corner, 0.0, 1.0);
}
