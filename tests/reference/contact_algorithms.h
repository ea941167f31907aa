/// All combinations of algorithms that can answer a contact, and tables of the error bounds for each.
///
/// A line of a table covers a set of algorithms; the first line that matches an algorithm applies. Each algorithm must match a
/// line and each line an algorithm, so a new algorithm requires that its bound is stated.
#pragma once

#include <doctest/doctest.h>

#include <algorithm>
#include <array>
#include <string>
#include <string_view>
#include <vector>

#include "support/text.h"

namespace plab::test
{

/// The resolution, the response and, for responses by rows, the manager.
struct Algorithm
{
    const char* resolution;
    const char* response;
    const char* manager = "Direct";

    bool rows() const { return std::string_view(response) == "Rows"; }
    bool springs() const { return std::string_view(response) == "Penalty" || std::string_view(response) == "HuntCrossley"; }
    bool locates() const { return !is("None") && !is("Speculative"); }
    bool certifies() const { return is("LocalRoot") || is("ConservativeAdvancement"); }
    bool is(std::string_view wanted) const { return resolution == wanted; }
    bool by(std::string_view wanted) const { return rows() && manager == wanted; }
    std::string law() const { return std::string(response) + (rows() ? std::string("/") + manager : ""); }
    std::string name() const { return std::string(resolution) + " + " + law(); }
};

/// Resolution x response x manager: all combinations that the host accepts (the unit test contact_rules lists those it refuses).
/// Spring responses query contacts themselves while bodies touch, so no resolution changes their results. Response/None answers
/// nothing: sensor().
inline std::vector<Algorithm> every_algorithm()
{
    std::vector<Algorithm> out;
    for (const char* resolution : {"None", "Bisection", "LocalBisection", "ConservativeAdvancement", "LocalRoot"})
        out.push_back({resolution, "Impulse"});
    for (const char* manager : {"Direct", "SequentialImpulse", "SoftStep"})
        for (const char* resolution : {"None", "Speculative", "Bisection", "LocalBisection", "ConservativeAdvancement", "LocalRoot"})
            out.push_back({resolution, "Rows", manager});
    out.push_back({"None", "Penalty"});
    out.push_back({"None", "HuntCrossley"});
    return out;
}

/// The combinations for persistent contacts. Left out are resolutions that locate events together with managers that sweep: one
/// second of C16 (Bisection, SequentialImpulse) did not end within a minute.
inline std::vector<Algorithm> standing_algorithms()
{
    std::vector<Algorithm> out = every_algorithm();
    std::erase_if(out, [](const Algorithm& r) { return r.locates() && r.rows() && !r.by("Direct"); });
    return out;
}

inline std::string contact(const std::string& between, const Algorithm& algorithm, double restitution, double friction = 0,
                           const std::string& more = "")
{
    return "<component id=\"contact\" type=\"CDetection/ODE\" between=\"" + between + "\" resolution=\"Resolution/" + algorithm.resolution +
           "\" response=\"Response/" + algorithm.response + "\" response.restitution=\"" + text(restitution) + "\" response.friction=\"" +
           text(friction) + "\"" + (algorithm.rows() ? std::string(" response.manager=\"Manager/") + algorithm.manager + "\"" : "") + " " +
           more + "/>";
}
/// The argument `more` of contact(): additional parameters of spring responses. Contacts of many points are as exact as single ones.
inline std::string stiffness(const Algorithm& algorithm, double linear, double hertz, const std::string& more = "")
{
    if (!algorithm.springs()) return "";
    return "response.stiffness=\"" + text(std::string_view(algorithm.response) == "Penalty" ? linear : hertz) +
           "\" response.steps_among_many=\"200\" " + more;
}

/// The restitution where nothing is to bounce. With little restitution, HuntCrossley separates so slowly that it takes thousands
/// of pieces; .5 is sufficient where bodies only need to settle.
inline double plastic(const Algorithm& algorithm) { return std::string_view(algorithm.response) == "HuntCrossley" ? 0.5 : 0; }

/// Upper and lower bounds of N measured values. An error known to be large has a lower bound as well: a smaller one means that
/// the algorithm has changed.
template <std::size_t N>
struct Bound
{
    /// "located", "certified", "halved" (by bisections), "at ends" (None, Speculative), "*", or a resolution.
    const char* when;
    /// "*", "springs", or the beginning of a law's name: "Impulse", "Rows", "Rows/SoftStep", "Penalty".
    const char* response;
    std::array<double, N> most;
    std::array<double, N> least = {};

    bool fits(const Algorithm& algorithm) const
    {
        const std::string_view time = when, answer = response;
        const bool at_time = time == "*" || algorithm.is(time) || (time == "located" && algorithm.locates()) ||
                             (time == "certified" && algorithm.certifies()) ||
                             (time == "halved" && algorithm.locates() && !algorithm.certifies()) ||
                             (time == "at ends" && !algorithm.locates());
        const bool by_law = answer == "*" || (answer == "springs" && algorithm.springs()) || algorithm.law().rfind(answer, 0) == 0;
        return at_time && by_law;
    }
};

/// `measure(algorithm)` returns the measured values for each of `algorithms`.
template <std::size_t N, std::size_t Lines, class Measure>
void check_algorithms(const std::vector<Algorithm>& algorithms, const Bound<N> (&table)[Lines], const Measure& measure)
{
    std::array<bool, Lines> used{};
    for (const Algorithm& algorithm : algorithms)
    {
        CAPTURE(algorithm.name());
        const auto line = std::find_if(std::begin(table), std::end(table), [&](const Bound<N>& b) { return b.fits(algorithm); });
        REQUIRE(line != std::end(table));
        used[static_cast<std::size_t>(line - std::begin(table))] = true;
        const std::array<double, N> figures = measure(algorithm);
        for (std::size_t figure = 0; figure < N; ++figure)
        {
            CAPTURE(figure);
            CHECK(figures[figure] <= line->most[figure]);
            if (line->least[figure] > 0) CHECK(figures[figure] >= line->least[figure]);
        }
    }
    for (std::size_t i = 0; i < Lines; ++i)
        CHECK_MESSAGE(used[i], "no algorithm has the line ", std::string(table[i].when), " + ", std::string(table[i].response));
}

}  // namespace plab::test
