#include "lib/clouds.glsl"
#include "lib/light.glsl"

in vec3 ray;
in vec3 light;
in vec2 at;
in float low;
out vec4 pixel;

uniform sampler2D clouds;  // how much clouds hide, what they send of the sun's light, and of light in full shade, and how much of the sun they hide

const vec2 LIMB = vec2(0.00443, 0.00483);  // sines between which the sun's disc ends, which is 0.53 degrees wide half-way
const float DISC = 12.0;     // radiance of the disc, of a white leaf's in full sun: far above white
const vec2 AUREOLE = vec2(0.35, 900.0);  // radiance of the aureole about it, of the same, and how narrow it is
const float GREYS = 255.0;  // steps that a picture has from black to white
const vec3 GRIT = vec3(0.06711056, 0.00583715, 52.9829189);  // interleaved gradient noise (Jimenez, Next Generation Post Processing, 2014)

// What the sun itself and the air about it send, of its light, by the cosine of the angle to it.
float glow(float cosine) {
    float aside = cosine > 0.0 ? 1.0 - cosine * cosine : 1.0, aureole = 1.0 / (1.0 + AUREOLE.y * aside);
    return DISC - DISC * smoothstep(LIMB.x * LIMB.x, LIMB.y * LIMB.y, aside) + AUREOLE.x * aureole * aureole;
}

void main() {
    vec3 toward = ray * inversesqrt(dot(ray, ray)), seen = light;
    float sunny = toward.y > 0.0 ? glow(dot(toward, sun)) : 0.0;
    if (cloud_edge <= 1.0) {
        vec4 cloud = textureLod(clouds, at, 0.0);
        seen = seen - cloud.x * seen + cloudlight * cloud.z;
        sunny = cloud.y + sunny * max(1.0 - cloud.w - low, 0.0);  // low down, the sun is seen past them as in the mean
    }
    seen += sunlight * sunny;
    float grit = fract(GRIT.z * fract(dot(gl_FragCoord.xy, GRIT.xy))) - 0.5;
    pixel = vec4(tone_mapped(seen) + (writes_raw > 0.5 ? 0.0 : grit / GREYS), 1.0);
}
