/// theta'' = -w0^2 sin theta from any angle and speed, by Jacobi's elliptic functions: libration and rotation.
///
/// sin(theta/2) = k sn(tau0 + w0 t | k^2), or theta = 2 am(tau0 + k w0 t | 1/k^2) beyond the separatrix, with
/// k^2 = sin^2(theta/2) + (theta'/2 w0)^2 (Abramowitz and Stegun, 16 and 17).
#pragma once

namespace plab::exact
{

class PendulumMotion
{
public:
    /// theta in rad from the stable equilibrium, speed in rad/s; w0 > 0.
    PendulumMotion(double w0, double theta, double speed);

    void at(double t, double& theta, double& speed) const;
    /// The first t > 0 at which the speed is 0; infinite if the pendulum rotates.
    double time_of_turn() const;
    double frequency() const { return w0_; }
    double k2() const { return k2_; }
    /// Largest angular rate that phases have, rad/s.
    double fastest() const;

private:
    double w0_, turns_ = 0, k2_ = 0, excess_ = 1, mc_ = 1, tau0_ = 0, sign_ = 1;
    bool swings_ = true;
};

}  // namespace plab::exact
