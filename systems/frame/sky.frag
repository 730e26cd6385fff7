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
    sky = mix(sky, haze.rgb, smoothstep(0.0, -0.02, toward.y));
    float grit = fract(52.9829189 * fract(dot(gl_FragCoord.xy, vec2(0.06711056, 0.00583715)))) - 0.5;
    pixel = vec4(sky + grit / 255.0, 1.0);
}
