#include "lib/frame.glsl"

in vec3 ray;
out vec4 pixel;

const float LIMB = 0.00483;  // sine of the outer edge of the sun's disc, which is 0.53 degrees wide half-way up its limb

void main() {
    vec3 toward = normalize(ray);
    float up = max(toward.y, 0.0);
    float low = 1.0 - up;
    low *= low;
    vec3 sky = mix(zenith.rgb, haze.rgb, low * low);
    float near_sun = max(dot(toward, sun.xyz), 0.0);
    float wide = near_sun * near_sun;
    wide *= wide;
    float aside = near_sun > 0.0 ? length(cross(toward, sun.xyz)) : 1.0;  // near 1, cosines are too coarse
    float disc = smoothstep(LIMB, LIMB - 0.0004, aside), aureole = exp2(-70.0 * aside);
    sky += glow.rgb * (0.22 * wide * wide + 0.3 * aureole + 0.9 * disc);
    sky = mix(sky, haze.rgb, smoothstep(0.0, -0.02, toward.y));
    float grit = fract(52.9829189 * fract(dot(gl_FragCoord.xy, vec2(0.06711056, 0.00583715)))) - 0.5;
    pixel = vec4(sky + grit / 255.0, 1.0);
}
