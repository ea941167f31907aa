#include "shaders.h"

namespace plab::render
{
namespace
{

/// Colours come and go as sRGB; light adds up in linear space. The background is a gradient over the picture's height.
constexpr const char* kCommon = R"(#version 330 core
vec3 linear(vec3 c) { return c * (c * (c * 0.305306011 + 0.682171111) + 0.012522878); }
// The curve of sRGB by square roots: four times as fast as a power, and off by less than one part in 255.
vec3 encoded(vec3 c)
{
    vec3 a = sqrt(max(c, 0.0)), b = sqrt(a), d = sqrt(b);
    return max(0.662002687 * a + 0.684122060 * b - 0.323583601 * d - 0.022541147 * c, 0.0);
}
uniform vec2 picture;  // pixels
vec3 background()
{
    float up = gl_FragCoord.y / picture.y;
    vec3 low = vec3(0.930, 0.938, 0.946), high = vec3(0.675, 0.735, 0.800);
    return mix(low, high, smoothstep(0.0, 1.0, up));
}
)";

/// How much of the key light comes through: a shadow map, compared at up to eight places, each bilinear. Most pixels are
/// the same at all of the first four, which ends the loop; on a CPU a loop that ends early saves time, an `if` does not.
constexpr const char* kShadow = R"(
uniform sampler2DShadow shadow_map;
uniform mat4 light_from_E;
uniform float texel;  // m
uniform float softness;  // radius of the places, as a share of the map
const vec2 kPlaces[8] = vec2[8](vec2(1.0, 0.45), vec2(-0.45, 1.0), vec2(-1.0, -0.45), vec2(0.45, -1.0),
                                vec2(0.55, -0.2), vec2(0.2, 0.55), vec2(-0.55, 0.2), vec2(-0.2, -0.55));
// `most`: places, 4 or 8.
float lit(vec3 p, vec3 n, int most)
{
    vec3 s = (light_from_E * vec4(p + n * (2.5 * texel), 1.0)).xyz * 0.5 + 0.5;
    float sum = 0.0, count = 0.0;
    for (int i = 0; i < most; ++i)
    {
        if (i == 4 && (sum == 0.0 || sum == 4.0)) break;
        sum += texture(shadow_map, s + vec3(kPlaces[i] * softness, 0.0));
        count += 1.0;
    }
    return count > 0.0 ? sum / count : 1.0;
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
centroid out vec3 point;  // on the surface also where the pixel's middle is not
centroid out vec3 outward;
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

/// What a point of a body looks like.
constexpr const char* kShading = R"(
uniform vec3 to_light;
// Sky above, light that the ground throws back below.
vec3 surroundings(float up) { return mix(vec3(0.46, 0.44, 0.42), vec3(0.78, 0.86, 0.96), smoothstep(-0.6, 0.8, up)); }

// `albedo`: linear; `n`: unit, towards the eye.
vec3 look(vec3 albedo, vec3 point, vec3 n, int places)
{
    vec3 v = normalize(-point), l = to_light, h = normalize(l + v);
    float facing = max(dot(n, v), 0.0), cosine = dot(n, l);
    float open = lit(point, n, cosine <= 0.0 ? 0 : places);
    float sun = max(cosine, 0.0) * open;

    // Key light, a weak one from the eye, and the surroundings; then what a clear coat mirrors (Schlick's law).
    vec3 color = albedo * (sun * vec3(1.10, 1.05, 0.97) + 0.15 * facing + 0.46 * surroundings(n.z));
    float rim = 1.0 - facing, rim2 = rim * rim;
    float fresnel = 0.04 + 0.96 * rim2 * rim2 * rim;
    float g = max(dot(n, h), 0.0);
    g *= g, g *= g, g *= g, g *= g, g *= g, g *= g;
    color += fresnel * 0.45 * surroundings(reflect(-v, n).z) + 0.30 * g * open * clamp(cosine * 6.0, 0.0, 1.0);
    return encoded(color / (1.0 + max(color - 0.8, 0.0)));  // bright spots keep their colour
}
)";

constexpr const char* kSolidFragment = R"(
centroid in vec3 point;
centroid in vec3 outward;
flat in vec3 base;
out vec4 result;
void main()
{
    vec3 n = normalize(outward);
    n = faceforward(n, point, n);  // an open mesh has two sides
    result = vec4(look(linear(base), point, n, 8), 1.0);
}
)";

/// A small sphere is one square across the ray to its middle, on which each pixel finds the sphere by itself: round at
/// any size, and much faster than many triangles of a few pixels.
constexpr const char* kBallVertex = R"(#version 330 core
layout(location = 0) in vec3 position;
layout(location = 2) in vec3 place;
layout(location = 4) in vec3 size;
layout(location = 5) in vec3 color;
uniform mat4 clip_from_E;
uniform float pixels_per_radian;
out vec3 ray;
flat out vec3 middle, base;
flat out float radius, pixel;  // m
void main()
{
    float away = length(place);
    vec3 along = place / away;
    vec3 u = normalize(cross(along, abs(along.z) < 0.7 ? vec3(0.0, 0.0, 1.0) : vec3(1.0, 0.0, 0.0))), v = cross(u, along);
    middle = place, base = color, radius = size.x, pixel = away / pixels_per_radian;
    float outline = radius * away / sqrt(max(away * away - radius * radius, 1e-12)) + 1.5 * pixel;
    ray = place + outline * (u * position.x + v * position.y);
    gl_Position = clip_from_E * vec4(ray, 1.0);
}
)";

