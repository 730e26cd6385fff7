// The sky over the whole picture, on a grid of squares: between their corners its colour is almost linear.
#include "lib/clouds.glsl"
#include "lib/light.glsl"

uniform sampler2D sky;  // sky map: by azimuth from the sun, 0 to pi, and by the root of the elevation's sine

out vec4 ray;  // line of sight: two parts across the direction to the sun, one along it, and the part upwards
out vec3 light;
out vec2 uv;  // from 0 to 1 across and up the picture

// Mean opacity of clouds before a low sun, in the haze where none is seen.
out float mean_opacity;

const float PI = 3.14159;
const vec3 ARC = vec3(1.5707, -0.2121, 0.0742);  // arc cosine over the root of 1 - c, as a polynomial in c (Hastings, 1955)

// Arc cosine in [0, pi], with a relative error of 0.004; acos() is slower.
float angle_of(float cosine) {
    float c = abs(cosine), near = sqrt(1.0 - c) * (ARC.x + c * (ARC.y + c * ARC.z));
    return cosine < 0.0 ? PI - near : near;
}

void main() {
    vec2 cell = vec2(float(gl_VertexID / 2), float(gl_InstanceID + (gl_VertexID & 1)));
    vec2 corner = cell * vec2(2.0 / float(ACROSS), 2.0 / float(UP)) - 1.0;
    vec3 sight = ray_ahead + corner.x * ray_across + corner.y * ray_up, toward = normalize(sight);
    vec2 leaning = sun.xz / (1.0 + max(sun.y, 0.0));  // (Frisvad, Building an Orthonormal Basis Without Normalization, 2012)
    vec2 across = sight.xz - sun.xz * (sight.y + dot(leaning, sight.xz));
    ray = vec4(across, dot(sight, sun), sight.y);
    float c = dot(toward.xz, toward_sun) * inversesqrt(dot(toward.xz, toward.xz) + LEAST_LENGTH);
    vec2 size = vec2(textureSize(sky, 0)), place = vec2(angle_of(clamp(c, -1.0, 1.0)) / PI, sqrt(max(toward.y, 0.0)));
    light = textureLod(sky, (place * (size - 1.0) + 0.5) / size, 0.0).rgb;
    uv = 0.5 * corner + 0.5;
    mean_opacity = (1.0 - clamp(cloud_edge, 0.0, 1.0)) * (1.0 - smoothstep(CLOUD_FADE.x, CLOUD_FADE.y, toward.y));
    gl_Position = vec4(corner, depth_ends.y, 1.0);
}
