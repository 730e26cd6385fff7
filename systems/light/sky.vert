// The sky over the whole picture, in rows of squares: between their corners its colour hardly bends.
#include "lib/clouds.glsl"
#include "lib/light.glsl"

uniform sampler2D sky;  // by azimuth from the sun, from 0 to pi, and by the root of the elevation's sine

out vec3 ray;
out vec3 light;
// Of clouds, how bright their edges are ahead of the sun; how far they are out of the haze; level of their map.
out vec3 clouding;

// How far aside from a cloud lies what shades it, towards the sun, in sides of their square; how much it does: not under an overcast,
// which has no sides.
flat out vec3 shaded_from;

const vec2 FADES = vec2(-0.02, 0.14);  // sines of elevations between which clouds come out of the haze at the horizon
const float FINEST = 0.35;  // sine of the elevation below which their map is read more coarsely

const float PI = 3.14159;
const vec3 ARC = vec3(1.5707, -0.2121, 0.0742);  // the arc cosine over the root of 1 - c, by powers of c (Hastings, 1955)

// An angle in [0, pi] by its cosine, within 0.004 of itself; acos is dearer.
float angle_of(float cosine) {
    float c = abs(cosine), near = sqrt(1.0 - c) * (ARC.x + c * (ARC.y + c * ARC.z));
    return cosine < 0.0 ? PI - near : near;
}

void main() {
    vec2 cell = vec2(float(gl_VertexID / 2), float(gl_InstanceID + (gl_VertexID & 1)));
    vec2 corner = cell * vec2(2.0 / float(ACROSS), 2.0 / float(UP)) - 1.0;
    ray = ray_ahead + corner.x * ray_across + corner.y * ray_up;
    vec3 toward = normalize(ray);
    float c = dot(toward.xz, toward_sun) * inversesqrt(dot(toward.xz, toward.xz) + LEAST_LENGTH);
    vec2 size = vec2(textureSize(sky, 0)), at = vec2(angle_of(clamp(c, -1.0, 1.0)) / PI, sqrt(max(toward.y, 0.0)));
    light = textureLod(sky, (at * (size - 1.0) + 0.5) / size, 0.0).rgb;
    float ahead = 0.5 + 0.5 * dot(toward, sun), silver = ahead * ahead * ahead;
    silver *= silver;
    shaded_from = vec3(CLOUD_ASIDE / CLOUDS_SIDE * toward_sun, clamp(1.0 + cloud_edge / CLOUD_OVERCAST, 0.0, 1.0));
    float out_of_haze = smoothstep(FADES.x, FADES.y, toward.y) * (1.0 - CLOUD_AIR * shaded_from.z);
    clouding = vec3(silver * silver, out_of_haze, log2(FINEST / clamp(toward.y, FADES.x, FINEST)));
    gl_Position = vec4(corner, depth_ends.y, 1.0);
}
