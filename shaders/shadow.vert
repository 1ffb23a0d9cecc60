layout(location = 0) in vec3 a_position;
uniform mat4 u_view_projection;
uniform vec3 u_up;
uniform vec3 u_floor;
out float v_height;

void main() {
  v_height = dot(a_position - u_floor, u_up);
  gl_Position = u_view_projection * vec4(a_position, 1.0);
}
