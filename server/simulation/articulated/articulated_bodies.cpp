#include "simulation/articulated/articulated_bodies.h"

#include <cmath>

#include "plab/rotation.h"

namespace plab::simulation
{
namespace
{

Vec3 part(std::span<const double> v, std::size_t i) { return {v[i], v[i + 1], v[i + 2]}; }
void set_part(std::span<double> v, std::size_t i, const Vec3& a) { v[i] = a.x, v[i + 1] = a.y, v[i + 2] = a.z; }

Vec3 row_of(const Mat3& a, int i) { return {a.m[i][0], a.m[i][1], a.m[i][2]}; }
void set_row(Mat3& a, int i, const Vec3& v) { a.m[i][0] = v.x, a.m[i][1] = v.y, a.m[i][2] = v.z; }

/// a + s x y^T
void add_outer(Mat3& a, const Vec3& x, const Vec3& y, double s)
{
    for (int i = 0; i < 3; ++i) set_row(a, i, row_of(a, i) + (s * x[i]) * y);
}

/// [l]x A
Mat3 cross_rows(const Vec3& l, const Mat3& a)
{
    Mat3 out;
    set_row(out, 0, l.y * row_of(a, 2) - l.z * row_of(a, 1));
    set_row(out, 1, l.z * row_of(a, 0) - l.x * row_of(a, 2));
    set_row(out, 2, l.x * row_of(a, 1) - l.y * row_of(a, 0));
    return out;
}

}  // namespace

std::size_t ArticulatedBodies::freedom(JointKind kind)
{
    switch (kind)
    {
        case JointKind::Weld:
            return 0;
        case JointKind::Hinge:
        case JointKind::Slider:
            return 1;
        case JointKind::Ball:
            return 3;
        case JointKind::Free:
            break;
    }
    return 6;
}

ArticulatedBodies::Spatial ArticulatedBodies::times(const Inertia& inertia, const Spatial& a)
{
    return {inertia.M * a.linear + inertia.H * a.angular, transposed_times(inertia.H, a.linear) + inertia.J * a.angular};
}

void ArticulatedBodies::start(const Bodies& bodies, const JointTree& tree)
{
    links_.resize(tree.links().size());
    size_ = 0;
    for (std::size_t i = 0; i < links_.size(); ++i)
    {
        const TreeLink& from = tree.links()[i];
        Link& link = links_[i];
        link.body = from.body, link.parent = from.parent, link.offset = static_cast<std::uint32_t>(size_);
        const Quat& q = bodies.orientation[link.body];
        const Vec3& c = bodies.position[link.body];
        if (from.joint == kNoIndex)
        {
            link.kind = JointKind::Free, link.anchor_P = c, link.relative = q, link.anchor_C = {};
            size_ += 6;
            continue;
        }
        const RecognizedJoint& joint = tree.joints()[from.joint];
        link.kind = joint.kind;
        const bool held = link.parent == kNoIndex;
        const std::uint32_t parent = held ? 0 : links_[link.parent].body;
        // A weld and a slider have no point of their own: the child's centre serves.
        const bool turns = joint.kind == JointKind::Hinge || joint.kind == JointKind::Ball;
        const Vec3& anchor = turns ? joint.anchor_W : c;
        link.anchor_P = held ? anchor : rotate_back(bodies.orientation[parent], anchor - bodies.position[parent]);
        link.anchor_C = turns ? rotate_back(q, c - anchor) : Vec3{};
        link.relative = held ? q : normalized(conjugate(bodies.orientation[parent]) * q);
        link.axis_C = rotate_back(q, from.reversed ? -joint.axis_W : joint.axis_W);
        size_ += freedom(link.kind);
    }
}

void ArticulatedBodies::read_speeds(const Bodies& bodies, std::span<double> u) const
{
    for (const Link& link : links_)
    {
        const Quat& q = bodies.orientation[link.body];
        const Vec3 &v = bodies.velocity[link.body], &w = bodies.angular_velocity[link.body];
        if (link.kind == JointKind::Weld) continue;
        if (link.kind == JointKind::Free)
        {
            set_part(u, link.offset, v), set_part(u, link.offset + 3, rotate_back(q, w));
            continue;
        }
        const bool held = link.parent == kNoIndex;
        const std::uint32_t parent = held ? 0 : links_[link.parent].body;
        const Vec3 w_P = held ? Vec3{} : bodies.angular_velocity[parent];
        if (link.kind == JointKind::Ball)
            set_part(u, link.offset, rotate_back(q, w - w_P));
        else if (link.kind == JointKind::Hinge)
            u[link.offset] = dot(rotate(q, link.axis_C), w - w_P);
        else
        {
            const Vec3 carried = held ? Vec3{} : bodies.velocity[parent] + cross(w_P, bodies.position[link.body] - bodies.position[parent]);
            u[link.offset] = dot(rotate(q, link.axis_C), v - carried);
        }
    }
}

void ArticulatedBodies::place(Bodies& bodies, std::span<const double> x, std::span<const double> u)
{
    static const Mat3 kUpright = Mat3::identity();
    for (Link& link : links_)
    {
        const Link* parent = link.parent == kNoIndex ? nullptr : &links_[link.parent];
        const Mat3& R_P = parent ? parent->R : kUpright;
        const Vec3 c_P = parent ? parent->c : Vec3{}, w_P = parent ? parent->w : Vec3{}, v_P = parent ? parent->v : Vec3{};
        const std::size_t k = link.offset;
        Quat local = link.relative;
        if (link.kind == JointKind::Hinge) local = local * exp_rotation(x[k] * link.axis_C);
        if (link.kind == JointKind::Ball) local = local * exp_rotation(part(x, k));
        if (link.kind == JointKind::Free) local = local * exp_rotation(part(x, k + 3));
        link.q = parent ? parent->q * local : local;
        link.R = rotation_matrix(link.q);
        link.axis = link.R * link.axis_C;
        link.r = link.R * link.anchor_C;
        Vec3 l = R_P * link.anchor_P + link.r;
        Vec3 relative;  // velocity of the centre relative to the parent as a rigid body
        link.turn = {};
        switch (link.kind)
        {
            case JointKind::Weld:
                break;
            case JointKind::Hinge:
                link.turn = u[k] * link.axis, relative = cross(link.turn, link.r);
                break;
            case JointKind::Slider:
                l += x[k] * link.axis, relative = u[k] * link.axis;
                break;
            case JointKind::Ball:
                link.turn = link.R * part(u, k), relative = cross(link.turn, link.r);
                break;
            case JointKind::Free:
                l += part(x, k), link.turn = link.R * part(u, k + 3), relative = part(u, k);
                break;
        }
        link.l = l, link.c = c_P + l;
        link.w = w_P + link.turn;
        link.v = v_P + cross(w_P, l) + relative;
        const std::uint32_t b = link.body;
        bodies.position[b] = link.c, bodies.orientation[b] = link.q;
        bodies.velocity[b] = link.v, bodies.angular_velocity[b] = link.w;
        bodies.angular_momentum[b] = link.R * (bodies.inertia_B[b] * transposed_times(link.R, link.w));
    }
}

void ArticulatedBodies::coordinate_rates(std::span<const double> x, std::span<const double> u, std::span<double> rates) const
{
    for (const Link& link : links_)
    {
        const std::size_t k = link.offset;
        if (link.kind == JointKind::Hinge || link.kind == JointKind::Slider) rates[k] = u[k];
        if (link.kind == JointKind::Ball) set_part(rates, k, rotation_vector_rate(part(x, k), part(u, k)));
        if (link.kind != JointKind::Free) continue;
        set_part(rates, k, part(u, k));
        set_part(rates, k + 3, rotation_vector_rate(part(x, k + 3), part(u, k + 3)));
    }
}

void ArticulatedBodies::set_subspace(Link& link) const
{
    if (link.kind == JointKind::Hinge) link.S[0] = {cross(link.axis, link.r), link.axis};
    if (link.kind == JointKind::Slider) link.S[0] = {link.axis, {}};
    if (link.kind != JointKind::Ball) return;
    for (int k = 0; k < 3; ++k)
    {
        const Vec3 e{link.R(0, k), link.R(1, k), link.R(2, k)};
        link.S[static_cast<std::size_t>(k)] = {cross(e, link.r), e};
    }
}

/// The acceleration at u' = 0 of a child whose parent does not accelerate: of a point that turns with the parent, and of the joint's own
/// motion.
void ArticulatedBodies::set_bias(Link& link) const
{
    link.bias = {};
    const Vec3 w_P = link.parent == kNoIndex ? Vec3{} : links_[link.parent].w;
    const Vec3 from_anchor = link.kind == JointKind::Hinge || link.kind == JointKind::Ball ? link.r : Vec3{};
    link.bias.linear = cross(w_P, cross(w_P, link.l - from_anchor));
    if (link.kind == JointKind::Slider)
        link.bias.linear += 2 * cross(w_P, link.v - (link.parent == kNoIndex ? Vec3{} : links_[link.parent].v + cross(w_P, link.l)));
    if (link.kind != JointKind::Hinge && link.kind != JointKind::Ball) return;
    link.bias.angular = cross(w_P, link.turn);
    link.bias.linear += cross(link.bias.angular, link.r) + cross(link.w, cross(link.w, link.r));
}

/// U = I^A S and the factors of D = S^T U.
void ArticulatedBodies::factor(Link& link, std::size_t n) const
{
    const auto inner = [](const Spatial& a, const Spatial& b) { return dot(a.linear, b.linear) + dot(a.angular, b.angular); };
    std::array<double, 6> D{};
    for (std::size_t k = 0, at = 0; k < n; ++k)
    {
        link.U[k] = times(link.inertia, link.S[k]);
        link.push[k] = -inner(link.S[k], link.p);
        for (std::size_t j = 0; j <= k; ++j) D[at++] = inner(link.S[k], link.U[j]);
    }
    link.D.factor(D, n);
}

/// Adds to the parent the inertia and the bias force that the joint lets through.
void ArticulatedBodies::pass_inward(const Link& link, std::size_t n)
{
    if (link.parent == kNoIndex) return;
    Inertia I = link.inertia;
    std::array<double, 3> give = link.push;
    link.D.solve(give, n);
    for (std::size_t k = 0; k < n; ++k)
    {
        std::array<double, 3> unit{};  // row k of D^-1
        unit[k] = 1;
        link.D.solve(unit, n);
        Spatial w{};
        for (std::size_t j = 0; j < n; ++j) w.linear += unit[j] * link.U[j].linear, w.angular += unit[j] * link.U[j].angular;
        add_outer(I.M, link.U[k].linear, w.linear, -1);
        add_outer(I.H, link.U[k].linear, w.angular, -1);
        add_outer(I.J, link.U[k].angular, w.angular, -1);
    }
    Spatial p = times(I, link.bias);
    p.linear += link.p.linear, p.angular += link.p.angular;
    for (std::size_t k = 0; k < n; ++k) p.linear += give[k] * link.U[k].linear, p.angular += give[k] * link.U[k].angular;

    // X^T I X, with H' = H - M [l]x and J' = J + [l]x H' + ([l]x H)^T.
    Link& parent = links_[link.parent];
    const Vec3& l = link.l;
    const Mat3 before = cross_rows(l, I.H);
    for (int i = 0; i < 3; ++i) set_row(I.H, i, row_of(I.H, i) - cross(row_of(I.M, i), l));
    const Mat3 after = cross_rows(l, I.H);
    Inertia& to = parent.inertia;
    for (int i = 0; i < 3; ++i)
        for (int j = 0; j < 3; ++j)
        {
            to.M.m[i][j] += I.M.m[i][j], to.H.m[i][j] += I.H.m[i][j];
            if (j > i) continue;
            to.J.m[i][j] += I.J.m[i][j] + after.m[i][j] + before.m[j][i];
            to.J.m[j][i] = to.J.m[i][j];
        }
    parent.p.linear += p.linear, parent.p.angular += p.angular + cross(l, p.linear);
}

/// The acceleration of a free root: I^A a = -p. The inertia is stored as 3 x 3 blocks, so the linear part is eliminated as one block;
/// M and the Schur complement are positive definite.
void ArticulatedBodies::free_acceleration(Link& link)
{
    const Inertia& I = link.inertia;
    const Mat3 M_inverse = inverse(I.M);
    const Mat3 K = M_inverse * I.H;
    const Mat3 Schur = I.J - transposed(I.H) * K;
    const Vec3 x = M_inverse * link.p.linear;
    link.a.angular = inverse(Schur) * (transposed_times(I.H, x) - link.p.angular);
    link.a.linear = -x - K * link.a.angular;
}

void ArticulatedBodies::accelerate(const Bodies& bodies, const Wrenches& wrenches, std::span<double> rates)
{
    for (Link& link : links_)
    {
        const std::uint32_t b = link.body;
        const double m = bodies.mass[b];
        link.inertia.M = Mat3::diagonal(m, m, m), link.inertia.H = {};
        link.inertia.J = link.R * bodies.inertia_B[b] * transposed(link.R);
        link.p = {-wrenches.force[b], cross(link.w, bodies.angular_momentum[b]) - wrenches.torque[b]};
        set_subspace(link), set_bias(link);
    }
    for (std::size_t i = links_.size(); i-- > 0;)
    {
        if (links_[i].kind == JointKind::Free) continue;
        const std::size_t n = freedom(links_[i].kind);
        if (n > 0) factor(links_[i], n);
        pass_inward(links_[i], n);
    }
    for (Link& link : links_)
    {
        const std::size_t k = link.offset;
        if (link.kind == JointKind::Free)
        {
            free_acceleration(link);
            set_part(rates, k, link.a.linear), set_part(rates, k + 3, transposed_times(link.R, link.a.angular));
            continue;
        }
        link.a = link.bias;
        if (link.parent != kNoIndex)
        {
            const Spatial& up = links_[link.parent].a;
            link.a.linear += up.linear + cross(up.angular, link.l), link.a.angular += up.angular;
        }
        const std::size_t n = freedom(link.kind);
        std::array<double, 3> du = link.push;
        for (std::size_t j = 0; j < n; ++j) du[j] -= dot(link.U[j].linear, link.a.linear) + dot(link.U[j].angular, link.a.angular);
        link.D.solve(du, n);
        for (std::size_t j = 0; j < n; ++j)
        {
            rates[k + j] = du[j];
            link.a.linear += du[j] * link.S[j].linear, link.a.angular += du[j] * link.S[j].angular;
        }
    }
}

std::span<const JointReaction> ArticulatedBodies::reactions(const JointTree& tree)
{
    reactions_.resize(tree.joints().size());
    for (std::size_t j = 0; j < reactions_.size(); ++j) reactions_[j] = {tree.joints()[j].component, {}, {}};
    for (std::size_t i = 0; i < links_.size(); ++i)
    {
        const TreeLink& from = tree.links()[i];
        if (from.joint == kNoIndex) continue;
        const Link& link = links_[i];
        JointReaction& r = reactions_[from.joint];
        const Spatial f = times(link.inertia, link.a);
        r.force = f.linear + link.p.linear, r.torque = f.angular + link.p.angular;
        if (!from.reversed) continue;
        // The last participant is the parent; a fixed one keeps the place that it has.
        const Vec3 last = link.parent == kNoIndex ? tree.joints()[from.joint].last_W : links_[link.parent].c;
        r.force = -r.force, r.torque = -r.torque + cross(link.c - last, r.force);
    }
    return reactions_;
}

}  // namespace plab::simulation
