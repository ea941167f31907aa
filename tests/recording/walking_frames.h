/// Frames as a server sends them, of bodies that move smoothly: the main content of recordings.
#pragma once

#include <cmath>
#include <random>
#include <vector>

#include "idl/topics.h"

namespace plab::test
{

/// Bodies that wander: velocities of about 1 m/s and 1 rad/s whose changes are random, poses that follow them.
class WalkingFrames
{
public:
    /// `moving` of `bodies` move; the others are at rest.
    WalkingFrames(std::size_t bodies, std::size_t moving, double dt) : bodies_(bodies), moving_(moving), dt_(dt)
    {
        for (std::size_t i = 0; i < bodies; ++i)
            bodies_[i] = {static_cast<std::uint32_t>(i), {normal(), normal(), normal()}, {1, 0, 0, 0}, {0, 0, 0}, {0, 0, 0}};
    }

    /// The next frame; its memory belongs to this object.
    const plab_v2_Frame& next()
    {
        for (std::size_t i = 0; i < moving_; ++i) walk(bodies_[i]);
        frame_.run = 1;
        ++frame_.sequence_number;
        ++frame_.step;
        frame_.time = dt_ * static_cast<double>(frame_.step);
        frame_.stamp_ns = 1'700'000'000'000'000'000 + static_cast<std::int64_t>(frame_.time * 1e9);
        const auto n = static_cast<std::uint32_t>(bodies_.size());
        frame_.bodies = {n, n, bodies_.data(), false};
        return frame_;
    }
    std::uint64_t log_time() const { return static_cast<std::uint64_t>(std::llround(frame_.time * 1e9)); }

private:
    double normal() { return normal_(random_); }
    void drift(plab_v2_Vector& v)
    {
        const double keep = std::exp(-dt_), kick = std::sqrt(1 - keep * keep);
        v = {keep * v.x + kick * normal(), keep * v.y + kick * normal(), keep * v.z + kick * normal()};
    }
    void walk(plab_v2_BodyState& b)
    {
        drift(b.linear_velocity);
        drift(b.angular_velocity);
        const plab_v2_Vector &v = b.linear_velocity, &w = b.angular_velocity;
        b.position = {b.position.x + dt_ * v.x, b.position.y + dt_ * v.y, b.position.z + dt_ * v.z};
        const plab_v2_Rotation q = b.orientation;
        const double h = dt_ / 2;
        const plab_v2_Rotation r{q.w - h * (w.x * q.x + w.y * q.y + w.z * q.z), q.x + h * (w.x * q.w + w.y * q.z - w.z * q.y),
                                 q.y + h * (w.y * q.w + w.z * q.x - w.x * q.z), q.z + h * (w.z * q.w + w.x * q.y - w.y * q.x)};
        const double n = 1 / std::sqrt(r.w * r.w + r.x * r.x + r.y * r.y + r.z * r.z);
        b.orientation = {n * r.w, n * r.x, n * r.y, n * r.z};
    }

    std::vector<plab_v2_BodyState> bodies_;
    std::size_t moving_;
    double dt_;
    plab_v2_Frame frame_{};
    std::mt19937_64 random_{1};
    std::normal_distribution<double> normal_{0, 1};
};

}  // namespace plab::test
