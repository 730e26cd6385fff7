// What the receivers of the frame have been told, and what they stand on.
uniform sampler2D received;  // by receiver: its message; height of the ground [m]; how densely its kind grows

const int RECEIVED_ROW = 1024;  // receivers in a row of the texture

vec4 received_by(int number) {
    return texelFetch(received, ivec2(number % RECEIVED_ROW, number / RECEIVED_ROW), 0);
}
