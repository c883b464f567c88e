// Marks each pixel that an object covers.

out vec4 covered;

void main() {
    covered = vec4(1.0);
}
