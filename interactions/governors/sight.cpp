#include "sight.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace plab::governors
{

double distance_to(const Viewpoint& eye, const Ball& ball) { return std::max(0.0, length(ball.center - eye.position) - ball.radius); }

double pixels_of(const Viewpoint& eye, const Ball& ball)
{
    const double distance = length(ball.center - eye.position);
    if (distance <= ball.radius) return std::numeric_limits<double>::infinity();
    const double pixels_per_metre = 0.5 * eye.height / std::tan(0.5 * eye.field_of_view);  // of a picture plane at 1 m
    return 2 * ball.radius / distance * pixels_per_metre;
}

Viewpoint widened(const Viewpoint& eye, double margin)
{
    constexpr double kWidest = 1.5;  // rad, of half a picture: a plane cannot show a right angle
    const double tall = std::min(kWidest, 0.5 * eye.field_of_view + margin);
    const double wide = std::min(kWidest, std::atan(std::tan(0.5 * eye.field_of_view) * eye.width / eye.height) + margin);
    Viewpoint out = eye;
    out.field_of_view = 2 * tall, out.width = eye.height * std::tan(wide) / std::tan(tall);
    return out;
}

bool is_in_view(const Viewpoint& eye, const Ball& ball)
{
    const Vec3 p = ball.center - eye.position;
    const Vec3 right = normalized(cross(eye.direction, eye.up)), up = cross(right, eye.direction);
    const double tall = std::tan(0.5 * eye.field_of_view), wide = tall * eye.width / eye.height;
    const double x = dot(p, right), y = dot(p, up), z = dot(p, eye.direction);
    if (z < -ball.radius) return false;
    // Distance from the four side planes through the eye, positive outside.
    const double beside = (std::fabs(x) - wide * z) / std::hypot(1.0, wide), above = (std::fabs(y) - tall * z) / std::hypot(1.0, tall);
    return beside <= ball.radius && above <= ball.radius;
}

double pixels_per_metre(const GovernedComponent& g, std::span<const Viewpoint> eyes, double look_ahead, double margin)
{
    constexpr double kNearest = 0.1;  // m: what is nearer fills the picture
    double most = 0;
    for (const Viewpoint& eye : eyes)
    {
        const double reach = look_ahead * (length(eye.velocity) + g.speed);
        if (!is_in_view(widened(eye, margin), {g.center, g.radius + reach})) continue;
        const double distance = std::max(kNearest, distance_to(eye, {g.center, g.radius}) - reach);
        most = std::max(most, 0.5 * eye.height / std::tan(0.5 * eye.field_of_view) / distance);
    }
    return most;
}

namespace
{

/// The side of the box, +1 or -1 along an axis, that faces the eye; 0: the eye is between the two.
int facing_side(double eye, double half) { return eye > half ? 1 : eye < -half ? -1 : 0; }

/// Whether the ball is on the far side of the plane that contains the eye and the edge, seen from the inside of the box's shadow.
bool inside_shadow_plane(const Vec3& eye, const Vec3& a, const Vec3& b, const Vec3& inner, const Ball& ball)
{
    Vec3 n = cross(a - eye, b - eye);
    const double size = length(n);
    if (size == 0) return false;
    n = n / size;
    if (dot(n, inner - eye) < 0) n = -n;
    return dot(n, ball.center - eye) >= ball.radius;
}

}  // namespace

bool is_hidden(const Vec3& eye_W, const Ball& ball_W, const Occluder& box)
{
    // In the frame of the box.
    const Vec3 eye = rotate_back(box.pose.q, eye_W - box.pose.p);
    const Ball ball{rotate_back(box.pose.q, ball_W.center - box.pose.p), ball_W.radius};
    int side[3];
    bool outside = false;
    for (int k = 0; k < 3; ++k) side[k] = facing_side(eye[k], box.half[k]), outside = outside || side[k] != 0;
    if (!outside) return false;  // the eye is in the box
    for (int k = 0; k < 3; ++k)
        if (side[k] != 0 && side[k] * ball.center[k] + ball.radius > box.half[k]) return false;  // not behind this face
    // The outline that the eye sees: edges between a face that it sees and one that it does not see.
    for (int k = 0; k < 3; ++k)
        for (int m = 0; m < 3; ++m)
        {
            if (m == k || side[k] == 0) continue;
            for (const int turned : {-1, 1})
            {
                if (side[m] == turned) continue;  // the eye sees both faces, so their edge is inside the outline
                const int along = 3 - k - m;
                Vec3 a;
                a[k] = side[k] * box.half[k], a[m] = turned * box.half[m], a[along] = box.half[along];
                Vec3 b = a;
                b[along] = -b[along];
                if (!inside_shadow_plane(eye, a, b, {}, ball)) return false;
            }
        }
    return true;
}

}  // namespace plab::governors
