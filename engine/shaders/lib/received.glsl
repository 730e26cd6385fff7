// What the receivers of the frame have been told, and what they stand on.
#include "systems/receive/received.py"

uniform sampler2D received;  // by receiver: its message; height of the ground [m]; how densely its kind grows

vec4 received_by(int number) {
    return texelFetch(received, ivec2(number % RECEIVED_ROW, number / RECEIVED_ROW), 0);
}
