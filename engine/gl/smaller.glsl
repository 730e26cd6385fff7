// A picture with fewer pixels than the host's, and how it is read in the host's. All places go from 0 to 1.

uniform sampler2D before;   // how deep the host's pixels were before anything was drawn here
uniform sampler2D picture;  // what was drawn smaller, premultiplied
uniform sampler2D deep;     // and how deep that is
uniform vec2 size;          // pixels of the smaller picture
uniform vec2 unit;          // how large each of them is
uniform float farthest;     // depth where nothing has been drawn, 1 or 0
uniform ivec2 corner;       // of the viewport in the host's framebuffer [pixels]

in vec2 at;

// The middle of the smaller picture's pixel.
vec2 middle_of(vec2 place) {
    return (floor(place * size) + 0.5) * unit;
}

// How much farther off one depth is than another.
float behind(float one, float other) {
    return farthest > 0.5 ? one - other : other - one;
}

// How deep the host's pixel was.
float depth_before() {
    return texelFetch(before, ivec2(gl_FragCoord.xy) - corner, 0).r;
}

// Whether the host had drawn something so deep.
bool has_host(float depth) {
    return depth != farthest;
}

// Within how many of the host's pixels one texel's colour goes over into the next one's. Evenly, over a whole texel, a quarter of the
// contrast would be lost, and a cubic takes three samples and is no nearer to the truth (FLIP, half the pixels across); within one,
// texels would be squares.
const float GOES_OVER = 1.1;

// Filtered up.
vec4 sharp(vec2 place) {
    vec2 texel = place * size - 0.5, part = fract(texel), within = min(GOES_OVER * vec2(dFdx(texel.x), dFdy(texel.y)), 1.0);
    return texture(picture, (floor(texel) + clamp((part - 0.5) / within + 0.5, 0.0, 1.0) + 0.5) * unit);
}
