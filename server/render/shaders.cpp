#include "shaders.h"

namespace plab::render
{
namespace
{

/// Colours come and go as sRGB; light adds up in linear space. The background is a gradient over the picture's height.
constexpr const char* kCommon = R"(#version 330 core
vec3 linear(vec3 c) { return c * (c * (c * 0.305306011 + 0.682171111) + 0.012522878); }
vec3 encoded(vec3 c)
{
    c = max(c, 0.0);
    return max(1.055 * pow(c, vec3(0.416666667)) - 0.055, 0.0);
}
uniform vec2 picture;  // pixels
vec3 background()
{
    float up = gl_FragCoord.y / picture.y;
    vec3 low = vec3(0.930, 0.938, 0.946), high = vec3(0.675, 0.735, 0.800);
    return mix(low, high, smoothstep(0.0, 1.0, up));
}
)";

/// How much of the key light comes through: a shadow map, sampled at five places of bilinear comparison each.
constexpr const char* kShadow = R"(
uniform sampler2DShadow shadow_map;
uniform mat4 light_from_E;
uniform float texel;       // m; 0: nothing throws a shadow
uniform vec2 shadow_step;  // one texel of the map, in its own coordinates
float lit(vec3 p, vec3 n, float spread)
{
    vec4 q = light_from_E * vec4(p + n * (2.0 * texel), 1.0);
    vec3 s = q.xyz * 0.5 + 0.5;
    vec2 d = shadow_step * spread;
    float sum = texture(shadow_map, s)
        + texture(shadow_map, s + vec3(d.x, 0.4 * d.y, 0.0)) + texture(shadow_map, s + vec3(-0.4 * d.x, d.y, 0.0))
        + texture(shadow_map, s + vec3(-d.x, -0.4 * d.y, 0.0)) + texture(shadow_map, s + vec3(0.4 * d.x, -d.y, 0.0));
    return texel > 0.0 ? 0.2 * sum : 1.0;
}
)";

/// An instance has a place relative to the eye, an orientation and a size of its own.
constexpr const char* kSolidVertex = R"(#version 330 core
layout(location = 0) in vec3 position;
layout(location = 1) in vec3 normal;
layout(location = 2) in vec3 place;
layout(location = 3) in vec4 turn;  // x y z w
layout(location = 4) in vec3 size;
layout(location = 5) in vec3 color;
uniform mat4 clip_from_E;
out vec3 point;
out vec3 outward;
flat out vec3 base;
vec3 turned(vec3 v)
{
    vec3 t = 2.0 * cross(turn.xyz, v);
    return v + turn.w * t + cross(turn.xyz, t);
}
void main()
{
    point = place + turned(position * size);
    outward = turned(normal * size.yzx * size.zxy);
    base = color;
    gl_Position = clip_from_E * vec4(point, 1.0);
}
)";

constexpr const char* kSolidFragment = R"(
in vec3 point;
in vec3 outward;
flat in vec3 base;
uniform vec3 to_light;
out vec4 result;

// Sky above, light that the ground throws back below.
vec3 surroundings(float up) { return mix(vec3(0.46, 0.44, 0.42), vec3(0.78, 0.86, 0.96), smoothstep(-0.6, 0.8, up)); }

void main()
{
    vec3 n = normalize(outward), v = normalize(-point);
    n = faceforward(n, -v, n);  // an open mesh has two sides
    vec3 l = to_light, h = normalize(l + v);
    float cosine = max(dot(n, l), 0.0);
    float sun = cosine * lit(point, n, 1.6);
    vec3 albedo = linear(base);

    // Key light, a weak one from the eye, and the surroundings; then what a clear coat mirrors (Schlick's law).
    vec3 color = albedo * (sun * vec3(1.02, 0.98, 0.92) + 0.12 * max(dot(n, v), 0.0) + 0.42 * surroundings(n.z));
    float fresnel = 0.04 + 0.96 * pow(1.0 - max(dot(n, v), 0.0), 5.0);
    float glare = pow(max(dot(n, h), 0.0), 60.0) * step(1e-4, cosine);
    color += fresnel * 0.45 * surroundings(reflect(-v, n).z) + 0.30 * glare * (sun / max(cosine, 0.15));
    color = color / (1.0 + max(color - 0.8, 0.0));  // bright spots keep their colour
    result = vec4(encoded(color), 1.0);
}
)";

/// A square of the plane's z = 0, about the point below the focus.
constexpr const char* kPlaneVertex = R"(#version 330 core
uniform mat4 clip_from_E;
uniform vec3 middle, axis_u, axis_v;  // relative to the eye; axes are unit
uniform float reach;
out vec3 point;
out vec2 local;  // m, from the middle
void main()
{
    local = reach * (2.0 * vec2(gl_VertexID & 1, gl_VertexID >> 1) - 1.0);
    point = middle + axis_u * local.x + axis_v * local.y;
    gl_Position = clip_from_E * vec4(point, 1.0);
}
)";

constexpr const char* kPlaneFragment = R"(
in vec3 point;
in vec2 local;
uniform float reach;
uniform float grid;    // width of a cell, m
uniform vec2 phase;    // of the middle, in cells, modulo 10
uniform vec3 color;    // of the plane, sRGB
uniform float opacity;
uniform vec3 normal, to_light;
out vec4 result;

// Lines of constant strength: as wide as given, never thinner than a pixel, fainter instead.
float lines(vec2 p, float width)
{
    vec2 pixel = max(fwidth(p), 1e-6);
    vec2 drawn = clamp(vec2(width), pixel, vec2(0.5));
    vec2 away = abs(fract(p + 0.5) - 0.5);
    vec2 line = smoothstep(drawn + pixel, drawn - pixel * 0.5, away) * clamp(width / drawn, 0.0, 1.0);
    line = mix(line, vec2(2.0 * width), clamp(pixel * 2.0 - 1.0, 0.0, 1.0));
    return mix(line.x, 1.0, line.y);
}

void main()
{
    float away = length(local) / reach;
    float fade = 1.0 - smoothstep(0.15, 1.0, away);
    vec2 cell = local / grid + phase;
    float line = max(0.55 * lines(cell, 0.010), lines(cell * 0.2, 0.0035));
    float open = lit(point, normal, 2.0);
    vec3 below = background();
    vec3 surface = mix(linear(below), linear(color), opacity);
    surface *= mix(0.50, 1.0, mix(1.0, open, fade * step(0.0, dot(normal, to_light))));
    surface = mix(surface, surface * 0.42, line * fade * 0.75);
    result = vec4(encoded(surface), 1.0);
    result = vec4(mix(below, result.rgb, fade), 1.0);
}
)";

constexpr const char* kBackgroundVertex = R"(#version 330 core
void main() { gl_Position = vec4(4.0 * float(gl_VertexID & 1) - 1.0, 4.0 * float(gl_VertexID >> 1) - 1.0, 1.0, 1.0); }
)";

constexpr const char* kBackgroundFragment = R"(
out vec4 result;
void main() { result = vec4(background(), 1.0); }
)";

}  // namespace

std::string solid_vertex_shader() { return kSolidVertex; }
std::string solid_fragment_shader() { return std::string(kCommon) + kShadow + kSolidFragment; }
std::string shadow_fragment_shader() { return "#version 330 core\nvoid main() {}\n"; }
std::string plane_vertex_shader() { return kPlaneVertex; }
std::string plane_fragment_shader() { return std::string(kCommon) + kShadow + kPlaneFragment; }
std::string background_vertex_shader() { return kBackgroundVertex; }
std::string background_fragment_shader() { return std::string(kCommon) + kBackgroundFragment; }

}  // namespace plab::render
