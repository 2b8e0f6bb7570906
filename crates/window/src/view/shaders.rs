//! The shaders of the painter by OpenGL.

/// Corners of surfaces to clip space, in the light of the viewer's pictures; goes after `MeshBuffer::LIGHT`. Light is worked out
/// at corners and not at pixels: surfaces have fewer corners than pixels, and where a processor draws, pixels cost most.
pub(super) const MESH_VERTEX: &str = "
uniform mat4 clip;
uniform vec3 eye;
uniform vec3 sight;
uniform vec3 key;
uniform vec3 fill;
uniform vec3 up;
in vec3 position;
in vec3 normal;
in vec4 front;
in vec4 reverse;
out vec3 v_front;
#ifndef ONLY_FRONT
out vec3 v_reverse;
#endif
vec3 shaded(vec4 color, vec3 n, vec3 to_eye) {
    float lean = dot(n, to_eye);
    if (lean < 0.0) {
        n = normalize(n - to_eye * lean);
    }
    vec3 light = lit(pow(color.rgb, vec3(2.2)), n, to_eye, key, fill, up, color.a > 0.5);
    return pow(clamp(light, 0.0, 1.0), vec3(1.0 / 2.2));
}
void main() {
    vec3 to_eye = sight == vec3(0.0) ? normalize(eye - position) : sight;
    v_front = shaded(front, normal, to_eye);
#ifndef ONLY_FRONT
    v_reverse = shaded(reverse, -normal, to_eye);
#endif
    gl_Position = clip * vec4(position, 1.0);
}
";

/// The side of a surface that is seen; with `ONLY_FRONT` defined in both shaders there is but one.
pub(super) const MESH_FRAGMENT: &str = "
uniform float strength;
in vec3 v_front;
out vec4 out_color;
#ifdef ONLY_FRONT
void main() {
    out_color = vec4(v_front, 1.0) * strength;
}
#else
in vec3 v_reverse;
void main() {
    out_color = vec4(gl_FrontFacing ? v_front : v_reverse, 1.0) * strength;
}
#endif
";

/// Lines and points as quads of so many pixels; what is behind the eye is left out.
pub(super) const LINE_VERTEX: &str = "
uniform mat4 clip;
uniform vec2 size;
uniform float bias;
uniform float scale;
in vec3 a;
in vec3 b;
in vec3 corner;
in vec4 color;
out vec4 v_color;
out vec2 v_across;
void main() {
    vec4 from = clip * vec4(a, 1.0);
    vec4 to = clip * vec4(b, 1.0);
    bool is_point = a == b;
    vec2 along = is_point ? vec2(1.0, 0.0) : (to.xy / to.w - from.xy / from.w) * size;
    along = length(along) > 1e-6 ? normalize(along) : vec2(1.0, 0.0);
    vec2 side = vec2(-along.y, along.x);
    float reach = scale * corner.z + 1.0;
    vec4 at = corner.x < 0.0 ? from : to;
    vec2 off = side * corner.y * reach + along * corner.x * (is_point ? reach : 0.0);
    at.xy += off * 2.0 / size * at.w;
    at.z -= bias * at.w;
    gl_Position = (from.w <= 0.0 || to.w <= 0.0) ? vec4(0.0, 0.0, 2.0, 1.0) : at;
    v_color = color;
    v_across = vec2(is_point ? corner.x * reach : 0.0, corner.y * reach);
}
";

/// Lines and points with soft edges.
pub(super) const LINE_FRAGMENT: &str = "
uniform float strength;
uniform float scale;
in vec4 v_color;
in vec2 v_across;
out vec4 out_color;
void main() {
    // The colour's last byte is the width in pixels at scale 1.
    float half_width = v_color.a * 127.5 * scale;
    float alpha = clamp(half_width + 0.5 - length(v_across), 0.0, 1.0) * strength;
    if (alpha <= 0.0) {
        discard;
    }
    out_color = vec4(v_color.rgb * alpha, alpha);
}
";
