#include "systems/light/sky.glsl"

in vec4 ray;
in vec3 light;
in vec2 uv;
in vec2 opacity;
out vec4 pixel;

const vec2 LIMB = vec2(0.00443, 0.00483);  // sines of the radii of the disc's soft edge; its diameter is 0.53 degrees
const float DISC = 12.0;     // radiance of the disc, relative to a white leaf in full sun: far above white

// Radiance of the aureole in the same unit, by the angle's sine to the power of -2: in clear air a fiftieth of the sun's light comes from
// about its disc (Buie, Monger and Dey, Sunshape Distributions for Terrestrial Solar Simulations, 2003).
const float AUREOLE = 1.1e-3;
const float GREYS = 255.0;  // steps of the picture from black to white
const vec3 GRIT = vec3(0.06711056, 0.00583715, 52.9829189);  // interleaved gradient noise (Jimenez, Next Generation Post Processing, 2014)

// Radiance of disc and aureole, relative to sunlight, by a line of sight's parts across the direction to the sun and along it.
float glow(vec3 ray) {
    float across = dot(ray.xy, ray.xy), aside = ray.z > 0.0 ? across / (across + ray.z * ray.z) : 1.0;
    return max(DISC - DISC * smoothstep(LIMB.x * LIMB.x, LIMB.y * LIMB.y, aside), AUREOLE / (aside + AUREOLE / DISC) - AUREOLE);
}

void main() {
    vec3 seen = light;
    float sunny = ray.w > 0.0 ? glow(ray.xyz) : 0.0;
    if (cloud_edge <= 1.0) {
        vec4 cloud = textureLod(clouds, uv, 0.0);
        seen = clouds_before(seen, cloud);
        sunny = cloud.y + sunny * max(1.0 - cloud.w * opacity.y - opacity.x, 0.0);
    }
    seen += sunlight * sunny;
    float grit = fract(GRIT.z * fract(dot(gl_FragCoord.xy, GRIT.xy))) - 0.5;
    pixel = vec4(tone_mapped(seen) + (writes_raw > 0.5 ? 0.0 : grit / GREYS), 1.0);
}
