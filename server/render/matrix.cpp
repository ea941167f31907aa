#include "matrix.h"

namespace plab::render
{
namespace
{

/// Row `row` of m is (a, d).
void set_row(Mat4& m, int row, const Vec3& a, double d)
{
    for (int column = 0; column < 3; ++column) m.m[4 * column + row] = static_cast<float>(a[column]);
    m.m[12 + row] = static_cast<float>(d);
}

}  // namespace

Basis basis_of(const Vec3& back, const Vec3& up)
{
    Basis out;
    out.back = normalized(back);
    if (length(out.back) == 0) out.back = {0, 0, 1};
    out.right = normalized(cross(normalized(up), out.back));
    if (length(out.right) == 0) out.right = any_perpendicular(out.back);
    out.up = cross(out.back, out.right);
    return out;
}

Mat4 perspective(const Basis& eye, double field_of_view, double aspect, double near, double far)
{
    const double focus = 1 / std::tan(0.5 * field_of_view);
    Mat4 out;
    set_row(out, 0, eye.right * (focus / aspect), 0);
    set_row(out, 1, eye.up * focus, 0);
    // clip z = -(far + near)/(far - near) (back . p) - 2 far near/(far - near) has back . p < 0 in front of the eye.
    set_row(out, 2, eye.back * (-(far + near) / (far - near)), -2 * far * near / (far - near));
    set_row(out, 3, -eye.back, 0);
    return out;
}

Mat4 orthographic(const Basis& light, const Box3& box)
{
    const Vec3 half = (box.high - box.low) * 0.5, middle = (box.high + box.low) * 0.5;
    Mat4 out;
    set_row(out, 0, light.right / half.x, -middle.x / half.x);
    set_row(out, 1, light.up / half.y, -middle.y / half.y);
    set_row(out, 2, -light.back / half.z, middle.z / half.z);
    set_row(out, 3, {}, 1);
    return out;
}

}  // namespace plab::render
