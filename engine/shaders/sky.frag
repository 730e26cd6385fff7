#include "lib/frame.glsl"

in vec3 ray;
out vec4 pixel;

void main() {
    vec3 toward = normalize(ray);
    float up = max(toward.y, 0.0);
    float low = 1.0 - up;
    low *= low;
    vec3 sky = mix(zenith.rgb, haze.rgb, low * low);
    float near_sun = max(dot(toward, sun.xyz), 0.0);
    float wide = near_sun * near_sun;
    wide *= wide;
    sky += glow.rgb * (0.22 * wide * wide + 0.9 * smoothstep(0.99955, 0.9998, near_sun));
    pixel = vec4(mix(sky, haze.rgb, smoothstep(0.0, -0.02, toward.y)), 1.0);
}