constexpr const char* kBallFragment = R"(
in vec3 ray;
flat in vec3 middle, base;
flat in float radius, pixel;
uniform mat4 clip_from_E;
out vec4 result;
void main()
{
    // The ray's nearest point to the middle, and half its chord through the ball.
    vec3 direction = normalize(ray);
    float along = dot(direction, middle);
    vec3 miss = direction * along - middle;
    float off = dot(miss, miss), half_chord = sqrt(max(radius * radius - off, 0.0));
    vec3 point = direction * (along - half_chord);
    vec4 clip = clip_from_E * vec4(point, 1.0);
    gl_FragDepth = 0.5 + 0.5 * clip.z / clip.w;
    float coverage = clamp((radius - sqrt(off)) / pixel + 0.5, 0.0, 1.0);
    result = vec4(look(linear(base), point, normalize(point - middle), 4), coverage);
}
)";

/// For the shadow map a ball is the disc through its middle, across the light.
constexpr const char* kBallShadowVertex = R"(#version 330 core
layout(location = 0) in vec3 position;
layout(location = 2) in vec3 place;
layout(location = 4) in vec3 size;
uniform mat4 clip_from_E;
uniform vec3 light_u, light_v;
void main() { gl_Position = clip_from_E * vec4(place + size.x * (light_u * position.x + light_v * position.y), 1.0); }
)";

/// A parallelogram of the plane's z = 0.
constexpr const char* kPlaneVertex = R"(#version 330 core
uniform mat4 clip_from_E;
uniform vec3 middle, side_u, side_v;  // relative to the eye, m
out vec3 point;
out vec2 local;  // from -1 to 1
void main()
{
    local = 2.0 * vec2(gl_VertexID & 1, gl_VertexID >> 1) - 1.0;
    point = middle + side_u * local.x + side_v * local.y;
    gl_Position = clip_from_E * vec4(point, 1.0);
}
)";

constexpr const char* kPlaneFragment = R"(
in vec3 point;
in vec2 local;
uniform float cells;   // from the middle to a side
uniform vec2 phase;    // of the middle, in cells, modulo 10
uniform vec3 color;    // sRGB
uniform float opacity;
out vec4 result;

// Lines of constant strength: as wide as given, never thinner than a pixel, fainter instead.
float lines(vec2 p, vec2 pixel, float width)
{
    vec2 drawn = clamp(vec2(width), pixel, vec2(0.5));
    vec2 away = abs(fract(p + 0.5) - 0.5);
    vec2 line = clamp((drawn - away) / pixel + 0.5, 0.0, 1.0) * (width / drawn);
    line = mix(line, vec2(2.0 * width), clamp(pixel * 2.0 - 1.0, 0.0, 1.0));
    return max(line.x, line.y);
}

void main()
{
    float fade = 1.0 - smoothstep(0.15, 1.0, length(local));
    vec2 cell = local * cells + phase, pixel = max(fwidth(cell), 1e-6);
    float line = 0.42 * max(0.55 * lines(cell, pixel, 0.010), lines(cell * 0.2, pixel * 0.2, 0.0035));
    // Two layers: what shines through is what neither hides.
    float opaque = 1.0 - (1.0 - opacity) * (1.0 - line);
    result = vec4(color * (opacity * (1.0 - line) / max(opaque, 1e-4)), opaque * fade);
}
)";

/// What lies on a plane where the light does not come; drawn over it, only where shadows can be.
constexpr const char* kPlaneShadowFragment = R"(
in vec3 point;
uniform vec3 normal, focus;  // focus relative to the eye
uniform float plane_range;        // m
out vec4 result;
void main()
{
    float fade = 1.0 - smoothstep(0.15, 1.0, distance(point, focus) / plane_range);
    result = vec4(0.02, 0.03, 0.05, 0.34 * fade * (1.0 - lit(point, normal, 8)));
}
)";

constexpr const char* kBackgroundVertex = R"(#version 330 core
void main() { gl_Position = vec4(4.0 * float(gl_VertexID & 1) - 1.0, 4.0 * float(gl_VertexID >> 1) - 1.0, 1.0, 1.0); }
)";

constexpr const char* kBackgroundFragment = R"(
out vec4 result;
void main() { result = vec4(background(), 1.0); }
)";

constexpr const char* kDepthOnly = "#version 330 core\nvoid main() {}\n";

}  // namespace

ShaderText solid_shader() { return {"solid", kSolidVertex, std::string(kCommon) + kShadow + kShading + kSolidFragment}; }
ShaderText ball_shader() { return {"ball", kBallVertex, std::string(kCommon) + kShadow + kShading + kBallFragment}; }
ShaderText solid_shadow_shader() { return {"solid shadow", kSolidVertex, kDepthOnly}; }
ShaderText ball_shadow_shader() { return {"ball shadow", kBallShadowVertex, kDepthOnly}; }
ShaderText plane_shader() { return {"plane", kPlaneVertex, std::string(kCommon) + kPlaneFragment}; }
ShaderText plane_shadow_shader() { return {"plane shadow", kPlaneVertex, std::string(kCommon) + kShadow + kPlaneShadowFragment}; }
ShaderText background_shader() { return {"background", kBackgroundVertex, std::string(kCommon) + kBackgroundFragment}; }

}  // namespace plab::render
