in vec3 v_position;
in vec3 v_normal;
uniform vec3 u_eye;
out vec4 o_colour;

// Denser at its rims, so that its shape is seen.
void main() {
  float facing = max(dot(normalize(v_normal), normalize(u_eye - v_position)), 0.0);
  o_colour = vec4(vec3(0.36, 0.40, 0.44), mix(0.62, 0.34, facing));
}
