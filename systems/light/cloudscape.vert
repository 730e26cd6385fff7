// Clouds over the whole picture, and how the sun stands to them.
#include "systems/light/clouding.glsl"

out vec3 ray;

// How much denser they are a way off towards the sun, by what is known of a place: how the map rises there, its height, and 1;
// how the billows rise there, and 1.
flat out vec4 sun_over;
flat out vec4 sun_into;

const float OVER = 4.0;  // sides of a triangle that a viewport of 2 by 2 lies in

void main() {
    vec2 corner = vec2(float(gl_VertexID & 1), float(gl_VertexID >> 1)) * OVER - 1.0;
    ray = ray_ahead + corner.x * ray_across + corner.y * ray_up;
    vec2 over = CLOUD_ASIDE * HEAPS_STEEPEST / CLOUDS_SIDE * sun.xz;
    float up = CLOUD_ASIDE / CLOUD_RISE * sun.y;
    sun_over = vec4(2.0 * over, -CLOUD_ROUND * up * vec2(2.0, up));
    sun_over.w -= over.x + over.y;
    vec3 into = CLOUD_BILLOWED * BILLOWS_STEEPEST * CLOUD_NEAR / CLOUDS_SIDE * (BLOCK * sun);
    sun_into = vec4(2.0 * into, -(into.x + into.y + into.z));
    gl_Position = vec4(corner, 0.0, 1.0);
}
