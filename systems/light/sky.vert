// The sky over the whole picture, on a grid of squares: between their corners its colour is almost linear.
#include "systems/light/sky.glsl"

out vec4 ray;  // line of sight: two parts across the direction to the sun, one along it, and the part upwards
out vec3 light;
out vec2 uv;  // from 0 to 1 across and up the picture

// Opacity of clouds before the sun: their mean one, for a low sun in the haze where none is seen, and a factor on that in their picture,
// where they stand out from the haze.
out vec2 opacity;

const float STANDS_OUT = 0.5;  // how far a cloud stands out from the haze where it hides the sun wholly

void main() {
    vec2 cell = vec2(float(gl_VertexID / 2), float(gl_InstanceID + (gl_VertexID & 1)));
    vec2 corner = cell * vec2(2.0 / float(ACROSS), 2.0 / float(UP)) - 1.0;
    vec3 sight = ray_ahead + corner.x * ray_across + corner.y * ray_up, toward = normalize(sight);
    vec2 leaning = sun.xz / (1.0 + max(sun.y, 0.0));  // (Frisvad, Building an Orthonormal Basis Without Normalization, 2012)
    vec2 across = sight.xz - sun.xz * (sight.y + dot(leaning, sight.xz));
    ray = vec4(across, dot(sight, sun), sight.y);
    light = sky_toward(toward);
    uv = 0.5 * corner + 0.5;
    float clear = out_of_haze(toward.y);
    opacity = vec2((1.0 - clamp(cloud_edge, 0.0, 1.0)) * max(1.0 - clear / STANDS_OUT, 0.0), 1.0 / max(clear, STANDS_OUT));
    gl_Position = vec4(corner, depth_ends.y, 1.0);
}
