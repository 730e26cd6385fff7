// Messages of the frame's receivers, and the ground under them.
#include "systems/receive/received.py"

uniform sampler2D received;  // by receiver: its message; height of the ground [m]; density of its kind

vec4 received_by(int number) {
    return texelFetch(received, ivec2(number % RECEIVED_ROW, number / RECEIVED_ROW), 0);
}
