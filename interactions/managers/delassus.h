/// Solves the contact law of a mechanism exactly, in the impulses alone of its contacts, of bounded rows (stops, brakes, motors) and of
/// rows that close loops. These are few, however many joints there are. With r these impulses and the joints held,
///
///   u = q + W r,   W = J_c A^-1 J_c^T
///
/// where A is the mechanism with its joints (joint_equations.h), q the velocities of the contacts without r, and W the Delassus operator: a
/// dense symmetric matrix with one column for each of r. The law u = q + W r, r = P(r - rho (u - least)) is that of newton.h, and solved
/// by the same semismooth Newton method, (1 + G W) dr = P(tau) - r; where that goes round in circles, projected Gauss-Seidel sweeps
/// over W lead on. Both cost no more than W itself. How redundant contacts share a load: as there, nearest to the guess.
///
/// A point that does not press and does not close is left out until it would.
///
/// Sources: E. Delassus, Ann. sci. ENS 34 (1917); V. Acary, B. Brogliato, Numerical methods for nonsmooth dynamical systems (2008), chapter
/// 12; J. Carpentier, R. Budhiraja, N. Mansard, RSS (2021), for W from the factors of the joint equations.
#pragma once

#include "contact_law.h"
#include "joint_equations.h"
#include "linear/dense.h"

namespace plab::managers
{

class DelassusSolver
{
public:
    struct Bounds
    {
        double tolerance = 1e-12;  ///< m/s, aimed at
        double enough = 0;         ///< m/s, which will do where a larger stiffness gains nothing
        double close = 0;          ///< m/s, which will do where loads are shared anew
        double locked = 1e-11;    ///< a point that the mechanism moves by less than this share of what its bodies alone would is not solved
        bool or_nothing = false;  ///< an approximation will not do
    };
    struct Found
    {
        bool solved = false;     ///< otherwise nothing has changed
        bool fell_back = false;  ///< the law is not satisfied
        int steps = 0, sweeps = 0;
    };
    /// Changes the present impulses to those of the contact law, and the velocities of the movers with them.
    Found solve(Problem& problem, const Bounds& bounds);

private:
    /// A point or row in r.
    struct Place
    {
        std::uint32_t index = 0, first = 0, count = 0;  ///< `first`: its place in r
        bool line = false;
    };

    /// Columns of W: with more, its factorisation costs more than that of the whole island.
    static constexpr std::size_t kMostImpulses = 192;

    // delassus_set_up.cpp
    bool add_missing(const Problem& problem, double least);
    void add_place(std::uint32_t index, std::uint32_t count, bool line);
    void find_columns(const Problem& problem, std::size_t from);
    void find_free(Problem& problem);
    bool set_up(const Problem& problem, double locked);
    bool take_row(const Problem& problem, const Place& place, Line& line, double locked);
    bool take_point(const Problem& problem, const Place& place, Point& p, double locked);
    void take_velocities(Problem& problem);

    // delassus.cpp
    void finish(Problem& problem, const Bounds& bounds, Found& out);
    double W(std::size_t r, std::size_t c) const { return W_[c * kMostImpulses + r]; }
    void add_responses(std::span<const double> r, std::span<double> to) const;
    void velocities_with(std::span<const double> r, std::span<double> u) const;
    Vec3 velocity(const Place& place) const;
    double gap(std::size_t place) const;
    void find_velocities();
    double residual() const;
    double rounding() const;
    bool changes_pieces();
    void add_row(std::uint32_t row, std::uint32_t of, double g);
    bool find_step(double kappa);
    bool factorise();
    bool is_spent() const;
    void go(double share);
    double newton(double tolerance, int most, Found& out);
    bool share_anew(double left, const Bounds& bounds, Found& out);
    void sweep(int times);
    void sweep_from_none(Found& out);
    void relax(std::size_t place);
    void change(std::size_t at, double by);
    bool find_impulses(const Bounds& bounds, Found& out);
    bool find_with_resistances(Problem& problem, const Bounds& bounds, Found& out);
    double bound_resistances(Problem& problem);

    // delassus_rounds.cpp
    void start_round(double kappa);
    Vec3 held(std::size_t place, std::span<const double> u, Mat3* G) const;
    double find_pull(bool with_matrix);
    double slope(double t);
    bool round(double kappa, double tolerance, Found& out);

    JointEquations with_forces_, without_forces_;  ///< changes of forces act in some solves of a step and not in others
    JointEquations* joints_ = &without_forces_;
    const Interruption* interruption_ = nullptr;
    std::vector<Place> places_;
    std::vector<std::uint8_t> point_in_, line_in_;
    std::vector<Point> points_;  ///< by place: with the mobility of the mechanism as K
    std::vector<Line> lines_;    ///< by place: likewise
    std::size_t size_ = 0;       ///< of r
    std::vector<double> W_;      ///< by column, each of kMost
    std::vector<double> q_, r_, u_, best_, guess_, step_;
    std::vector<double> y_, pull_, rates_, trial_;  ///< of a round, as are these, by place
    std::vector<double> rho_, bias_;
    linear::Factors<double> factors_;
    double work_ = 0;           ///< of all factorisations of a solve, in cubes of the number of impulses
    bool contradicts_ = false;  ///< newton() has ended where a larger stiffness gains nothing
    std::vector<char> pieces_;
    std::vector<Column6> columns_;
    std::vector<Vec3> guess_points_;
    std::vector<double> guess_lines_;
};

}  // namespace plab::managers
