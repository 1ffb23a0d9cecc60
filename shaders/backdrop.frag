in vec2 v_at;
uniform int u_dark;
out vec4 o_colour;

void main() {
  vec3 low = u_dark == 1 ? vec3(0.105, 0.120, 0.140) : vec3(0.988, 0.988, 0.984);
  vec3 high = u_dark == 1 ? vec3(0.150, 0.168, 0.190) : vec3(0.938, 0.950, 0.962);
  o_colour = vec4(mix(low, high, smoothstep(0.1, 1.0, v_at.y)), 1.0);
}
