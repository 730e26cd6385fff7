// Uniforms and sampling of a picture of reduced resolution, drawn over the host's. All positions go from 0 to 1.

uniform sampler2D host_depth;   // depth of the host's pixels before anything was drawn here
uniform sampler2D small_color;  // the smaller picture, premultiplied
uniform sampler2D small_depth;  // and its depth
uniform vec2 size;              // of the smaller picture [pixels]
uniform vec2 texel;             // size of its pixels
uniform float farthest;         // depth where nothing has been drawn, 1 or 0
uniform ivec2 corner;           // of the viewport in the host's framebuffer [pixels]

in vec2 at;

// Centre of the smaller picture's pixel at a position.
vec2 pixel_centre(vec2 place) {
    return (floor(place * size) + 0.5) * texel;
}

// Distance in depth by which `depth` is farther than `other`.
float farther_by(float depth, float other) {
    return farthest > 0.5 ? depth - other : other - depth;
}

// Depth of the host's pixel.
float host_depth_here() {
    return texelFetch(host_depth, ivec2(gl_FragCoord.xy) - corner, 0).r;
}

// Whether a depth is of something that has been drawn.
bool is_drawn(float depth) {
    return depth != farthest;
}

// Width of the transition from one texel's colour to the next one's [pixels of the host]. Plain bilinear interpolation, over a whole
// texel, would lose a quarter of the contrast, and a cubic filter takes three samples and is no nearer to the truth (FLIP, half the
// pixels across); within one pixel, texels would show as squares.
const float TRANSITION = 1.1;

// Return the smaller picture, upsampled by sharpened bilinear interpolation.
vec4 upsampled(vec2 place) {
    vec2 at_texel = place * size - 0.5, fraction = fract(at_texel);
    vec2 width = min(TRANSITION * vec2(dFdx(at_texel.x), dFdy(at_texel.y)), 1.0);
    return texture(small_color, (floor(at_texel) + clamp((fraction - 0.5) / width + 0.5, 0.0, 1.0) + 0.5) * texel);
}
