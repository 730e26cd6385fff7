// A panel's pixels: letters and shapes, all from one image.
uniform sampler2D image;
in vec2 image_at;
in vec4 tint;
out vec4 shown;

void main() {
    shown = tint * texture(image, image_at);
}
