layout(location = 0) in vec3 a_position;
layout(location = 1) in vec3 a_normal;
layout(location = 2) in float a_at;
layout(location = 3) in vec4 a_colour;
uniform mat4 u_view_projection;
out vec3 v_position;
out vec3 v_normal;
out float v_at;
flat out vec4 v_colour;

void main() {
  v_position = a_position;
  v_normal = a_normal;
  v_at = a_at;
  v_colour = a_colour;
  gl_Position = u_view_projection * vec4(a_position, 1.0);
}
